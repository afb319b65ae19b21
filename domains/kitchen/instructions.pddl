; The kitchen: what each instruction of a household robot needs and does.
;
; The thirteen instructions of Table I of "Tell Me Dave" (RSS 2014) and three more that people use
; (pour, add, insert). One robot, pr2, with two hands. instructions.pddl is written by hand; domain.pddl is
; compiled from it and from objects.yaml (classes become types, substances become constants).
;
; Physics in one paragraph. A thing must be found before the robot can go to it, and what is behind a closed door
; cannot be found, approached, opened or taken. Standing somewhere ends standing elsewhere; what is held stays in reach. An effector
; (burner, tap, microwave, dispenser, coffee maker) is worked through the part that controls it: that is an edge
; of the object graph, as is the door that interrupts a microwave or the button that unlatches a door. Heat needs
; time: what stands on a lit burner is heating, and becomes hot when the robot waits. Raw food in hot water is
; cooked by waiting.

(define (domain kitchen)
  (:requirements :strips :typing :negative-preconditions :disjunctive-preconditions :equality
                 :conditional-effects)

  (:types
    thing robot relation setting substance - object
    fixture item - thing                 ; fixtures stay where they are, items can be carried
    furniture appliance part - fixture   ; parts are vertices of an object graph
    outlet - part                        ; a part that gives a liquid
    vessel utensil supply tool - item    ; supply: food as it is bought; tool: anything else
    liquid solid - substance
  )

  (:constants
    pr2 - robot
    floor - furniture
    water - liquid
    on in next_to - relation
    off low high - setting
  )

  (:predicates
    ; --- the robot
    (found ?r - robot ?x - thing)          ; the robot knows where x is
    (near ?r - robot ?x - thing)           ; x is within reach
    (standing_at ?r - robot ?x - fixture)  ; what the robot lets go of lands on x
    (holding ?r - robot ?x - thing)        ; x is in a hand
    (one_hand_used ?r - robot)             ; exactly one hand holds something
    (both_hands_used ?r - robot)           ; both hands hold something
    ; --- the world as it changes
    (at ?x - thing ?y - thing ?rel - relation) ; x is on, in or next to y
    (opened ?x - thing)                    ; the door, drawer or lid x is open
    (shut ?x - thing)                      ; the inside of x is behind a closed door
    (hidden ?x - thing)                    ; x is behind a closed door
    (active ?x - thing)                    ; x is working: burner lit, tap running, microwave on
    (set_to ?x - thing ?s - setting)       ; the knob x stands at s
    (contains ?x - thing ?s - substance)   ; there is some s in x
    (filled ?x - thing)                    ; there is something in x
    (heating ?x - thing)                   ; x is exposed to heat
    (hot ?x - thing)                       ; x and what it contains are hot
    (occupied ?x - thing)                  ; something stands on x, which has room for one thing only
    (loaded ?x - thing)                    ; what x needs to work is in its slot
    ; --- edges of the object graphs; they never change
    (part_of ?x - thing ?y - thing)        ; x is a part of y
    (same_unit ?x - thing ?y - thing)      ; x and y belong to one object (or are the same)
    (controls ?x - thing ?y - thing)       ; working x starts and stops y
    (guards ?x - thing ?y - thing)         ; the door x closes off the inside of y
    (interrupts ?x - thing ?y - thing)     ; opening x stops y
    (unlatches ?x - thing ?y - thing)      ; pressing x makes y spring open
    (pours_into ?x - outlet ?y - thing ?s - liquid) ; x, when working, fills with s what stands at y
    (drops_on ?x - thing ?y - fixture)     ; what is let go of in front of x lands on y
    ; --- what things are good for; these never change either
    (allows ?x - thing ?rel - relation)    ; something can be put on, in or next to x
    (accepts ?x - thing ?rel - relation)   ; something can be squeezed on or into x
    (openable ?x - thing)                  ; x opens by hand
    (pressable ?x - thing)                 ; x is a button
    (offers ?x - thing ?s - setting)       ; the knob x has this setting
    (idle ?s - setting)                    ; at this setting nothing works
    (heats ?x - thing ?rel - relation)     ; x, when working, heats what is there
    (serves_hot ?x - outlet)               ; what x gives is hot
    (single ?x - thing)                    ; x has room for one thing only
    (bare_heat ?x - thing)                 ; only what is heatproof may stand on x
    (heatproof ?x - thing)                 ; x may stand on a burner
    (no_metal ?x - thing)                  ; metal must not be put into x
    (metal ?x - thing)                     ; x is of metal
    (momentary ?x - thing)                 ; x gives one portion and stops by itself
    (needs_shut ?x - thing)                ; x works only with its door closed
    (needs_load ?x - thing)                ; x works only when loaded
    (receives ?x - thing)                  ; food and drink can be put into x
    (drains ?x - thing)                    ; what is poured into x is gone
    (bulk ?x - thing)                      ; x holds many portions and does not run out
    (lidded ?x - thing)                    ; x gives nothing while it is closed
    (pourable ?x - item)                   ; x can be tipped out
    (addable ?x - item)                    ; x is a portion to be put in as a whole
    (scoopable ?x - thing)                 ; one can scoop from x
    (squeezable ?x - item)                 ; x is a squeeze bottle
    (fits ?x - item ?y - thing)            ; x belongs into the slot of y
    (cooks_into ?s - substance ?t - substance) ; s in hot water becomes t in time
  )

  ; Look around until x is in view, and with it everything it is one object with.
  (:action find
    :parameters (?x - thing)
    :precondition (not (hidden ?x))
    :effect (forall (?y - thing)
              (when (same_unit ?x ?y) (found pr2 ?y))))

  ; Go and stand before x. What was in reach is so no longer, unless it is held or one object with x.
  (:action moveto
    :parameters (?x - thing)
    :precondition (and (found pr2 ?x) (not (hidden ?x)) (not (holding pr2 ?x)))
    :effect (and
      (forall (?y - item)
        (when (and (not (same_unit ?x ?y)) (not (holding pr2 ?y))) (not (near pr2 ?y))))
      (forall (?y - fixture)
        (when (not (same_unit ?x ?y)) (not (near pr2 ?y))))
      (forall (?y - thing)
        (when (same_unit ?x ?y) (near pr2 ?y)))
      (forall (?y - fixture) (not (standing_at pr2 ?y)))
      (forall (?y - fixture) (when (drops_on ?x ?y) (standing_at pr2 ?y)))
      (forall (?y - fixture ?z - fixture ?rel - relation)
        (when (and (at ?x ?y ?rel) (drops_on ?y ?z)) (standing_at pr2 ?z)))))

  ; Take x into a free hand, out of a slot as well. Things behind a closed door cannot be taken.
  (:action grasp
    :parameters (?x - item)
    :precondition (and (near pr2 ?x) (not (holding pr2 ?x)) (not (hidden ?x)) (not (both_hands_used pr2)))
    :effect (and
      (holding pr2 ?x)
      (when (one_hand_used pr2) (both_hands_used pr2))
      (when (one_hand_used pr2) (not (one_hand_used pr2)))
      (when (not (one_hand_used pr2)) (one_hand_used pr2))
      (forall (?y - thing ?rel - relation) (not (at ?x ?y ?rel)))
      (forall (?y - fixture ?rel - relation)
        (when (and (single ?y) (not (= ?rel next_to)) (at ?x ?y ?rel)) (not (occupied ?y))))
      (forall (?y - appliance) (when (and (fits ?x ?y) (at ?x ?y in)) (not (loaded ?y))))
      (not (heating ?x))))

  ; Let x fall: the gripper opens, and x lands where the robot stands.
  (:action release
    :parameters (?x - item)
    :precondition (holding pr2 ?x)
    :effect (and
      (not (holding pr2 ?x))
      (when (both_hands_used pr2) (one_hand_used pr2))
      (when (both_hands_used pr2) (not (both_hands_used pr2)))
      (when (one_hand_used pr2) (not (one_hand_used pr2)))
      (forall (?y - fixture) (when (standing_at pr2 ?y) (at ?x ?y on)))))

  ; Put x on, in or next to y. To reach inside, the door must be open; some places have room for
  ; one thing, a burner takes only what is heatproof, a microwave no metal. A burner that is lit begins to heat x,
  ; a tap that runs fills it with cold water.
  (:action keep
    :parameters (?x - item ?y - fixture ?rel - relation)
    :precondition (and (holding pr2 ?x) (near pr2 ?y) (allows ?y ?rel)
                       (or (not (= ?rel in)) (not (shut ?y)))
                       (or (= ?rel next_to) (not (single ?y)) (not (occupied ?y)))
                       (or (= ?rel next_to) (not (bare_heat ?y)) (heatproof ?x))
                       (or (= ?rel next_to) (not (no_metal ?y)) (not (metal ?x))))
    :effect (and
      (not (holding pr2 ?x))
      (when (both_hands_used pr2) (one_hand_used pr2))
      (when (both_hands_used pr2) (not (both_hands_used pr2)))
      (when (one_hand_used pr2) (not (one_hand_used pr2)))
      (at ?x ?y ?rel)
      (when (and (single ?y) (not (= ?rel next_to))) (occupied ?y))
      (when (and (heats ?y ?rel) (active ?y)) (heating ?x))
      (forall (?o - outlet ?s - liquid)
        (when (and (pours_into ?o ?y ?s) (not (= ?rel next_to)) (active ?o) (receives ?x)) (contains ?x ?s)))
      (forall (?o - outlet ?s - liquid)
        (when (and (pours_into ?o ?y ?s) (not (= ?rel next_to)) (active ?o) (receives ?x)) (filled ?x)))
      (forall (?o - outlet ?s - liquid)
        (when (and (pours_into ?o ?y ?s) (not (= ?rel next_to)) (active ?o) (receives ?x)) (not (hot ?x))))))

  ; Open x, a door, drawer or lid; it takes a free hand, as do closing, pressing and turning. What it hid can be
  ; seen; what must not run with x open stops.
  (:action open
    :parameters (?x - thing)
    :precondition (and (near pr2 ?x) (not (hidden ?x)) (openable ?x) (not (opened ?x)) (not (both_hands_used pr2)))
    :effect (and
      (opened ?x)
      (forall (?y - thing) (when (guards ?x ?y) (not (shut ?y))))
      (forall (?y - fixture ?z - item) (when (and (guards ?x ?y) (at ?z ?y in)) (not (hidden ?z))))
      (forall (?y - fixture) (when (interrupts ?x ?y) (not (active ?y))))
      (forall (?y - fixture ?z - item)
        (when (and (interrupts ?x ?y) (at ?z ?y in)) (not (heating ?z))))))

  ; Close x, a door, drawer or lid. What is behind it is out of sight.
  (:action close
    :parameters (?x - thing)
    :precondition (and (near pr2 ?x) (not (hidden ?x)) (opened ?x) (not (both_hands_used pr2)))
    :effect (and
      (not (opened ?x))
      (forall (?y - thing) (when (guards ?x ?y) (shut ?y)))
      (forall (?y - fixture ?z - item) (when (and (guards ?x ?y) (at ?z ?y in)) (hidden ?z)))))

  ; Press the button x. What it controls starts, or stops if it was working; a door it unlatches springs open.
  (:action press
    :parameters (?x - part)
    :precondition (and (near pr2 ?x) (pressable ?x) (not (both_hands_used pr2)))
    :effect (and
      ; switching on, and what follows from it
      (forall (?y - fixture)
        (when (and (controls ?x ?y) (not (active ?y)) (not (momentary ?y))
                   (or (not (needs_shut ?y)) (shut ?y)))
              (active ?y)))
      (forall (?y - fixture ?z - item ?rel - relation)
        (when (and (controls ?x ?y) (heats ?y ?rel) (not (active ?y)) (at ?z ?y ?rel)
                   (or (not (needs_shut ?y)) (shut ?y)))
              (heating ?z)))
      ; switching off
      (forall (?y - fixture)
        (when (and (controls ?x ?y) (active ?y)) (not (active ?y))))
      (forall (?y - fixture ?z - item ?rel - relation)
        (when (and (controls ?x ?y) (heats ?y ?rel) (active ?y) (at ?z ?y ?rel)) (not (heating ?z))))
      ; one portion from a dispenser or a coffee maker
      (forall (?o - outlet ?y - fixture ?s - liquid ?z - vessel ?rel - relation)
        (when (and (controls ?x ?o) (momentary ?o) (pours_into ?o ?y ?s) (not (= ?rel next_to)) (at ?z ?y ?rel)
                   (or (not (needs_load ?y)) (loaded ?y)))
              (contains ?z ?s)))
      (forall (?o - outlet ?y - fixture ?s - liquid ?z - vessel ?rel - relation)
        (when (and (controls ?x ?o) (momentary ?o) (pours_into ?o ?y ?s) (not (= ?rel next_to)) (at ?z ?y ?rel)
                   (or (not (needs_load ?y)) (loaded ?y)))
              (filled ?z)))
      (forall (?o - outlet ?y - fixture ?s - liquid ?z - vessel ?rel - relation)
        (when (and (controls ?x ?o) (momentary ?o) (pours_into ?o ?y ?s) (not (= ?rel next_to)) (at ?z ?y ?rel)
                   (or (not (needs_load ?y)) (loaded ?y)) (serves_hot ?o))
              (hot ?z)))
      (forall (?o - outlet ?y - fixture ?s - liquid ?z - vessel ?rel - relation)
        (when (and (controls ?x ?o) (momentary ?o) (pours_into ?o ?y ?s) (not (= ?rel next_to)) (at ?z ?y ?rel)
                   (or (not (needs_load ?y)) (loaded ?y)) (not (serves_hot ?o)))
              (not (hot ?z))))
      ; a door that springs open
      (forall (?d - part) (when (unlatches ?x ?d) (opened ?d)))
      (forall (?d - part ?y - fixture)
        (when (and (unlatches ?x ?d) (guards ?d ?y)) (not (shut ?y))))
      (forall (?d - part ?y - fixture ?z - item)
        (when (and (unlatches ?x ?d) (guards ?d ?y) (at ?z ?y in)) (not (hidden ?z))))
      (forall (?d - part ?y - fixture)
        (when (and (unlatches ?x ?d) (interrupts ?d ?y)) (not (active ?y))))
      (forall (?d - part ?y - fixture ?z - item)
        (when (and (unlatches ?x ?d) (interrupts ?d ?y) (at ?z ?y in)) (not (heating ?z))))))

  ; Turn the knob x to s. What it controls works at every setting but the idle one.
  (:action turn
    :parameters (?x - part ?s - setting)
    :precondition (and (near pr2 ?x) (offers ?x ?s) (not (set_to ?x ?s)) (not (both_hands_used pr2)))
    :effect (and
      (set_to ?x ?s)
      (forall (?t - setting) (when (not (= ?s ?t)) (not (set_to ?x ?t))))
      (forall (?y - fixture) (when (and (controls ?x ?y) (not (idle ?s))) (active ?y)))
      (forall (?y - fixture) (when (and (controls ?x ?y) (idle ?s)) (not (active ?y))))
      (forall (?y - fixture ?z - item ?rel - relation)
        (when (and (controls ?x ?y) (heats ?y ?rel) (not (idle ?s)) (at ?z ?y ?rel)) (heating ?z)))
      (forall (?y - fixture ?z - item ?rel - relation)
        (when (and (controls ?x ?y) (heats ?y ?rel) (idle ?s) (at ?z ?y ?rel)) (not (heating ?z))))
      (forall (?o - outlet ?y - fixture ?l - liquid ?z - vessel ?rel - relation)
        (when (and (controls ?x ?o) (pours_into ?o ?y ?l) (not (= ?rel next_to)) (not (idle ?s)) (at ?z ?y ?rel))
              (contains ?z ?l)))
      (forall (?o - outlet ?y - fixture ?l - liquid ?z - vessel ?rel - relation)
        (when (and (controls ?x ?o) (pours_into ?o ?y ?l) (not (= ?rel next_to)) (not (idle ?s)) (at ?z ?y ?rel))
              (filled ?z)))
      (forall (?o - outlet ?y - fixture ?l - liquid ?z - vessel ?rel - relation)
        (when (and (controls ?x ?o) (pours_into ?o ?y ?l) (not (= ?rel next_to)) (not (idle ?s)) (at ?z ?y ?rel))
              (not (hot ?z))))))

  ; Take a scoop of what is in y with the utensil x.
  (:action scoopfrom
    :parameters (?x - utensil ?y - item)
    :precondition (and (holding pr2 ?x) (near pr2 ?y) (not (= ?x ?y)) (not (hidden ?y)) (scoopable ?y)
                       (filled ?y) (not (filled ?x)) (or (not (lidded ?y)) (opened ?y)))
    :effect (and
      (filled ?x)
      (forall (?s - substance) (when (contains ?y ?s) (contains ?x ?s)))))

  ; Let what is on the utensil x fall into y.
  (:action scoopto
    :parameters (?x - utensil ?y - vessel)
    :precondition (and (holding pr2 ?x) (near pr2 ?y) (not (hidden ?y)) (receives ?y) (filled ?x))
    :effect (and
      (not (filled ?x))
      (filled ?y)
      (forall (?s - substance) (when (contains ?x ?s) (contains ?y ?s)))
      (forall (?s - substance) (when (contains ?x ?s) (not (contains ?x ?s))))))

  ; Squeeze the bottle x so that some of it is on or in y.
  (:action squeeze
    :parameters (?x - supply ?y - vessel ?rel - relation)
    :precondition (and (holding pr2 ?x) (near pr2 ?y) (not (hidden ?y)) (squeezable ?x) (accepts ?y ?rel)
                       (filled ?x))
    :effect (and
      (filled ?y)
      (forall (?s - substance) (when (contains ?x ?s) (contains ?y ?s)))))

  ; Pour x out into y: into a vessel, or away into a sink. Heat goes with the contents.
  (:action pour
    :parameters (?x - item ?y - thing)
    :precondition (and (holding pr2 ?x) (near pr2 ?y) (not (= ?x ?y)) (not (hidden ?y)) (receives ?y)
                       (pourable ?x) (filled ?x) (or (not (lidded ?x)) (opened ?x)))
    :effect (and
      (when (not (bulk ?x)) (not (filled ?x)))
      (when (not (drains ?y)) (filled ?y))
      (when (and (hot ?x) (not (drains ?y))) (hot ?y))
      (when (not (bulk ?x)) (not (hot ?x)))
      (forall (?s - substance)
        (when (and (contains ?x ?s) (not (drains ?y))) (contains ?y ?s)))
      (forall (?s - substance)
        (when (and (contains ?x ?s) (not (bulk ?x))) (not (contains ?x ?s))))))

  ; Put the portion x into y.
  (:action add
    :parameters (?x - supply ?y - vessel)
    :precondition (and (holding pr2 ?x) (near pr2 ?y) (not (hidden ?y)) (receives ?y)
                       (addable ?x) (filled ?x) (or (not (lidded ?x)) (opened ?x)))
    :effect (and
      (filled ?y)
      (when (not (bulk ?x)) (not (filled ?x)))
      (forall (?s - substance) (when (contains ?x ?s) (contains ?y ?s)))
      (forall (?s - substance)
        (when (and (contains ?x ?s) (not (bulk ?x))) (not (contains ?x ?s))))))

  ; Push x into the slot of y.
  (:action insert
    :parameters (?x - item ?y - appliance)
    :precondition (and (holding pr2 ?x) (near pr2 ?y) (fits ?x ?y) (not (loaded ?y)))
    :effect (and
      (not (holding pr2 ?x))
      (when (both_hands_used pr2) (one_hand_used pr2))
      (when (both_hands_used pr2) (not (both_hands_used pr2)))
      (when (one_hand_used pr2) (not (one_hand_used pr2)))
      (at ?x ?y in)
      (loaded ?y)))

  ; Let time pass: what is being heated gets hot, what lies in hot water is cooked.
  (:action wait
    :parameters ()
    :precondition (and)
    :effect (and
      (forall (?x - vessel) (when (and (heating ?x) (filled ?x)) (hot ?x)))
      (forall (?x - vessel ?s - substance ?t - substance)
        (when (and (cooks_into ?s ?t) (contains ?x ?s) (contains ?x water) (or (hot ?x) (heating ?x)))
              (contains ?x ?t)))
      (forall (?x - vessel ?s - substance ?t - substance)
        (when (and (cooks_into ?s ?t) (contains ?x ?s) (contains ?x water) (or (hot ?x) (heating ?x)))
              (not (contains ?x ?s))))))
)
