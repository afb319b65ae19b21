(define (domain apiary)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    place hive item - object
    smoker syrup bucket - item)
  (:predicates
    (beekeeper_at ?p - place)
    (hive_at ?h - hive ?p - place)
    (item_at ?i - item ?p - place)
    (holding ?i - item)
    (hand_empty)
    (lit ?s - smoker)
    (roof_on ?h - hive)
    (fed ?h - hive)
    (inspected ?h - hive)
    (has_honey ?h - hive)
    (full_of_honey ?b - bucket))
  (:action walk
    :parameters (?from - place ?to - place)
    :precondition (beekeeper_at ?from)
    :effect (and (beekeeper_at ?to) (not (beekeeper_at ?from))))
  (:action take
    :parameters (?i - item ?p - place)
    :precondition (and (beekeeper_at ?p) (item_at ?i ?p) (hand_empty))
    :effect (and (holding ?i) (not (item_at ?i ?p)) (not (hand_empty))))
  (:action put_down
    :parameters (?i - item ?p - place)
    :precondition (and (beekeeper_at ?p) (holding ?i))
    :effect (and (item_at ?i ?p) (hand_empty) (not (holding ?i))))
  (:action light_smoker
    :parameters (?s - smoker)
    :precondition (and (holding ?s) (not (lit ?s)))
    :effect (lit ?s))
  (:action lift_roof
    :parameters (?h - hive ?p - place)
    :precondition (and (beekeeper_at ?p) (hive_at ?h ?p) (hand_empty) (roof_on ?h))
    :effect (not (roof_on ?h)))
  (:action put_roof_back
    :parameters (?h - hive ?p - place)
    :precondition (and (beekeeper_at ?p) (hive_at ?h ?p) (hand_empty) (not (roof_on ?h)))
    :effect (roof_on ?h))
  (:action feed_hive
    :parameters (?h - hive ?s - syrup ?p - place)
    :precondition (and (beekeeper_at ?p) (hive_at ?h ?p) (holding ?s) (not (roof_on ?h)) (not (fed ?h)))
    :effect (fed ?h))
  (:action inspect_hive
    :parameters (?h - hive ?s - smoker ?p - place)
    :precondition (and (beekeeper_at ?p) (hive_at ?h ?p) (holding ?s) (lit ?s) (not (roof_on ?h)))
    :effect (inspected ?h))
  ; the honey of one hive fills one bucket
  (:action harvest_honey
    :parameters (?h - hive ?b - bucket ?p - place)
    :precondition (and (beekeeper_at ?p) (hive_at ?h ?p) (holding ?b) (has_honey ?h) (not (roof_on ?h)) (not (full_of_honey ?b)))
    :effect (and (full_of_honey ?b) (not (has_honey ?h)))))
