(define (domain hall)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    locatable room person - object
    robot surface item - locatable
    box - item)
  (:predicates
    (at ?x - locatable ?l - room)
    (on ?i - item ?s - surface)
    (in ?i - item ?b - box)
    (have ?r - robot ?i - item)
    (free ?r - robot)
    (clear ?s - surface)
    (open ?b - box)
    (lit ?l - room)
    (locked ?l - room)
    (link ?a ?b - room)
    (brought ?p - person ?b - box))

  (:action move
    :parameters (?r - robot ?a ?b - room)
    :precondition (and (at ?r ?a) (link ?a ?b) (not (locked ?b)))
    :effect (and (at ?r ?b) (not (at ?r ?a))))

  ; floor
  (:action pick
    :parameters (?r - robot ?i - item ?l - room)
    :precondition (and (at ?r ?l) (at ?i ?l) (free ?r))
    :effect (and (have ?r ?i) (not (at ?i ?l)) (not (free ?r))))

  (:action drop
    :parameters (?r - robot ?i - item ?l - room)
    :precondition (and (at ?r ?l) (have ?r ?i))
    :effect (and (at ?i ?l) (free ?r) (not (have ?r ?i))))

  ; tables and shelves, one thing each
  (:action take
    :parameters (?r - robot ?i - item ?s - surface ?l - room)
    :precondition (and (at ?r ?l) (at ?s ?l) (on ?i ?s) (free ?r))
    :effect (and (have ?r ?i) (clear ?s) (not (on ?i ?s)) (not (free ?r))))

  (:action put
    :parameters (?r - robot ?i - item ?s - surface ?l - room)
    :precondition (and (at ?r ?l) (at ?s ?l) (have ?r ?i) (clear ?s))
    :effect (and (on ?i ?s) (free ?r) (not (clear ?s)) (not (have ?r ?i))))

  ; boxes
  (:action get-out
    :parameters (?r - robot ?i - item ?b - box ?l - room)
    :precondition (and (at ?r ?l) (at ?b ?l) (open ?b) (in ?i ?b) (free ?r))
    :effect (and (have ?r ?i) (not (in ?i ?b)) (not (free ?r))))

  (:action put-in
    :parameters (?r - robot ?i - item ?b - box ?l - room)
    :precondition (and (at ?r ?l) (at ?b ?l) (open ?b) (have ?r ?i))
    :effect (and (in ?i ?b) (free ?r) (not (have ?r ?i))))

  (:action open-box
    :parameters (?r - robot ?b - box ?l - room)
    :precondition (and (at ?r ?l) (at ?b ?l) (free ?r) (not (open ?b)))
    :effect (open ?b))

  (:action close-box
    :parameters (?r - robot ?b - box ?l - room)
    :precondition (and (at ?r ?l) (at ?b ?l) (free ?r) (open ?b))
    :effect (not (open ?b)))

  (:action light-on
    :parameters (?r - robot ?l - room)
    :precondition (and (at ?r ?l) (not (lit ?l)))
    :effect (lit ?l))

  (:action light-off
    :parameters (?r - robot ?l - room)
    :precondition (and (at ?r ?l) (lit ?l))
    :effect (not (lit ?l)))

  (:action unlock
    :parameters (?r - robot ?a ?b - room)
    :precondition (and (at ?r ?a) (link ?a ?b) (locked ?b))
    :effect (not (locked ?b)))
)
