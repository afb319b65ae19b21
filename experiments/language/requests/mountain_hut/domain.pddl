(define (domain mountain_hut)
  (:requirements :strips :negative-preconditions)

  (:predicates
    (room ?x)
    (stove ?x)
    (bunk ?x)
    (rucksack ?x)
    (inside ?x ?r)
    (lit ?s)
    (stocked ?s)
    (chimney_blocked ?s)
    (made_up ?b)
    (shuttered ?r)
    (swept ?r))

  (:action stock_stove
    :parameters (?s)
    :precondition (and (stove ?s) (not (stocked ?s)))
    :effect (stocked ?s))

  (:action light_stove
    :parameters (?s)
    :precondition (and (stove ?s) (stocked ?s) (not (lit ?s)) (not (chimney_blocked ?s)))
    :effect (lit ?s))

  (:action put_out_stove
    :parameters (?s)
    :precondition (and (stove ?s) (lit ?s))
    :effect (not (lit ?s)))

  (:action make_up_bunk
    :parameters (?b)
    :precondition (and (bunk ?b) (not (made_up ?b)))
    :effect (made_up ?b))

  (:action strip_bunk
    :parameters (?b)
    :precondition (and (bunk ?b) (made_up ?b))
    :effect (not (made_up ?b)))

  (:action close_shutters
    :parameters (?r)
    :precondition (and (room ?r) (not (shuttered ?r)))
    :effect (shuttered ?r))

  (:action open_shutters
    :parameters (?r)
    :precondition (and (room ?r) (shuttered ?r))
    :effect (not (shuttered ?r)))

  (:action sweep_room
    :parameters (?r)
    :precondition (and (room ?r) (not (shuttered ?r)) (not (swept ?r)))
    :effect (swept ?r))

  (:action carry_rucksack
    :parameters (?k ?from ?to)
    :precondition (and (rucksack ?k) (room ?from) (room ?to) (inside ?k ?from))
    :effect (and (inside ?k ?to) (not (inside ?k ?from)))))
