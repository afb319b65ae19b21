(define (domain kindergarten)
  (:requirements :strips :negative-preconditions)
  (:predicates
    (teacher ?x) (child ?x) (room ?x) (toy ?x) (box ?x)
    (dining_area ?r) (has_beds ?r)
    (in_room ?x ?r)
    (inside ?t ?b)
    (box_open ?b)
    (hungry ?c)
    (asleep ?c))

  (:action walk
    :parameters (?t ?a ?b)
    :precondition (and (teacher ?t) (room ?a) (room ?b) (in_room ?t ?a))
    :effect (and (in_room ?t ?b) (not (in_room ?t ?a))))

  (:action lead_child
    :parameters (?t ?c ?a ?b)
    :precondition (and (teacher ?t) (child ?c) (room ?a) (room ?b)
                       (in_room ?t ?a) (in_room ?c ?a) (not (asleep ?c)))
    :effect (and (in_room ?t ?b) (in_room ?c ?b)
                 (not (in_room ?t ?a)) (not (in_room ?c ?a))))

  (:action carry_toy
    :parameters (?t ?x ?a ?b)
    :precondition (and (teacher ?t) (toy ?x) (room ?a) (room ?b)
                       (in_room ?t ?a) (in_room ?x ?a))
    :effect (and (in_room ?t ?b) (in_room ?x ?b)
                 (not (in_room ?t ?a)) (not (in_room ?x ?a))))

  (:action open_box
    :parameters (?t ?b ?r)
    :precondition (and (teacher ?t) (box ?b) (room ?r)
                       (in_room ?t ?r) (in_room ?b ?r) (not (box_open ?b)))
    :effect (box_open ?b))

  (:action close_box
    :parameters (?t ?b ?r)
    :precondition (and (teacher ?t) (box ?b) (room ?r)
                       (in_room ?t ?r) (in_room ?b ?r) (box_open ?b))
    :effect (not (box_open ?b)))

  (:action put_away
    :parameters (?t ?x ?b ?r)
    :precondition (and (teacher ?t) (toy ?x) (box ?b) (room ?r)
                       (in_room ?t ?r) (in_room ?x ?r) (in_room ?b ?r) (box_open ?b))
    :effect (and (inside ?x ?b) (not (in_room ?x ?r))))

  (:action take_out
    :parameters (?t ?x ?b ?r)
    :precondition (and (teacher ?t) (toy ?x) (box ?b) (room ?r)
                       (in_room ?t ?r) (in_room ?b ?r) (inside ?x ?b) (box_open ?b))
    :effect (and (in_room ?x ?r) (not (inside ?x ?b))))

  (:action serve_lunch
    :parameters (?t ?c ?r)
    :precondition (and (teacher ?t) (child ?c) (room ?r) (dining_area ?r)
                       (in_room ?t ?r) (in_room ?c ?r) (hungry ?c) (not (asleep ?c)))
    :effect (not (hungry ?c)))

  ; no nap on an empty stomach
  (:action put_to_bed
    :parameters (?t ?c ?r)
    :precondition (and (teacher ?t) (child ?c) (room ?r) (has_beds ?r)
                       (in_room ?t ?r) (in_room ?c ?r) (not (hungry ?c)) (not (asleep ?c)))
    :effect (asleep ?c))
)
