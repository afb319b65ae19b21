; Things on furniture, and a robot with one hand. The second step of the ladder: objects that stand in a relation.

(define (domain table)
  (:requirements :strips :typing :equality :existential-preconditions :conditional-effects)

  (:types
    thing robot relation - object
    furniture item - thing       ; furniture stays where it is, items can be carried
  )

  (:constants
    pr2 - robot
    on - relation
  )

  (:predicates
    (near ?r - robot ?x - furniture)           ; what is on x is within reach
    (holding ?r - robot ?x - item)             ; x is in the hand
    (free ?r - robot)                          ; nothing is in the hand
    (at ?x - thing ?y - thing ?rel - relation) ; x is on y
  )

  ; Go and stand before x, or before what x is on. What was in reach is so no longer.
  (:action moveto
    :parameters (?x - thing)
    :precondition (and)
    :effect (and
      (forall (?y - furniture) (not (near pr2 ?y)))
      (forall (?y - furniture) (when (= ?x ?y) (near pr2 ?y)))
      (forall (?y - furniture) (when (at ?x ?y on) (near pr2 ?y)))))

  ; Take x, which is on the furniture that the robot stands at.
  (:action grasp
    :parameters (?x - item)
    :precondition (and (free pr2) (exists (?y - furniture) (and (near pr2 ?y) (at ?x ?y on))))
    :effect (and (holding pr2 ?x) (not (free pr2)) (forall (?y - furniture) (not (at ?x ?y on)))))

  ; Put x on y: what is in the hand on the furniture the robot stands at.
  (:action keep
    :parameters (?x - item ?y - furniture ?rel - relation)
    :precondition (and (holding pr2 ?x) (near pr2 ?y))
    :effect (and (at ?x ?y ?rel) (free pr2) (not (holding pr2 ?x))))
)
