; The stage crew's robot of a small theatre. It walks between places and has one hand. Lanterns take colour gels, which are
; fitted while the lantern is off; the fog machine runs on fluid; trunks have lids; the curtain is flown up and down.

(define (domain theatre)
  (:requirements :strips :typing :negative-preconditions :disjunctive-preconditions :universal-preconditions)

  (:types
    place item device curtain - object
    area trunk - place                  ; tables, rails and shelves are plain places
    prop costume gel - item             ; tools are plain items
    spotlight - device)                 ; fog machines, work lights and so on are plain devices

  (:constants broom steamer fluid_can - item)

  (:predicates
    (robot_at ?p - place)
    (at ?x - object ?p - place)              ; an item lies there, a device or curtain is worked from there
    (holding ?i - item)
    (hand_free)
    (heavy ?i - item)                        ; too heavy for one hand
    (closed ?p - place)                      ; of trunks: the lid is down
    (locked ?t - trunk)                      ; the stage manager has the key
    (switched_on ?d - device)
    (takes_fluid ?d - device)
    (filled ?d - device)                     ; there is fluid in its tank
    (fitted ?g - gel ?s - spotlight)         ; the gel is in the spotlight's frame
    (raised ?c - curtain)
    (swept ?a - area)
    (steamed ?c - costume))

  (:action walk
    :parameters (?from - place ?to - place)
    :precondition (robot_at ?from)
    :effect (and (not (robot_at ?from)) (robot_at ?to)))

  (:action pick_up
    :parameters (?i - item ?p - place)
    :precondition (and (robot_at ?p) (at ?i ?p) (hand_free) (not (closed ?p)) (not (heavy ?i)))
    :effect (and (holding ?i) (not (hand_free)) (not (at ?i ?p))))

  (:action put_down
    :parameters (?i - item ?p - place)
    :precondition (and (robot_at ?p) (holding ?i) (not (closed ?p)))
    :effect (and (at ?i ?p) (hand_free) (not (holding ?i))))

  (:action open_trunk
    :parameters (?t - trunk)
    :precondition (and (robot_at ?t) (hand_free) (closed ?t) (not (locked ?t)))
    :effect (not (closed ?t)))

  (:action close_trunk
    :parameters (?t - trunk)
    :precondition (and (robot_at ?t) (hand_free) (not (closed ?t)))
    :effect (closed ?t))

  (:action switch_on
    :parameters (?d - device ?p - place)
    :precondition (and (robot_at ?p) (at ?d ?p) (hand_free) (not (switched_on ?d))
      (or (not (takes_fluid ?d)) (filled ?d)))
    :effect (switched_on ?d))

  (:action switch_off
    :parameters (?d - device ?p - place)
    :precondition (and (robot_at ?p) (at ?d ?p) (hand_free) (switched_on ?d))
    :effect (not (switched_on ?d)))

  (:action refill
    :parameters (?d - device ?p - place)
    :precondition (and (robot_at ?p) (at ?d ?p) (holding fluid_can) (takes_fluid ?d) (not (switched_on ?d)))
    :effect (filled ?d))

  (:action fit_gel
    :parameters (?g - gel ?s - spotlight ?p - place)
    :precondition (and (robot_at ?p) (at ?s ?p) (holding ?g) (not (switched_on ?s))
      (forall (?h - gel) (not (fitted ?h ?s))))
    :effect (and (fitted ?g ?s) (hand_free) (not (holding ?g))))

  (:action remove_gel
    :parameters (?g - gel ?s - spotlight ?p - place)
    :precondition (and (robot_at ?p) (at ?s ?p) (fitted ?g ?s) (hand_free) (not (switched_on ?s)))
    :effect (and (holding ?g) (not (hand_free)) (not (fitted ?g ?s))))

  (:action raise_curtain
    :parameters (?c - curtain ?p - place)
    :precondition (and (robot_at ?p) (at ?c ?p) (hand_free) (not (raised ?c)))
    :effect (raised ?c))

  (:action lower_curtain
    :parameters (?c - curtain ?p - place)
    :precondition (and (robot_at ?p) (at ?c ?p) (hand_free) (raised ?c))
    :effect (not (raised ?c)))

  (:action sweep
    :parameters (?a - area)
    :precondition (and (robot_at ?a) (holding broom))
    :effect (swept ?a))

  (:action steam
    :parameters (?c - costume ?p - place)
    :precondition (and (robot_at ?p) (at ?c ?p) (holding steamer) (not (closed ?p)))
    :effect (steamed ?c))
)
