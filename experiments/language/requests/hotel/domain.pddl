; A housekeeping robot on one floor of a hotel.
(define (domain hotel-housekeeping)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    room item - object
    guest-room service-room - room
    bed-sheets towel-set drink cleaning-tool lost-property - item
    vacuum mop - cleaning-tool)
  (:predicates
    (robot-at ?r - room)
    (adjacent ?r1 ?r2 - room)
    (item-at ?i - item ?r - room)
    (carrying ?i - item)
    (hand-empty)
    (door-locked ?r - room)
    (do-not-disturb ?r - guest-room)
    (bed-made ?r - guest-room)
    (towels-changed ?r - guest-room)
    (bathroom-clean ?r - guest-room)
    (in-minibar ?d - drink ?r - guest-room)
    (vacuumed ?r - room)
    (bin-full ?r - room)
    (curtains-open ?r - guest-room)
    (heating-on ?r - guest-room))

  (:action move
    :parameters (?from ?to - room)
    :precondition (and (robot-at ?from) (adjacent ?from ?to) (not (door-locked ?from)) (not (door-locked ?to)))
    :effect (and (robot-at ?to) (not (robot-at ?from))))

  (:action unlock-door
    :parameters (?r - guest-room ?c - service-room)
    :precondition (and (robot-at ?c) (adjacent ?c ?r) (door-locked ?r))
    :effect (not (door-locked ?r)))

  (:action lock-door
    :parameters (?r - guest-room ?c - service-room)
    :precondition (and (robot-at ?c) (adjacent ?c ?r) (not (door-locked ?r)))
    :effect (door-locked ?r))

  (:action pick-up
    :parameters (?i - item ?r - room)
    :precondition (and (robot-at ?r) (item-at ?i ?r) (hand-empty))
    :effect (and (carrying ?i) (not (item-at ?i ?r)) (not (hand-empty))))

  (:action put-down
    :parameters (?i - item ?r - room)
    :precondition (and (robot-at ?r) (carrying ?i))
    :effect (and (item-at ?i ?r) (hand-empty) (not (carrying ?i))))

  (:action make-bed
    :parameters (?s - bed-sheets ?r - guest-room)
    :precondition (and (robot-at ?r) (carrying ?s) (not (bed-made ?r)) (not (do-not-disturb ?r)))
    :effect (and (bed-made ?r) (hand-empty) (not (carrying ?s))))

  (:action change-towels
    :parameters (?t - towel-set ?r - guest-room)
    :precondition (and (robot-at ?r) (carrying ?t) (not (do-not-disturb ?r)))
    :effect (and (towels-changed ?r) (hand-empty) (not (carrying ?t))))

  (:action stock-minibar
    :parameters (?d - drink ?r - guest-room)
    :precondition (and (robot-at ?r) (carrying ?d) (not (do-not-disturb ?r)))
    :effect (and (in-minibar ?d ?r) (hand-empty) (not (carrying ?d))))

  (:action vacuum-floor
    :parameters (?v - vacuum ?r - guest-room)
    :precondition (and (robot-at ?r) (carrying ?v) (not (vacuumed ?r)) (not (do-not-disturb ?r)))
    :effect (vacuumed ?r))

  (:action vacuum-hall
    :parameters (?v - vacuum ?r - service-room)
    :precondition (and (robot-at ?r) (carrying ?v) (not (vacuumed ?r)))
    :effect (vacuumed ?r))

  (:action clean-bathroom
    :parameters (?m - mop ?r - guest-room)
    :precondition (and (robot-at ?r) (carrying ?m) (not (bathroom-clean ?r)) (not (do-not-disturb ?r)))
    :effect (bathroom-clean ?r))

  (:action empty-bin
    :parameters (?r - room)
    :precondition (and (robot-at ?r) (bin-full ?r) (hand-empty))
    :effect (not (bin-full ?r)))

  (:action open-curtains
    :parameters (?r - guest-room)
    :precondition (and (robot-at ?r) (not (curtains-open ?r)))
    :effect (curtains-open ?r))

  (:action close-curtains
    :parameters (?r - guest-room)
    :precondition (and (robot-at ?r) (curtains-open ?r))
    :effect (not (curtains-open ?r)))

  (:action turn-heating-on
    :parameters (?r - guest-room)
    :precondition (and (robot-at ?r) (not (heating-on ?r)))
    :effect (heating-on ?r))

  (:action turn-heating-off
    :parameters (?r - guest-room)
    :precondition (and (robot-at ?r) (heating-on ?r))
    :effect (not (heating-on ?r))))
