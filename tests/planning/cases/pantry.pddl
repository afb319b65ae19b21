; A pantry with everything that searching has to cope with: two hands kept by flags, conditional effects, a
; disjunctive precondition, negative goals, costs (some steps are free) and a thing that can be used up.
(define (domain pantry)
  (:requirements :strips :typing :negative-preconditions :disjunctive-preconditions :conditional-effects
                 :action-costs)
  (:types place thing - object
          jar box - thing)
  (:predicates
    (here ?p - place)
    (at ?x - thing ?p - place)
    (held ?x - thing)
    (one_used)
    (both_used)
    (open ?x - jar)
    (torn ?x - box)
    (sticky))
  (:functions (total-cost) - number (way ?p - place ?q - place) - number)
  (:action go
    :parameters (?p - place ?q - place)
    :precondition (and (here ?p) (not (here ?q)))
    :effect (and (here ?q) (not (here ?p)) (increase (total-cost) (way ?p ?q))))
  (:action take
    :parameters (?x - thing ?p - place)
    :precondition (and (here ?p) (at ?x ?p) (not (both_used)))
    :effect (and (held ?x) (not (at ?x ?p))
                 (when (one_used) (both_used))
                 (when (one_used) (not (one_used)))
                 (when (not (one_used)) (one_used))
                 (increase (total-cost) 2)))
  (:action put
    :parameters (?x - thing ?p - place)
    :precondition (and (here ?p) (held ?x))
    :effect (and (not (held ?x)) (at ?x ?p)
                 (when (both_used) (one_used))
                 (when (both_used) (not (both_used)))
                 (when (one_used) (not (one_used)))
                 (increase (total-cost) 1)))
  (:action unscrew
    :parameters (?x - jar)
    :precondition (and (held ?x) (not (open ?x)))
    :effect (and (open ?x) (when (both_used) (sticky)) (increase (total-cost) 3)))
  (:action tear
    :parameters (?x - box ?y - jar)
    :precondition (and (held ?x) (or (not (torn ?x)) (open ?y)))
    :effect (and (torn ?x) (when (held ?y) (not (open ?y))) (increase (total-cost) 1)))
  (:action wash
    :parameters ()
    :precondition (sticky)
    :effect (not (sticky))))
