(define (domain carWash)
  (:requirements :strips :typing :negative-preconditions)
  (:types vehicle colour spot machine)
  (:constants
    washTunnel vacuumBay - spot
    brushes blower - machine)
  (:predicates
    (parkedAt ?v - vehicle ?s - spot)
    (hasColour ?v - vehicle ?c - colour)
    (isLarge ?v - vehicle)
    (isDirty ?v - vehicle)
    (isWet ?v - vehicle)
    (isWaxed ?v - vehicle)
    (isVacuumed ?v - vehicle)
    (windowsClosed ?v - vehicle)
    (isRunning ?m - machine))

  (:action driveTo
    :parameters (?v - vehicle ?from - spot ?to - spot)
    :precondition (parkedAt ?v ?from)
    :effect (and (not (parkedAt ?v ?from)) (parkedAt ?v ?to)))

  (:action startMachine
    :parameters (?m - machine)
    :precondition (not (isRunning ?m))
    :effect (isRunning ?m))

  (:action stopMachine
    :parameters (?m - machine)
    :precondition (isRunning ?m)
    :effect (not (isRunning ?m)))

  (:action closeWindows
    :parameters (?v - vehicle)
    :precondition (not (windowsClosed ?v))
    :effect (windowsClosed ?v))

  (:action openWindows
    :parameters (?v - vehicle)
    :precondition (windowsClosed ?v)
    :effect (not (windowsClosed ?v)))

  ; the tunnel is too low for large vehicles
  (:action washVehicle
    :parameters (?v - vehicle)
    :precondition (and (parkedAt ?v washTunnel) (isRunning brushes) (windowsClosed ?v) (not (isLarge ?v)))
    :effect (and (not (isDirty ?v)) (isWet ?v) (not (isWaxed ?v))))

  (:action dryVehicle
    :parameters (?v - vehicle)
    :precondition (and (parkedAt ?v washTunnel) (isRunning blower) (isWet ?v))
    :effect (not (isWet ?v)))

  (:action waxVehicle
    :parameters (?v - vehicle)
    :precondition (and (not (isDirty ?v)) (not (isWet ?v)))
    :effect (isWaxed ?v))

  (:action vacuumInside
    :parameters (?v - vehicle)
    :precondition (parkedAt ?v vacuumBay)
    :effect (isVacuumed ?v))
)
