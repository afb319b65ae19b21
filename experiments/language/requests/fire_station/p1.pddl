(define (problem day-shift)
  (:domain fire-station)
  (:objects
    bay-1 bay-2 bay-3 - bay
    back-yard - yard
    gear-room workshop hose-tower - indoor-room
    pumper tanker ladder-truck - vehicle
    red-hose yellow-hose - hose
    foam-extinguisher co2-extinguisher powder-extinguisher - extinguisher
    spare-mask chief-mask - breathing-mask
    chainsaw stretcher traffic-cone - rescue-tool)
  (:init
    (worker-at gear-room) (hands-free)
    (drying-place hose-tower) (charging-place workshop)
    (parked pumper bay-1) (parked tanker bay-2) (parked ladder-truck back-yard)
    (bay-vacant bay-3)
    (door-open bay-1) (door-open bay-3)
    (water-full tanker)
    (refuelled pumper)
    (washed tanker)
    (plugged-in tanker)
    (siren-tested tanker)
    (kept-at red-hose back-yard)
    (kept-at yellow-hose hose-tower) (dry yellow-hose)
    (kept-at foam-extinguisher gear-room) (kept-at co2-extinguisher gear-room)
    (kept-at powder-extinguisher workshop)
    (kept-at spare-mask workshop) (kept-at chief-mask gear-room) (disinfected chief-mask)
    (kept-at chainsaw back-yard)
    (kept-at traffic-cone back-yard)
    (on-board stretcher pumper))
  (:goal (and (water-full pumper) (siren-tested pumper))))
