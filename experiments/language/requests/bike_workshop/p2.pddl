(define (problem saturday)
  (:domain bike_workshop)
  (:objects
    LeftStand RightStand - Stand
    Counter Window Shelf Yard - Place
    RacingBike KidsBike CargoBike - Bike
    RacingFront RacingRear KidsFront KidsRear CargoFront CargoRear - Wheel
    HandPump - Pump
    OilCan1 - OilCan
    HexKey - Wrench
    OldShirt - Rag
    BikeLamp - Light)
  (:init
    (robotAt Counter) (doorAt Counter) (shopOpen)
    (at_place RacingBike LeftStand) (clamped RacingBike LeftStand)
    (at_place KidsBike Yard) (at_place CargoBike Yard)
    (mounted RacingRear RacingBike) (at_place RacingFront Shelf)
    (mounted KidsFront KidsBike) (mounted KidsRear KidsBike)
    (mounted CargoFront CargoBike) (mounted CargoRear CargoBike)
    (flat KidsFront) (flat KidsRear) (flat CargoRear)
    (at_place HandPump Shelf) (at_place OilCan1 Counter) (at_place HexKey Counter) (at_place OldShirt Shelf)
    (at_place BikeLamp Window)
    (dirty CargoBike)
    (brakesOk RacingBike) (chainOiled KidsBike))
  (:goal (mounted RacingFront RacingBike)))
