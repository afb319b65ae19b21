(define (domain zoo)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    enclosure animal feed - object
    pool-enclosure heated-enclosure - enclosure)
  (:predicates
    (lives-in ?a - animal ?e - enclosure)
    (occupied ?e - enclosure)
    (gate-locked ?e - enclosure)
    (swept ?e - enclosure)
    (heating-on ?e - heated-enclosure)
    (pool-filled ?e - pool-enclosure)
    (eats ?a - animal ?f - feed)
    (in-bucket ?f - feed)
    (bucket-empty)
    (fed ?a - animal))
  (:action unlock-gate
    :parameters (?e - enclosure)
    :precondition (gate-locked ?e)
    :effect (not (gate-locked ?e)))
  (:action lock-gate
    :parameters (?e - enclosure)
    :precondition (not (gate-locked ?e))
    :effect (gate-locked ?e))
  (:action fill-bucket
    :parameters (?f - feed)
    :precondition (bucket-empty)
    :effect (and (in-bucket ?f) (not (bucket-empty))))
  (:action feed
    :parameters (?a - animal ?f - feed ?e - enclosure)
    :precondition (and (in-bucket ?f) (eats ?a ?f) (lives-in ?a ?e) (not (gate-locked ?e)))
    :effect (and (fed ?a) (bucket-empty) (not (in-bucket ?f))))
  (:action move-animal
    :parameters (?a - animal ?from - enclosure ?to - enclosure)
    :precondition (and (lives-in ?a ?from) (not (occupied ?to)) (not (gate-locked ?from)) (not (gate-locked ?to)))
    :effect (and (lives-in ?a ?to) (occupied ?to) (not (lives-in ?a ?from)) (not (occupied ?from))))
  (:action sweep
    :parameters (?e - enclosure)
    :precondition (and (not (occupied ?e)) (not (gate-locked ?e)))
    :effect (swept ?e))
  (:action switch-heating-on
    :parameters (?e - heated-enclosure)
    :precondition (not (heating-on ?e))
    :effect (heating-on ?e))
  (:action switch-heating-off
    :parameters (?e - heated-enclosure)
    :precondition (heating-on ?e)
    :effect (not (heating-on ?e)))
  (:action fill-pool
    :parameters (?e - pool-enclosure)
    :precondition (not (pool-filled ?e))
    :effect (pool-filled ?e)))
