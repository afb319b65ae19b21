(define (problem MarinaMay)
  (:domain Marina)
  (:objects
    BerthOne BerthTwo BerthThree BerthFour - Berth
    FuelDock - FuelPier
    Slipway - Ramp
    Albatross Heron - SailingBoat
    Otter Pike - MotorBoat)
  (:init
    (MooredAt Albatross BerthOne) (MooredAt Heron BerthTwo) (MooredAt Otter BerthThree) (MooredAt Pike Slipway)
    (Vacant BerthFour) (Vacant FuelDock)
    (CoverOn Albatross) (CoverOn Otter)
    (PowerConnected Heron)
    (SailsHoisted Heron)
    (TankFull Pike)
    (HullClean Pike))
  (:goal (and (TankFull Otter))))
