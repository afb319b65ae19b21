; VEIL-500, sane: the same instructions with the physics that a planner needs.
;
; The robot is near one thing at a time and has two hands. What is behind a closed door cannot be taken. What is let
; go of lands where the robot stands, things stay on what is carried, pouring empties, burners and the microwave
; heat, and water that is heated boils.
;
; Every sequence that is executable here is executable in veil500_literal too, so a plan made here never fails in the
; data set's own simulator. That is why some things are stricter than a robot would need: taking a thing ends
; being near it, and pouring, adding, scooping, squeezing and inserting need both things in the hands. "place" of
; the literal rules is left out: it lets go of the wrong thing there.

(define (domain veil500_sane)
  (:requirements :strips :typing :negative-preconditions :disjunctive-preconditions :existential-preconditions
                 :equality :conditional-effects)

  (:types
    thing robot relation state - object
    item button knob door - thing    ; items can be carried
    additive scooper - item          ; what can be added, what scoops
    content switch channel doorstate - state
  )

  (:constants
    pr2 - robot
    on in inside next_to - relation
    water coffee coke energydrink icecream chocolate canadadry vanilla salt ramen egg haschips - content
    tapison stovefire1 stovefire2 stovefire3 stovefire4 microwaveison waterdispenserisopen ison - switch
    channel1 channel2 channel3 channel4 channel5 channel6 - channel
    doorisopen leftdoorisopen rightdoorisopen - doorstate
    spoon fork percentfilled scoopsleft volume isopen cd - state
  )

  (:predicates
    ; --- the robot
    (near ?r - robot ?x - thing)             ; the robot stands at x
    (holding ?r - robot ?x - thing)          ; x is in a hand
    (one_hand_used ?r - robot)               ; exactly one hand holds something
    (both_hands_used ?r - robot)             ; both hands hold something
    ; --- the world as it changes
    (at ?x - thing ?y - thing ?rel - relation) ; x is on, in or next to y
    (is ?x - thing ?s - state)               ; the state s of x is true
    (lit ?x - thing)                         ; the burner x is on (the state of the stove, seen from the burner)
    (shut_away ?x - thing)                   ; x is behind a closed door
    (hot ?x - thing)                         ; x has been heated
    (boiling ?x - thing)                     ; the water in x boils
    ; --- what never changes
    (declares ?x - thing ?s - state)         ; things like x have the state s
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
    (swings ?d - thing ?x - thing ?s - doorstate) ; opening d makes the state s of x true
    (stops ?d - thing ?x - thing ?s - switch) ; opening d switches the state s of x off
    (opened_in_hand ?d - thing)              ; d is a bag, torn open while it is held
    (hand_fed ?z - thing ?rel - relation)    ; things go rel z only while z itself is held
    (yields ?a - thing ?s - state)           ; adding a gives the other thing the state s
    (goes_whole ?a - additive)               ; what is added is a itself, not a pinch of it
    (supports ?z - thing ?rel - relation)    ; things can be put rel z
    (closed_off ?z - thing ?rel - relation)  ; things go rel z only through an open door
    (encloses ?d - thing ?x - thing)         ; d closes off the inside of x
    (only_door ?d - door)                    ; no other door does so
    (twin_door ?d - door ?s - doorstate)     ; the other door is open when s is true
    (needs_shut ?x - thing)                  ; x starts only with its door closed
    (lights ?k - knob ?x - thing)            ; k starts and stops the burner x
  )

  ; Go to a thing. The robot leaves where it was.
  (:action moveto
    :parameters (?x - thing)
    :precondition (not (holding pr2 ?x))
    :effect (and
      (near pr2 ?x)
      (forall (?y - thing) (when (not (= ?x ?y)) (not (near pr2 ?y))))))

  ; Take a thing that no closed door hides into a free hand. It leaves its place; what is on or in it stays there.
  (:action grasp
    :parameters (?x - item)
    :precondition (and
      (near pr2 ?x) (not (holding pr2 ?x)) (not (shut_away ?x)) (not (both_hands_used pr2)))
    :effect (and
      (holding pr2 ?x)
      (not (near pr2 ?x))
      (forall (?y - thing ?rel - relation) (not (at ?x ?y ?rel)))
      (when (not (one_hand_used pr2)) (one_hand_used pr2))
      (when (one_hand_used pr2) (not (one_hand_used pr2)))
      (when (one_hand_used pr2) (both_hands_used pr2))))

  ; Let go: the thing lands on what the robot stands at, if that carries things, else on the floor.
  (:action release
    :parameters (?x - item)
    :precondition (holding pr2 ?x)
    :effect (and
      (not (holding pr2 ?x))
      (forall (?y - thing) (when (and (near pr2 ?y) (supports ?y on)) (at ?x ?y on)))
      (forall (?k - knob ?y - thing)
        (when (and (near pr2 ?y) (feeds ?k ?y) (is ?k tapison) (declares ?x water)) (is ?x water)))
      (forall (?y - thing) (when (and (near pr2 ?y) (lit ?y)) (hot ?x)))
      (forall (?y - thing) (when (and (near pr2 ?y) (lit ?y) (is ?x water)) (boiling ?x)))
      (when (both_hands_used pr2) (one_hand_used pr2))
      (when (both_hands_used pr2) (not (both_hands_used pr2)))
      (when (one_hand_used pr2) (not (one_hand_used pr2)))))

  ; Put a held thing on, in or next to another one; "inside" means in. Doors in the way must be open. Under a running
  ; tap it gets water, on a lit burner it gets hot.
  (:action keep
    :parameters (?x - item ?z - thing ?rel - relation)
    :precondition (and
      (holding pr2 ?x)
      (not (= ?x ?z))
      (supports ?z ?rel)
      (or (near pr2 ?z) (hand_fed ?z ?rel))
      (or (not (hand_fed ?z ?rel)) (holding pr2 ?z))
      (or (not (closed_off ?z ?rel)) (exists (?s - doorstate) (is ?z ?s))))
    :effect (and
      (not (holding pr2 ?x))
      (when (not (= ?rel inside)) (at ?x ?z ?rel))
      (when (= ?rel inside) (at ?x ?z in))
      (forall (?k - knob)
        (when (and (= ?rel on) (feeds ?k ?z) (is ?k tapison) (declares ?x water)) (is ?x water)))
      (when (and (= ?rel on) (lit ?z)) (hot ?x))
      (when (and (= ?rel on) (lit ?z) (is ?x water)) (boiling ?x))
      (when (both_hands_used pr2) (one_hand_used pr2))
      (when (both_hands_used pr2) (not (both_hands_used pr2)))
      (when (one_hand_used pr2) (not (one_hand_used pr2)))))

  ; Turn a knob on or off: a tap fills what is on the sink, a burner heats what is on it.
  (:action turn
    :parameters (?k - knob)
    :precondition (exists (?x - thing) (and (reached_at ?k ?x) (near pr2 ?x)))
    :effect (and
      (forall (?x - thing ?s - switch) (when (and (works ?k ?x ?s) (not (is ?x ?s))) (is ?x ?s)))
      (forall (?x - thing ?s - switch) (when (and (works ?k ?x ?s) (is ?x ?s)) (not (is ?x ?s))))
      (forall (?x - thing ?v - item)
        (when (and (feeds ?k ?x) (not (is ?k tapison)) (at ?v ?x on) (declares ?v water)) (is ?v water)))
      (forall (?x - thing) (when (and (lights ?k ?x) (not (lit ?x))) (lit ?x)))
      (forall (?x - thing) (when (and (lights ?k ?x) (lit ?x)) (not (lit ?x))))
      (forall (?x - thing ?v - item)
        (when (and (lights ?k ?x) (not (lit ?x)) (at ?v ?x on)) (hot ?v)))
      (forall (?x - thing ?v - item)
        (when (and (lights ?k ?x) (not (lit ?x)) (at ?v ?x on) (is ?v water)) (boiling ?v)))))

  ; Press a button. The microwave starts only with its door closed and heats what is in it; the dispenser fills what
  ; is held.
  (:action press
    :parameters (?b - button)
    :precondition (and
      (or (reached_anywhere ?b)
          (exists (?x - thing)
            (and (reached_at ?b ?x) (near pr2 ?x) (or (not (needs_shut ?x)) (not (is ?x doorisopen))))))
      (or (worked_freely ?b) (exists (?x - thing) (and (worked_by ?b ?x) (holding pr2 ?x)))))
    :effect (and
      (forall (?x - thing ?s - switch) (when (and (works ?b ?x ?s) (not (is ?x ?s))) (is ?x ?s)))
      (forall (?x - thing ?s - switch) (when (and (works ?b ?x ?s) (is ?x ?s)) (not (is ?x ?s))))
      (forall (?x - thing ?v - item)
        (when (and (dispenses ?b ?x) (not (is ?x waterdispenserisopen)) (holding pr2 ?v) (declares ?v water))
          (is ?v water)))
      (forall (?x - thing ?v - item)
        (when (and (works ?b ?x microwaveison) (not (is ?x microwaveison)) (at ?v ?x in)) (hot ?v)))
      (forall (?x - thing ?v - item)
        (when (and (works ?b ?x microwaveison) (not (is ?x microwaveison)) (at ?v ?x in) (is ?v water))
          (boiling ?v)))
      (forall (?x - thing ?s - channel ?t - channel)
        (when (and (steps ?b ?x ?s ?t) (is ?x ison) (is ?x ?s)) (not (is ?x ?s))))
      (forall (?x - thing ?s - channel ?t - channel)
        (when (and (steps ?b ?x ?s ?t) (is ?x ison) (is ?x ?s)) (is ?x ?t)))
      (forall (?x - thing) (when (and (raises ?b ?x) (is ?x ison)) (is ?x volume)))
      (forall (?x - thing) (when (and (lowers ?b ?x) (is ?x ison)) (not (is ?x volume))))))

  ; Open a closed door one stands at, or the closed bag one holds. What is behind the door can be taken then.
  (:action open
    :parameters (?d - thing)
    :precondition (or
      (exists (?x - thing ?s - doorstate)
        (and (swings ?d ?x ?s) (reached_at ?d ?x) (near pr2 ?x) (not (is ?x ?s))))
      (and (opened_in_hand ?d) (holding pr2 ?d) (not (is ?d isopen))))
    :effect (and
      (forall (?x - thing ?s - doorstate) (when (swings ?d ?x ?s) (is ?x ?s)))
      (forall (?x - thing ?s - switch) (when (stops ?d ?x ?s) (not (is ?x ?s))))
      (when (and (opened_in_hand ?d) (declares ?d isopen)) (is ?d isopen))
      (forall (?x - thing ?v - thing) (when (and (encloses ?d ?x) (at ?v ?x in)) (not (shut_away ?v))))))

  ; Close an open door one stands at. Behind the last one, things are shut away.
  (:action close
    :parameters (?d - door)
    :precondition (exists (?x - thing ?s - doorstate)
      (and (swings ?d ?x ?s) (reached_at ?d ?x) (near pr2 ?x) (is ?x ?s)))
    :effect (and
      (forall (?x - thing ?s - doorstate) (when (swings ?d ?x ?s) (not (is ?x ?s))))
      (forall (?x - thing ?v - thing)
        (when (and (only_door ?d) (encloses ?d ?x) (at ?v ?x in)) (shut_away ?v)))
      (forall (?x - thing ?v - thing ?s - doorstate)
        (when (and (twin_door ?d ?s) (encloses ?d ?x) (not (is ?x ?s)) (at ?v ?x in)) (shut_away ?v)))))

  ; Empty a held thing, into the sink or on the floor.
  (:action pour_out
    :parameters (?x - item)
    :precondition (holding pr2 ?x)
    :effect (and
      (forall (?s - content) (not (is ?x ?s)))
      (not (boiling ?x))))

  ; Pour from one held thing into another one. The first is empty then.
  (:action pour
    :parameters (?x - item ?y - item)
    :precondition (and (holding pr2 ?x) (holding pr2 ?y) (not (= ?x ?y)))
    :effect (and
      (forall (?s - content) (when (and (is ?x ?s) (declares ?y ?s)) (is ?y ?s)))
      (forall (?s - content) (not (is ?x ?s)))
      (when (and (boiling ?x) (declares ?y water)) (boiling ?y))
      (when (and (boiling ?x) (declares ?y water)) (hot ?y))
      (not (boiling ?x))))

  ; Add salt, noodles or an egg to a held thing. Noodles and eggs leave the hand.
  (:action add
    :parameters (?a - additive ?y - item)
    :precondition (and (holding pr2 ?a) (holding pr2 ?y) (not (= ?a ?y)))
    :effect (and
      (forall (?s - content) (when (and (yields ?a ?s) (declares ?y ?s)) (is ?y ?s)))
      (when (goes_whole ?a) (not (holding pr2 ?a)))
      (when (goes_whole ?a) (at ?a ?y in))
      (when (goes_whole ?a) (one_hand_used pr2))
      (when (goes_whole ?a) (not (both_hands_used pr2)))))

  ; Take a scoop on the spoon from what has scoops left.
  (:action scoopfrom
    :parameters (?x - scooper ?y - item)
    :precondition (and (holding pr2 ?x) (holding pr2 ?y) (not (= ?x ?y)) (is ?y scoopsleft))
    :effect (when (declares ?x scoopsleft) (is ?x scoopsleft)))

  ; Add the scoop on the spoon to a thing in reach.
  (:action scoopto
    :parameters (?x - scooper ?y - item)
    :precondition (and
      (holding pr2 ?x)
      (is ?x scoopsleft)
      (not (= ?x ?y))
      (or (holding pr2 ?y) (and (near pr2 ?y) (not (shut_away ?y)))))
    :effect (and
      (when (declares ?y icecream) (is ?y icecream))
      (not (is ?x scoopsleft))))

  ; Squeeze syrup of either flavour from one held thing on another one.
  (:action squeeze
    :parameters (?x - item ?y - item)
    :precondition (and (holding pr2 ?x) (holding pr2 ?y) (not (= ?x ?y)) (squeezable ?x))
    :effect (and
      (when (and (is ?x chocolate) (declares ?y chocolate)) (is ?y chocolate))
      (when (and (is ?x vanilla) (declares ?y vanilla)) (is ?y vanilla))))

  ; Put a disc into a held device whose slot is empty.
  (:action insert
    :parameters (?x - item ?y - item)
    :precondition (and
      (is ?x cd) (holding pr2 ?x) (holding pr2 ?y) (not (= ?x ?y)) (declares ?y cd) (not (is ?y cd)))
    :effect (and
      (is ?y cd)
      (not (holding pr2 ?x))
      (at ?x ?y in)
      (one_hand_used pr2)
      (not (both_hands_used pr2))))

  ; Do nothing. The effect says so at length, because some tools lose an action that has none.
  (:action wait
    :parameters ()
    :precondition (and)
    :effect (forall (?x - thing) (when (near pr2 ?x) (near pr2 ?x))))
)
