(define (domain Campsite)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    Place Thing - object
    Pitch Store FirePit - Place
    Tent Gear - Thing
    Lantern - Gear)
  (:predicates
    (PitchedOn ?t - Tent ?p - Pitch)
    (Packed ?t - Tent)
    (Taken ?p - Pitch)
    (ZippedUp ?t - Tent)
    (KeptAt ?g - Gear ?p - Place)
    (KeptInside ?g - Gear ?t - Tent)
    (Burning ?f - FirePit))
  (:action PitchTent
    :parameters (?t - Tent ?p - Pitch)
    :precondition (and (Packed ?t) (not (Taken ?p)))
    :effect (and (PitchedOn ?t ?p) (Taken ?p) (not (Packed ?t))))
  (:action TakeDownTent
    :parameters (?t - Tent ?p - Pitch)
    :precondition (and (PitchedOn ?t ?p) (not (ZippedUp ?t)))
    :effect (and (Packed ?t) (not (PitchedOn ?t ?p)) (not (Taken ?p))))
  (:action ZipUp
    :parameters (?t - Tent)
    :precondition (and (not (ZippedUp ?t)) (not (Packed ?t)))
    :effect (ZippedUp ?t))
  (:action Unzip
    :parameters (?t - Tent)
    :precondition (ZippedUp ?t)
    :effect (not (ZippedUp ?t)))
  (:action Carry
    :parameters (?g - Gear ?from - Place ?to - Place)
    :precondition (KeptAt ?g ?from)
    :effect (and (KeptAt ?g ?to) (not (KeptAt ?g ?from))))
  (:action StowInside
    :parameters (?g - Gear ?from - Place ?t - Tent)
    :precondition (and (KeptAt ?g ?from) (not (Packed ?t)) (not (ZippedUp ?t)))
    :effect (and (KeptInside ?g ?t) (not (KeptAt ?g ?from))))
  (:action FetchOut
    :parameters (?g - Gear ?t - Tent ?to - Place)
    :precondition (and (KeptInside ?g ?t) (not (ZippedUp ?t)))
    :effect (and (KeptAt ?g ?to) (not (KeptInside ?g ?t))))
  (:action LightFire
    :parameters (?f - FirePit)
    :precondition (not (Burning ?f))
    :effect (Burning ?f))
  (:action DouseFire
    :parameters (?f - FirePit)
    :precondition (Burning ?f)
    :effect (not (Burning ?f))))
