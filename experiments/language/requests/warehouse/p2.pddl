(define (problem shift2)
  (:domain warehouse2)
  (:objects aisle7 aisle8 - aisle
            dock3 dock4 dock5 - dock
            packing2 - packingStation
            truck9 truck10 - truck
            crate11 crate12 crate13 crate14 - crate
            barrel5 - barrel)
  (:init (forkAt aisle8) (forkFree)
         (linked aisle7 aisle8) (linked aisle8 aisle7)
         (linked aisle8 packing2) (linked packing2 aisle8)
         (linked packing2 dock3) (linked dock3 packing2)
         (linked dock3 dock4) (linked dock4 dock3)
         (linked dock4 dock5) (linked dock5 dock4)
         (truckAt truck9 dock3) (truckAt truck10 dock4)
         (doorUp dock3) (doorUp dock5)
         (loadAt crate11 aisle7) (loadAt crate12 aisle7) (loadAt crate13 aisle7) (inTruck crate14 truck9)
         (loadAt barrel5 aisle8)
         (labelled crate13)
         (fragile barrel5))
  (:goal (and (departed truck9) (inTruck crate12 truck10))))
