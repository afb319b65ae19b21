;; off-grid farm: panels, inverters, batteries and what hangs on them
(define (domain solarFarm)
  (:requirements :strips :typing :negative-preconditions)
  (:types panel inverter battery appliance cable angle)
  (:predicates
    (isDusty ?p - panel)
    (tilted ?p - panel ?a - angle)
    (isRunning ?i - inverter)
    (feeds ?i - inverter ?b - battery)
    (isFull ?b - battery)
    (joins ?c - cable ?b - battery ?x - appliance)
    (powered ?x - appliance)
    (spare ?c - cable))

  (:action washPanel
    :parameters (?p - panel)
    :precondition (isDusty ?p)
    :effect (not (isDusty ?p)))

  (:action tiltPanel
    :parameters (?p - panel ?old ?new - angle)
    :precondition (tilted ?p ?old)
    :effect (and (not (tilted ?p ?old)) (tilted ?p ?new)))

  (:action startInverter
    :parameters (?i - inverter)
    :precondition (not (isRunning ?i))
    :effect (isRunning ?i))

  (:action stopInverter
    :parameters (?i - inverter)
    :precondition (isRunning ?i)
    :effect (not (isRunning ?i)))

  (:action redirect
    :parameters (?i - inverter ?old ?new - battery)
    :precondition (feeds ?i ?old)
    :effect (and (not (feeds ?i ?old)) (feeds ?i ?new)))

  (:action chargeBattery
    :parameters (?b - battery ?i - inverter)
    :precondition (and (isRunning ?i) (feeds ?i ?b))
    :effect (isFull ?b))

  (:action plugIn
    :parameters (?x - appliance ?b - battery ?c - cable)
    :precondition (and (spare ?c) (not (powered ?x)))
    :effect (and (joins ?c ?b ?x) (powered ?x) (not (spare ?c))))

  (:action unplug
    :parameters (?x - appliance ?b - battery ?c - cable)
    :precondition (joins ?c ?b ?x)
    :effect (and (not (joins ?c ?b ?x)) (not (powered ?x)) (spare ?c))))
