; A fitness studio: an attendant (or a robot) keeps the rooms, the machines and the equipment in order.
(define (domain fitness-studio)
  (:requirements :strips :typing :negative-preconditions :universal-preconditions)

  (:types
    storage-place device item member window - object
    room rack - storage-place
    machine fan - device
    treadmill rowing-machine - machine
    dumbbell mat towel bottle - item)

  (:predicates
    (stored-in ?i - item ?p - storage-place)
    (located-in ?d - device ?r - room)
    (present-in ?m - member ?r - room)
    (window-of ?w - window ?r - room)
    (working-out-on ?m - member ?k - machine)
    (has-item ?m - member ?i - item)
    (switched-on ?d - device)
    (out-of-order ?d - device)
    (wiped-down ?k - machine)
    (window-open ?w - window)
    (dirty ?t - towel)
    (filled-up ?b - bottle)
    (has-washing-machine ?r - room)
    (has-water-tap ?r - room))

  (:action carry-item
    :parameters (?i - item ?from ?to - storage-place)
    :precondition (and (stored-in ?i ?from))
    :effect (and (not (stored-in ?i ?from)) (stored-in ?i ?to)))

  (:action hand-over
    :parameters (?i - item ?m - member ?r - room)
    :precondition (and (stored-in ?i ?r) (present-in ?m ?r))
    :effect (and (not (stored-in ?i ?r)) (has-item ?m ?i)))

  (:action take-back
    :parameters (?i - item ?m - member ?r - room)
    :precondition (and (has-item ?m ?i) (present-in ?m ?r))
    :effect (and (not (has-item ?m ?i)) (stored-in ?i ?r)))

  (:action switch-on
    :parameters (?d - device)
    :precondition (and (not (switched-on ?d)) (not (out-of-order ?d)))
    :effect (switched-on ?d))

  (:action switch-off
    :parameters (?d - device)
    :precondition (switched-on ?d)
    :effect (not (switched-on ?d)))

  (:action wipe-down
    :parameters (?k - machine)
    :precondition (and (not (switched-on ?k)) (forall (?m - member) (not (working-out-on ?m ?k))))
    :effect (wiped-down ?k))

  (:action open-window
    :parameters (?w - window)
    :precondition (not (window-open ?w))
    :effect (window-open ?w))

  (:action close-window
    :parameters (?w - window)
    :precondition (window-open ?w)
    :effect (not (window-open ?w)))

  (:action wash-towel
    :parameters (?t - towel ?r - room)
    :precondition (and (stored-in ?t ?r) (has-washing-machine ?r) (dirty ?t))
    :effect (not (dirty ?t)))

  (:action refill-bottle
    :parameters (?b - bottle ?r - room)
    :precondition (and (stored-in ?b ?r) (has-water-tap ?r) (not (filled-up ?b)))
    :effect (filled-up ?b)))
