(define (problem tuesdayQueue)
  (:domain carWash)
  (:objects
    taxi minibus pickup oldBeetle sportsCar - vehicle
    yellow white blue red - colour
    forecourt parkingLot - spot)
  (:init
    (parkedAt taxi forecourt) (hasColour taxi yellow) (isDirty taxi) (windowsClosed taxi)
    (parkedAt minibus forecourt) (hasColour minibus white) (isDirty minibus) (isLarge minibus)
    (parkedAt pickup parkingLot) (hasColour pickup blue) (isDirty pickup)
    (parkedAt oldBeetle washTunnel) (hasColour oldBeetle red) (isWet oldBeetle) (windowsClosed oldBeetle)
    (parkedAt sportsCar parkingLot) (hasColour sportsCar red) (windowsClosed sportsCar)
    (isRunning blower))
  (:goal (and (not (isDirty taxi)) (isVacuumed taxi))))
