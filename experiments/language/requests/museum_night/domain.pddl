; A night porter robot in a small museum.
(define (domain museum_night)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    room exhibit display_case - object
    gallery back_room - room
    sculpture painting small_exhibit - exhibit
    vessel jewel - small_exhibit)
  (:predicates
    (robot_in ?r - room)
    (connected ?r1 ?r2 - room)
    (exhibit_in ?e - exhibit ?r - room)
    (case_in ?c - display_case ?g - gallery)
    (inside_case ?e - small_exhibit ?c - display_case)
    (case_open ?c - display_case)
    (case_locked ?c - display_case)
    (glass_clean ?c - display_case)
    (holding ?e - exhibit)
    (gripper_empty)
    (dusted ?e - exhibit)
    (labeled ?e - exhibit)
    (wrapped ?e - exhibit)
    (lights_on ?r - room)
    (alarm_on ?g - gallery)
    (blinds_down ?g - gallery)
    (floor_mopped ?r - room))

  (:action move
    :parameters (?from ?to - room)
    :precondition (and (robot_in ?from) (connected ?from ?to))
    :effect (and (robot_in ?to) (not (robot_in ?from))))

  (:action pick_up_in_gallery
    :parameters (?e - exhibit ?g - gallery)
    :precondition (and (robot_in ?g) (exhibit_in ?e ?g) (gripper_empty) (not (alarm_on ?g)))
    :effect (and (holding ?e) (not (exhibit_in ?e ?g)) (not (gripper_empty))))

  (:action pick_up_in_back_room
    :parameters (?e - exhibit ?r - back_room)
    :precondition (and (robot_in ?r) (exhibit_in ?e ?r) (gripper_empty))
    :effect (and (holding ?e) (not (exhibit_in ?e ?r)) (not (gripper_empty))))

  (:action put_down
    :parameters (?e - exhibit ?r - room)
    :precondition (and (robot_in ?r) (holding ?e))
    :effect (and (exhibit_in ?e ?r) (gripper_empty) (not (holding ?e))))

  (:action take_from_case
    :parameters (?e - small_exhibit ?c - display_case ?g - gallery)
    :precondition (and (robot_in ?g) (case_in ?c ?g) (inside_case ?e ?c) (case_open ?c) (gripper_empty) (not (alarm_on ?g)))
    :effect (and (holding ?e) (not (inside_case ?e ?c)) (not (gripper_empty))))

  (:action place_in_case
    :parameters (?e - small_exhibit ?c - display_case ?g - gallery)
    :precondition (and (robot_in ?g) (case_in ?c ?g) (holding ?e) (case_open ?c) (not (wrapped ?e)))
    :effect (and (inside_case ?e ?c) (gripper_empty) (not (holding ?e))))

  (:action unlock_case
    :parameters (?c - display_case ?g - gallery)
    :precondition (and (robot_in ?g) (case_in ?c ?g) (case_locked ?c) (not (alarm_on ?g)))
    :effect (not (case_locked ?c)))

  (:action lock_case
    :parameters (?c - display_case ?g - gallery)
    :precondition (and (robot_in ?g) (case_in ?c ?g) (not (case_locked ?c)) (not (case_open ?c)))
    :effect (case_locked ?c))

  (:action open_case
    :parameters (?c - display_case ?g - gallery)
    :precondition (and (robot_in ?g) (case_in ?c ?g) (not (case_locked ?c)) (not (case_open ?c)))
    :effect (case_open ?c))

  (:action close_case
    :parameters (?c - display_case ?g - gallery)
    :precondition (and (robot_in ?g) (case_in ?c ?g) (case_open ?c))
    :effect (not (case_open ?c)))

  (:action clean_glass
    :parameters (?c - display_case ?g - gallery)
    :precondition (and (robot_in ?g) (case_in ?c ?g) (gripper_empty) (not (alarm_on ?g)))
    :effect (glass_clean ?c))

  (:action dust
    :parameters (?e - exhibit ?r - room)
    :precondition (and (robot_in ?r) (exhibit_in ?e ?r) (not (wrapped ?e)))
    :effect (dusted ?e))

  (:action attach_label
    :parameters (?e - exhibit ?r - room)
    :precondition (and (robot_in ?r) (exhibit_in ?e ?r) (not (labeled ?e)))
    :effect (labeled ?e))

  (:action wrap
    :parameters (?e - exhibit ?r - room)
    :precondition (and (robot_in ?r) (exhibit_in ?e ?r) (not (wrapped ?e)))
    :effect (wrapped ?e))

  (:action unwrap
    :parameters (?e - exhibit ?r - room)
    :precondition (and (robot_in ?r) (exhibit_in ?e ?r) (wrapped ?e))
    :effect (not (wrapped ?e)))

  (:action switch_lights_on
    :parameters (?r - room)
    :precondition (and (robot_in ?r) (not (lights_on ?r)))
    :effect (lights_on ?r))

  (:action switch_lights_off
    :parameters (?r - room)
    :precondition (and (robot_in ?r) (lights_on ?r))
    :effect (not (lights_on ?r)))

  (:action arm_alarm
    :parameters (?g - gallery)
    :precondition (and (robot_in ?g) (not (alarm_on ?g)))
    :effect (alarm_on ?g))

  (:action disarm_alarm
    :parameters (?g - gallery)
    :precondition (and (robot_in ?g) (alarm_on ?g))
    :effect (not (alarm_on ?g)))

  (:action lower_blinds
    :parameters (?g - gallery)
    :precondition (and (robot_in ?g) (not (blinds_down ?g)))
    :effect (blinds_down ?g))

  (:action raise_blinds
    :parameters (?g - gallery)
    :precondition (and (robot_in ?g) (blinds_down ?g))
    :effect (not (blinds_down ?g)))

  (:action mop_floor
    :parameters (?r - room)
    :precondition (and (robot_in ?r) (gripper_empty) (not (floor_mopped ?r)))
    :effect (floor_mopped ?r)))
