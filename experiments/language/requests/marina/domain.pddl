(define (domain Marina)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    Mooring Boat - object
    SailingBoat MotorBoat - Boat
    Berth FuelPier Ramp - Mooring)
  (:predicates
    (MooredAt ?b - Boat ?m - Mooring)
    (Vacant ?m - Mooring)
    (CoverOn ?b - Boat)
    (PowerConnected ?b - Boat)
    (SailsHoisted ?b - Boat)
    (TankFull ?b - MotorBoat)
    (HullClean ?b - Boat))
  (:action MoveBoat
    :parameters (?b - Boat ?from - Mooring ?to - Mooring)
    :precondition (and (MooredAt ?b ?from) (Vacant ?to) (not (CoverOn ?b)) (not (PowerConnected ?b)))
    :effect (and (MooredAt ?b ?to) (Vacant ?from) (not (MooredAt ?b ?from)) (not (Vacant ?to))))
  (:action PutCoverOn
    :parameters (?b - Boat)
    :precondition (and (not (CoverOn ?b)) (not (SailsHoisted ?b)))
    :effect (CoverOn ?b))
  (:action TakeCoverOff
    :parameters (?b - Boat)
    :precondition (CoverOn ?b)
    :effect (not (CoverOn ?b)))
  (:action ConnectPower
    :parameters (?b - Boat ?m - Berth)
    :precondition (and (MooredAt ?b ?m) (not (PowerConnected ?b)))
    :effect (PowerConnected ?b))
  (:action DisconnectPower
    :parameters (?b - Boat)
    :precondition (PowerConnected ?b)
    :effect (not (PowerConnected ?b)))
  (:action HoistSails
    :parameters (?b - SailingBoat)
    :precondition (and (not (SailsHoisted ?b)) (not (CoverOn ?b)))
    :effect (SailsHoisted ?b))
  (:action LowerSails
    :parameters (?b - SailingBoat)
    :precondition (SailsHoisted ?b)
    :effect (not (SailsHoisted ?b)))
  (:action FillTank
    :parameters (?b - MotorBoat ?f - FuelPier)
    :precondition (and (MooredAt ?b ?f) (not (TankFull ?b)))
    :effect (TankFull ?b))
  (:action ScrubHull
    :parameters (?b - Boat ?r - Ramp)
    :precondition (and (MooredAt ?b ?r) (not (HullClean ?b)))
    :effect (HullClean ?b)))
