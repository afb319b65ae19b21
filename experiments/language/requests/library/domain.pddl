(define (domain library)
  (:requirements :strips :typing :negative-preconditions :conditional-effects)
  (:types
    location book patron cart - object
    shelf desk box - location)
  (:predicates
    (robot-at ?l - location)
    (on-shelf ?b - book ?s - shelf)
    (on-desk ?b - book ?d - desk)
    (in-box ?b - book ?x - box)
    (in-cart ?b - book ?c - cart)
    (cart-at ?c - cart ?l - location)
    (holding ?b - book)
    (hand-empty)
    (lent-to ?b - book ?p - patron)
    (waiting-at ?p - patron ?d - desk)
    (damaged ?b - book)
    (labelled ?b - book)
    (box-open ?x - box)
    (lamp-on ?d - desk)
    (has-lamp ?d - desk)
    (has-tape ?d - desk))

  (:action go
    :parameters (?from ?to - location)
    :precondition (robot-at ?from)
    :effect (and (not (robot-at ?from)) (robot-at ?to)))

  (:action take-from-shelf
    :parameters (?b - book ?s - shelf)
    :precondition (and (robot-at ?s) (on-shelf ?b ?s) (hand-empty))
    :effect (and (holding ?b) (not (hand-empty)) (not (on-shelf ?b ?s))))

  (:action take-from-desk
    :parameters (?b - book ?d - desk)
    :precondition (and (robot-at ?d) (on-desk ?b ?d) (hand-empty))
    :effect (and (holding ?b) (not (hand-empty)) (not (on-desk ?b ?d))))

  (:action take-from-box
    :parameters (?b - book ?x - box)
    :precondition (and (robot-at ?x) (in-box ?b ?x) (box-open ?x) (hand-empty))
    :effect (and (holding ?b) (not (hand-empty)) (not (in-box ?b ?x))))

  (:action shelve
    :parameters (?b - book ?s - shelf)
    :precondition (and (robot-at ?s) (holding ?b))
    :effect (and (on-shelf ?b ?s) (hand-empty) (not (holding ?b))))

  (:action lay-down
    :parameters (?b - book ?d - desk)
    :precondition (and (robot-at ?d) (holding ?b))
    :effect (and (on-desk ?b ?d) (hand-empty) (not (holding ?b))))

  (:action load
    :parameters (?b - book ?c - cart ?l - location)
    :precondition (and (robot-at ?l) (cart-at ?c ?l) (holding ?b))
    :effect (and (in-cart ?b ?c) (hand-empty) (not (holding ?b))))

  (:action push-cart
    :parameters (?c - cart ?from ?to - location)
    :precondition (and (robot-at ?from) (cart-at ?c ?from) (hand-empty))
    :effect (and (robot-at ?to) (cart-at ?c ?to) (not (robot-at ?from)) (not (cart-at ?c ?from))))

  (:action check-out
    :parameters (?b - book ?p - patron ?d - desk)
    :precondition (and (robot-at ?d) (waiting-at ?p ?d) (holding ?b) (not (damaged ?b)))
    :effect (and (lent-to ?b ?p) (hand-empty) (not (holding ?b))))

  (:action check-in
    :parameters (?b - book ?p - patron ?d - desk)
    :precondition (and (robot-at ?d) (waiting-at ?p ?d) (lent-to ?b ?p) (hand-empty))
    :effect (and (holding ?b) (not (hand-empty)) (not (lent-to ?b ?p))))

  (:action repair
    :parameters (?b - book ?d - desk)
    :precondition (and (robot-at ?d) (has-tape ?d) (holding ?b) (damaged ?b))
    :effect (not (damaged ?b)))

  (:action label
    :parameters (?b - book ?d - desk)
    :precondition (and (robot-at ?d) (on-desk ?b ?d) (not (labelled ?b)))
    :effect (labelled ?b))

  (:action open-box
    :parameters (?x - box)
    :precondition (and (robot-at ?x) (hand-empty) (not (box-open ?x)))
    :effect (box-open ?x))

  (:action switch-lamp-on
    :parameters (?d - desk)
    :precondition (and (robot-at ?d) (has-lamp ?d) (not (lamp-on ?d)))
    :effect (lamp-on ?d))

  (:action switch-lamp-off
    :parameters (?d - desk)
    :precondition (and (robot-at ?d) (lamp-on ?d))
    :effect (not (lamp-on ?d)))
)
