(define (domain boardgame-cafe)
  (:requirements :strips :typing :negative-preconditions)
  (:types guest game table drink)
  (:predicates
    (waiting ?g - guest)
    (seated ?g - guest ?t - table)
    (knows ?g - guest ?b - game)
    (on-table ?b - game ?t - table)
    (in-cabinet ?b - game)
    (lent-to ?b - game ?g - guest)
    (served ?g - guest ?d - drink)
    (clean ?t - table))

  (:action seat
    :parameters (?g - guest ?t - table)
    :precondition (waiting ?g)
    :effect (and (seated ?g ?t) (not (waiting ?g))))

  (:action move-guest
    :parameters (?g - guest ?from ?to - table)
    :precondition (seated ?g ?from)
    :effect (and (not (seated ?g ?from)) (seated ?g ?to)))

  (:action bring-game
    :parameters (?b - game ?t - table)
    :precondition (in-cabinet ?b)
    :effect (and (on-table ?b ?t) (not (in-cabinet ?b))))

  (:action put-away
    :parameters (?b - game ?t - table)
    :precondition (on-table ?b ?t)
    :effect (and (in-cabinet ?b) (not (on-table ?b ?t))))

  (:action explain-rules
    :parameters (?b - game ?g - guest ?t - table)
    :precondition (and (on-table ?b ?t) (seated ?g ?t))
    :effect (knows ?g ?b))

  (:action lend-out
    :parameters (?b - game ?g - guest)
    :precondition (in-cabinet ?b)
    :effect (and (lent-to ?b ?g) (not (in-cabinet ?b))))

  (:action take-back
    :parameters (?b - game ?g - guest)
    :precondition (lent-to ?b ?g)
    :effect (and (in-cabinet ?b) (not (lent-to ?b ?g))))

  (:action serve
    :parameters (?d - drink ?g - guest ?t - table)
    :precondition (seated ?g ?t)
    :effect (served ?g ?d))

  (:action wipe
    :parameters (?t - table)
    :precondition (not (clean ?t))
    :effect (clean ?t)))
