; Blocks on a table, and a hand that holds one of them. Plain PDDL: no object graphs, nothing compiled.

(define (domain blocks)
  (:requirements :strips :typing)

  (:types block - object)

  (:predicates
    (on ?x - block ?y - block)   ; x stands on y
    (on_table ?x - block)        ; x stands on the table
    (clear ?x - block)           ; nothing stands on x, and it is not held
    (holding ?x - block)         ; x is in the hand
    (hand_empty)                 ; nothing is in the hand
  )

  ; Take x from the table.
  (:action pick_up
    :parameters (?x - block)
    :precondition (and (clear ?x) (on_table ?x) (hand_empty))
    :effect (and (holding ?x) (not (clear ?x)) (not (on_table ?x)) (not (hand_empty))))

  ; Put x on the table: what is in the hand.
  (:action put_down
    :parameters (?x - block)
    :precondition (holding ?x)
    :effect (and (on_table ?x) (clear ?x) (hand_empty) (not (holding ?x))))

  ; Take x from y.
  (:action unstack
    :parameters (?x - block ?y - block)
    :precondition (and (on ?x ?y) (clear ?x) (hand_empty))
    :effect (and (holding ?x) (clear ?y) (not (on ?x ?y)) (not (clear ?x)) (not (hand_empty))))

  ; Put x on y: what is in the hand on another block.
  (:action stack
    :parameters (?x - block ?y - block)
    :precondition (and (holding ?x) (clear ?y))
    :effect (and (on ?x ?y) (clear ?x) (hand_empty) (not (holding ?x)) (not (clear ?y))))
)
