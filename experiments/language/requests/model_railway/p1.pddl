(define (problem saturdayLayout)
  (:domain modelRailway)
  (:objects
    steamEngine dieselEngine - engine
    coalWagon flatWagon cattleWagon passengerCar - wagon
    logs sheep milkCans - freight
    centralStation mountainStation harbour sawmill engineShed - place
    centralSignal mountainSignal harbourSignal sawmillSignal shedSignal - signal
    villageCrossing millCrossing - crossing)
  (:init
    (track centralStation mountainStation) (track mountainStation centralStation)
    (track centralStation harbour) (track harbour centralStation)
    (track centralStation sawmill) (track sawmill centralStation)
    (track centralStation engineShed) (track engineShed centralStation)
    (protects centralSignal centralStation) (protects mountainSignal mountainStation)
    (protects harbourSignal harbour) (protects sawmillSignal sawmill) (protects shedSignal engineShed)
    (at steamEngine centralStation)
    (at passengerCar centralStation)
    (coupled passengerCar steamEngine)
    (at dieselEngine sawmill)
    (at flatWagon sawmill)
    (at coalWagon centralStation)
    (at cattleWagon mountainStation)
    (inWagon sheep cattleWagon)
    (at logs sawmill)
    (at milkCans mountainStation)
    (green centralSignal) (green mountainSignal) (green shedSignal)
    (barrierDown villageCrossing) (barrierDown millCrossing))
  (:goal (and (at logs harbour) (at steamEngine engineShed))))
