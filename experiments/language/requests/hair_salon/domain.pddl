(define (domain hair-salon)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    helper client seat tool place drink - object
    chair sofa - seat
    comb - tool)
  (:predicates
    (seated ?c - client ?s - seat)
    (taken ?s - chair)
    (has-basin ?s - chair)
    (washed ?c - client)
    (wet ?c - client)
    (trimmed ?c - client)
    (served ?c - client ?d - drink)
    (kept-in ?t - tool ?p - place)
    (dirty ?t - tool)
    (cuts-hair ?t - tool)
    (swept ?s - seat)
    (paid ?c - client))

  (:action seat-client
    :parameters (?h - helper ?c - client ?from - seat ?to - chair)
    :precondition (and (seated ?c ?from) (not (taken ?to)))
    :effect (and (seated ?c ?to) (taken ?to) (not (seated ?c ?from))))

  (:action send-to-sofa
    :parameters (?h - helper ?c - client ?from - chair ?to - sofa)
    :precondition (seated ?c ?from)
    :effect (and (seated ?c ?to) (not (taken ?from)) (not (seated ?c ?from))))

  (:action wash-hair
    :parameters (?h - helper ?c - client ?s - chair)
    :precondition (and (seated ?c ?s) (has-basin ?s))
    :effect (and (washed ?c) (wet ?c)))

  (:action trim-hair
    :parameters (?h - helper ?c - client ?s - chair ?t - tool)
    :precondition (and (seated ?c ?s) (cuts-hair ?t) (not (dirty ?t)))
    :effect (and (trimmed ?c) (dirty ?t)))

  (:action blow-dry
    :parameters (?h - helper ?c - client ?s - chair)
    :precondition (and (seated ?c ?s) (wet ?c))
    :effect (not (wet ?c)))

  (:action serve-drink
    :parameters (?h - helper ?c - client ?d - drink)
    :precondition (not (served ?c ?d))
    :effect (served ?c ?d))

  (:action clean-tool
    :parameters (?h - helper ?t - tool)
    :precondition (dirty ?t)
    :effect (not (dirty ?t)))

  (:action put-away
    :parameters (?h - helper ?t - tool ?from ?to - place)
    :precondition (kept-in ?t ?from)
    :effect (and (kept-in ?t ?to) (not (kept-in ?t ?from))))

  (:action sweep-around
    :parameters (?h - helper ?s - seat)
    :precondition (not (swept ?s))
    :effect (swept ?s))

  (:action take-payment
    :parameters (?h - helper ?c - client)
    :precondition (not (paid ?c))
    :effect (paid ?c)))
