; Blocks on a table, one hand: plain STRIPS without types.
(define (domain blocks)
  (:requirements :strips)
  (:predicates
    (on ?x ?y)      ; block x stands on block y
    (on-table ?x)   ; block x stands on the table
    (clear ?x)      ; nothing stands on block x
    (hand-empty)    ; the hand holds nothing
    (in-hand ?x))   ; the hand holds block x
  (:action pick-up
    :parameters (?x)
    :precondition (and (clear ?x) (on-table ?x) (hand-empty))
    :effect (and (not (on-table ?x)) (not (clear ?x)) (not (hand-empty)) (in-hand ?x)))
  (:action put-down
    :parameters (?x)
    :precondition (in-hand ?x)
    :effect (and (not (in-hand ?x)) (clear ?x) (hand-empty) (on-table ?x)))
  (:action stack
    :parameters (?x ?y)
    :precondition (and (in-hand ?x) (clear ?y))
    :effect (and (not (in-hand ?x)) (not (clear ?y)) (clear ?x) (hand-empty) (on ?x ?y)))
  (:action unstack
    :parameters (?x ?y)
    :precondition (and (on ?x ?y) (clear ?x) (hand-empty))
    :effect (and (in-hand ?x) (clear ?y) (not (clear ?x)) (not (hand-empty)) (not (on ?x ?y))))
)
