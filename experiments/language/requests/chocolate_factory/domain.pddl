;; Small chocolate factory: melt, pour, chill, wrap.
(define (domain chocolate-factory)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    worker room tray chocolate device - object
    kettle machine - device)

  (:constants cold-room packing-room - room)

  (:predicates
    (worker-at ?w - worker ?r - room)
    (hands-free ?w - worker)
    (carrying ?w - worker ?t - tray)
    (tray-at ?t - tray ?r - room)
    (tray-empty ?t - tray)
    (filled-with ?t - tray ?c - chocolate)
    (firm ?t - tray)
    (wrapped ?t - tray)
    (stands-in ?d - device ?r - room)
    (switched-on ?d - device)
    (kettle-empty ?k - kettle)
    (melted-in ?c - chocolate ?k - kettle))

  (:action walk
    :parameters (?w - worker ?from ?to - room)
    :precondition (worker-at ?w ?from)
    :effect (and (not (worker-at ?w ?from)) (worker-at ?w ?to)))

  (:action pick-up
    :parameters (?w - worker ?t - tray ?r - room)
    :precondition (and (worker-at ?w ?r) (tray-at ?t ?r) (hands-free ?w))
    :effect (and (carrying ?w ?t) (not (tray-at ?t ?r)) (not (hands-free ?w))))

  (:action put-down
    :parameters (?w - worker ?t - tray ?r - room)
    :precondition (and (worker-at ?w ?r) (carrying ?w ?t))
    :effect (and (tray-at ?t ?r) (hands-free ?w) (not (carrying ?w ?t))))

  (:action switch-on
    :parameters (?w - worker ?d - device ?r - room)
    :precondition (and (worker-at ?w ?r) (stands-in ?d ?r) (not (switched-on ?d)))
    :effect (switched-on ?d))

  (:action switch-off
    :parameters (?w - worker ?d - device ?r - room)
    :precondition (and (worker-at ?w ?r) (stands-in ?d ?r) (switched-on ?d))
    :effect (not (switched-on ?d)))

  (:action melt
    :parameters (?w - worker ?c - chocolate ?k - kettle ?r - room)
    :precondition (and (worker-at ?w ?r) (stands-in ?k ?r) (switched-on ?k) (kettle-empty ?k))
    :effect (and (melted-in ?c ?k) (not (kettle-empty ?k))))

  ; one kettle makes exactly one tray
  (:action pour
    :parameters (?w - worker ?c - chocolate ?k - kettle ?t - tray ?r - room)
    :precondition (and (worker-at ?w ?r) (stands-in ?k ?r) (tray-at ?t ?r)
                       (melted-in ?c ?k) (tray-empty ?t))
    :effect (and (filled-with ?t ?c) (not (tray-empty ?t))
                 (kettle-empty ?k) (not (melted-in ?c ?k))))

  (:action chill
    :parameters (?t - tray ?m - machine ?c - chocolate)
    :precondition (and (tray-at ?t cold-room) (stands-in ?m cold-room)
                       (switched-on ?m) (filled-with ?t ?c))
    :effect (firm ?t))

  (:action wrap
    :parameters (?w - worker ?t - tray ?m - machine)
    :precondition (and (worker-at ?w packing-room) (tray-at ?t packing-room)
                       (stands-in ?m packing-room) (switched-on ?m) (firm ?t))
    :effect (wrapped ?t))
)
