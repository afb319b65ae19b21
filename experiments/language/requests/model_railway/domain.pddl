(define (domain modelRailway)
  (:requirements :strips :typing :negative-preconditions :universal-preconditions :conditional-effects)
  (:types
    movable place signal crossing - object
    engine wagon freight - movable)
  (:predicates
    (at ?m - movable ?p - place)
    (track ?a ?b - place)
    (protects ?s - signal ?p - place)
    (green ?s - signal)
    (coupled ?w - wagon ?e - engine)
    (inWagon ?f - freight ?w - wagon)
    (barrierDown ?c - crossing))

  (:action drive
    :parameters (?e - engine ?from ?to - place ?s - signal)
    :precondition (and (at ?e ?from) (track ?from ?to) (protects ?s ?to) (green ?s))
    :effect (and (at ?e ?to) (not (at ?e ?from))
      (forall (?w - wagon)
        (when (coupled ?w ?e) (and (at ?w ?to) (not (at ?w ?from)))))))

  (:action couple
    :parameters (?w - wagon ?e - engine ?p - place)
    :precondition (and (at ?w ?p) (at ?e ?p) (forall (?x - engine) (not (coupled ?w ?x))))
    :effect (coupled ?w ?e))

  (:action uncouple
    :parameters (?w - wagon ?e - engine)
    :precondition (coupled ?w ?e)
    :effect (not (coupled ?w ?e)))

  (:action load
    :parameters (?f - freight ?w - wagon ?p - place)
    :precondition (and (at ?f ?p) (at ?w ?p))
    :effect (and (inWagon ?f ?w) (not (at ?f ?p))))

  (:action unload
    :parameters (?f - freight ?w - wagon ?p - place)
    :precondition (and (inWagon ?f ?w) (at ?w ?p))
    :effect (and (at ?f ?p) (not (inWagon ?f ?w))))

  (:action setGreen
    :parameters (?s - signal)
    :precondition (not (green ?s))
    :effect (green ?s))

  (:action setRed
    :parameters (?s - signal)
    :precondition (green ?s)
    :effect (not (green ?s)))

  (:action lowerBarrier
    :parameters (?c - crossing)
    :precondition (not (barrierDown ?c))
    :effect (barrierDown ?c))

  (:action raiseBarrier
    :parameters (?c - crossing)
    :precondition (barrierDown ?c)
    :effect (not (barrierDown ?c))))
