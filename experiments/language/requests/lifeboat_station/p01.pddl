(define (problem after-the-exercise)
  (:domain lifeboat-station)
  (:objects
    petrel kittiwake margaret-ross old-dinghy - lifeboat
    helen rob iain moira - crew
    red-lifejacket yellow-lifejacket orange-lifejacket - lifejacket
    first-aid-kit stretcher tow-rope flare-box - gear
    boathouse pontoon crew-room workshop - place
    boathouse-doors crew-room-door workshop-door - door
    slipway-floodlight yard-floodlight - floodlight
    vhf-radio crew-room-heater - device)
  (:init
    (boat-at petrel boathouse)
    (boat-at margaret-ross boathouse)
    (boat-at old-dinghy boathouse)
    (boat-at kittiwake pontoon)
    (fuelled petrel)
    (fuelled margaret-ross)
    (salty kittiwake)
    (salty margaret-ross)
    (salty old-dinghy)
    (holed old-dinghy)
    (crew-at helen crew-room)
    (crew-at rob crew-room)
    (crew-at iain boathouse)
    (crew-at moira workshop)
    (gear-at red-lifejacket crew-room)
    (gear-at yellow-lifejacket crew-room)
    (gear-at orange-lifejacket boathouse)
    (gear-at first-aid-kit crew-room)
    (gear-at stretcher workshop)
    (gear-at tow-rope workshop)
    (gear-at flare-box workshop)
    (door-of boathouse-doors boathouse)
    (door-of crew-room-door crew-room)
    (door-of workshop-door workshop)
    (open crew-room-door)
    (switched-on yard-floodlight)
    (switched-on crew-room-heater)
    (slip-between boathouse pontoon)
    (fuel-pump-at pontoon))
  (:goal (and (fuelled kittiwake) (not (salty kittiwake)))))
