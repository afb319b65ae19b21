;; A small volunteer lifeboat station: boats, crew, gear, doors and lights.
(define (domain lifeboat-station)
  (:requirements :strips :typing :negative-preconditions)

  (:types
    lifeboat crew gear place door device - object
    lifejacket - gear
    floodlight - device)

  (:predicates
    (boat-at ?b - lifeboat ?p - place)
    (crew-at ?c - crew ?p - place)
    (aboard ?c - crew ?b - lifeboat)
    (gear-at ?g - gear ?p - place)
    (stowed ?g - gear ?b - lifeboat)
    (wearing ?c - crew ?j - lifejacket)
    (fuelled ?b - lifeboat)
    (salty ?b - lifeboat)
    (holed ?b - lifeboat)
    (open ?d - door)
    (switched-on ?x - device)
    (door-of ?d - door ?p - place)
    (slip-between ?p - place ?q - place)
    (fuel-pump-at ?p - place))

  (:action walk
    :parameters (?c - crew ?from - place ?to - place)
    :precondition (crew-at ?c ?from)
    :effect (and (crew-at ?c ?to) (not (crew-at ?c ?from))))

  (:action carry
    :parameters (?c - crew ?g - gear ?from - place ?to - place)
    :precondition (and (crew-at ?c ?from) (gear-at ?g ?from))
    :effect (and (crew-at ?c ?to) (gear-at ?g ?to) (not (crew-at ?c ?from)) (not (gear-at ?g ?from))))

  (:action stow
    :parameters (?c - crew ?g - gear ?b - lifeboat ?p - place)
    :precondition (and (crew-at ?c ?p) (gear-at ?g ?p) (boat-at ?b ?p))
    :effect (and (stowed ?g ?b) (not (gear-at ?g ?p))))

  (:action put-on-jacket
    :parameters (?c - crew ?j - lifejacket ?p - place)
    :precondition (and (crew-at ?c ?p) (gear-at ?j ?p))
    :effect (and (wearing ?c ?j) (not (gear-at ?j ?p))))

  (:action board
    :parameters (?c - crew ?j - lifejacket ?b - lifeboat ?p - place)
    :precondition (and (crew-at ?c ?p) (boat-at ?b ?p) (wearing ?c ?j))
    :effect (and (aboard ?c ?b) (not (crew-at ?c ?p))))

  (:action launch
    :parameters (?b - lifeboat ?d - door ?from - place ?to - place)
    :precondition (and (boat-at ?b ?from) (door-of ?d ?from) (open ?d) (slip-between ?from ?to)
                       (fuelled ?b) (not (holed ?b)))
    :effect (and (boat-at ?b ?to) (salty ?b) (not (boat-at ?b ?from))))

  (:action haul-up
    :parameters (?b - lifeboat ?d - door ?from - place ?to - place)
    :precondition (and (boat-at ?b ?from) (door-of ?d ?to) (open ?d) (slip-between ?to ?from))
    :effect (and (boat-at ?b ?to) (not (boat-at ?b ?from))))

  (:action refuel
    :parameters (?c - crew ?b - lifeboat ?p - place)
    :precondition (and (crew-at ?c ?p) (boat-at ?b ?p) (fuel-pump-at ?p) (not (fuelled ?b)))
    :effect (fuelled ?b))

  (:action rinse-down
    :parameters (?c - crew ?b - lifeboat ?p - place)
    :precondition (and (crew-at ?c ?p) (boat-at ?b ?p) (salty ?b))
    :effect (not (salty ?b)))

  (:action open-door
    :parameters (?d - door)
    :precondition (not (open ?d))
    :effect (open ?d))

  (:action close-door
    :parameters (?d - door)
    :precondition (open ?d)
    :effect (not (open ?d)))

  (:action switch-on
    :parameters (?x - device)
    :precondition (not (switched-on ?x))
    :effect (switched-on ?x))

  (:action switch-off
    :parameters (?x - device)
    :precondition (switched-on ?x)
    :effect (not (switched-on ?x))))
