(define (problem shift1)
  (:domain warehouse2)
  (:objects aisle1 aisle2 aisle3 - aisle
            dock1 dock2 - dock
            packing1 - packingStation
            truck1 truck2 - truck
            crate1 crate2 crate3 crate4 - crate
            barrel1 barrel2 - barrel)
  (:init (forkAt packing1) (forkFree)
         (linked packing1 aisle1) (linked aisle1 packing1)
         (linked packing1 aisle2) (linked aisle2 packing1)
         (linked packing1 aisle3) (linked aisle3 packing1)
         (linked packing1 dock1) (linked dock1 packing1)
         (linked packing1 dock2) (linked dock2 packing1)
         (linked dock1 dock2) (linked dock2 dock1)
         (truckAt truck1 dock1) (truckAt truck2 dock2)
         (doorUp dock2)
         (loadAt crate1 aisle1) (loadAt crate2 aisle1) (loadAt crate3 aisle2) (inTruck crate4 truck2)
         (loadAt barrel1 aisle3) (loadAt barrel2 aisle2)
         (labelled crate1) (labelled crate4)
         (fragile crate2) (fragile barrel1))
  (:goal (and (inTruck crate1 truck1) (inTruck crate2 truck1))))
