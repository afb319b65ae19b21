(define (domain lamps)
  (:requirements :strips :typing :negative-preconditions :conditional-effects)
  (:types
    thing - object
    switch lamp - thing)
  (:constants main - switch)
  (:predicates
    (wired ?s - switch ?l - lamp)
    (lit ?l - lamp))

  (:action press
    :parameters (?s - switch ?l - lamp)
    :precondition (and (wired ?s ?l) (not (lit ?l)))
    :effect (lit ?l))

  (:action dim
    :parameters (?l - lamp)
    :precondition (lit ?l)
    :effect (and
      (not (lit ?l))))

  (:action panic
    :parameters ()
    :precondition (and)
    :effect (forall (?l - lamp)
      (when (lit ?l) (not (lit ?l))))))
