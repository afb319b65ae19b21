; Office service robot: fetches and delivers things, looks after doors, lights, desks and plants.
(define (domain officeRobot)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    robot room door surface item plant printer person - object
    desk table shelf - surface
    folder parcel - item)

  (:predicates
    (robotAt ?r - robot ?x - room)
    (carrying ?r - robot ?i - item)
    (handFree ?r - robot)
    (doorBetween ?d - door ?x - room ?y - room)
    (doorOpen ?d - door)
    (standsIn ?s - surface ?x - room)
    (isOn ?i - item ?s - surface)
    (tooHeavy ?i - item)
    (isClean ?s - surface)
    (lightOn ?x - room)
    (plantIn ?p - plant ?x - room)
    (isWatered ?p - plant)
    (printerIn ?p - printer ?x - room)
    (hasPaper ?p - printer)
    (personIn ?h - person ?x - room)
    (hasItem ?h - person ?i - item))

  (:action moveTo
    :parameters (?r - robot ?x ?y - room ?d - door)
    :precondition (and (robotAt ?r ?x) (doorBetween ?d ?x ?y) (doorOpen ?d))
    :effect (and (not (robotAt ?r ?x)) (robotAt ?r ?y)))

  (:action openDoor
    :parameters (?r - robot ?d - door ?x ?y - room)
    :precondition (and (robotAt ?r ?x) (doorBetween ?d ?x ?y) (not (doorOpen ?d)))
    :effect (doorOpen ?d))

  (:action closeDoor
    :parameters (?r - robot ?d - door ?x ?y - room)
    :precondition (and (robotAt ?r ?x) (doorBetween ?d ?x ?y) (doorOpen ?d))
    :effect (not (doorOpen ?d)))

  (:action pickUp
    :parameters (?r - robot ?i - item ?s - surface ?x - room)
    :precondition (and (robotAt ?r ?x) (standsIn ?s ?x) (isOn ?i ?s) (handFree ?r) (not (tooHeavy ?i)))
    :effect (and (carrying ?r ?i) (not (isOn ?i ?s)) (not (handFree ?r))))

  (:action putDown
    :parameters (?r - robot ?i - item ?s - surface ?x - room)
    :precondition (and (robotAt ?r ?x) (standsIn ?s ?x) (carrying ?r ?i))
    :effect (and (isOn ?i ?s) (handFree ?r) (not (carrying ?r ?i))))

  (:action giveTo
    :parameters (?r - robot ?i - item ?h - person ?x - room)
    :precondition (and (robotAt ?r ?x) (personIn ?h ?x) (carrying ?r ?i))
    :effect (and (hasItem ?h ?i) (handFree ?r) (not (carrying ?r ?i))))

  (:action wipeSurface
    :parameters (?r - robot ?s - surface ?x - room)
    :precondition (and (robotAt ?r ?x) (standsIn ?s ?x) (handFree ?r))
    :effect (isClean ?s))

  (:action waterPlant
    :parameters (?r - robot ?p - plant ?x - room)
    :precondition (and (robotAt ?r ?x) (plantIn ?p ?x) (handFree ?r))
    :effect (isWatered ?p))

  (:action loadPaper
    :parameters (?r - robot ?p - printer ?x - room)
    :precondition (and (robotAt ?r ?x) (printerIn ?p ?x) (handFree ?r) (not (hasPaper ?p)))
    :effect (hasPaper ?p))

  (:action switchLightOn
    :parameters (?r - robot ?x - room)
    :precondition (and (robotAt ?r ?x) (not (lightOn ?x)))
    :effect (lightOn ?x))

  (:action switchLightOff
    :parameters (?r - robot ?x - room)
    :precondition (and (robotAt ?r ?x) (lightOn ?x))
    :effect (not (lightOn ?x))))
