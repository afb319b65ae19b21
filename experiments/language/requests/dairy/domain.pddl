(define (domain small_dairy)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    location animal tool - object
    field pen building - location
    cow sheep - animal
    bucket shears feed - tool)
  (:predicates
    (dairyman_at ?l - location)
    (animal_at ?a - animal ?l - location)
    (tool_at ?t - tool ?l - location)
    (carrying ?t - tool)
    (hands_free)
    (has_gate ?l - location)
    (gate_closed ?l - location)
    (has_trough ?l - location)
    (trough_full ?l - location)
    (hungry ?a - animal)
    (milked ?c - cow)
    (has_milk ?b - bucket)
    (sheared ?s - sheep))
  (:action go_to
    :parameters (?from - location ?to - location)
    :precondition (dairyman_at ?from)
    :effect (and (dairyman_at ?to) (not (dairyman_at ?from))))
  (:action open_gate
    :parameters (?l - location)
    :precondition (and (dairyman_at ?l) (has_gate ?l) (gate_closed ?l))
    :effect (not (gate_closed ?l)))
  (:action close_gate
    :parameters (?l - location)
    :precondition (and (dairyman_at ?l) (has_gate ?l) (not (gate_closed ?l)))
    :effect (gate_closed ?l))
  ; the animal goes along with the dairyman, through open gates only
  (:action drive_animal
    :parameters (?a - animal ?from - location ?to - location)
    :precondition (and (dairyman_at ?from) (animal_at ?a ?from) (not (gate_closed ?from)) (not (gate_closed ?to)))
    :effect (and (animal_at ?a ?to) (dairyman_at ?to) (not (animal_at ?a ?from)) (not (dairyman_at ?from))))
  (:action pick_up
    :parameters (?t - tool ?l - location)
    :precondition (and (dairyman_at ?l) (tool_at ?t ?l) (hands_free))
    :effect (and (carrying ?t) (not (tool_at ?t ?l)) (not (hands_free))))
  (:action put_down
    :parameters (?t - tool ?l - location)
    :precondition (and (dairyman_at ?l) (carrying ?t))
    :effect (and (tool_at ?t ?l) (hands_free) (not (carrying ?t))))
  (:action feed_animal
    :parameters (?a - animal ?f - feed ?l - location)
    :precondition (and (dairyman_at ?l) (animal_at ?a ?l) (carrying ?f) (hungry ?a))
    :effect (not (hungry ?a)))
  (:action milk_cow
    :parameters (?c - cow ?b - bucket ?l - location)
    :precondition (and (dairyman_at ?l) (animal_at ?c ?l) (carrying ?b) (not (has_milk ?b)) (not (milked ?c)))
    :effect (and (milked ?c) (has_milk ?b)))
  (:action shear_sheep
    :parameters (?s - sheep ?k - shears ?l - location)
    :precondition (and (dairyman_at ?l) (animal_at ?s ?l) (carrying ?k) (not (sheared ?s)))
    :effect (sheared ?s))
  (:action fill_trough
    :parameters (?l - location)
    :precondition (and (dairyman_at ?l) (has_trough ?l) (not (trough_full ?l)))
    :effect (trough_full ?l)))
