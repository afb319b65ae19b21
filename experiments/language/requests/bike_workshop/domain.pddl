; bike workshop, group 7
; ADL version
(define (domain bike_workshop)
  (:requirements :adl :typing)
  (:types
    Place Thing - object
    Stand - Place
    Bike Wheel Tool Light - Thing
    Pump OilCan Wrench Rag - Tool)
  (:predicates
    (robotAt ?p - Place)
    (at_place ?t - Thing ?p - Place)
    (inGripper ?t - Thing)
    (clamped ?b - Bike ?s - Stand)
    (mounted ?w - Wheel ?b - Bike)
    (spare ?w - Wheel)
    (flat ?w - Wheel)
    (bent ?w - Wheel)
    (chainOiled ?b - Bike)
    (brakesOk ?b - Bike)
    (dirty ?b - Bike)
    (fitted ?l - Light ?b - Bike)
    (shopOpen)
    (doorAt ?p - Place))

  (:action driveTo
    :parameters (?a - Place ?b - Place)
    :precondition (and (robotAt ?a) (not (= ?a ?b)))
    :effect (and (robotAt ?b) (not (robotAt ?a))))

  ; bikes can be lifted too, but not out of the clamp
  (:action grab
    :parameters (?t - Thing ?p - Place)
    :precondition (and (robotAt ?p) (at_place ?t ?p)
                       (not (exists (?x - Thing) (inGripper ?x)))
                       (not (exists (?s - Stand ?b - Bike) (and (= ?t ?b) (clamped ?b ?s)))))
    :effect (and (inGripper ?t) (not (at_place ?t ?p))))

  (:action drop
    :parameters (?t - Thing ?p - Place)
    :precondition (and (robotAt ?p) (inGripper ?t))
    :effect (and (at_place ?t ?p) (not (inGripper ?t))))

  (:action clampBike
    :parameters (?b - Bike ?s - Stand)
    :precondition (and (robotAt ?s) (inGripper ?b)
                       (not (exists (?o - Bike) (clamped ?o ?s))))
    :effect (and (clamped ?b ?s) (at_place ?b ?s) (not (inGripper ?b))))

  (:action unclampBike
    :parameters (?b - Bike ?s - Stand)
    :precondition (and (robotAt ?s) (clamped ?b ?s) (not (exists (?x - Thing) (inGripper ?x))))
    :effect (not (clamped ?b ?s)))

  (:action removeWheel
    :parameters (?w - Wheel ?b - Bike ?s - Stand)
    :precondition (and (robotAt ?s) (clamped ?b ?s) (mounted ?w ?b)
                       (not (exists (?x - Thing) (inGripper ?x))))
    :effect (and (not (mounted ?w ?b)) (inGripper ?w)))

  (:action mountWheel
    :parameters (?w - Wheel ?b - Bike ?s - Stand)
    :precondition (and (robotAt ?s) (clamped ?b ?s) (inGripper ?w) (not (bent ?w)))
    :effect (and (mounted ?w ?b) (not (inGripper ?w))))

  ; wheels are pumped up on the bike or lying around
  (:action pumpUp
    :parameters (?w - Wheel ?p - Place ?t - Pump)
    :precondition (and (robotAt ?p) (inGripper ?t) (flat ?w)
                       (or (at_place ?w ?p)
                           (exists (?b - Bike) (and (mounted ?w ?b) (at_place ?b ?p)))))
    :effect (not (flat ?w)))

  (:action oilChain
    :parameters (?b - Bike ?p - Place ?t - OilCan)
    :precondition (and (robotAt ?p) (at_place ?b ?p) (inGripper ?t))
    :effect (chainOiled ?b))

  (:action adjustBrakes
    :parameters (?b - Bike ?s - Stand ?t - Wrench)
    :precondition (and (robotAt ?s) (clamped ?b ?s) (inGripper ?t))
    :effect (brakesOk ?b))

  (:action wipe
    :parameters (?b - Bike ?p - Place ?t - Rag)
    :precondition (and (robotAt ?p) (at_place ?b ?p) (inGripper ?t) (dirty ?b))
    :effect (not (dirty ?b)))

  (:action fitLight
    :parameters (?l - Light ?b - Bike ?p - Place)
    :precondition (and (robotAt ?p) (at_place ?b ?p) (inGripper ?l))
    :effect (and (fitted ?l ?b) (not (inGripper ?l))))

  (:action flipSign
    :parameters (?p - Place)
    :precondition (and (robotAt ?p) (doorAt ?p))
    :effect (and (when (shopOpen) (not (shopOpen)))
                 (when (not (shopOpen)) (shopOpen))))
)
