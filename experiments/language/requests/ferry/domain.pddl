;; deck hand on a small car ferry, moored at the quay
(define (domain car-ferry)
  (:requirements :strips :typing)
  (:types
    place vehicle passenger thing ramp horn - object
    car van motorbike - vehicle
    life-jacket suitcase thermos - thing)

  (:predicates
    (hand-at ?p - place)
    (stairs ?a ?b - place)
    (is-quay ?p - place)
    (is-car-deck ?p - place)
    (horn-at ?h - horn ?p - place)
    (ashore ?v - vehicle)
    (aboard ?v - vehicle)
    (loose ?v - vehicle)
    (lashed ?v - vehicle)
    (ramp-down ?r - ramp)
    (ramp-up ?r - ramp)
    (sits-in ?x - passenger ?p - place)
    (lying-in ?t - thing ?p - place)
    (in-hand ?t - thing)
    (hand-empty)
    (has ?x - passenger ?t - thing)
    (sounded ?h - horn))

  (:action walk
    :parameters (?a ?b - place)
    :precondition (and (hand-at ?a) (stairs ?a ?b))
    :effect (and (hand-at ?b) (not (hand-at ?a))))

  (:action drive-aboard
    :parameters (?v - vehicle ?q ?d - place ?r - ramp)
    :precondition (and (hand-at ?q) (is-quay ?q) (is-car-deck ?d) (ashore ?v) (ramp-down ?r))
    :effect (and (aboard ?v) (hand-at ?d) (not (ashore ?v)) (not (hand-at ?q))))

  (:action drive-ashore
    :parameters (?v - vehicle ?d ?q - place ?r - ramp)
    :precondition (and (hand-at ?d) (is-car-deck ?d) (is-quay ?q) (aboard ?v) (loose ?v) (ramp-down ?r))
    :effect (and (ashore ?v) (hand-at ?q) (not (aboard ?v)) (not (hand-at ?d))))

  (:action lash
    :parameters (?v - vehicle ?d - place)
    :precondition (and (hand-at ?d) (is-car-deck ?d) (aboard ?v) (loose ?v))
    :effect (and (lashed ?v) (not (loose ?v))))

  (:action raise-ramp
    :parameters (?r - ramp ?d - place)
    :precondition (and (hand-at ?d) (is-car-deck ?d) (ramp-down ?r))
    :effect (and (ramp-up ?r) (not (ramp-down ?r))))

  (:action lower-ramp
    :parameters (?r - ramp ?d - place)
    :precondition (and (hand-at ?d) (is-car-deck ?d) (ramp-up ?r))
    :effect (and (ramp-down ?r) (not (ramp-up ?r))))

  (:action pick-up
    :parameters (?t - thing ?p - place)
    :precondition (and (hand-at ?p) (lying-in ?t ?p) (hand-empty))
    :effect (and (in-hand ?t) (not (lying-in ?t ?p)) (not (hand-empty))))

  (:action set-down
    :parameters (?t - thing ?p - place)
    :precondition (and (hand-at ?p) (in-hand ?t))
    :effect (and (lying-in ?t ?p) (hand-empty) (not (in-hand ?t))))

  (:action hand-over
    :parameters (?t - thing ?x - passenger ?p - place)
    :precondition (and (hand-at ?p) (sits-in ?x ?p) (in-hand ?t))
    :effect (and (has ?x ?t) (hand-empty) (not (in-hand ?t))))

  (:action sound-horn
    :parameters (?h - horn ?p - place)
    :precondition (and (hand-at ?p) (horn-at ?h ?p))
    :effect (and (sounded ?h))))
