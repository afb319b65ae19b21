; A laundry room with a helper that does the washing.
(define (domain laundry-room)
  (:requirements :strips :typing :negative-preconditions :conditional-effects :universal-preconditions)
  (:types
    place item - object
    machine furniture - place
    washer dryer - machine
    basket table ironing-table closet line - furniture
    shirt towel bedding trousers socks cloth - item)
  (:predicates
    (robot-at ?p - place)
    (is-in ?i - item ?p - place)
    (carrying ?i - item)
    (hand-free)
    (has-door ?p - place)
    (shut ?p - place)
    (dirty ?i - item)
    (wet ?i - item)
    (folded ?i - item)
    (ironed ?i - item)
    (delicate ?i - item)
    (shrunk ?i - item)
    (airy ?p - place)
    (has-detergent ?w - washer))
  (:action walk
    :parameters (?from ?to - place)
    :precondition (robot-at ?from)
    :effect (and (not (robot-at ?from)) (robot-at ?to)))
  (:action pick-up
    :parameters (?i - item ?p - place)
    :precondition (and (robot-at ?p) (is-in ?i ?p) (hand-free) (not (shut ?p)))
    :effect (and (carrying ?i) (not (hand-free)) (not (is-in ?i ?p))))
  (:action put-down
    :parameters (?i - item ?p - place)
    :precondition (and (robot-at ?p) (carrying ?i) (not (shut ?p)))
    :effect (and (is-in ?i ?p) (hand-free) (not (carrying ?i))
                 (when (airy ?p) (not (wet ?i)))))
  (:action open-door
    :parameters (?p - place)
    :precondition (and (robot-at ?p) (has-door ?p) (shut ?p))
    :effect (not (shut ?p)))
  (:action close-door
    :parameters (?p - place)
    :precondition (and (robot-at ?p) (has-door ?p) (not (shut ?p)))
    :effect (shut ?p))
  (:action add-detergent
    :parameters (?w - washer)
    :precondition (and (robot-at ?w) (not (has-detergent ?w)))
    :effect (has-detergent ?w))
  (:action wash
    :parameters (?w - washer)
    :precondition (and (robot-at ?w) (shut ?w) (has-detergent ?w))
    :effect (and (not (has-detergent ?w))
                 (forall (?i - item)
                   (when (is-in ?i ?w)
                         (and (not (dirty ?i)) (wet ?i) (not (folded ?i)) (not (ironed ?i)))))))
  (:action tumble-dry
    :parameters (?d - dryer)
    :precondition (and (robot-at ?d) (shut ?d))
    :effect (forall (?i - item)
              (and (when (is-in ?i ?d) (not (wet ?i)))
                   (when (and (is-in ?i ?d) (delicate ?i)) (shrunk ?i)))))
  (:action fold
    :parameters (?i - item ?t - table)
    :precondition (and (robot-at ?t) (is-in ?i ?t) (hand-free) (not (dirty ?i)) (not (wet ?i)))
    :effect (folded ?i))
  (:action iron
    :parameters (?i - item ?b - ironing-table)
    :precondition (and (robot-at ?b) (is-in ?i ?b) (hand-free) (not (dirty ?i)) (not (wet ?i)))
    :effect (ironed ?i)))
