; Keeping a lighthouse on a small island
(define (domain lighthouseIsland)
  (:requirements :strips :typing :negative-preconditions)
  (:types person boat cargo device place)
  (:predicates
    (personAt ?p - person ?l - place)
    (boatAt ?b - boat ?l - place)
    (cargoAt ?c - cargo ?l - place)
    (loadedOn ?c - cargo ?b - boat)
    (installedAt ?d - device ?l - place)
    (turnedOn ?d - device)
    (isDirty ?d - device)
    (isLeaking ?b - boat)
    (isPier ?l - place)
    (hasPath ?a ?b - place))

  (:action walkTo
    :parameters (?p - person ?a ?b - place)
    :precondition (and (personAt ?p ?a) (hasPath ?a ?b))
    :effect (and (personAt ?p ?b) (not (personAt ?p ?a))))

  (:action carryCargo
    :parameters (?p - person ?c - cargo ?a ?b - place)
    :precondition (and (personAt ?p ?a) (cargoAt ?c ?a) (hasPath ?a ?b))
    :effect (and (personAt ?p ?b) (not (personAt ?p ?a))
                 (cargoAt ?c ?b) (not (cargoAt ?c ?a))))

  (:action sailBoat
    :parameters (?p - person ?b - boat ?from ?to - place)
    :precondition (and (personAt ?p ?from) (boatAt ?b ?from)
                       (isPier ?from) (isPier ?to) (not (isLeaking ?b)))
    :effect (and (personAt ?p ?to) (not (personAt ?p ?from))
                 (boatAt ?b ?to) (not (boatAt ?b ?from))))

  (:action loadCargo
    :parameters (?p - person ?c - cargo ?b - boat ?l - place)
    :precondition (and (personAt ?p ?l) (boatAt ?b ?l) (cargoAt ?c ?l))
    :effect (and (loadedOn ?c ?b) (not (cargoAt ?c ?l))))

  (:action unloadCargo
    :parameters (?p - person ?c - cargo ?b - boat ?l - place)
    :precondition (and (personAt ?p ?l) (boatAt ?b ?l) (loadedOn ?c ?b))
    :effect (and (cargoAt ?c ?l) (not (loadedOn ?c ?b))))

  (:action turnOn
    :parameters (?p - person ?d - device ?l - place)
    :precondition (and (personAt ?p ?l) (installedAt ?d ?l) (not (turnedOn ?d)))
    :effect (turnedOn ?d))

  (:action turnOff
    :parameters (?p - person ?d - device ?l - place)
    :precondition (and (personAt ?p ?l) (installedAt ?d ?l) (turnedOn ?d))
    :effect (not (turnedOn ?d)))

  ; never clean a device while it is on
  (:action cleanDevice
    :parameters (?p - person ?d - device ?l - place)
    :precondition (and (personAt ?p ?l) (installedAt ?d ?l) (not (turnedOn ?d)))
    :effect (not (isDirty ?d)))
)
