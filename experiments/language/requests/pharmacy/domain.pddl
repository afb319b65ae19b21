(define (domain pharmacy)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    place medicine customer - object
    lockable - place)
  (:predicates
    (stored ?m - medicine ?p - place)
    (in_hand ?m - medicine)
    (hand_free)
    (locked ?p - place)
    (labelled ?m - medicine)
    (bagged ?m - medicine)
    (prescribed ?m - medicine ?c - customer)
    (given_to ?m - medicine ?c - customer)
    (sold_out ?m - medicine)
    (ordered ?m - medicine))
  (:action unlock
    :parameters (?p - lockable)
    :precondition (locked ?p)
    :effect (not (locked ?p)))
  (:action lock
    :parameters (?p - lockable)
    :precondition (not (locked ?p))
    :effect (locked ?p))
  (:action take
    :parameters (?m - medicine ?p - place)
    :precondition (and (stored ?m ?p) (hand_free) (not (locked ?p)))
    :effect (and (in_hand ?m) (not (stored ?m ?p)) (not (hand_free))))
  (:action put
    :parameters (?m - medicine ?p - place)
    :precondition (and (in_hand ?m) (not (locked ?p)))
    :effect (and (stored ?m ?p) (hand_free) (not (in_hand ?m))))
  (:action label
    :parameters (?m - medicine)
    :precondition (and (in_hand ?m) (not (labelled ?m)))
    :effect (labelled ?m))
  (:action bag
    :parameters (?m - medicine)
    :precondition (and (in_hand ?m) (labelled ?m) (not (bagged ?m)))
    :effect (bagged ?m))
  (:action hand_over
    :parameters (?m - medicine ?c - customer)
    :precondition (and (in_hand ?m) (bagged ?m) (prescribed ?m ?c))
    :effect (and (given_to ?m ?c) (hand_free) (not (in_hand ?m))))
  (:action order
    :parameters (?m - medicine)
    :precondition (and (sold_out ?m) (not (ordered ?m)))
    :effect (ordered ?m)))
