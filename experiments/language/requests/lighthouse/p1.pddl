(define (problem foggyMorning)
  (:domain lighthouseIsland)
  (:objects
    greta olaf - person
    redBoat greyBoat - boat
    oilDrum foodCrate mailBag - cargo
    beacon foghorn generator radio - device
    harbour jetty cottage tower shed - place)
  (:init
    (personAt greta cottage) (personAt olaf harbour)
    (boatAt redBoat harbour)
    (boatAt greyBoat jetty) (isLeaking greyBoat)
    (cargoAt oilDrum harbour) (loadedOn foodCrate redBoat) (cargoAt mailBag cottage)
    (installedAt beacon tower) (installedAt foghorn tower)
    (installedAt generator shed) (installedAt radio cottage)
    (isDirty beacon) (isDirty generator)
    (turnedOn foghorn) (turnedOn radio)
    (isPier harbour) (isPier jetty)
    (hasPath jetty cottage) (hasPath cottage jetty)
    (hasPath cottage tower) (hasPath tower cottage)
    (hasPath cottage shed) (hasPath shed cottage))
  (:goal (and (turnedOn beacon) (cargoAt foodCrate cottage))))
