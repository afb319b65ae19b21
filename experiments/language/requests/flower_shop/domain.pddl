(define (domain flowershop)
(:requirements :strips :typing :negative-preconditions)
; my wife's shop :)
(:types florist customer - person
        flower potplant - greenery
        vase bucket - container
        person greenery container spot - object)
(:predicates
 (path ?a ?b - spot)
 (is-at ?p - (either florist customer) ?s - spot)
 (lies ?x - (either greenery container) ?s - spot)
 (in-hand ?x - (either greenery container) ?p - florist)
 (busy ?p - florist)
 (tap ?s - spot)
 (full ?c - container)
 (stuck-in ?f - flower ?c - container)
 (trimmed ?f - flower)
 (wilted ?f - flower)
 (thirsty ?p - potplant)
 (wrapped ?x - (either flower potplant))
 (sold ?x - (either flower potplant) ?c - customer)
 (binned ?f - flower))

(:action go
 :parameters (?p - florist ?a ?b - spot)
 :precondition (and (is-at ?p ?a) (path ?a ?b))
 :effect (and (is-at ?p ?b) (not (is-at ?p ?a))))
(:action grab
 :parameters (?p - florist ?x - (either greenery container) ?s - spot)
 :precondition (and (is-at ?p ?s) (lies ?x ?s) (not (busy ?p)))
 :effect (and (in-hand ?x ?p) (busy ?p) (not (lies ?x ?s))))
(:action drop
 :parameters (?p - florist ?x - (either greenery container) ?s - spot)
 :precondition (and (is-at ?p ?s) (in-hand ?x ?p))
 :effect (and (lies ?x ?s) (not (in-hand ?x ?p)) (not (busy ?p))))
(:action trim ; cut the stem
 :parameters (?p - florist ?f - flower)
 :precondition (and (in-hand ?f ?p) (not (trimmed ?f)) (not (wrapped ?f)))
 :effect (trimmed ?f))
(:action fill-up
 :parameters (?p - florist ?c - container ?s - spot)
 :precondition (and (is-at ?p ?s) (tap ?s) (in-hand ?c ?p) (not (full ?c)))
 :effect (full ?c))
(:action empty-out
 :parameters (?p - florist ?c - container ?s - spot)
 :precondition (and (is-at ?p ?s) (tap ?s) (in-hand ?c ?p) (full ?c))
 :effect (not (full ?c)))
(:action arrange
 :parameters (?p - florist ?f - flower ?c - (either vase bucket) ?s - spot)
 :precondition (and (is-at ?p ?s) (lies ?c ?s) (full ?c) (in-hand ?f ?p) (trimmed ?f) (not (wrapped ?f)) (not (wilted ?f)))
 :effect (and (stuck-in ?f ?c) (not (in-hand ?f ?p)) (not (busy ?p))))
(:action pull-out
 :parameters (?p - florist ?f - flower ?c - (either vase bucket) ?s - spot)
 :precondition (and (is-at ?p ?s) (lies ?c ?s) (stuck-in ?f ?c) (not (busy ?p)))
 :effect (and (in-hand ?f ?p) (busy ?p) (not (stuck-in ?f ?c))))
(:action water
 :parameters (?p - florist ?x - potplant ?s - spot)
 :precondition (and (is-at ?p ?s) (lies ?x ?s) (thirsty ?x) (not (busy ?p)))
 :effect (not (thirsty ?x)))
(:action wrap
 :parameters (?p - florist ?x - (either flower potplant) ?s - spot)
 :precondition (and (is-at ?p ?s) (in-hand ?x ?p) (not (wrapped ?x)))
 :effect (wrapped ?x))
(:action sell
 :parameters (?p - florist ?x - (either flower potplant) ?c - customer ?s - spot)
 :precondition (and (is-at ?p ?s) (is-at ?c ?s) (in-hand ?x ?p) (wrapped ?x))
 :effect (and (sold ?x ?c) (not (in-hand ?x ?p)) (not (busy ?p))))
(:action bin
 :parameters (?p - florist ?f - flower)
 :precondition (and (in-hand ?f ?p) (wilted ?f))
 :effect (and (binned ?f) (not (in-hand ?f ?p)) (not (busy ?p))))
)
