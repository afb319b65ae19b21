; back office of a small ski rental; the desk robot does everything, so there is no actor
(define (domain ski-rental)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    gear place customer - object
    board wearable - gear
    skis snowboard - board
    boots helmet - wearable)
  (:constants workshop drying-room counter - place)
  (:predicates
    (in ?g - gear ?p - place)
    (rented ?g - gear ?c - customer)
    (fits ?g - gear ?c - customer)
    (waxed ?b - board)
    (sharpened ?b - board)
    (broken ?g - gear)
    (dry ?w - wearable)
    (heater-on)
    (shop-open))

  (:action move
    :parameters (?g - gear ?from ?to - place)
    :precondition (in ?g ?from)
    :effect (and (in ?g ?to) (not (in ?g ?from))))

  (:action wax
    :parameters (?b - board)
    :precondition (and (in ?b workshop) (not (waxed ?b)))
    :effect (waxed ?b))

  (:action sharpen
    :parameters (?b - board)
    :precondition (and (in ?b workshop) (not (sharpened ?b)))
    :effect (sharpened ?b))

  (:action repair
    :parameters (?g - gear)
    :precondition (and (in ?g workshop) (broken ?g))
    :effect (not (broken ?g)))

  (:action dry-out
    :parameters (?w - wearable)
    :precondition (and (in ?w drying-room) (heater-on))
    :effect (dry ?w))

  (:action hand-out
    :parameters (?g - gear ?c - customer)
    :precondition (and (in ?g counter) (fits ?g ?c) (not (broken ?g)))
    :effect (and (rented ?g ?c) (not (in ?g counter))))

  (:action take-back
    :parameters (?g - gear ?c - customer)
    :precondition (rented ?g ?c)
    :effect (and (in ?g counter) (not (rented ?g ?c))))

  (:action switch-on-heater
    :parameters ()
    :precondition (not (heater-on))
    :effect (heater-on))

  (:action switch-off-heater
    :parameters ()
    :precondition (heater-on)
    :effect (not (heater-on)))

  (:action open-shop
    :parameters ()
    :precondition (not (shop-open))
    :effect (shop-open))

  (:action close-shop
    :parameters ()
    :precondition (shop-open)
    :effect (not (shop-open))))
