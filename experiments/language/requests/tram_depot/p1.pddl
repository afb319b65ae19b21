(define (problem tramDepotNight)
  (:domain tramDepot)
  (:objects
    redTram blueTram heritageTram - tram
    trackA trackB trackC exitTrack - yardTrack
    washBay - washTrack
    jonas petra - driver
    umbrella schoolBag scarf - lostItem
    lostPropertyBox - box)
  (:init
    (onTrack redTram trackA)
    (onTrack blueTram trackB)
    (onTrack heritageTram trackC)
    (trackFree exitTrack)
    (trackFree washBay)
    (poweredUp redTram)
    (doorsOpen redTram)
    (clean blueTram)
    (windscreenBroken heritageTram)
    (inCab jonas redTram)
    (inBreakRoom petra)
    (leftIn umbrella blueTram)
    (leftIn schoolBag redTram)
    (leftIn scarf heritageTram))
  (:goal (and (clean redTram) (storedIn umbrella lostPropertyBox))))
