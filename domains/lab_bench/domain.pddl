; Compiled from instructions.pddl and objects.yaml; change those and run `tmd compile`.
;
; A laboratory bench: solutions are dosed into glassware, warmed on a hotplate, spun in a centrifuge, and what is left
; goes into the waste. The robot has one hand and, for doors and knobs, the other.

(define (domain lab_bench)
  (:requirements :strips :typing :negative-preconditions :disjunctive-preconditions
                 :equality :quantified-preconditions :conditional-effects)

  (:types
    thing robot relation setting substance - object
    fixture item - thing              ; fixtures stay where they are, items can be carried
    station part - fixture            ; parts are vertices of an object graph
    vessel tool - item
    glassware tube bottle - vessel    ; glassware can be heated, tubes can be spun
    ; types of objects.yaml
    knob - part
    button - part
    lid - part
    door - part
    plate - part
    rotor - part
    bench - station
    rack - station
    hotplate - station
    centrifuge - station
    cold_cabinet - station
    beaker - glassware
    flask - glassware
    sample_tube - tube
    reagent_bottle - bottle
    waste_bottle - bottle
    pipette - tool
    marker - tool
  )

  (:constants
    pr2 - robot
    on in - relation
    off low high - setting
    ; constants of objects.yaml
    buffer - substance
    ethanol - substance
    water - substance
    sample - substance
  )

  (:predicates
    ; --- the robot
    (near ?r - robot ?x - fixture)                ; x is within reach
    (holding ?r - robot ?x - item)                ; x is in the hand
    (free ?r - robot)                             ; the hand is empty
    ; --- the bench as it changes
    (at ?x - thing ?y - fixture ?rel - relation)  ; x is on or in y
    (opened ?x - part)                            ; the lid or door x is open
    (set_to ?x - part ?s - setting)               ; the knob x stands at s
    (active ?x - part)                            ; the plate is warm, the rotor turns
    (loaded ?x - tool ?s - substance)             ; there is s in the pipette x
    (contains ?x - vessel ?s - substance)         ; there is some s in x
    (hot ?x - vessel)                             ; what is in x is hot
    (separated ?x - vessel)                       ; x was spun
    (labelled ?x - vessel)                        ; x has a label
    ; --- edges of the object graphs; they never change
    (part_of ?x - thing ?y - thing)               ; x is a part of y
    (controls ?x - part ?y - part)                ; working x starts and stops y
    (heats ?x - part ?y - station)                ; x heats what stands on y
    (spins ?x - part ?y - station)                ; x spins what is in y
    (shuts ?x - part ?y - station)                ; nothing goes into or out of y while x is closed
    (guards ?x - part ?y - part)                  ; y does not start while x is open
    ; --- what things are good for; these never change either
    (allows ?x - fixture ?rel - relation)         ; things can be put on or in x
    (openable ?x - part)                          ; x opens by hand
    (pressable ?x - part)                         ; x is a button
    (offers ?x - part ?s - setting)               ; the knob x has this setting
    (idle ?s - setting)                           ; at this setting nothing works
    (draws ?x - tool)                             ; liquids can be drawn into x
    (writes ?x - tool)                            ; one can write with x
    (drains ?x - vessel)                          ; what is poured into x is gone for good
  )

  ; Go and stand before x, or before what x is a part of, or is on or in; all the parts there come into reach.
  (:action moveto
    :parameters (?x - thing)
    :precondition (and)
    :effect (and
      (forall (?y - fixture) (not (near pr2 ?y)))
      (forall (?y - station) (when (= ?x ?y) (near pr2 ?y)))
      (forall (?y - station) (when (part_of ?x ?y) (near pr2 ?y)))
      (forall (?y - part) (when (part_of ?y ?x) (near pr2 ?y)))
      (forall (?y - part ?z - station) (when (and (part_of ?x ?z) (part_of ?y ?z)) (near pr2 ?y)))
      (forall (?y - station ?rel - relation) (when (at ?x ?y ?rel) (near pr2 ?y)))
      (forall (?y - part ?z - station ?rel - relation)
        (when (and (at ?x ?z ?rel) (part_of ?y ?z)) (near pr2 ?y)))))

  ; Open x, a lid or a door; not while what it guards runs.
  (:action open
    :parameters (?x - part)
    :precondition (and (near pr2 ?x) (openable ?x) (not (opened ?x))
      (forall (?p - part) (or (not (guards ?x ?p)) (not (active ?p)))))
    :effect (opened ?x))

  ; Close x, a lid or a door.
  (:action close
    :parameters (?x - part)
    :precondition (and (near pr2 ?x) (openable ?x) (opened ?x))
    :effect (not (opened ?x)))

  ; Take x from where it is. What lies behind a closed lid or door cannot be taken.
  (:action grasp
    :parameters (?x - item)
    :precondition (and (free pr2)
      (exists (?y - station ?rel - relation)
        (and (near pr2 ?y) (at ?x ?y ?rel) (forall (?d - part) (or (not (shuts ?d ?y)) (opened ?d))))))
    :effect (and (holding pr2 ?x) (not (free pr2))
      (forall (?y - station ?rel - relation) (not (at ?x ?y ?rel)))))

  ; Put x on or in y.
  (:action keep
    :parameters (?x - item ?y - station ?rel - relation)
    :precondition (and (holding pr2 ?x) (near pr2 ?y) (allows ?y ?rel)
      (forall (?d - part) (or (not (shuts ?d ?y)) (opened ?d))))
    :effect (and (at ?x ?y ?rel) (free pr2) (not (holding pr2 ?x))))

  ; Turn the knob x to s; what it controls starts or stops.
  (:action turn
    :parameters (?x - part ?s - setting)
    :precondition (and (near pr2 ?x) (offers ?x ?s) (not (set_to ?x ?s)))
    :effect (and
      (forall (?t - setting) (not (set_to ?x ?t)))
      (set_to ?x ?s)
      (forall (?p - part) (when (and (controls ?x ?p) (not (idle ?s))) (active ?p)))
      (forall (?p - part) (when (and (controls ?x ?p) (idle ?s)) (not (active ?p))))))

  ; Press the button x; what it controls starts, if it runs not yet and no lid stands open, or stops.
  (:action press
    :parameters (?x - part)
    :precondition (and (near pr2 ?x) (pressable ?x)
      (forall (?p - part ?d - part) (or (not (controls ?x ?p)) (not (guards ?d ?p)) (not (opened ?d)))))
    :effect (and
      (forall (?p - part) (when (and (controls ?x ?p) (not (active ?p))) (active ?p)))
      (forall (?p - part) (when (and (controls ?x ?p) (active ?p)) (not (active ?p))))))

  ; Let things take their time: what stands on a warm plate gets hot, what is in a turning rotor is separated.
  (:action wait
    :parameters ()
    :precondition (and)
    :effect (and
      (forall (?v - glassware ?p - part ?y - station)
        (when (and (at ?v ?y on) (heats ?p ?y) (active ?p)) (hot ?v)))
      (forall (?v - tube ?p - part ?y - station)
        (when (and (at ?v ?y in) (spins ?p ?y) (active ?p)) (separated ?v)))))

  ; Draw some s from v into the pipette x, which is in the hand. The vessel keeps the rest.
  (:action draw
    :parameters (?x - tool ?s - substance ?v - vessel)
    :precondition (and (holding pr2 ?x) (draws ?x) (contains ?v ?s)
      (exists (?y - station ?rel - relation)
        (and (near pr2 ?y) (at ?v ?y ?rel) (forall (?d - part) (or (not (shuts ?d ?y)) (opened ?d)))))
      (forall (?t - substance) (not (loaded ?x ?t))))
    :effect (loaded ?x ?s))

  ; Let the s that is in the pipette x out into v.
  (:action dispense
    :parameters (?x - tool ?s - substance ?v - vessel)
    :precondition (and (holding pr2 ?x) (loaded ?x ?s)
      (exists (?y - station ?rel - relation)
        (and (near pr2 ?y) (at ?v ?y ?rel) (forall (?d - part) (or (not (shuts ?d ?y)) (opened ?d))))))
    :effect (and (contains ?v ?s) (not (loaded ?x ?s))))

  ; Pour all that is in x into v.
  (:action pour
    :parameters (?x - vessel ?v - vessel)
    :precondition (and (holding pr2 ?x)
      (exists (?y - station ?rel - relation)
        (and (near pr2 ?y) (at ?v ?y ?rel) (forall (?d - part) (or (not (shuts ?d ?y)) (opened ?d))))))
    :effect (and
      (forall (?s - substance)
        (when (and (contains ?x ?s) (not (drains ?v))) (contains ?v ?s)))
      (forall (?s - substance) (not (contains ?x ?s)))
      (when (hot ?x) (and (hot ?v) (not (hot ?x))))))

  ; Write a label on v with the pen x, which is in the hand.
  (:action label
    :parameters (?x - tool ?v - vessel)
    :precondition (and (holding pr2 ?x) (writes ?x)
      (exists (?y - station ?rel - relation)
        (and (near pr2 ?y) (at ?v ?y ?rel) (forall (?d - part) (or (not (shuts ?d ?y)) (opened ?d))))))
    :effect (labelled ?v))
)
