; A volunteer in a charity shop (untyped)
(define (domain charity-shop)
  (:requirements :strips)
  (:predicates
    (room ?r) (door-between ?a ?b)
    (clothing ?x) (book ?x) (toy ?x) (electrical ?x) (item ?x)
    (flat ?f) (rail ?f) (pricing-desk ?f) (stands-in ?f ?r)
    (sign ?s) (sign-at ?s ?r)
    (volunteer-in ?r) (holding ?x) (empty-handed)
    (on ?x ?f)
    (creased ?x) (steamed ?x)
    (unpriced ?x) (priced ?x)
    (untested ?x) (tested ?x)
    (dusty ?r) (swept ?r)
    (shows-open ?s) (shows-closed ?s))

  (:action walk
    :parameters (?a ?b)
    :precondition (and (room ?a) (room ?b) (door-between ?a ?b) (volunteer-in ?a))
    :effect (and (volunteer-in ?b) (not (volunteer-in ?a))))

  (:action take
    :parameters (?x ?f ?r)
    :precondition (and (item ?x) (on ?x ?f) (stands-in ?f ?r) (volunteer-in ?r) (empty-handed))
    :effect (and (holding ?x) (not (on ?x ?f)) (not (empty-handed))))

  (:action put
    :parameters (?x ?f ?r)
    :precondition (and (holding ?x) (flat ?f) (stands-in ?f ?r) (volunteer-in ?r))
    :effect (and (on ?x ?f) (empty-handed) (not (holding ?x))))

  (:action hang
    :parameters (?x ?f ?r)
    :precondition (and (holding ?x) (clothing ?x) (rail ?f) (stands-in ?f ?r) (volunteer-in ?r))
    :effect (and (on ?x ?f) (empty-handed) (not (holding ?x))))

  (:action steam
    :parameters (?x ?f ?r)
    :precondition (and (clothing ?x) (creased ?x) (on ?x ?f) (stands-in ?f ?r) (volunteer-in ?r))
    :effect (and (steamed ?x) (not (creased ?x))))

  (:action price
    :parameters (?x ?f ?r)
    :precondition (and (item ?x) (unpriced ?x) (on ?x ?f) (pricing-desk ?f) (stands-in ?f ?r) (volunteer-in ?r))
    :effect (and (priced ?x) (not (unpriced ?x))))

  (:action test
    :parameters (?x ?f ?r)
    :precondition (and (electrical ?x) (untested ?x) (on ?x ?f) (pricing-desk ?f) (stands-in ?f ?r) (volunteer-in ?r))
    :effect (and (tested ?x) (not (untested ?x))))

  (:action sweep
    :parameters (?r)
    :precondition (and (room ?r) (dusty ?r) (volunteer-in ?r))
    :effect (and (swept ?r) (not (dusty ?r))))

  (:action turn-sign-to-open
    :parameters (?s ?r)
    :precondition (and (sign ?s) (sign-at ?s ?r) (volunteer-in ?r) (shows-closed ?s))
    :effect (and (shows-open ?s) (not (shows-closed ?s))))

  (:action turn-sign-to-closed
    :parameters (?s ?r)
    :precondition (and (sign ?s) (sign-at ?s ?r) (volunteer-in ?r) (shows-open ?s))
    :effect (and (shows-closed ?s) (not (shows-open ?s)))))
