(define (domain Aquarium)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    Animal Tank Food - object
    Fish Ray - Animal)
  (:predicates
    (LivesIn ?a - Animal ?t - Tank)
    (Eats ?a - Animal ?f - Food)
    (FedWith ?a - Animal ?f - Food)
    (IsSick ?a - Animal)
    (Treated ?a - Animal)
    (GlassClean ?t - Tank)
    (PumpRunning ?t - Tank)
    (LightOn ?t - Tank)
    (LidClosed ?t - Tank))

  (:action MoveAnimal
    :parameters (?a - Animal ?from ?to - Tank)
    :precondition (and (LivesIn ?a ?from) (not (LidClosed ?from)) (not (LidClosed ?to)))
    :effect (and (LivesIn ?a ?to) (not (LivesIn ?a ?from))))

  (:action FeedAnimal
    :parameters (?a - Animal ?f - Food ?t - Tank)
    :precondition (and (LivesIn ?a ?t) (Eats ?a ?f) (not (LidClosed ?t)))
    :effect (FedWith ?a ?f))

  (:action GiveMedicine
    :parameters (?a - Animal ?t - Tank)
    :precondition (and (LivesIn ?a ?t) (IsSick ?a) (not (LidClosed ?t)))
    :effect (Treated ?a))

  (:action WipeGlass
    :parameters (?t - Tank)
    :precondition (not (GlassClean ?t))
    :effect (GlassClean ?t))

  (:action StartPump
    :parameters (?t - Tank)
    :precondition (not (PumpRunning ?t))
    :effect (PumpRunning ?t))

  (:action StopPump
    :parameters (?t - Tank)
    :precondition (PumpRunning ?t)
    :effect (not (PumpRunning ?t)))

  (:action SwitchLightOn
    :parameters (?t - Tank)
    :precondition (not (LightOn ?t))
    :effect (LightOn ?t))

  (:action SwitchLightOff
    :parameters (?t - Tank)
    :precondition (LightOn ?t)
    :effect (not (LightOn ?t)))

  (:action OpenLid
    :parameters (?t - Tank)
    :precondition (LidClosed ?t)
    :effect (not (LidClosed ?t)))

  (:action CloseLid
    :parameters (?t - Tank)
    :precondition (not (LidClosed ?t))
    :effect (LidClosed ?t)))
