(define (problem winter-morning)
  (:domain ground_handling)
  (:objects
    gateA gateB gateC - gate
    remoteStand - stand
    hangar1 - hangar
    baggageHall depot - building
    airbus boeing cessna - aircraft
    tug1 - tug
    fuelTruck1 - fuelTruck
    deicer1 - deicer
    cart1 - baggageCart
    stairs1 stairs2 - stairTruck
    redSuitcase blackSuitcase - suitcase
    dogCrate - crate
    golfBag skiBag - sportsBag
    northRunway southRunway - runway)
  (:init
    (planeAt airbus gateA) (planeAt boeing gateB) (planeAt cessna hangar1)
    (vacant gateC) (vacant remoteStand)
    (vehicleAt tug1 depot) (vehicleAt fuelTruck1 depot) (vehicleAt deicer1 depot)
    (vehicleAt cart1 baggageHall) (vehicleAt stairs1 gateB) (vehicleAt stairs2 depot)
    (docked stairs1 boeing) (stairsAt boeing) (busy stairs1)
    (chocked boeing) (fuelled boeing) (cabinClean cessna)
    (holdOpen airbus)
    (aboard redSuitcase airbus)
    (bagAt blackSuitcase baggageHall) (bagAt golfBag baggageHall) (bagAt skiBag baggageHall)
    (bagAt dogCrate hangar1)
    (lightsOn northRunway))
  (:goal (and (aboard golfBag boeing) (fuelled airbus))))
