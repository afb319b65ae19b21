(define (domain small_cinema)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    room staff film - object
    hall - room)
  (:constants foyer - room)
  (:predicates
    (is_in ?s - staff ?r - room)
    (has_keys ?s - staff)
    (door_locked ?r - room)
    (on_shelf ?f - film)
    (loaded ?f - film ?h - hall)
    (projector_free ?h - hall)
    (playing ?f - film ?h - hall)
    (lights_on ?h - hall)
    (swept ?h - hall)
    (for_children ?f - film)
    (big ?h - hall)
    (small ?h - hall))

  (:action go_to
    :parameters (?s - staff ?from ?to - room)
    :precondition (and (is_in ?s ?from) (not (door_locked ?from)) (not (door_locked ?to)))
    :effect (and (is_in ?s ?to) (not (is_in ?s ?from))))

  (:action lock_door
    :parameters (?s - staff ?r - room)
    :precondition (and (has_keys ?s) (is_in ?s foyer) (not (door_locked ?r)))
    :effect (door_locked ?r))

  (:action unlock_door
    :parameters (?s - staff ?r - room)
    :precondition (and (has_keys ?s) (is_in ?s foyer) (door_locked ?r))
    :effect (not (door_locked ?r)))

  (:action load_film
    :parameters (?s - staff ?f - film ?h - hall)
    :precondition (and (is_in ?s ?h) (on_shelf ?f) (projector_free ?h))
    :effect (and (loaded ?f ?h) (not (on_shelf ?f)) (not (projector_free ?h))))

  (:action take_out_film
    :parameters (?s - staff ?f - film ?h - hall)
    :precondition (and (is_in ?s ?h) (loaded ?f ?h))
    :effect (and (on_shelf ?f) (projector_free ?h) (not (loaded ?f ?h)) (not (playing ?f ?h))))

  (:action start_film
    :parameters (?s - staff ?f - film ?h - hall)
    :precondition (and (is_in ?s ?h) (loaded ?f ?h) (not (lights_on ?h)))
    :effect (playing ?f ?h))

  (:action switch_on_lights
    :parameters (?s - staff ?h - hall)
    :precondition (and (is_in ?s ?h) (not (lights_on ?h)))
    :effect (lights_on ?h))

  (:action switch_off_lights
    :parameters (?s - staff ?h - hall)
    :precondition (and (is_in ?s ?h) (lights_on ?h))
    :effect (not (lights_on ?h)))

  (:action sweep
    :parameters (?s - staff ?h - hall)
    :precondition (and (is_in ?s ?h) (lights_on ?h) (not (swept ?h)))
    :effect (swept ?h)))
