(define (domain shop)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    thing robot - object
    furniture item part - thing)
  (:constants pr2 - robot)
  (:predicates
    (at ?x - thing ?y - thing ?r - object)
    (holding ?r - robot ?x - item)
    (opened ?x - thing)
    (guards ?x - part ?y - furniture)
    (heavy ?x - thing))

  (:action grasp
    :parameters (?x - item)
    :precondition (not (heavy ?x))
    :effect (holding pr2 ?x))

  (:action open
    :parameters (?d - part ?f - furniture)
    :precondition (guards ?d ?f)
    :effect (opened ?f)))
