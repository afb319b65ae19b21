; VEIL-500, literal: the rules by which the data set's own simulator runs, slips included.
;
; Use this domain to score predictions comparably: recorded and predicted sequences are executed by force in it
; (effects apply even where preconditions fail). It is no model of a kitchen: coming near one thing does not end
; being near another, grasping a thing ends being near it, nothing is ever heated, a poured vessel stays full.
; For planning use veil500_sane, in which every executable sequence is executable here too.
;
; States are facts (is thing state); a state that the class of a thing does not declare can never be set. Which
; button works what, and what must be near or held for it, are facts that never change, so that one schema does
; for all buttons. Where the rules choose by the name of an argument ("turn SinkKnob"), the argument has a type;
; where they ask for an affordance, it is a fact, so that forced execution still has its effects.

(define (domain veil500_literal)
  (:requirements :strips :typing :negative-preconditions :disjunctive-preconditions :existential-preconditions
                 :equality :conditional-effects)

  (:types
    thing robot relation state - object
    button knob openable additive cutlery - thing
    door - openable               ; what close is for; open is also for the bag
    scooper - cutlery             ; the one spoon that "add IceCreamScoop" means
    content switch channel doorstate - state
    fluid - content               ; what pouring hands on
  )

  (:constants
    pr2 - robot
    on in inside next_to - relation
    water coffee coke energydrink icecream chocolate canadadry vanilla salt - fluid
    ramen egg - content
    tapison stovefire1 stovefire2 stovefire3 stovefire4 microwaveison waterdispenserisopen ison - switch
    channel1 channel2 channel3 channel4 channel5 channel6 - channel
    doorisopen leftdoorisopen rightdoorisopen - doorstate
    spoon fork percentfilled scoopsleft volume haschips isopen cd - state
  )

  (:predicates
    ; --- the robot
    (near ?r - robot ?x - thing)             ; the robot has come to x and not taken it since
    (holding ?r - robot ?x - thing)          ; the robot grasps x
    ; --- the world as it changes
    (at ?x - thing ?y - thing ?rel - relation) ; x is on, in or next to y
    (is ?x - thing ?s - state)               ; the state s of x is true
    ; --- what never changes
    (declares ?x - thing ?s - state)         ; the class of x has the state s
    (graspable ?x - thing)                   ; x can be picked up
    (squeezable ?x - thing)                  ; x is a bottle of syrup
    (works ?k - thing ?x - thing ?s - state) ; pressing or turning k switches the state s of x
    (feeds ?k - thing ?x - thing)            ; the tap k lets water run on x
    (dispenses ?b - button ?x - thing)       ; b works the water dispenser of x
    (steps ?b - button ?x - thing ?s - channel ?t - channel) ; b changes x from channel s to channel t
    (raises ?b - button ?x - thing)          ; b makes x loud
    (lowers ?b - button ?x - thing)          ; b makes x silent
    (reached_at ?k - thing ?x - thing)       ; to work k the robot must be near x
    (reached_anywhere ?b - button)           ; b is on something that is held, not stood at
    (worked_by ?b - button ?x - thing)       ; to work b the robot must hold x
    (worked_freely ?b - button)              ; nothing need be held to work b
    (swings ?d - openable ?x - thing ?s - doorstate) ; opening d makes the state s of x true
    (stops ?d - openable ?x - thing ?s - switch) ; opening d switches the state s of x off
    (opened_in_hand ?d - openable)           ; d is a bag, torn open while it is held
    (gated ?z - thing ?rel - relation)       ; things go rel z only through its open door
    (hand_fed ?z - thing ?rel - relation)    ; things go rel z only while z itself is held
    (yields ?a - thing ?s - state)           ; adding or placing a gives the other thing the state s
    (goes_whole ?a - additive)               ; what is added is a itself, not a pinch of it
  )

  ; Come near a thing. Being near other things does not end.
  (:action moveto
    :parameters (?x - thing)
    :precondition (and)
    :effect (and
      (near pr2 ?x)
      (forall (?y - thing)
        (when (and (not (= ?x ?y)) (not (holding pr2 ?y))) (not (at ?x ?y next_to))))))

  ; Pick a thing up. It leaves everything it was on, in or next to, what is on or in it leaves it, and the
  ; robot is not near it any more.
  (:action grasp
    :parameters (?x - thing)
    :precondition (and (graspable ?x) (near pr2 ?x) (not (holding pr2 ?x)))
    :effect (and
      (holding pr2 ?x)
      (not (near pr2 ?x))
      (forall (?y - thing ?rel - relation) (when (not (= ?x ?y)) (not (at ?x ?y ?rel))))
      (forall (?y - thing ?rel - relation) (when (not (= ?x ?y)) (not (at ?y ?x ?rel))))))

  ; Let go. Nothing says where the thing is then.
  (:action release
    :parameters (?x - thing)
    :precondition (holding pr2 ?x)
    :effect (not (holding pr2 ?x)))

  ; Put a held thing on, in or next to another one. "Inside" lets go and says nothing more. Under a running tap
  ; it gets water.
  (:action keep
    :parameters (?x - thing ?z - thing ?rel - relation)
    :precondition (and
      (holding pr2 ?x)
      (or (near pr2 ?z) (hand_fed ?z ?rel))
      (or (holding pr2 ?z) (not (hand_fed ?z ?rel)))
      (or (is ?z doorisopen) (not (gated ?z ?rel))))
    :effect (and
      (not (holding pr2 ?x))
      (when (not (= ?rel inside)) (at ?x ?z ?rel))
      (forall (?k - knob)
        (when (and (= ?rel on) (feeds ?k ?z) (is ?k tapison) (declares ?x water)) (is ?x water)))))

  ; Turn a knob on or off. An opened tap fills what is on the sink; a lit burner heats nothing.
  (:action turn
    :parameters (?k - knob)
    :precondition (exists (?x - thing) (and (reached_at ?k ?x) (near pr2 ?x)))
    :effect (and
      (forall (?x - thing ?s - switch) (when (and (works ?k ?x ?s) (not (is ?x ?s))) (is ?x ?s)))
      (forall (?x - thing ?s - switch) (when (and (works ?k ?x ?s) (is ?x ?s)) (not (is ?x ?s))))
      (forall (?x - thing ?v - thing)
        (when (and (feeds ?k ?x) (not (is ?k tapison)) (at ?v ?x on) (declares ?v water)) (is ?v water)))))

  ; Press a button: a switch, the water dispenser (fills what is held), a channel or the volume.
  (:action press
    :parameters (?b - button)
    :precondition (and
      (or (reached_anywhere ?b) (exists (?x - thing) (and (reached_at ?b ?x) (near pr2 ?x))))
      (or (worked_freely ?b) (exists (?x - thing) (and (worked_by ?b ?x) (holding pr2 ?x)))))
    :effect (and
      (forall (?x - thing ?s - switch) (when (and (works ?b ?x ?s) (not (is ?x ?s))) (is ?x ?s)))
      (forall (?x - thing ?s - switch) (when (and (works ?b ?x ?s) (is ?x ?s)) (not (is ?x ?s))))
      (forall (?x - thing ?v - thing)
        (when (and (dispenses ?b ?x) (not (is ?x waterdispenserisopen)) (holding pr2 ?v) (declares ?v water))
          (is ?v water)))
      (forall (?x - thing ?s - channel ?t - channel)
        (when (and (steps ?b ?x ?s ?t) (is ?x ison) (is ?x ?s)) (not (is ?x ?s))))
      (forall (?x - thing ?s - channel ?t - channel)
        (when (and (steps ?b ?x ?s ?t) (is ?x ison) (is ?x ?s)) (is ?x ?t)))
      (forall (?x - thing) (when (and (raises ?b ?x) (is ?x ison)) (is ?x volume)))
      (forall (?x - thing) (when (and (lowers ?b ?x) (is ?x ison)) (not (is ?x volume))))))

  ; Open a closed door one is near, or the bag one holds.
  (:action open
    :parameters (?d - openable)
    :precondition (or
      (exists (?x - thing ?s - doorstate)
        (and (swings ?d ?x ?s) (reached_at ?d ?x) (near pr2 ?x) (not (is ?x ?s))))
      (and (opened_in_hand ?d) (holding pr2 ?d)))
    :effect (and
      (forall (?x - thing ?s - doorstate) (when (swings ?d ?x ?s) (is ?x ?s)))
      (forall (?x - thing ?s - switch) (when (stops ?d ?x ?s) (not (is ?x ?s))))
      (when (and (opened_in_hand ?d) (declares ?d isopen)) (is ?d isopen))))

  ; Close an open door one is near.
  (:action close
    :parameters (?d - door)
    :precondition (exists (?x - thing ?s - doorstate)
      (and (swings ?d ?x ?s) (reached_at ?d ?x) (near pr2 ?x) (is ?x ?s)))
    :effect (forall (?x - thing ?s - doorstate) (when (swings ?d ?x ?s) (not (is ?x ?s)))))

  ; Empty a held thing.
  (:action pour_out
    :parameters (?x - thing)
    :precondition (holding pr2 ?x)
    :effect (forall (?s - content) (not (is ?x ?s))))

  ; Pour from one held thing into another one. The first stays full.
  (:action pour
    :parameters (?x - thing ?y - thing)
    :precondition (and (holding pr2 ?x) (holding pr2 ?y))
    :effect (forall (?s - fluid) (when (and (is ?x ?s) (declares ?y ?s)) (is ?y ?s))))

  ; Add salt, noodles or an egg to a held thing.
  (:action add
    :parameters (?a - additive ?y - thing)
    :precondition (and (holding pr2 ?a) (holding pr2 ?y))
    :effect (and
      (forall (?s - content) (when (and (yields ?a ?s) (declares ?y ?s)) (is ?y ?s)))
      (when (goes_whole ?a) (not (holding pr2 ?a)))
      (when (goes_whole ?a) (at ?a ?y in))))

  ; Take a scoop of what has scoops left.
  (:action scoopfrom
    :parameters (?x - thing ?y - thing)
    :precondition (and (holding pr2 ?x) (holding pr2 ?y) (is ?y scoopsleft))
    :effect (when (declares ?x scoopsleft) (is ?x scoopsleft)))

  ; Add the scoop on the spoon to anything anywhere.
  (:action scoopto
    :parameters (?x - scooper ?y - thing)
    :precondition (and (holding pr2 ?x) (is ?x scoopsleft))
    :effect (and
      (when (declares ?y icecream) (is ?y icecream))
      (not (is ?x scoopsleft))))

  ; Squeeze syrup. Only chocolate comes out.
  (:action squeeze
    :parameters (?x - thing ?y - thing)
    :precondition (and (holding pr2 ?x) (holding pr2 ?y) (squeezable ?x))
    :effect (when (and (is ?x chocolate) (declares ?y chocolate)) (is ?y chocolate)))

  ; Lay cutlery in a held thing, which is then let go of.
  (:action place
    :parameters (?a - cutlery ?y - thing)
    :precondition (holding pr2 ?y)
    :effect (and
      (not (holding pr2 ?y))
      (at ?a ?y in)
      (forall (?s - state) (when (and (yields ?a ?s) (declares ?y ?s)) (is ?y ?s)))))

  ; Put a disc into a held device.
  (:action insert
    :parameters (?x - thing ?y - thing)
    :precondition (and (is ?x cd) (holding pr2 ?x) (holding pr2 ?y))
    :effect (and
      (when (declares ?y cd) (is ?y cd))
      (not (holding pr2 ?x))
      (at ?x ?y in)))

  ; Do nothing. The effect says so at length, because some tools lose an action that has none.
  (:action wait
    :parameters ()
    :precondition (and)
    :effect (forall (?x - thing) (when (near pr2 ?x) (near pr2 ?x))))
)
