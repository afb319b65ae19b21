(define (domain recycling_yard)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    item place gate - object
    jar bottle can paper battery - item
    skip locker machine belt dock tap - place)
  (:predicates
    (truck-at ?p - place)
    (lying-at ?i - item ?p - place)
    (in ?i - item ?p - place)
    (gripping ?i - item)
    (gripper-free)
    (rinsed ?i - item)
    (crushed ?i - item)
    (shredded ?i - item)
    (weighed ?i - item)
    (running ?m - machine)
    (locked ?l - locker)
    (gate-open ?g - gate)
    (can-crush ?m - machine)
    (can-shred ?m - machine)
    (crushable ?i - item)
    (shreddable ?i - item)
    (scale-at ?p - place))

  (:action drive
    :parameters (?from ?to - place)
    :precondition (truck-at ?from)
    :effect (and (not (truck-at ?from)) (truck-at ?to)))

  (:action grip
    :parameters (?i - item ?p - place)
    :precondition (and (truck-at ?p) (lying-at ?i ?p) (gripper-free))
    :effect (and (gripping ?i) (not (gripper-free)) (not (lying-at ?i ?p))))

  (:action fish-out
    :parameters (?i - item ?s - skip)
    :precondition (and (truck-at ?s) (in ?i ?s) (gripper-free))
    :effect (and (gripping ?i) (not (gripper-free)) (not (in ?i ?s))))

  (:action set-down
    :parameters (?i - item ?p - belt)
    :precondition (and (truck-at ?p) (gripping ?i))
    :effect (and (lying-at ?i ?p) (gripper-free) (not (gripping ?i))))

  (:action tip-into
    :parameters (?i - item ?s - skip)
    :precondition (and (truck-at ?s) (gripping ?i))
    :effect (and (in ?i ?s) (gripper-free) (not (gripping ?i))))

  (:action store
    :parameters (?i - battery ?l - locker)
    :precondition (and (truck-at ?l) (gripping ?i) (not (locked ?l)))
    :effect (and (in ?i ?l) (gripper-free) (not (gripping ?i))))

  (:action rinse
    :parameters (?i - item ?t - tap)
    :precondition (and (truck-at ?t) (gripping ?i) (not (rinsed ?i)))
    :effect (rinsed ?i))

  (:action crush
    :parameters (?i - item ?m - machine)
    :precondition (and (truck-at ?m) (gripping ?i) (can-crush ?m) (running ?m) (crushable ?i))
    :effect (crushed ?i))

  (:action shred
    :parameters (?i - item ?m - machine)
    :precondition (and (truck-at ?m) (gripping ?i) (can-shred ?m) (running ?m) (shreddable ?i))
    :effect (shredded ?i))

  (:action weigh
    :parameters (?i - item ?p - place)
    :precondition (and (truck-at ?p) (scale-at ?p) (lying-at ?i ?p))
    :effect (weighed ?i))

  (:action start
    :parameters (?m - machine)
    :precondition (and (truck-at ?m) (not (running ?m)))
    :effect (running ?m))

  (:action stop
    :parameters (?m - machine)
    :precondition (and (truck-at ?m) (running ?m))
    :effect (not (running ?m)))

  (:action lock
    :parameters (?l - locker)
    :precondition (and (truck-at ?l) (not (locked ?l)))
    :effect (locked ?l))

  (:action unlock
    :parameters (?l - locker)
    :precondition (and (truck-at ?l) (locked ?l))
    :effect (not (locked ?l)))

  (:action shut-gate
    :parameters (?g - gate ?d - dock)
    :precondition (and (truck-at ?d) (gate-open ?g))
    :effect (not (gate-open ?g)))
)
