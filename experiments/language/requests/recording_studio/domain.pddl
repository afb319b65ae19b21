(define (domain recording-studio)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    room gear song - object
    instrument microphone headphones - gear)
  (:predicates
    (engineer-in ?r - room)
    (gear-in ?g - gear ?r - room)
    (carrying ?g - gear)
    (hands-free)
    (tuned ?i - instrument)
    (plugged-in ?m - microphone)
    (door-closed ?r - room)
    (recorded ?s - song))
  (:action walk
    :parameters (?from - room ?to - room)
    :precondition (engineer-in ?from)
    :effect (and (engineer-in ?to) (not (engineer-in ?from))))
  (:action pick-up
    :parameters (?g - gear ?r - room)
    :precondition (and (engineer-in ?r) (gear-in ?g ?r) (hands-free))
    :effect (and (carrying ?g) (not (gear-in ?g ?r)) (not (hands-free))))
  (:action set-down
    :parameters (?g - gear ?r - room)
    :precondition (and (engineer-in ?r) (carrying ?g))
    :effect (and (gear-in ?g ?r) (hands-free) (not (carrying ?g))))
  (:action tune
    :parameters (?i - instrument ?r - room)
    :precondition (and (engineer-in ?r) (gear-in ?i ?r) (not (tuned ?i)))
    :effect (tuned ?i))
  (:action plug-in
    :parameters (?m - microphone ?r - room)
    :precondition (and (engineer-in ?r) (gear-in ?m ?r) (not (plugged-in ?m)))
    :effect (plugged-in ?m))
  (:action unplug
    :parameters (?m - microphone ?r - room)
    :precondition (and (engineer-in ?r) (gear-in ?m ?r) (plugged-in ?m))
    :effect (not (plugged-in ?m)))
  (:action close-door
    :parameters (?r - room)
    :precondition (and (engineer-in ?r) (not (door-closed ?r)))
    :effect (door-closed ?r))
  (:action open-door
    :parameters (?r - room)
    :precondition (and (engineer-in ?r) (door-closed ?r))
    :effect (not (door-closed ?r)))
  (:action record
    :parameters (?s - song ?m - microphone ?r - room)
    :precondition (and (engineer-in ?r) (gear-in ?m ?r) (plugged-in ?m) (door-closed ?r) (not (recorded ?s)))
    :effect (recorded ?s)))
