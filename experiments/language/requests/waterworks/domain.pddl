(define (domain waterWorks)
  (:requirements :strips :typing :negative-preconditions :universal-preconditions :conditional-effects :equality)
  (:types tank valve pump sluiceGate filterUnit lvl - object)
  (:predicates
    (isOpen ?v - valve)
    (isRunning ?p - pump)
    (gateRaised ?g - sluiceGate)
    (fillLvl ?t - tank ?l - lvl)
    (chlDosed ?t - tank)
    (sampled ?t - tank)
    (fltClean ?f - filterUnit)
    (feeds ?p - pump ?t - tank)
    (outletOf ?v - valve ?t - tank)
    (fltOf ?f - filterUnit ?p - pump))
  (:constants empty half full - lvl)

  (:action openValve
    :parameters (?v - valve)
    :precondition (not (isOpen ?v))
    :effect (isOpen ?v))

  (:action closeValve
    :parameters (?v - valve)
    :precondition (isOpen ?v)
    :effect (not (isOpen ?v)))

  (:action startPump
    :parameters (?p - pump)
    :precondition (not (isRunning ?p))
    :effect (isRunning ?p))

  (:action stopPump
    :parameters (?p - pump)
    :precondition (isRunning ?p)
    :effect (not (isRunning ?p)))

  (:action raiseGate
    :parameters (?g - sluiceGate)
    :precondition (not (gateRaised ?g))
    :effect (gateRaised ?g))

  (:action lowerGate
    :parameters (?g - sluiceGate)
    :precondition (gateRaised ?g)
    :effect (not (gateRaised ?g)))

  (:action fillTank
    :parameters (?p - pump ?t - tank ?l - lvl)
    :precondition (and (feeds ?p ?t) (isRunning ?p) (fillLvl ?t ?l) (not (= ?l full))
                       (forall (?v - valve) (not (and (outletOf ?v ?t) (isOpen ?v)))))
    :effect (and (fillLvl ?t full) (not (fillLvl ?t ?l)) (not (chlDosed ?t)) (not (sampled ?t))))

  (:action drainTank
    :parameters (?v - valve ?t - tank ?l - lvl)
    :precondition (and (outletOf ?v ?t) (isOpen ?v) (fillLvl ?t ?l) (not (= ?l empty)))
    :effect (and (fillLvl ?t empty) (not (fillLvl ?t ?l)) (not (chlDosed ?t)) (not (sampled ?t))))

  (:action doseChlorine
    :parameters (?t - tank)
    :precondition (not (fillLvl ?t empty))
    :effect (chlDosed ?t))

  (:action takeSample
    :parameters (?t - tank)
    :precondition (not (fillLvl ?t empty))
    :effect (sampled ?t))

  (:action backwashFilter
    :parameters (?f - filterUnit ?p - pump)
    :precondition (and (fltOf ?f ?p) (not (isRunning ?p)))
    :effect (fltClean ?f))
)
