;; Container terminal: stacks of containers, cranes, trucks and a ship.
(define (domain terminal)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    location locatable - object
    crane vehicle surface - locatable
    truck ship - vehicle
    container pallet - surface
    reefer - container)

  (:predicates
    (at ?x - locatable ?l - location)
    (on ?c - container ?s - surface)
    (in ?c - container ?v - vehicle)
    (clear ?s - surface)
    (holding ?k - crane ?c - container)
    (free ?k - crane)
    (fuelled ?t - truck)
    (inspected ?c - container)
    (sealed ?c - container)
    (plugged ?r - reefer)
    (office ?l - location))          ; where containers are inspected

  (:action drive
    :parameters (?t - truck ?from ?to - location)
    :precondition (and (at ?t ?from))
    :effect (and (at ?t ?to) (not (at ?t ?from))))

  (:action refuel
    :parameters (?t - truck)
    :precondition (and (not (fuelled ?t)))
    :effect (and (fuelled ?t)))

  (:action lift
    :parameters (?k - crane ?c - container ?s - surface ?l - location)
    :precondition (and (at ?k ?l) (at ?c ?l) (on ?c ?s) (clear ?c) (free ?k))
    :effect (and (holding ?k ?c) (not (free ?k)) (not (on ?c ?s)) (not (at ?c ?l)) (not (clear ?c)) (clear ?s)))

  (:action drop
    :parameters (?k - crane ?c - container ?s - surface ?l - location)
    :precondition (and (at ?k ?l) (at ?s ?l) (clear ?s) (holding ?k ?c))
    :effect (and (free ?k) (not (holding ?k ?c)) (at ?c ?l) (on ?c ?s) (clear ?c) (not (clear ?s))))

  (:action load
    :parameters (?k - crane ?c - container ?v - vehicle ?l - location)
    :precondition (and (at ?k ?l) (at ?v ?l) (holding ?k ?c))
    :effect (and (in ?c ?v) (free ?k) (not (holding ?k ?c))))

  (:action unload
    :parameters (?k - crane ?c - container ?v - vehicle ?l - location)
    :precondition (and (at ?k ?l) (at ?v ?l) (free ?k) (in ?c ?v))
    :effect (and (holding ?k ?c) (not (free ?k)) (not (in ?c ?v))))

  (:action inspect
    :parameters (?c - container ?l - location)
    :precondition (and (at ?c ?l) (office ?l) (not (sealed ?c)))
    :effect (and (inspected ?c)))

  (:action seal
    :parameters (?c - container)
    :precondition (and (not (sealed ?c)))
    :effect (and (sealed ?c)))

  (:action break-seal
    :parameters (?c - container)
    :precondition (and (sealed ?c))
    :effect (and (not (sealed ?c))))

  (:action plug
    :parameters (?r - reefer ?p - pallet)
    :precondition (and (on ?r ?p) (not (plugged ?r)))
    :effect (and (plugged ?r)))

  (:action unplug
    :parameters (?r - reefer)
    :precondition (and (plugged ?r))
    :effect (and (not (plugged ?r)))))
