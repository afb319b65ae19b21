;; repair shop, two mechanics
(define (domain garage)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    locatable location - object
    mechanic vehicle item - locatable
    bay - location
    car van motorbike - vehicle
    battery tool - item
  )
  (:predicates
    (at ?x - locatable ?l - location)
    (holding ?m - mechanic ?i - item)
    (hands_free ?m - mechanic)
    (raised ?v - vehicle)
    (hood_open ?v - vehicle)
    (installed ?b - battery ?v - vehicle)
    (has_battery ?v - vehicle)
    (compatible ?b - battery ?v - vehicle)
    (dead ?b - battery)
    (oil_changed ?v - vehicle)
    (washed ?v - vehicle)
    (has_hose ?l - location)
    (is_oil ?t - tool)
  )

  (:action walk
    :parameters (?m - mechanic ?from ?to - location)
    :precondition (at ?m ?from)
    :effect (and (not (at ?m ?from)) (at ?m ?to)))

  (:action drive
    :parameters (?m - mechanic ?v - vehicle ?from ?to - location)
    :precondition (and (at ?m ?from) (at ?v ?from) (has_battery ?v)
                       (not (raised ?v)) (not (hood_open ?v)))
    :effect (and (not (at ?m ?from)) (not (at ?v ?from)) (at ?m ?to) (at ?v ?to)))

  (:action pick_up
    :parameters (?m - mechanic ?i - item ?l - location)
    :precondition (and (at ?m ?l) (at ?i ?l) (hands_free ?m))
    :effect (and (holding ?m ?i) (not (at ?i ?l)) (not (hands_free ?m))))

  (:action put_down
    :parameters (?m - mechanic ?i - item ?l - location)
    :precondition (and (at ?m ?l) (holding ?m ?i))
    :effect (and (at ?i ?l) (hands_free ?m) (not (holding ?m ?i))))

  (:action raise
    :parameters (?m - mechanic ?v - vehicle ?b - bay)
    :precondition (and (at ?m ?b) (at ?v ?b) (not (raised ?v)))
    :effect (raised ?v))

  (:action lower
    :parameters (?m - mechanic ?v - vehicle ?b - bay)
    :precondition (and (at ?m ?b) (at ?v ?b) (raised ?v))
    :effect (not (raised ?v)))

  (:action open_hood
    :parameters (?m - mechanic ?v - vehicle ?l - location)
    :precondition (and (at ?m ?l) (at ?v ?l) (hands_free ?m) (not (hood_open ?v)))
    :effect (hood_open ?v))

  (:action close_hood
    :parameters (?m - mechanic ?v - vehicle ?l - location)
    :precondition (and (at ?m ?l) (at ?v ?l) (hood_open ?v))
    :effect (not (hood_open ?v)))

  (:action remove_battery
    :parameters (?m - mechanic ?b - battery ?v - vehicle ?l - location)
    :precondition (and (at ?m ?l) (at ?v ?l) (hood_open ?v) (installed ?b ?v) (hands_free ?m))
    :effect (and (holding ?m ?b) (not (hands_free ?m)) (not (installed ?b ?v)) (not (has_battery ?v))))

  (:action install_battery
    :parameters (?m - mechanic ?b - battery ?v - vehicle ?l - location)
    :precondition (and (at ?m ?l) (at ?v ?l) (hood_open ?v) (holding ?m ?b)
                       (compatible ?b ?v) (not (has_battery ?v)))
    :effect (and (installed ?b ?v) (has_battery ?v) (hands_free ?m) (not (holding ?m ?b))))

  (:action change_oil
    :parameters (?m - mechanic ?v - vehicle ?b - bay ?o - tool)
    :precondition (and (at ?m ?b) (at ?v ?b) (raised ?v) (holding ?m ?o) (is_oil ?o))
    :effect (oil_changed ?v))

  (:action wash
    :parameters (?m - mechanic ?v - vehicle ?l - location)
    :precondition (and (at ?m ?l) (at ?v ?l) (has_hose ?l) (not (hood_open ?v)))
    :effect (washed ?v))
)
