; A desk with drawers, and a robot with one hand. The third step of the ladder: objects that have parts.

(define (domain drawer)
  (:requirements :strips :typing :negative-preconditions :disjunctive-preconditions :equality
                 :existential-preconditions :conditional-effects)

  (:types
    thing robot relation - object
    fixture item - thing         ; fixtures stay where they are, items can be carried
    furniture part - fixture     ; parts are vertices of an object graph
  )

  (:constants
    pr2 - robot
    on in - relation
  )

  (:predicates
    ; --- the robot
    (near ?r - robot ?x - fixture)             ; x is within reach
    (holding ?r - robot ?x - item)             ; x is in the hand
    (free ?r - robot)                          ; nothing is in the hand
    ; --- the world as it changes
    (at ?x - thing ?y - fixture ?rel - relation) ; x is on or in y
    (opened ?x - fixture)                        ; the drawer x is open
    ; --- edges of the object graphs; they never change
    (part_of ?x - thing ?y - thing)             ; x is a part of y
    ; --- what things are good for; these never change either
    (allows ?x - fixture ?rel - relation)      ; things can be put on or in x
    (closes ?x - fixture)                      ; x gives and takes nothing while it is not open
  )

  ; Go and stand before x, or before what x is a part of, or is on or in; all the parts there come into reach.
  (:action moveto
    :parameters (?x - thing)
    :precondition (and)
    :effect (and
      (forall (?y - fixture) (not (near pr2 ?y)))
      (forall (?y - furniture) (when (= ?x ?y) (near pr2 ?y)))
      (forall (?y - furniture) (when (part_of ?x ?y) (near pr2 ?y)))
      (forall (?y - part) (when (part_of ?y ?x) (near pr2 ?y)))
      (forall (?y - part ?z - furniture) (when (and (part_of ?x ?z) (part_of ?y ?z)) (near pr2 ?y)))
      (forall (?y - furniture ?rel - relation) (when (at ?x ?y ?rel) (near pr2 ?y)))
      (forall (?y - part ?z - furniture ?rel - relation)
        (when (and (at ?x ?z ?rel) (part_of ?y ?z)) (near pr2 ?y)))
      (forall (?y - part ?z - furniture ?p - part ?rel - relation)
        (when (and (at ?x ?p ?rel) (part_of ?p ?z) (part_of ?y ?z)) (near pr2 ?y)))
      (forall (?z - furniture ?p - part ?rel - relation)
        (when (and (at ?x ?p ?rel) (part_of ?p ?z)) (near pr2 ?z)))))

  ; Pull the drawer x open; that takes the hand.
  (:action open
    :parameters (?x - part)
    :precondition (and (near pr2 ?x) (free pr2) (closes ?x) (not (opened ?x)))
    :effect (opened ?x))

  ; Push the drawer x shut.
  (:action close
    :parameters (?x - part)
    :precondition (and (near pr2 ?x) (free pr2) (opened ?x))
    :effect (not (opened ?x)))

  ; Take x from y. The place is a parameter: planners look for what fits, where they would enumerate an exists.
  (:action grasp
    :parameters (?x - item ?y - fixture ?rel - relation)
    :precondition (and (free pr2) (at ?x ?y ?rel) (near pr2 ?y) (or (opened ?y) (not (closes ?y))))
    :effect (and (holding pr2 ?x) (not (free pr2)) (not (at ?x ?y ?rel))))

  ; Put x on or in y.
  (:action keep
    :parameters (?x - item ?y - fixture ?rel - relation)
    :precondition (and (holding pr2 ?x) (near pr2 ?y) (allows ?y ?rel) (or (opened ?y) (not (closes ?y))))
    :effect (and (at ?x ?y ?rel) (free pr2) (not (holding pr2 ?x))))
)
