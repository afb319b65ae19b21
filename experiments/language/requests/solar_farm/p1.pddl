(define (problem lateSummer)
  (:domain solarFarm)
  (:objects
    roofPanel barnPanel fieldPanelEast fieldPanelWest - panel
    inverterA inverterB - inverter
    bigBattery smallBattery - battery
    waterPump electricFence chickenLamp workshopHeater - appliance
    longCable shortCable yellowCable - cable
    flat medium steep - angle)
  (:init
    (isDusty barnPanel)
    (isDusty fieldPanelEast)
    (isDusty fieldPanelWest)
    (tilted roofPanel steep)
    (tilted barnPanel flat)
    (tilted fieldPanelEast medium)
    (tilted fieldPanelWest steep)
    (isRunning inverterA)
    (feeds inverterA bigBattery)
    (feeds inverterB smallBattery)
    (isFull bigBattery)
    (joins shortCable bigBattery electricFence)
    (powered electricFence)
    (joins yellowCable smallBattery chickenLamp)
    (powered chickenLamp)
    (spare longCable))
  (:goal (and (isFull smallBattery) (powered waterPump))))
