(define (domain quarry)
  (:requirements :strips :typing)
  (:types location locatable - object
          truck driver slab - locatable)
  (:predicates
    (at ?obj - locatable ?loc - location)
    (in ?s - slab ?t - truck)
    (driving ?d - driver ?t - truck)
    (empty ?t - truck)
    (link ?x ?y - location)
    (saw_at ?l - location)
    (polisher_at ?l - location)
    (cut ?s - slab)
    (polished ?s - slab))

  (:action load-truck
    :parameters (?s - slab ?t - truck ?loc - location)
    :precondition (and (at ?t ?loc) (at ?s ?loc))
    :effect (and (not (at ?s ?loc)) (in ?s ?t)))

  (:action unload-truck
    :parameters (?s - slab ?t - truck ?loc - location)
    :precondition (and (at ?t ?loc) (in ?s ?t))
    :effect (and (not (in ?s ?t)) (at ?s ?loc)))

  (:action board-truck
    :parameters (?d - driver ?t - truck ?loc - location)
    :precondition (and (at ?t ?loc) (at ?d ?loc) (empty ?t))
    :effect (and (not (at ?d ?loc)) (driving ?d ?t) (not (empty ?t))))

  (:action disembark-truck
    :parameters (?d - driver ?t - truck ?loc - location)
    :precondition (and (at ?t ?loc) (driving ?d ?t))
    :effect (and (not (driving ?d ?t)) (at ?d ?loc) (empty ?t)))

  (:action drive-truck
    :parameters (?t - truck ?from ?to - location ?d - driver)
    :precondition (and (at ?t ?from) (driving ?d ?t) (link ?from ?to))
    :effect (and (not (at ?t ?from)) (at ?t ?to)))

  (:action walk
    :parameters (?d - driver ?from ?to - location)
    :precondition (and (at ?d ?from) (link ?from ?to))
    :effect (and (not (at ?d ?from)) (at ?d ?to)))

  (:action saw-slab
    :parameters (?s - slab ?l - location)
    :precondition (and (at ?s ?l) (saw_at ?l))
    :effect (cut ?s))

  (:action polish-slab
    :parameters (?s - slab ?l - location)
    :precondition (and (at ?s ?l) (polisher_at ?l) (cut ?s))
    :effect (polished ?s)))
