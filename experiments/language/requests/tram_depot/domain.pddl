(define (domain tramDepot)
  (:requirements :strips :typing :negative-preconditions)

  (:types
    tram track driver lostItem box - object
    yardTrack washTrack - track)

  (:predicates
    (onTrack ?t - tram ?k - track)
    (trackFree ?k - track)
    (poweredUp ?t - tram)
    (doorsOpen ?t - tram)
    (clean ?t - tram)
    (windscreenBroken ?t - tram)
    (inCab ?d - driver ?t - tram)
    (inBreakRoom ?d - driver)
    (leftIn ?i - lostItem ?t - tram)
    (storedIn ?i - lostItem ?b - box))

  (:action driveTram
    :parameters (?d - driver ?t - tram ?from - track ?to - track)
    :precondition (and (inCab ?d ?t) (onTrack ?t ?from) (trackFree ?to) (poweredUp ?t)
                       (not (doorsOpen ?t)) (not (windscreenBroken ?t)))
    :effect (and (onTrack ?t ?to) (trackFree ?from) (not (onTrack ?t ?from)) (not (trackFree ?to))))

  (:action boardTram
    :parameters (?d - driver ?t - tram)
    :precondition (and (inBreakRoom ?d) (doorsOpen ?t))
    :effect (and (inCab ?d ?t) (not (inBreakRoom ?d))))

  (:action leaveTram
    :parameters (?d - driver ?t - tram)
    :precondition (and (inCab ?d ?t) (doorsOpen ?t))
    :effect (and (inBreakRoom ?d) (not (inCab ?d ?t))))

  (:action openDoors
    :parameters (?t - tram)
    :precondition (not (doorsOpen ?t))
    :effect (doorsOpen ?t))

  (:action closeDoors
    :parameters (?t - tram)
    :precondition (doorsOpen ?t)
    :effect (not (doorsOpen ?t)))

  (:action powerUp
    :parameters (?t - tram)
    :precondition (not (poweredUp ?t))
    :effect (poweredUp ?t))

  (:action powerDown
    :parameters (?t - tram)
    :precondition (poweredUp ?t)
    :effect (not (poweredUp ?t)))

  (:action washTram
    :parameters (?t - tram ?w - washTrack)
    :precondition (and (onTrack ?t ?w) (not (doorsOpen ?t)) (not (clean ?t)))
    :effect (clean ?t))

  (:action handInItem
    :parameters (?i - lostItem ?t - tram ?b - box)
    :precondition (and (leftIn ?i ?t) (doorsOpen ?t))
    :effect (and (storedIn ?i ?b) (not (leftIn ?i ?t)))))
