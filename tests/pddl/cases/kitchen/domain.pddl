; A small kitchen: types with either, constants, conditional and universal effects, disjunction,
; negation, equality and action costs.
(define (domain tiny-kitchen)
  (:requirements :strips :typing :negative-preconditions :disjunctive-preconditions :equality
                 :existential-preconditions :conditional-effects :action-costs)
  (:types
    mug pot - vessel          ; children may stand before their parent
    vessel tool - item
    item place appliance - thing
    knob - thing
    liquid - object
    thing - object)
  (:constants water coffee - liquid)
  (:predicates
    (at ?i - item ?p - (either place appliance)) ; the item stands there
    (holding ?i - item)       ; the robot has the item in its hand
    (near ?t - (either place appliance)) ; the robot stands there
    (contains ?v - vessel ?l - liquid) ; the liquid is in the vessel
    (hot ?v - vessel)         ; the vessel and what is in it are hot
    (on ?k - knob)            ; the knob is turned on
    (open ?a - appliance)     ; the door of the appliance is open
    (clean ?i - item)
    (controls ?k - knob ?a - appliance) ; static: turning the knob feeds the appliance
    (sink ?p - place)         ; static
    (locked ?a - appliance))  ; nothing ever unlocks it
  (:functions (total-cost) - number (distance ?a ?b - thing) - number)

  (:action moveto
    :parameters (?from ?to - (either place appliance))
    :precondition (and (near ?from) (not (= ?from ?to)))
    :effect (and (not (near ?from)) (near ?to) (increase (total-cost) (distance ?from ?to))))

  (:action grasp
    :parameters (?i - item ?p - (either place appliance))
    :precondition (and (at ?i ?p) (near ?p) (not (exists (?j - item) (holding ?j))))
    :effect (and (holding ?i) (not (at ?i ?p)) (increase (total-cost) 2)))

  (:action put
    :parameters (?i - item ?p - (either place appliance))
    :precondition (and (holding ?i) (near ?p))
    :effect (and (not (holding ?i)) (at ?i ?p) (increase (total-cost) 2)))

  (:action turn
    :parameters (?k - knob ?a - appliance)
    :precondition (and (controls ?k ?a) (near ?a) (imply (on ?k) (not (open ?a))))
    :effect (and
      (when (not (on ?k))
        (and (on ?k) (forall (?v - vessel) (when (at ?v ?a) (hot ?v)))))
      (when (on ?k) (not (on ?k)))
      (increase (total-cost) 1)))

  (:action swing
    :parameters (?a - appliance)
    :precondition (and (near ?a) (not (locked ?a)))
    :effect (and (when (open ?a) (not (open ?a))) (when (not (open ?a)) (open ?a)) (increase (total-cost) 1)))

  (:action fill
    :parameters (?v - vessel ?p - place)
    :precondition (and (holding ?v) (near ?p) (sink ?p) (or (clean ?v) (contains ?v water)))
    :effect (and (contains ?v water) (not (hot ?v)) (not (clean ?v)) (increase (total-cost) 1)))

  (:action pour
    :parameters (?from ?to - vessel ?p - (either place appliance))
    :precondition (and (holding ?from) (near ?p) (at ?to ?p)
                       (exists (?l - liquid) (contains ?from ?l)))
    :effect (and
      (forall (?l - liquid)
        (when (contains ?from ?l) (and (not (contains ?from ?l)) (contains ?to ?l))))
      (when (hot ?from) (hot ?to))
      (not (clean ?to))
      (increase (total-cost) 3)))

  (:action rinse
    :parameters (?i - vessel ?p - place)
    :precondition (and (holding ?i) (near ?p) (sink ?p))
    :effect (and (clean ?i) (forall (?l - liquid) (not (contains ?i ?l))) (increase (total-cost) 1)))

  (:action wait :parameters () :effect (and))
)
