; Types, quantifiers and constants with fixed costs, in the form that every reader takes.
(define (domain parcels)
  (:requirements :strips :typing :negative-preconditions :equality :universal-preconditions :disjunctive-preconditions
                 :conditional-effects :action-costs)
  (:types parcel van - thing depot - object thing - object)
  (:constants hub - depot)
  (:predicates
    (at ?t - thing ?d - depot)     ; the thing is at the depot
    (in ?p - parcel ?v - van)      ; the parcel is in the van
    (sealed ?v - van)              ; the doors are shut
    (fragile ?p - parcel)          ; static
    (road ?a ?b - depot))          ; static
  (:functions (total-cost))
  (:action load
    :parameters (?p - parcel ?v - van ?d - depot)
    :precondition (and (at ?p ?d) (at ?v ?d) (not (sealed ?v))
                       (forall (?q - parcel) (or (not (in ?q ?v)) (not (fragile ?q)))))
    :effect (and (in ?p ?v) (not (at ?p ?d)) (increase (total-cost) 2)))
  (:action seal
    :parameters (?v - van)
    :precondition (not (sealed ?v))
    :effect (sealed ?v))
  (:action drive
    :parameters (?v - van ?a ?b - depot)
    :precondition (and (at ?v ?a) (road ?a ?b) (sealed ?v) (not (= ?b hub)))
    :effect (and (not (at ?v ?a)) (at ?v ?b) (increase (total-cost) 5)))
  (:action unload
    :parameters (?v - van ?d - depot)
    :precondition (and (at ?v ?d))
    :effect (and (not (sealed ?v))
                 (forall (?p - parcel)
                   (when (in ?p ?v) (and (not (in ?p ?v)) (at ?p ?d))))
                 (increase (total-cost) 1)))
)
