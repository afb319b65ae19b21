(define (domain print_shop)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    machine job paper - object)
  (:predicates
    (switched_on ?m - machine)
    (tray_empty ?m - machine)
    (loaded ?m - machine ?p - paper)
    (needs ?j - job ?p - paper)
    (approved ?j - job)
    (printed ?j - job)
    (trimmed ?j - job)
    (stapled ?j - job)
    (boxed ?j - job)
    (sent ?j - job))
  (:action switch_on
    :parameters (?m - machine)
    :precondition (not (switched_on ?m))
    :effect (switched_on ?m))
  (:action switch_off
    :parameters (?m - machine)
    :precondition (switched_on ?m)
    :effect (not (switched_on ?m)))
  (:action load
    :parameters (?m - machine ?p - paper)
    :precondition (tray_empty ?m)
    :effect (and (loaded ?m ?p) (not (tray_empty ?m))))
  (:action unload
    :parameters (?m - machine ?p - paper)
    :precondition (loaded ?m ?p)
    :effect (and (tray_empty ?m) (not (loaded ?m ?p))))
  (:action print
    :parameters (?j - job ?m - machine ?p - paper)
    :precondition (and (approved ?j) (needs ?j ?p) (loaded ?m ?p) (switched_on ?m) (not (printed ?j)))
    :effect (printed ?j))
  (:action trim
    :parameters (?j - job)
    :precondition (and (printed ?j) (not (trimmed ?j)) (not (boxed ?j)))
    :effect (trimmed ?j))
  (:action staple
    :parameters (?j - job)
    :precondition (and (printed ?j) (not (stapled ?j)) (not (boxed ?j)))
    :effect (stapled ?j))
  (:action box
    :parameters (?j - job)
    :precondition (and (printed ?j) (not (boxed ?j)))
    :effect (boxed ?j))
  (:action send
    :parameters (?j - job)
    :precondition (and (boxed ?j) (not (sent ?j)))
    :effect (sent ?j)))
