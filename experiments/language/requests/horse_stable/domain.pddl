; Daily work in a riding stable.
(define (domain horse_stable)
  (:requirements :adl)
  (:types
    horse rider saddle location - object
    stall paddock arena - location)

  (:predicates
    (horse_is_in_location ?h - horse ?l - location)
    (horse_has_been_fed ?h - horse)
    (horse_has_been_brushed ?h - horse)
    (horse_is_wearing_saddle ?h - horse ?s - saddle)
    (horse_is_wearing_blanket ?h - horse)
    (horse_is_injured ?h - horse)
    (saddle_is_in_tack_room ?s - saddle)
    (rider_is_assigned_to_horse ?r - rider ?h - horse)
    (rider_is_mounted_on_horse ?r - rider ?h - horse)
    (stall_is_mucked_out ?s - stall)
    (paddock_gate_is_closed ?p - paddock)
    (water_trough_is_full ?p - paddock))

  (:action lead_horse
    :parameters (?h - horse ?from - location ?to - location)
    :precondition (and (horse_is_in_location ?h ?from)
                       (not (= ?from ?to))
                       (forall (?r - rider) (not (rider_is_mounted_on_horse ?r ?h)))
                       (forall (?p - paddock)
                         (imply (or (= ?p ?from) (= ?p ?to)) (not (paddock_gate_is_closed ?p)))))
    :effect (and (horse_is_in_location ?h ?to)
                 (not (horse_is_in_location ?h ?from))))

  (:action feed_horse
    :parameters (?h - horse ?s - stall)
    :precondition (horse_is_in_location ?h ?s)
    :effect (horse_has_been_fed ?h))

  (:action brush_horse
    :parameters (?h - horse)
    :precondition (and (not (horse_is_wearing_blanket ?h))
                       (forall (?s - saddle) (not (horse_is_wearing_saddle ?h ?s))))
    :effect (horse_has_been_brushed ?h))

  (:action put_saddle_on_horse
    :parameters (?s - saddle ?h - horse)
    :precondition (and (saddle_is_in_tack_room ?s)
                       (horse_has_been_brushed ?h)
                       (not (horse_is_wearing_blanket ?h))
                       (not (horse_is_injured ?h))
                       (forall (?o - saddle) (not (horse_is_wearing_saddle ?h ?o))))
    :effect (and (horse_is_wearing_saddle ?h ?s)
                 (not (saddle_is_in_tack_room ?s))))

  (:action take_saddle_off_horse
    :parameters (?s - saddle ?h - horse)
    :precondition (and (horse_is_wearing_saddle ?h ?s)
                       (forall (?r - rider) (not (rider_is_mounted_on_horse ?r ?h))))
    :effect (and (saddle_is_in_tack_room ?s)
                 (not (horse_is_wearing_saddle ?h ?s))))

  (:action cover_horse_with_blanket
    :parameters (?h - horse)
    :precondition (and (not (horse_is_wearing_blanket ?h))
                       (forall (?s - saddle) (not (horse_is_wearing_saddle ?h ?s))))
    :effect (horse_is_wearing_blanket ?h))

  (:action remove_blanket_from_horse
    :parameters (?h - horse)
    :precondition (horse_is_wearing_blanket ?h)
    :effect (not (horse_is_wearing_blanket ?h)))

  (:action let_rider_mount
    :parameters (?r - rider ?h - horse ?s - saddle ?a - arena)
    :precondition (and (rider_is_assigned_to_horse ?r ?h)
                       (horse_is_in_location ?h ?a)
                       (horse_is_wearing_saddle ?h ?s)
                       (forall (?o - rider) (not (rider_is_mounted_on_horse ?o ?h))))
    :effect (rider_is_mounted_on_horse ?r ?h))

  (:action muck_out_stall
    :parameters (?s - stall)
    :precondition (forall (?h - horse) (not (horse_is_in_location ?h ?s)))
    :effect (stall_is_mucked_out ?s))

  (:action open_paddock_gate
    :parameters (?p - paddock)
    :precondition (paddock_gate_is_closed ?p)
    :effect (not (paddock_gate_is_closed ?p)))

  (:action close_paddock_gate
    :parameters (?p - paddock)
    :precondition (not (paddock_gate_is_closed ?p))
    :effect (paddock_gate_is_closed ?p))

  (:action fill_water_trough
    :parameters (?p - paddock)
    :precondition (not (water_trough_is_full ?p))
    :effect (water_trough_is_full ?p))
)
