(define (domain cafe)
  (:requirements :strips :typing :negative-preconditions :conditional-effects)
  (:types
    thing place - object
    mug food - thing)
  (:constants counter - place)
  (:predicates
    (at ?x - thing ?p - place)
    (held ?x - thing)
    (full ?m - mug)
    (tap ?p - place))

  (:action grasp
    :parameters (?x - thing ?p - place)
    :precondition (and (at ?x ?p) (not (held ?x)))
    :effect (and (held ?x) (not (at ?x ?p))))

  (:action put
    :parameters (?x - thing ?p - place)
    :precondition (held ?x)
    :effect (and (at ?x ?p) (not (held ?x))))

  (:action fill
    :parameters (?m - mug ?p - place)
    :precondition (and (at ?m ?p) (tap ?p))
    :effect (when (not (full ?m)) (full ?m))))
