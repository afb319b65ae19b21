(define (domain bowling-alley)
  (:requirements :strips :typing :negative-preconditions)

  (:types
    place item staff - object
    lane counter rack - place
    ball shoes - item)

  (:predicates
    (staff-at ?s - staff ?p - place)
    (item-at ?i - item ?p - place)
    (holding ?s - staff ?i - item)
    (hands-free ?s - staff)
    (lane-open ?l - lane)
    (lane-oiled ?l - lane)
    (bumpers-up ?l - lane)
    (disinfected ?x - shoes)
    (cracked ?b - ball))

  (:action walk
    :parameters (?s - staff ?from - place ?to - place)
    :precondition (staff-at ?s ?from)
    :effect (and (staff-at ?s ?to) (not (staff-at ?s ?from))))

  (:action pick-up
    :parameters (?s - staff ?i - item ?p - place)
    :precondition (and (staff-at ?s ?p) (item-at ?i ?p) (hands-free ?s))
    :effect (and (holding ?s ?i) (not (item-at ?i ?p)) (not (hands-free ?s))))

  (:action put-down
    :parameters (?s - staff ?i - item ?p - place)
    :precondition (and (staff-at ?s ?p) (holding ?s ?i))
    :effect (and (item-at ?i ?p) (hands-free ?s) (not (holding ?s ?i))))

  (:action open-lane
    :parameters (?s - staff ?l - lane)
    :precondition (and (staff-at ?s ?l) (lane-oiled ?l) (not (lane-open ?l)))
    :effect (lane-open ?l))

  (:action close-lane
    :parameters (?s - staff ?l - lane)
    :precondition (and (staff-at ?s ?l) (lane-open ?l))
    :effect (not (lane-open ?l)))

  (:action oil-lane
    :parameters (?s - staff ?l - lane)
    :precondition (and (staff-at ?s ?l) (hands-free ?s) (not (lane-open ?l)) (not (lane-oiled ?l)))
    :effect (lane-oiled ?l))

  (:action raise-bumpers
    :parameters (?s - staff ?l - lane)
    :precondition (and (staff-at ?s ?l) (not (bumpers-up ?l)))
    :effect (bumpers-up ?l))

  (:action lower-bumpers
    :parameters (?s - staff ?l - lane)
    :precondition (and (staff-at ?s ?l) (bumpers-up ?l))
    :effect (not (bumpers-up ?l)))

  (:action disinfect-shoes
    :parameters (?s - staff ?x - shoes ?c - counter)
    :precondition (and (staff-at ?s ?c) (item-at ?x ?c) (not (disinfected ?x)))
    :effect (disinfected ?x)))
