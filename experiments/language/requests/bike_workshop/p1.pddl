(define (problem monday)
  (:domain bike_workshop)
  (:objects
    RepairStand - Stand
    Workbench BikeRack FrontDoor - Place
    RedBike BlueBike - Bike
    RedFront RedRear BlueFront BlueRear SpareWheel - Wheel
    FloorPump - Pump
    Oil - OilCan
    Spanner - Wrench
    Cloth - Rag
    HeadLight TailLight - Light)
  (:init
    (robotAt FrontDoor) (doorAt FrontDoor)
    (at_place RedBike BikeRack) (at_place BlueBike BikeRack)
    (mounted RedFront RedBike) (mounted RedRear RedBike)
    (mounted BlueFront BlueBike) (mounted BlueRear BlueBike)
    (flat RedFront) (bent BlueRear)
    (at_place SpareWheel Workbench) (spare SpareWheel)
    (at_place FloorPump Workbench) (at_place Oil Workbench) (at_place Spanner Workbench) (at_place Cloth FrontDoor)
    (at_place HeadLight Workbench) (at_place TailLight Workbench)
    (dirty RedBike) (dirty BlueBike)
    (brakesOk BlueBike) (chainOiled RedBike))
  (:goal (not (flat RedFront))))
