(define (domain photoStudio)
  (:requirements :strips :typing :negative-preconditions)

  (:types
    spot person camera movable backdrop blind - object
    device tripod - movable
    light fan - device)

  (:predicates
    (personAt ?p - person ?s - spot)
    (standsAt ?m - movable ?s - spot)
    (switchedOn ?d - device)
    (rolledDown ?b - backdrop)
    (blindShut ?b - blind)
    (mounted ?k - camera ?t - tripod)
    (loose ?k - camera)
    (tripodFree ?t - tripod)
    (capOn ?k - camera)
    (lensDirty ?k - camera)
    (batteryFlat ?k - camera)
    (photographedWith ?p - person ?k - camera))

  (:action guide
    :parameters (?p - person ?from - spot ?to - spot)
    :precondition (personAt ?p ?from)
    :effect (and (personAt ?p ?to) (not (personAt ?p ?from))))

  (:action wheel
    :parameters (?m - movable ?from - spot ?to - spot)
    :precondition (standsAt ?m ?from)
    :effect (and (standsAt ?m ?to) (not (standsAt ?m ?from))))

  (:action switchOn
    :parameters (?d - device)
    :precondition (not (switchedOn ?d))
    :effect (switchedOn ?d))

  (:action switchOff
    :parameters (?d - device)
    :precondition (switchedOn ?d)
    :effect (not (switchedOn ?d)))

  (:action rollDown
    :parameters (?b - backdrop)
    :precondition (not (rolledDown ?b))
    :effect (rolledDown ?b))

  (:action rollUp
    :parameters (?b - backdrop)
    :precondition (rolledDown ?b)
    :effect (not (rolledDown ?b)))

  (:action shutBlind
    :parameters (?b - blind)
    :precondition (not (blindShut ?b))
    :effect (blindShut ?b))

  (:action openBlind
    :parameters (?b - blind)
    :precondition (blindShut ?b)
    :effect (not (blindShut ?b)))

  (:action takeCapOff
    :parameters (?k - camera)
    :precondition (capOn ?k)
    :effect (not (capOn ?k)))

  (:action putCapOn
    :parameters (?k - camera)
    :precondition (not (capOn ?k))
    :effect (capOn ?k))

  (:action cleanLens
    :parameters (?k - camera)
    :precondition (and (lensDirty ?k) (not (capOn ?k)))
    :effect (not (lensDirty ?k)))

  (:action mount
    :parameters (?k - camera ?t - tripod)
    :precondition (and (loose ?k) (tripodFree ?t))
    :effect (and (mounted ?k ?t) (not (loose ?k)) (not (tripodFree ?t))))

  (:action unmount
    :parameters (?k - camera ?t - tripod)
    :precondition (mounted ?k ?t)
    :effect (and (loose ?k) (tripodFree ?t) (not (mounted ?k ?t))))

  (:action takePortrait
    :parameters (?p - person ?k - camera ?t - tripod ?s - spot)
    :precondition (and (personAt ?p ?s) (standsAt ?t ?s) (mounted ?k ?t)
                       (not (capOn ?k)) (not (lensDirty ?k)) (not (batteryFlat ?k)))
    :effect (photographedWith ?p ?k))
)
