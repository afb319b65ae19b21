(define (domain classroom)
  (:requirements :adl)
  (:types place item device openable board bin - object
          desk shelf - place
          cupboard - place
          book plant - item)
  (:constants watering-can sponge - item)
  (:predicates (at ?x - item ?y - place)
               (carrying ?x - item)
               (is-open ?x - object)
               (is-on ?d - device)
               (is-clean ?b - board)
               (watered ?p - plant)
               (full ?x - object)
               (has-door ?y - place))

  (:action pick-up
    :parameters (?x - item ?y - place)
    :precondition (and (at ?x ?y)
                       (forall (?z - item) (not (carrying ?z)))
                       (imply (has-door ?y) (is-open ?y)))
    :effect (and (carrying ?x) (not (at ?x ?y))))

  (:action put-down
    :parameters (?x - item ?y - place)
    :precondition (and (carrying ?x)
                       (imply (has-door ?y) (is-open ?y)))
    :effect (and (at ?x ?y) (not (carrying ?x))))

  (:action open
    :parameters (?x - (either openable cupboard))
    :precondition (not (is-open ?x))
    :effect (is-open ?x))

  (:action close
    :parameters (?x - (either openable cupboard))
    :precondition (is-open ?x)
    :effect (not (is-open ?x)))

  (:action switch-on
    :parameters (?d - device)
    :precondition (not (is-on ?d))
    :effect (is-on ?d))

  (:action switch-off
    :parameters (?d - device)
    :precondition (is-on ?d)
    :effect (not (is-on ?d)))

  (:action wipe
    :parameters (?b - board)
    :precondition (and (carrying sponge) (not (is-clean ?b)))
    :effect (is-clean ?b))

  (:action fill-can
    :parameters ()
    :precondition (and (carrying watering-can) (not (full watering-can)))
    :effect (full watering-can))

  (:action water
    :parameters (?p - plant)
    :precondition (and (carrying watering-can) (full watering-can))
    :effect (and (watered ?p) (not (full watering-can))))

  (:action empty
    :parameters (?b - bin)
    :precondition (and (full ?b) (forall (?z - item) (not (carrying ?z))))
    :effect (not (full ?b))))
