; house removals
(define (domain removals)
  (:requirements :strips)
  (:predicates
    (van ?x) (mover ?x) (place ?x) (thing ?x)
    (road ?p ?q)
    (at ?x ?p)
    (in ?x ?v)
    (carries ?m ?x)
    (free ?m)
    (fragile ?x)
    (wrapped ?x)
    (safe ?x)
    (handy ?x)
    (can-dismantle ?x)
    (assembled ?x))

  (:action drive
    :parameters (?v ?m ?p ?q)
    :precondition (and (van ?v) (mover ?m) (place ?p) (place ?q) (road ?p ?q) (at ?v ?p) (in ?m ?v))
    :effect (and (at ?v ?q) (not (at ?v ?p))))

  (:action get-in
    :parameters (?m ?v ?p)
    :precondition (and (mover ?m) (van ?v) (place ?p) (at ?m ?p) (at ?v ?p) (free ?m))
    :effect (and (in ?m ?v) (not (at ?m ?p))))

  (:action get-out
    :parameters (?m ?v ?p)
    :precondition (and (mover ?m) (van ?v) (place ?p) (in ?m ?v) (at ?v ?p))
    :effect (and (at ?m ?p) (not (in ?m ?v))))

  (:action lift
    :parameters (?m ?x ?p)
    :precondition (and (mover ?m) (thing ?x) (place ?p) (at ?m ?p) (at ?x ?p) (handy ?x) (free ?m))
    :effect (and (carries ?m ?x) (not (at ?x ?p)) (not (free ?m))))

  (:action set-down
    :parameters (?m ?x ?p)
    :precondition (and (mover ?m) (thing ?x) (place ?p) (at ?m ?p) (carries ?m ?x))
    :effect (and (at ?x ?p) (free ?m) (not (carries ?m ?x))))

  (:action load
    :parameters (?m ?x ?v ?p)
    :precondition (and (mover ?m) (thing ?x) (van ?v) (place ?p) (at ?m ?p) (at ?v ?p) (carries ?m ?x) (safe ?x))
    :effect (and (in ?x ?v) (free ?m) (not (carries ?m ?x))))

  (:action unload
    :parameters (?m ?x ?v ?p)
    :precondition (and (mover ?m) (thing ?x) (van ?v) (place ?p) (at ?m ?p) (at ?v ?p) (in ?x ?v) (free ?m))
    :effect (and (carries ?m ?x) (not (in ?x ?v)) (not (free ?m))))

  (:action wrap
    :parameters (?m ?x ?p)
    :precondition (and (mover ?m) (thing ?x) (place ?p) (at ?m ?p) (at ?x ?p) (fragile ?x) (free ?m))
    :effect (and (wrapped ?x) (safe ?x)))

  (:action unwrap
    :parameters (?m ?x ?p)
    :precondition (and (mover ?m) (thing ?x) (place ?p) (at ?m ?p) (at ?x ?p) (wrapped ?x) (free ?m))
    :effect (and (not (wrapped ?x)) (not (safe ?x))))

  (:action dismantle
    :parameters (?m ?x ?p)
    :precondition (and (mover ?m) (thing ?x) (place ?p) (at ?m ?p) (at ?x ?p) (can-dismantle ?x) (assembled ?x) (free ?m))
    :effect (and (handy ?x) (not (assembled ?x))))

  (:action assemble
    :parameters (?m ?x ?p)
    :precondition (and (mover ?m) (thing ?x) (place ?p) (at ?m ?p) (at ?x ?p) (can-dismantle ?x) (handy ?x) (free ?m))
    :effect (and (assembled ?x) (not (handy ?x))))
)
