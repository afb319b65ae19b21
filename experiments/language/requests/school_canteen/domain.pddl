;; The kitchen and the dining hall of a school.
(define (domain school-canteen)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    place cook appliance item - object
    table - place
    heater washer - appliance
    food tray - item)

  (:predicates
    (stands-at ?c - cook ?p - place)
    (located ?i - item ?p - place)
    (holds ?c - cook ?i - item)
    (hands-free ?c - cook)
    (installed ?a - appliance ?p - place)
    (switched-on ?a - appliance)
    (heats ?a - heater ?f - food)
    (frozen ?f - food)
    (warm ?f - food)
    (salted ?f - food)
    (on-tray ?f - food ?t - tray)
    (empty-tray ?t - tray)
    (dirty ?t - tray)
    (wiped ?b - table))

  (:action walk
    :parameters (?c - cook ?from ?to - place)
    :precondition (stands-at ?c ?from)
    :effect (and (stands-at ?c ?to) (not (stands-at ?c ?from))))

  (:action take
    :parameters (?c - cook ?i - item ?p - place)
    :precondition (and (stands-at ?c ?p) (located ?i ?p) (hands-free ?c))
    :effect (and (holds ?c ?i) (not (located ?i ?p)) (not (hands-free ?c))))

  (:action put
    :parameters (?c - cook ?i - item ?p - place)
    :precondition (and (stands-at ?c ?p) (holds ?c ?i))
    :effect (and (located ?i ?p) (hands-free ?c) (not (holds ?c ?i))))

  (:action switch-on
    :parameters (?c - cook ?a - appliance ?p - place)
    :precondition (and (stands-at ?c ?p) (installed ?a ?p) (not (switched-on ?a)))
    :effect (switched-on ?a))

  (:action switch-off
    :parameters (?c - cook ?a - appliance ?p - place)
    :precondition (and (stands-at ?c ?p) (installed ?a ?p) (switched-on ?a))
    :effect (not (switched-on ?a)))

  (:action thaw
    :parameters (?c - cook ?f - food ?p - place)
    :precondition (and (stands-at ?c ?p) (located ?f ?p) (frozen ?f))
    :effect (not (frozen ?f)))

  (:action heat
    :parameters (?c - cook ?f - food ?a - heater ?p - place)
    :precondition (and (stands-at ?c ?p) (installed ?a ?p) (located ?f ?p)
                       (switched-on ?a) (heats ?a ?f) (not (frozen ?f)))
    :effect (warm ?f))

  (:action salt
    :parameters (?c - cook ?f - food ?p - place)
    :precondition (and (stands-at ?c ?p) (located ?f ?p) (not (salted ?f)))
    :effect (salted ?f))

  (:action dish-up
    :parameters (?c - cook ?f - food ?t - tray ?p - place)
    :precondition (and (stands-at ?c ?p) (located ?f ?p) (located ?t ?p)
                       (empty-tray ?t) (not (dirty ?t)) (not (frozen ?f)))
    :effect (and (on-tray ?f ?t) (not (located ?f ?p)) (not (empty-tray ?t))))

  (:action wash
    :parameters (?c - cook ?t - tray ?w - washer ?p - place)
    :precondition (and (stands-at ?c ?p) (installed ?w ?p) (located ?t ?p)
                       (switched-on ?w) (dirty ?t) (empty-tray ?t))
    :effect (not (dirty ?t)))

  (:action wipe
    :parameters (?c - cook ?b - table)
    :precondition (and (stands-at ?c ?b) (not (wiped ?b)))
    :effect (wiped ?b)))
