; The assistant robot of a small veterinary practice.
(define (domain vet-clinic)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    animal cage instrument vaccine - object
    dog cat rabbit - animal)
  (:predicates
    (in-cage ?a - animal ?c - cage)
    (on-table ?a - animal)
    (table-free)
    (cage-open ?c - cage)
    (vacant ?c - cage)
    (clean ?c - cage)
    (fed ?a - animal)
    (weighed ?a - animal)
    (vaccinated ?a - animal ?v - vaccine)
    (nails-trimmed ?a - animal)
    (wearing-cone ?a - animal)
    (sterile ?i - instrument))

  (:action open-cage
    :parameters (?c - cage)
    :precondition (not (cage-open ?c))
    :effect (cage-open ?c))

  (:action close-cage
    :parameters (?c - cage)
    :precondition (cage-open ?c)
    :effect (not (cage-open ?c)))

  (:action lift-onto-table
    :parameters (?a - animal ?c - cage)
    :precondition (and (in-cage ?a ?c) (cage-open ?c) (table-free))
    :effect (and (on-table ?a) (vacant ?c) (not (in-cage ?a ?c)) (not (table-free))))

  (:action put-in-cage
    :parameters (?a - animal ?c - cage)
    :precondition (and (on-table ?a) (cage-open ?c) (vacant ?c))
    :effect (and (in-cage ?a ?c) (table-free) (not (on-table ?a)) (not (vacant ?c))))

  (:action clean-cage
    :parameters (?c - cage)
    :precondition (and (vacant ?c) (cage-open ?c) (not (clean ?c)))
    :effect (clean ?c))

  (:action feed
    :parameters (?a - animal ?c - cage)
    :precondition (and (in-cage ?a ?c) (cage-open ?c) (not (fed ?a)))
    :effect (fed ?a))

  (:action weigh
    :parameters (?a - animal)
    :precondition (on-table ?a)
    :effect (weighed ?a))

  (:action vaccinate
    :parameters (?a - animal ?v - vaccine)
    :precondition (and (on-table ?a) (not (vaccinated ?a ?v)))
    :effect (vaccinated ?a ?v))

  (:action trim-nails
    :parameters (?a - animal)
    :precondition (and (on-table ?a) (not (nails-trimmed ?a)))
    :effect (nails-trimmed ?a))

  (:action put-cone-on
    :parameters (?a - animal)
    :precondition (and (on-table ?a) (not (wearing-cone ?a)))
    :effect (wearing-cone ?a))

  (:action take-cone-off
    :parameters (?a - animal)
    :precondition (and (on-table ?a) (wearing-cone ?a))
    :effect (not (wearing-cone ?a)))

  (:action sterilize
    :parameters (?i - instrument)
    :precondition (not (sterile ?i))
    :effect (sterile ?i)))
