; boarding kennel: volunteers look after the dogs
(define (domain dog-kennel)
  (:requirements :strips :negative-preconditions)
  (:constants wash-house)
  (:predicates
    (dog ?x) (handler ?x) (place ?x)
    (black ?d) (small ?d)
    (is-at ?x ?p)
    (on-lead ?d ?h)
    (loose ?d)
    (free-hands ?h)
    (gate-open ?p)
    (fed ?d)
    (muddy ?d))

  (:action open-gate
    :parameters (?h ?p)
    :precondition (and (handler ?h) (place ?p) (free-hands ?h) (not (gate-open ?p)))
    :effect (gate-open ?p))

  (:action shut-gate
    :parameters (?h ?p)
    :precondition (and (handler ?h) (place ?p) (gate-open ?p))
    :effect (not (gate-open ?p)))

  (:action walk
    :parameters (?h ?from ?to)
    :precondition (and (handler ?h) (place ?from) (place ?to) (is-at ?h ?from)
                       (free-hands ?h) (gate-open ?from) (gate-open ?to))
    :effect (and (is-at ?h ?to) (not (is-at ?h ?from))))

  (:action put-on-lead
    :parameters (?h ?d ?p)
    :precondition (and (handler ?h) (dog ?d) (place ?p) (is-at ?h ?p) (is-at ?d ?p)
                       (loose ?d) (free-hands ?h))
    :effect (and (on-lead ?d ?h) (not (loose ?d)) (not (free-hands ?h))))

  (:action take-off-lead
    :parameters (?h ?d)
    :precondition (and (handler ?h) (dog ?d) (on-lead ?d ?h))
    :effect (and (free-hands ?h) (loose ?d) (not (on-lead ?d ?h))))

  (:action lead-dog
    :parameters (?h ?d ?from ?to)
    :precondition (and (handler ?h) (dog ?d) (place ?from) (place ?to) (on-lead ?d ?h)
                       (is-at ?h ?from) (is-at ?d ?from) (gate-open ?from) (gate-open ?to))
    :effect (and (is-at ?h ?to) (is-at ?d ?to) (not (is-at ?h ?from)) (not (is-at ?d ?from))))

  (:action feed-dog
    :parameters (?h ?d ?p)
    :precondition (and (handler ?h) (dog ?d) (place ?p) (is-at ?h ?p) (is-at ?d ?p)
                       (free-hands ?h) (not (fed ?d)))
    :effect (fed ?d))

  (:action wash-dog
    :parameters (?h ?d)
    :precondition (and (handler ?h) (dog ?d) (is-at ?h wash-house) (is-at ?d wash-house) (muddy ?d))
    :effect (not (muddy ?d))))
