; The duty robot of a fire station looks after vehicles and kit.
(define (domain fire-station)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    location vehicle equipment - object
    bay yard indoor-room - location
    hose extinguisher breathing-mask rescue-tool - equipment)
  (:predicates
    (worker-at ?l - location)
    (drying-place ?l - location)
    (charging-place ?l - location)
    (kept-at ?e - equipment ?l - location)
    (on-board ?e - equipment ?v - vehicle)
    (holding ?e - equipment)
    (hands-free)
    (parked ?v - vehicle ?l - location)
    (bay-vacant ?b - bay)
    (door-open ?b - bay)
    (water-full ?v - vehicle)
    (refuelled ?v - vehicle)
    (washed ?v - vehicle)
    (plugged-in ?v - vehicle)
    (siren-tested ?v - vehicle)
    (dry ?h - hose)
    (rolled ?h - hose)
    (charged ?x - extinguisher)
    (disinfected ?m - breathing-mask))

  (:action walk
    :parameters (?from ?to - location)
    :precondition (worker-at ?from)
    :effect (and (worker-at ?to) (not (worker-at ?from))))

  (:action take
    :parameters (?e - equipment ?l - location)
    :precondition (and (worker-at ?l) (kept-at ?e ?l) (hands-free))
    :effect (and (holding ?e) (not (kept-at ?e ?l)) (not (hands-free))))

  (:action put
    :parameters (?e - equipment ?l - location)
    :precondition (and (worker-at ?l) (holding ?e))
    :effect (and (kept-at ?e ?l) (hands-free) (not (holding ?e))))

  (:action load
    :parameters (?e - equipment ?v - vehicle ?l - location)
    :precondition (and (worker-at ?l) (parked ?v ?l) (holding ?e))
    :effect (and (on-board ?e ?v) (hands-free) (not (holding ?e))))

  (:action unload
    :parameters (?e - equipment ?v - vehicle ?l - location)
    :precondition (and (worker-at ?l) (parked ?v ?l) (on-board ?e ?v) (hands-free))
    :effect (and (holding ?e) (not (on-board ?e ?v)) (not (hands-free))))

  (:action open-bay-door
    :parameters (?b - bay)
    :precondition (and (worker-at ?b) (not (door-open ?b)))
    :effect (door-open ?b))

  (:action close-bay-door
    :parameters (?b - bay)
    :precondition (and (worker-at ?b) (door-open ?b))
    :effect (not (door-open ?b)))

  (:action drive-in
    :parameters (?v - vehicle ?y - yard ?b - bay)
    :precondition (and (worker-at ?y) (parked ?v ?y) (door-open ?b) (bay-vacant ?b))
    :effect (and (parked ?v ?b) (worker-at ?b) (not (parked ?v ?y)) (not (worker-at ?y)) (not (bay-vacant ?b))))

  (:action drive-out
    :parameters (?v - vehicle ?b - bay ?y - yard)
    :precondition (and (worker-at ?b) (parked ?v ?b) (door-open ?b) (not (plugged-in ?v)))
    :effect (and (parked ?v ?y) (worker-at ?y) (bay-vacant ?b) (not (parked ?v ?b)) (not (worker-at ?b))))

  (:action fill-water-tank
    :parameters (?v - vehicle ?l - location)
    :precondition (and (worker-at ?l) (parked ?v ?l) (not (water-full ?v)))
    :effect (water-full ?v))

  (:action refuel
    :parameters (?v - vehicle ?y - yard)
    :precondition (and (worker-at ?y) (parked ?v ?y) (not (refuelled ?v)))
    :effect (refuelled ?v))

  (:action wash
    :parameters (?v - vehicle ?l - location)
    :precondition (and (worker-at ?l) (parked ?v ?l) (hands-free) (not (washed ?v)))
    :effect (washed ?v))

  (:action plug-in
    :parameters (?v - vehicle ?b - bay)
    :precondition (and (worker-at ?b) (parked ?v ?b) (not (plugged-in ?v)))
    :effect (plugged-in ?v))

  (:action unplug
    :parameters (?v - vehicle ?b - bay)
    :precondition (and (worker-at ?b) (parked ?v ?b) (plugged-in ?v))
    :effect (not (plugged-in ?v)))

  (:action test-siren
    :parameters (?v - vehicle ?l - location)
    :precondition (and (worker-at ?l) (parked ?v ?l))
    :effect (siren-tested ?v))

  (:action dry-hose
    :parameters (?h - hose ?l - location)
    :precondition (and (worker-at ?l) (drying-place ?l) (holding ?h) (not (rolled ?h)))
    :effect (dry ?h))

  (:action roll-hose
    :parameters (?h - hose)
    :precondition (and (holding ?h) (dry ?h) (not (rolled ?h)))
    :effect (rolled ?h))

  (:action unroll-hose
    :parameters (?h - hose)
    :precondition (and (holding ?h) (rolled ?h))
    :effect (not (rolled ?h)))

  (:action charge-extinguisher
    :parameters (?x - extinguisher ?l - location)
    :precondition (and (worker-at ?l) (charging-place ?l) (holding ?x) (not (charged ?x)))
    :effect (charged ?x))

  (:action disinfect
    :parameters (?m - breathing-mask ?l - location)
    :precondition (and (worker-at ?l) (charging-place ?l) (holding ?m))
    :effect (disinfected ?m)))
