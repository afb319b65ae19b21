; POST OFFICE. Plain STRIPS, every state has its opposite as a predicate of its own
(define (domain post-office)
  (:requirements :strips :typing)
  (:types
    location item container - object
    letter parcel - item
    pigeonhole sack - container)
  (:predicates
    (agent-in ?l - location)
    (item-at ?i - item ?l - location)
    (inside ?i - item ?c - container)
    (container-at ?c - container ?l - location)
    (holds ?i - item)
    (empty-handed)
    (stamps-at ?l - location)
    (scale-at ?l - location)
    (unstamped ?i - item)
    (stamped ?i - item)
    (unweighed ?p - parcel)
    (weighed ?p - parcel)
    (uncancelled ?l - letter)
    (cancelled ?l - letter)
    (tied ?s - sack)
    (untied ?s - sack)
    (shutter-of ?l - location)
    (shutter-up ?l - location)
    (shutter-down ?l - location)
    (fragile ?p - parcel)
    (registered ?l - letter))

  (:action GO
    :parameters (?a ?b - location)
    :precondition (agent-in ?a)
    :effect (and (agent-in ?b) (not (agent-in ?a))))

  (:action TAKE
    :parameters (?i - item ?l - location)
    :precondition (and (agent-in ?l) (item-at ?i ?l) (empty-handed))
    :effect (and (holds ?i) (not (item-at ?i ?l)) (not (empty-handed))))

  (:action LAY
    :parameters (?i - item ?l - location)
    :precondition (and (agent-in ?l) (holds ?i))
    :effect (and (item-at ?i ?l) (empty-handed) (not (holds ?i))))

  (:action SORT-INTO
    :parameters (?i - letter ?c - pigeonhole ?l - location)
    :precondition (and (agent-in ?l) (container-at ?c ?l) (holds ?i) (stamped ?i))
    :effect (and (inside ?i ?c) (empty-handed) (not (holds ?i))))

  (:action PULL-OUT
    :parameters (?i - letter ?c - pigeonhole ?l - location)
    :precondition (and (agent-in ?l) (container-at ?c ?l) (inside ?i ?c) (empty-handed))
    :effect (and (holds ?i) (not (inside ?i ?c)) (not (empty-handed))))

  (:action BAG
    :parameters (?i - item ?s - sack ?l - location)
    :precondition (and (agent-in ?l) (container-at ?s ?l) (untied ?s) (holds ?i))
    :effect (and (inside ?i ?s) (empty-handed) (not (holds ?i))))

  (:action UNBAG
    :parameters (?i - item ?s - sack ?l - location)
    :precondition (and (agent-in ?l) (container-at ?s ?l) (untied ?s) (inside ?i ?s) (empty-handed))
    :effect (and (holds ?i) (not (inside ?i ?s)) (not (empty-handed))))

  (:action TIE
    :parameters (?s - sack ?l - location)
    :precondition (and (agent-in ?l) (container-at ?s ?l) (untied ?s) (empty-handed))
    :effect (and (tied ?s) (not (untied ?s))))

  (:action UNTIE
    :parameters (?s - sack ?l - location)
    :precondition (and (agent-in ?l) (container-at ?s ?l) (tied ?s) (empty-handed))
    :effect (and (untied ?s) (not (tied ?s))))

  (:action STAMP
    :parameters (?i - item ?l - location)
    :precondition (and (agent-in ?l) (stamps-at ?l) (holds ?i) (unstamped ?i))
    :effect (and (stamped ?i) (not (unstamped ?i))))

  (:action CANCEL
    :parameters (?i - letter ?l - location)
    :precondition (and (agent-in ?l) (stamps-at ?l) (holds ?i) (stamped ?i) (uncancelled ?i))
    :effect (and (cancelled ?i) (not (uncancelled ?i))))

  (:action WEIGH
    :parameters (?p - parcel ?l - location)
    :precondition (and (agent-in ?l) (scale-at ?l) (holds ?p) (unweighed ?p))
    :effect (and (weighed ?p) (not (unweighed ?p))))

  (:action SHUTTER-RAISE
    :parameters (?l - location)
    :precondition (and (agent-in ?l) (shutter-of ?l) (shutter-down ?l) (empty-handed))
    :effect (and (shutter-up ?l) (not (shutter-down ?l))))

  (:action SHUTTER-LOWER
    :parameters (?l - location)
    :precondition (and (agent-in ?l) (shutter-of ?l) (shutter-up ?l) (empty-handed))
    :effect (and (shutter-down ?l) (not (shutter-up ?l))))
)
