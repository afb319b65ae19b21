(define (problem terminal-1)
  (:domain terminal)
  (:objects
    yard customs quay - location
    crane1 crane2 crane3 - crane
    truck1 truck2 - truck
    aurora - ship
    container1 container2 container3 container4 - container
    reefer1 - reefer
    pallet1 pallet2 pallet3 pallet4 pallet5 - pallet)
  (:init
    (office customs)
    (at crane1 yard) (at crane2 customs) (at crane3 quay)
    (free crane1) (free crane2) (free crane3)
    (at truck1 yard) (at truck2 customs)
    (fuelled truck2)
    (at aurora quay)
    (at pallet1 yard) (at pallet2 yard) (at pallet3 yard) (at pallet4 customs) (at pallet5 quay)
    (at container1 yard) (on container1 pallet1)
    (at container2 yard) (on container2 container1) (clear container2)
    (at reefer1 yard) (on reefer1 pallet2) (clear reefer1)
    (clear pallet3)
    (at container3 customs) (on container3 pallet4)
    (at container4 customs) (on container4 container3) (clear container4)
    (sealed container4)
    (clear pallet5))
  (:goal (and (in container2 aurora))))
