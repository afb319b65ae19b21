; The living room: what each instruction of a household robot needs and does.
;
; The instructions of Table I of "Tell Me Dave" (RSS 2014) but for squeeze, and three more that people use
; (pour, add, insert). Names and meanings are those of the kitchen, so that what was learned there can serve here.
; One robot, pr2, with two hands. instructions.pddl is written by hand; domain.pddl is compiled from it and from
; objects.yaml (classes become types, substances become constants).
;
; Physics in one paragraph. A thing must be found before the robot can go to it, and what is behind a closed door,
; in a drawer or in a tied-up bag cannot be found, approached, worked or taken. Standing somewhere ends standing elsewhere; what is held
; stays in reach, with its parts. A television, player, lamp or microwave is worked through the part that controls
; it, or through a remote control that is in the hand. Buttons shift the channel and the volume step by step, while
; the television is on. A player plays when it is on and has a disc. What a running microwave heats gets hot, and
; corn pops, when the robot waits.

(define (domain living_room)
  (:requirements :strips :typing :negative-preconditions :disjunctive-preconditions :equality
                 :universal-preconditions :conditional-effects)

  (:types
    thing robot relation setting direction substance - object
    channel loudness - setting
    fixture item - thing                 ; fixtures stay where they are, items can be carried
    furniture appliance part - fixture   ; parts are vertices of an object graph; those of an item go where it goes
    vessel utensil supply tool - item    ; supply: food as it is bought; tool: anything else
    liquid solid - substance
  )

  (:constants
    pr2 - robot
    floor - furniture
    on in next_to - relation
    off low high - setting
    channel1 channel2 channel3 channel4 - channel
    quiet medium loud - loudness
    up down - direction
  )

  (:predicates
    ; --- the robot
    (found ?r - robot ?x - thing)          ; the robot knows where x is
    (near ?r - robot ?x - thing)           ; x is within reach
    (standing_at ?r - robot ?x - fixture)  ; what the robot lets go of lands on x
    (holding ?r - robot ?x - thing)        ; x is in a hand
    (carried ?r - robot ?x - part)         ; what x is a part of is in a hand
    (one_hand_used ?r - robot)             ; exactly one hand holds something
    (both_hands_used ?r - robot)           ; both hands hold something
    ; --- the world as it changes
    (at ?x - thing ?y - thing ?rel - relation) ; x is on, in or next to y
    (opened ?x - thing)                    ; the door, drawer, lid, bag or curtain x is open
    (shut ?x - thing)                      ; the inside of x is behind a closed door
    (hidden ?x - thing)                    ; x is behind a closed door
    (active ?x - thing)                    ; x is working: television on, lamp lit, film playing
    (set_to ?x - thing ?s - setting)       ; x is set to s (a knob stands there, a screen shows it)
    (contains ?x - thing ?s - substance)   ; there is some s in x
    (filled ?x - thing)                    ; there is something in x
    (heating ?x - thing)                   ; x is exposed to heat
    (hot ?x - thing)                       ; x and what it contains are hot
    (loaded ?x - thing)                    ; there is a disc in x
    ; --- edges of the object graphs; they never change
    (part_of ?x - thing ?y - thing)        ; x is a part of y
    (same_unit ?x - thing ?y - thing)      ; x and y belong to one object (or are the same)
    (controls ?x - thing ?y - thing)       ; working x starts and stops y
    (starts ?x - thing ?y - part)          ; pressing x starts and stops y, if what y is a part of is on and loaded
    (shifts ?x - thing ?y - part ?d - direction) ; pressing x sets y one further, if what y is a part of is on
    (guards ?x - thing ?y - thing)         ; the door x closes off the inside of y
    (interrupts ?x - thing ?y - thing)     ; opening x stops y
    (drops_on ?x - thing ?y - fixture)     ; what is let go of in front of x lands on y
    ; --- what things are good for; these never change either
    (allows ?x - thing ?rel - relation)    ; something can be put on, in or next to x
    (openable ?x - thing)                  ; x opens by hand
    (pressable ?x - thing)                 ; x is a button or switch
    (handheld ?x - thing)                  ; x works only in the hand
    (offers ?x - thing ?s - setting)       ; the knob x has this setting
    (idle ?s - setting)                    ; at this setting nothing works
    (leads ?s - setting ?d - direction ?t - setting) ; one further from s is t
    (heats ?x - thing ?rel - relation)     ; x, when working, heats what is there
    (no_metal ?x - thing)                  ; metal must not be put into x
    (metal ?x - thing)                     ; x is of metal
    (needs_shut ?x - thing)                ; x works only with its door closed
    (receives ?x - thing)                  ; food and drink can be put into x
    (drains ?x - thing)                    ; what is poured into x is gone
    (bulk ?x - thing)                      ; x holds many portions and does not run out
    (lidded ?x - thing)                    ; x gives nothing while it is closed
    (pourable ?x - item)                   ; x can be tipped out
    (addable ?x - item)                    ; x is a portion to be put in as a whole
    (scoopable ?x - thing)                 ; one can scoop from x
    (fits ?x - item ?y - thing)            ; x belongs into the slot of y
    (cooks_into ?s - substance ?t - substance) ; s, heated, becomes t in time
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
      (forall (?y - furniture)
        (when (not (same_unit ?x ?y)) (not (near pr2 ?y))))
      (forall (?y - appliance)
        (when (not (same_unit ?x ?y)) (not (near pr2 ?y))))
      (forall (?y - part)
        (when (and (not (same_unit ?x ?y)) (not (carried pr2 ?y))) (not (near pr2 ?y))))
      (forall (?y - thing)
        (when (same_unit ?x ?y) (near pr2 ?y)))
      (forall (?y - fixture) (not (standing_at pr2 ?y)))
      (forall (?y - fixture) (when (drops_on ?x ?y) (standing_at pr2 ?y)))
      (forall (?y - thing ?z - fixture ?rel - relation)
        (when (and (at ?x ?y ?rel) (drops_on ?y ?z)) (standing_at pr2 ?z)))))

  ; Take x into a free hand, out of a player as well. Things behind a closed door cannot be taken.
  (:action grasp
    :parameters (?x - item)
    :precondition (and (near pr2 ?x) (not (holding pr2 ?x)) (not (hidden ?x)) (not (both_hands_used pr2)))
    :effect (and
      (holding pr2 ?x)
      (forall (?y - part) (when (part_of ?y ?x) (carried pr2 ?y)))
      (when (one_hand_used pr2) (both_hands_used pr2))
      (when (one_hand_used pr2) (not (one_hand_used pr2)))
      (when (not (one_hand_used pr2)) (one_hand_used pr2))
      (forall (?y - thing ?rel - relation) (not (at ?x ?y ?rel)))
      (forall (?y - appliance) (when (and (fits ?x ?y) (at ?x ?y in)) (not (loaded ?y))))
      (forall (?y - appliance ?z - part)
        (when (and (fits ?x ?y) (at ?x ?y in) (part_of ?z ?y)) (not (active ?z))))
      (not (heating ?x))))

  ; Let x fall: the gripper opens, and x lands where the robot stands.
  (:action release
    :parameters (?x - item)
    :precondition (holding pr2 ?x)
    :effect (and
      (not (holding pr2 ?x))
      (forall (?y - part) (when (part_of ?y ?x) (not (carried pr2 ?y))))
      (when (both_hands_used pr2) (one_hand_used pr2))
      (when (both_hands_used pr2) (not (both_hands_used pr2)))
      (when (one_hand_used pr2) (not (one_hand_used pr2)))
      (forall (?y - fixture) (when (standing_at pr2 ?y) (at ?x ?y on)))))

  ; Put x on, in or next to y. To reach inside, the door, lid or bag must be open; a microwave
  ; takes no metal, and heats x if it runs.
  (:action keep
    :parameters (?x - item ?y - thing ?rel - relation)
    :precondition (and (holding pr2 ?x) (near pr2 ?y) (not (= ?x ?y)) (not (hidden ?y)) (allows ?y ?rel)
                       (or (not (= ?rel in)) (not (shut ?y)))
                       (or (= ?rel next_to) (not (no_metal ?y)) (not (metal ?x))))
    :effect (and
      (not (holding pr2 ?x))
      (forall (?z - part) (when (part_of ?z ?x) (not (carried pr2 ?z))))
      (when (both_hands_used pr2) (one_hand_used pr2))
      (when (both_hands_used pr2) (not (both_hands_used pr2)))
      (when (one_hand_used pr2) (not (one_hand_used pr2)))
      (at ?x ?y ?rel)
      (when (and (heats ?y ?rel) (active ?y)) (heating ?x))))

  ; Open x, a door, drawer, lid, bag or curtain; it takes a free hand, as do closing, pressing and turning. What it
  ; hid can be seen; what must not run with x open stops.
  (:action open
    :parameters (?x - thing)
    :precondition (and (near pr2 ?x) (not (hidden ?x)) (openable ?x) (not (opened ?x)) (not (both_hands_used pr2)))
    :effect (and
      (opened ?x)
      (forall (?y - thing) (when (guards ?x ?y) (not (shut ?y))))
      (forall (?y - thing ?z - item) (when (and (guards ?x ?y) (at ?z ?y in)) (not (hidden ?z))))
      (forall (?y - thing ?z - item ?w - part)
        (when (and (guards ?x ?y) (part_of ?w ?z) (at ?z ?y in)) (not (hidden ?w))))
      (forall (?y - fixture) (when (interrupts ?x ?y) (not (active ?y))))
      (forall (?y - fixture ?z - item)
        (when (and (interrupts ?x ?y) (at ?z ?y in)) (not (heating ?z))))))

  ; Close x. What is behind it is out of sight.
  (:action close
    :parameters (?x - thing)
    :precondition (and (near pr2 ?x) (not (hidden ?x)) (opened ?x) (not (both_hands_used pr2)))
    :effect (and
      (not (opened ?x))
      (forall (?y - thing) (when (guards ?x ?y) (shut ?y)))
      (forall (?y - thing ?z - item) (when (and (guards ?x ?y) (at ?z ?y in)) (hidden ?z)))
      (forall (?y - thing ?z - item ?w - part)
        (when (and (guards ?x ?y) (part_of ?w ?z) (at ?z ?y in)) (hidden ?w)))))

  ; Press x, a button or switch. What it controls starts, or stops if it was working; channel or volume go one
  ; further, and for these the television or player has to be on. The buttons of a remote control want it in the hand.
  (:action press
    :parameters (?x - part)
    :precondition (and (near pr2 ?x) (not (hidden ?x)) (pressable ?x) (not (both_hands_used pr2))
                       (or (not (handheld ?x)) (carried pr2 ?x))
                       (forall (?y - part ?z - appliance)
                         (or (not (starts ?x ?y)) (not (part_of ?y ?z)) (and (active ?z) (loaded ?z))))
                       (forall (?y - part ?z - appliance ?d - direction)
                         (or (not (shifts ?x ?y ?d)) (not (part_of ?y ?z)) (active ?z))))
    :effect (and
      ; switching on, and what follows from it
      (forall (?y - fixture)
        (when (and (controls ?x ?y) (not (active ?y))
                   (or (not (needs_shut ?y)) (shut ?y)))
              (active ?y)))
      (forall (?y - fixture ?z - item ?rel - relation)
        (when (and (controls ?x ?y) (heats ?y ?rel) (not (active ?y)) (at ?z ?y ?rel)
                   (or (not (needs_shut ?y)) (shut ?y)))
              (heating ?z)))
      ; switching off: nothing plays in a player that is off
      (forall (?y - fixture)
        (when (and (controls ?x ?y) (active ?y)) (not (active ?y))))
      (forall (?y - fixture ?z - part)
        (when (and (controls ?x ?y) (active ?y) (part_of ?z ?y)) (not (active ?z))))
      (forall (?y - fixture ?z - item ?rel - relation)
        (when (and (controls ?x ?y) (heats ?y ?rel) (active ?y) (at ?z ?y ?rel)) (not (heating ?z))))
      ; playing a disc, and stopping it
      (forall (?y - part)
        (when (and (starts ?x ?y) (not (active ?y))) (active ?y)))
      (forall (?y - part)
        (when (and (starts ?x ?y) (active ?y)) (not (active ?y))))
      ; one channel, or one step of volume, further
      (forall (?y - part ?d - direction ?s - setting ?t - setting)
        (when (and (shifts ?x ?y ?d) (leads ?s ?d ?t) (set_to ?y ?s)) (set_to ?y ?t)))
      (forall (?y - part ?d - direction ?s - setting ?t - setting)
        (when (and (shifts ?x ?y ?d) (leads ?s ?d ?t) (set_to ?y ?s)) (not (set_to ?y ?s))))))

  ; Turn the knob x to s. What it controls works at every setting but the idle one.
  (:action turn
    :parameters (?x - part ?s - setting)
    :precondition (and (near pr2 ?x) (not (hidden ?x)) (offers ?x ?s) (not (set_to ?x ?s))
                       (not (both_hands_used pr2)))
    :effect (and
      (set_to ?x ?s)
      (forall (?t - setting) (when (not (= ?s ?t)) (not (set_to ?x ?t))))
      (forall (?y - fixture) (when (and (controls ?x ?y) (not (idle ?s))) (active ?y)))
      (forall (?y - fixture) (when (and (controls ?x ?y) (idle ?s)) (not (active ?y))))))

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

  ; Pour x out into y: into a vessel, or away into a bin whose lid is open. Heat goes with the contents.
  (:action pour
    :parameters (?x - item ?y - thing)
    :precondition (and (holding pr2 ?x) (near pr2 ?y) (not (= ?x ?y)) (not (hidden ?y)) (not (shut ?y)) (receives ?y)
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

  ; Let time pass: what is being heated gets hot, and corn pops.
  (:action wait
    :parameters ()
    :precondition (and)
    :effect (and
      (forall (?x - item) (when (and (heating ?x) (filled ?x)) (hot ?x)))
      (forall (?x - item ?s - substance ?t - substance)
        (when (and (cooks_into ?s ?t) (contains ?x ?s) (heating ?x)) (contains ?x ?t)))
      (forall (?x - item ?s - substance ?t - substance)
        (when (and (cooks_into ?s ?t) (contains ?x ?s) (heating ?x)) (not (contains ?x ?s))))))
)
