(define (domain pottery)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    piece glaze spot - object
    wheel kiln rack - spot)
  (:predicates
    (at ?p - piece ?s - spot)
    (shaped ?p - piece)
    (dry ?p - piece)
    (bare ?p - piece)
    (glazed ?p - piece ?g - glaze)
    (fired ?p - piece)
    (tin-open ?g - glaze)
    (hot ?k - kiln))

  (:action carry
    :parameters (?p - piece ?from ?to - spot)
    :precondition (at ?p ?from)
    :effect (and (at ?p ?to) (not (at ?p ?from))))

  (:action shape
    :parameters (?p - piece ?w - wheel)
    :precondition (and (at ?p ?w) (not (shaped ?p)))
    :effect (shaped ?p))

  (:action dry-out
    :parameters (?p - piece ?r - rack)
    :precondition (and (at ?p ?r) (shaped ?p))
    :effect (dry ?p))

  (:action open-tin
    :parameters (?g - glaze)
    :precondition (not (tin-open ?g))
    :effect (tin-open ?g))

  (:action close-tin
    :parameters (?g - glaze)
    :precondition (tin-open ?g)
    :effect (not (tin-open ?g)))

  (:action glaze
    :parameters (?p - piece ?g - glaze)
    :precondition (and (dry ?p) (bare ?p) (not (fired ?p)) (tin-open ?g))
    :effect (and (glazed ?p ?g) (not (bare ?p))))

  (:action heat-up
    :parameters (?k - kiln)
    :precondition (not (hot ?k))
    :effect (hot ?k))

  (:action cool-down
    :parameters (?k - kiln)
    :precondition (hot ?k)
    :effect (not (hot ?k)))

  (:action fire
    :parameters (?p - piece ?k - kiln)
    :precondition (and (at ?p ?k) (hot ?k) (dry ?p))
    :effect (fired ?p)))
