;; Craft brewery, two people and one van
(define (domain brewery)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    location locatable beer - object
    worker van tank movable - locatable
    keg sack - movable)
  (:predicates
    (at ?x - locatable ?l - location)
    (free ?w - worker)
    (carrying ?w - worker ?x - movable)
    (contains ?v - locatable ?b - beer)     ; ?v is a tank or a keg
    (empty ?v - locatable)
    (clean ?v - locatable)
    (cooling_on ?t - tank)
    (labelled ?k - keg)
    (loaded ?k - keg ?v - van)
    (malt_for ?s - sack ?b - beer))

  (:action walk
    :parameters (?w - worker ?a ?b - location)
    :precondition (at ?w ?a)
    :effect (and (at ?w ?b) (not (at ?w ?a))))
  (:action drive
    :parameters (?w - worker ?v - van ?a ?b - location)
    :precondition (and (at ?w ?a) (at ?v ?a) (free ?w))
    :effect (and (at ?w ?b) (at ?v ?b) (not (at ?w ?a)) (not (at ?v ?a))))
  (:action lift
    :parameters (?w - worker ?x - movable ?l - location)
    :precondition (and (at ?w ?l) (at ?x ?l) (free ?w))
    :effect (and (carrying ?w ?x) (not (at ?x ?l)) (not (free ?w))))
  (:action set_down
    :parameters (?w - worker ?x - movable ?l - location)
    :precondition (and (at ?w ?l) (carrying ?w ?x))
    :effect (and (at ?x ?l) (free ?w) (not (carrying ?w ?x))))
  (:action load
    :parameters (?w - worker ?k - keg ?v - van ?l - location)
    :precondition (and (at ?w ?l) (at ?v ?l) (carrying ?w ?k))
    :effect (and (loaded ?k ?v) (free ?w) (not (carrying ?w ?k))))
  (:action unload
    :parameters (?w - worker ?k - keg ?v - van ?l - location)
    :precondition (and (at ?w ?l) (at ?v ?l) (loaded ?k ?v) (free ?w))
    :effect (and (carrying ?w ?k) (not (free ?w)) (not (loaded ?k ?v))))
  (:action wash
    :parameters (?w - worker ?v - locatable ?l - location)
    :precondition (and (at ?w ?l) (at ?v ?l) (empty ?v) (not (clean ?v)))
    :effect (clean ?v))
  (:action drain
    :parameters (?w - worker ?v - locatable ?b - beer ?l - location)
    :precondition (and (at ?w ?l) (at ?v ?l) (contains ?v ?b))
    :effect (and (empty ?v) (not (contains ?v ?b)) (not (clean ?v))))
  (:action fill
    :parameters (?w - worker ?k - keg ?t - tank ?b - beer ?l - location)
    :precondition (and (at ?w ?l) (at ?k ?l) (at ?t ?l) (contains ?t ?b) (empty ?k) (clean ?k))
    :effect (and (contains ?k ?b) (not (empty ?k))))
  (:action brew
    :parameters (?w - worker ?t - tank ?s - sack ?b - beer ?l - location)
    :precondition (and (at ?w ?l) (at ?t ?l) (carrying ?w ?s) (malt_for ?s ?b) (empty ?t) (clean ?t))
    :effect (and (contains ?t ?b) (not (empty ?t))))
  (:action stick_label
    :parameters (?w - worker ?k - keg ?l - location)
    :precondition (and (at ?w ?l) (at ?k ?l) (not (empty ?k)))
    :effect (labelled ?k))
  (:action start_cooling
    :parameters (?w - worker ?t - tank ?l - location)
    :precondition (and (at ?w ?l) (at ?t ?l) (not (cooling_on ?t)))
    :effect (cooling_on ?t))
  (:action stop_cooling
    :parameters (?w - worker ?t - tank ?l - location)
    :precondition (and (at ?w ?l) (at ?t ?l) (cooling_on ?t))
    :effect (not (cooling_on ?t))))
