(define (domain canal)
  (:requirements :strips :typing :negative-preconditions :disjunctive-preconditions :existential-preconditions
    :universal-preconditions :derived-predicates)
  (:types place boat - object lock basin - place)
  (:predicates
    (joins ?a ?b - place)
    (at ?b - boat ?p - place)
    (dry ?p - place)
    (busy ?p - place)
    (open-way ?a ?b - place)
    (free ?p - place))

  (:derived (busy ?p - place)
    (exists (?b - boat) (at ?b ?p)))

  (:derived (free ?p)
    (and (not (busy ?p)) (not (dry ?p))))

  (:derived (open-way ?a ?b)
    (and (joins ?a ?b) (free ?b)))

  (:action sail
    :parameters (?b - boat ?from ?to - place)
    :precondition (and (at ?b ?from) (open-way ?from ?to))
    :effect (and (at ?b ?to) (not (at ?b ?from))))

  (:action flood
    :parameters (?l - lock)
    :precondition (dry ?l)
    :effect (not (dry ?l))))
