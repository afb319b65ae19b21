;; Greenhouse robot - assignment 2
(define (domain greenhouse)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    place - object
    portable - object
    plant tool - portable
    watering-can pruner fertilizer - tool
    vent grow-lamp - object)

  (:predicates
    (robot-at ?p - place)
    (stands-at ?x - portable ?p - place)
    (carrying ?x - portable)
    (hand-free)
    (has-tap ?p - place)
    (vent-of ?v - vent ?p - place)
    (lamp-of ?l - grow-lamp ?p - place)
    (vent-open ?v - vent)
    (lamp-on ?l - grow-lamp)
    (full ?c - watering-can)
    (watered ?x - plant)
    (fertilized ?x - plant)
    (pruned ?x - plant)
    (ripe ?x - plant)
    (harvested ?x - plant))

  (:action walk
    :parameters (?from ?to - place)
    :precondition (robot-at ?from)
    :effect (and (robot-at ?to) (not (robot-at ?from))))

  (:action pick-up
    :parameters (?x - portable ?p - place)
    :precondition (and (robot-at ?p) (stands-at ?x ?p) (hand-free))
    :effect (and (carrying ?x) (not (hand-free)) (not (stands-at ?x ?p))))

  (:action put-down
    :parameters (?x - portable ?p - place)
    :precondition (and (robot-at ?p) (carrying ?x))
    :effect (and (stands-at ?x ?p) (hand-free) (not (carrying ?x))))

  (:action fill-can
    :parameters (?c - watering-can ?p - place)
    :precondition (and (robot-at ?p) (has-tap ?p) (carrying ?c) (not (full ?c)))
    :effect (full ?c))

  (:action water
    :parameters (?x - plant ?c - watering-can ?p - place)
    :precondition (and (robot-at ?p) (stands-at ?x ?p) (carrying ?c) (full ?c))
    :effect (and (watered ?x) (not (full ?c))))

  (:action fertilize
    :parameters (?x - plant ?f - fertilizer ?p - place)
    :precondition (and (robot-at ?p) (stands-at ?x ?p) (carrying ?f))
    :effect (fertilized ?x))

  (:action prune
    :parameters (?x - plant ?s - pruner ?p - place)
    :precondition (and (robot-at ?p) (stands-at ?x ?p) (carrying ?s))
    :effect (pruned ?x))

  (:action harvest
    :parameters (?x - plant ?p - place)
    :precondition (and (robot-at ?p) (stands-at ?x ?p) (hand-free) (ripe ?x))
    :effect (and (harvested ?x) (not (ripe ?x))))

  (:action open-vent
    :parameters (?v - vent ?p - place)
    :precondition (and (robot-at ?p) (vent-of ?v ?p) (hand-free) (not (vent-open ?v)))
    :effect (vent-open ?v))

  (:action close-vent
    :parameters (?v - vent ?p - place)
    :precondition (and (robot-at ?p) (vent-of ?v ?p) (hand-free) (vent-open ?v))
    :effect (not (vent-open ?v)))

  (:action switch-on
    :parameters (?l - grow-lamp ?p - place)
    :precondition (and (robot-at ?p) (lamp-of ?l ?p) (hand-free) (not (lamp-on ?l)))
    :effect (lamp-on ?l))

  (:action switch-off
    :parameters (?l - grow-lamp ?p - place)
    :precondition (and (robot-at ?p) (lamp-of ?l ?p) (hand-free) (lamp-on ?l))
    :effect (not (lamp-on ?l)))
)
