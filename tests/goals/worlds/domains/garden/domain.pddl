; A garden with a shed, a greenhouse or a fenced plot. Plain PDDL: no object graphs, nothing compiled.
;
; The gardener has two hands and stands in one area at a time. A shed or a fenced plot is entered only when it is
; unlatched; what is in a latched chest cannot be reached. Seeds need a bed that was dug. A watering can waters two beds
; and is filled at a running tap or from a butt, which runs out. Tough stalks are cut with something sharp. Petrol and a
; naked flame never come together, petrol never gets into the greenhouse, and poison never among what one eats.

(define (domain garden)
  (:requirements :strips :typing :negative-preconditions :disjunctive-preconditions :equality
                 :existential-preconditions :universal-preconditions :conditional-effects)

  (:types
    place hand stuff amount - object
    area thing - place
    ground enclosure - area               ; enclosures are entered through a door or gate
    lane terrace kitchen_garden - ground
    shed greenhouse plot - enclosure
    fixture portable - thing              ; fixtures stay where they are, portables can be carried
    surface chest bed source device heap grindstone scarecrow - fixture
    shelf bench table - surface
    butt - source
    tap sprinkler light heater - device   ; all of these have a valve or a switch
    tool vessel carrier barrow seeds crop jug - portable
    spade fork rake trowel knife - tool
    watering_can - vessel
    basket crate - carrier
    tomato pumpkin - crop
    petrol_can weedkiller - jug
  )

  (:constants
    left_hand right_hand - hand
    empty half full - amount
    manure weeds - stuff
  )

  (:predicates
    ; --- the gardener
    (standing_in ?a - area)                   ; the gardener is in a
    (in_hand ?x - portable ?h - hand)         ; x is carried in h
    (spare ?h - hand)                         ; nothing is in h
    ; --- where things are
    (in_area ?x - place ?a - area)            ; x is somewhere in a, wherever there
    (inside ?x - portable ?y - place)         ; x is in the container y, or on the floor of the enclosure y
    (resting_on ?x - portable ?y - place)     ; x lies or stands on y
    ; --- what changes
    (gate_open ?x - place)                    ; the door, gate or lid of x is unlatched and open
    (dug ?b - bed)                            ; the soil of b is loose
    (soil_wet ?b - fixture)                   ; b was watered
    (planted ?s - seeds ?b - bed)             ; s was sown in b
    (growing_in ?c - crop ?b - bed)           ; c is still on its stalk in b
    (picked ?c - crop)                        ; c was harvested
    (level ?x - place ?l - amount)            ; how much water there is in a can or a butt
    (running ?d - fixture)                    ; water comes out of d
    (lit ?d - device)                         ; d burns or shines
    (sharp ?t - tool)                         ; t has an edge
    (loaded_with ?b - portable ?s - stuff)    ; there is s in the barrow
    (heaped_on ?s - stuff ?y - fixture)       ; there is s on the bed or heap y
    ; --- what never changes
    (path ?a - area ?b - area)                ; from a one gets to b
    (latchable ?x - place)                    ; x has a latch
    (latch_by ?x - place ?a - area)           ; the latch of x is worked from a
    (flat ?y - place)                         ; things can be put on y
    (hollow ?y - place)                       ; things can be put into y
    (ripe ?c - crop)                          ; c may be harvested
    (tough ?c - crop)                         ; c does not come off by hand
    (cuts ?t - tool)                          ; one can cut with t, when it is sharp
    (digs ?t - tool)                          ; one can dig with t
    (gives_water ?d - device)                 ; d is a tap or the like
    (gives_light ?d - device)                 ; d is a lamp or a heater
    (fills_cans ?w - fixture)                 ; when running, w fills a can
    (sprays ?d - device ?b - bed)             ; d, when it starts, wets b
    (bulky ?x - portable)                     ; x takes both hands
    (large ?x - portable)                     ; x fits into no basket and no chest
    (takes_load ?y - fixture)                 ; barrows and cans can be tipped out on y
    (inflammable ?x - portable)               ; keep x away from flames
    (naked_flame ?d - device)                 ; when lit, d burns with a flame
    (no_fuel ?y - place)                      ; nothing inflammable may be put there
    (poisonous ?x - portable)                 ; keep x away from food
    (for_food ?y - place)                     ; what one eats is kept in y
  )

  ; Go from one area to the next. A latched door or gate stops one, and petrol is not carried to where a flame burns.
  (:action walk_to
    :parameters (?from - area ?to - area)
    :precondition (and (standing_in ?from) (path ?from ?to)
      (or (not (latchable ?from)) (gate_open ?from))
      (or (not (latchable ?to)) (gate_open ?to))
      (forall (?x - portable ?h - hand ?d - device)
        (or (not (inflammable ?x)) (not (naked_flame ?d)) (not (in_area ?d ?to)) (not (lit ?d)) (not (in_hand ?x ?h)))))
    :effect (and (standing_in ?to) (not (standing_in ?from))))

  ; Undo a latch and open the door, gate or lid; that takes a hand.
  (:action unlatch
    :parameters (?x - place ?a - area ?h - hand)
    :precondition (and (standing_in ?a) (latch_by ?x ?a) (spare ?h) (not (gate_open ?x)))
    :effect (gate_open ?x))

  ; Shut the door, gate or lid and latch it.
  (:action latch
    :parameters (?x - place ?a - area ?h - hand)
    :precondition (and (standing_in ?a) (latch_by ?x ?a) (spare ?h) (gate_open ?x))
    :effect (not (gate_open ?x)))

  ; Take something that is here and not in a latched chest; with what is in it. Bulky things take both hands.
  (:action pick_up
    :parameters (?x - portable ?a - area ?h - hand)
    :precondition (and (standing_in ?a) (in_area ?x ?a) (spare ?h)
      (or (not (bulky ?x)) (forall (?g - hand) (spare ?g)))
      (forall (?c - chest) (or (not (inside ?x ?c)) (gate_open ?c))))
    :effect (and (in_hand ?x ?h) (not (spare ?h)) (not (in_area ?x ?a))
      (forall (?g - hand) (when (bulky ?x) (not (spare ?g))))
      (forall (?y - place) (and (not (inside ?x ?y)) (not (resting_on ?x ?y))))
      (forall (?z - portable) (when (inside ?z ?x) (not (in_area ?z ?a))))))

  ; Put something down on a table, a shelf, the ground, … Bulky things stand on the ground.
  (:action put_on
    :parameters (?x - portable ?y - place ?a - area ?h - hand)
    :precondition (and (in_hand ?x ?h) (standing_in ?a) (flat ?y)
      (or (= ?y ?a) (in_area ?y ?a))
      (or (not (inflammable ?x)) (and (not (no_fuel ?y)) (not (no_fuel ?a))
        (forall (?d - device) (or (not (naked_flame ?d)) (not (in_area ?d ?a)) (not (lit ?d))))))
      (or (not (poisonous ?x)) (not (for_food ?y)))
      (or (not (bulky ?x)) (= ?y ?a)))
    :effect (and (resting_on ?x ?y) (in_area ?x ?a) (not (in_hand ?x ?h)) (spare ?h)
      (forall (?g - hand) (when (bulky ?x) (spare ?g)))
      (forall (?z - portable) (when (inside ?z ?x) (in_area ?z ?a)))))

  ; Put something into a chest, a basket, the shed, … Large things go into a shed or a greenhouse only.
  (:action put_into
    :parameters (?x - portable ?y - place ?a - area ?h - hand)
    :precondition (and (in_hand ?x ?h) (standing_in ?a) (hollow ?y)
      (or (= ?y ?a) (in_area ?y ?a))
      (or (not (latchable ?y)) (gate_open ?y))
      (or (not (inflammable ?x)) (and (not (no_fuel ?y)) (not (no_fuel ?a))
        (forall (?d - device) (or (not (naked_flame ?d)) (not (in_area ?d ?a)) (not (lit ?d))))))
      (or (not (poisonous ?x)) (not (for_food ?y)))
      (or (not (large ?x)) (= ?y ?a)))
    :effect (and (inside ?x ?y) (in_area ?x ?a) (not (in_hand ?x ?h)) (spare ?h)
      (forall (?g - hand) (when (bulky ?x) (spare ?g)))
      (forall (?z - portable) (when (inside ?z ?x) (in_area ?z ?a)))))

  ; Turn the valve or the switch of d: it starts, or stops if it was going. No flame is lit beside petrol.
  (:action turn_knob
    :parameters (?d - device ?a - area ?h - hand)
    :precondition (and (standing_in ?a) (in_area ?d ?a) (spare ?h)
      (or (not (naked_flame ?d)) (lit ?d)
        (forall (?x - portable ?g - hand)
          (or (not (inflammable ?x)) (and (not (in_area ?x ?a)) (not (in_hand ?x ?g)))))))
    :effect (and
      (when (and (gives_water ?d) (not (running ?d))) (running ?d))
      (when (and (gives_water ?d) (running ?d)) (not (running ?d)))
      (forall (?b - bed) (when (and (sprays ?d ?b) (not (running ?d))) (soil_wet ?b)))
      (when (and (gives_light ?d) (not (lit ?d))) (lit ?d))
      (when (and (gives_light ?d) (lit ?d)) (not (lit ?d)))))

  ; Fill a can at a running tap, or from a butt, which has less in it then.
  (:action fill_can
    :parameters (?c - watering_can ?w - fixture ?a - area ?h - hand)
    :precondition (and (in_hand ?c ?h) (standing_in ?a) (in_area ?w ?a) (not (level ?c full))
      (or (and (fills_cans ?w) (running ?w)) (level ?w half) (level ?w full)))
    :effect (and (level ?c full) (not (level ?c half)) (not (level ?c empty))
      (when (level ?w full) (and (level ?w half) (not (level ?w full))))
      (when (level ?w half) (and (level ?w empty) (not (level ?w half))))))

  ; Water a bed with half of what a full can holds.
  (:action water_bed
    :parameters (?b - bed ?c - watering_can ?a - area ?h - hand)
    :precondition (and (in_hand ?c ?h) (standing_in ?a) (in_area ?b ?a) (not (level ?c empty)))
    :effect (and (soil_wet ?b)
      (when (level ?c full) (and (level ?c half) (not (level ?c full))))
      (when (level ?c half) (and (level ?c empty) (not (level ?c half))))))

  ; Dig a bed over; not where something grows or was sown.
  (:action dig
    :parameters (?b - bed ?t - tool ?a - area ?h - hand)
    :precondition (and (in_hand ?t ?h) (digs ?t) (standing_in ?a) (in_area ?b ?a) (not (dug ?b))
      (forall (?c - crop) (not (growing_in ?c ?b)))
      (forall (?s - seeds) (not (planted ?s ?b))))
    :effect (dug ?b))

  ; Sow in a bed that was dug and has nothing in it yet. The packet stays in the hand.
  (:action sow
    :parameters (?s - seeds ?b - bed ?a - area ?h - hand)
    :precondition (and (in_hand ?s ?h) (standing_in ?a) (in_area ?b ?a) (dug ?b)
      (forall (?c - crop) (not (growing_in ?c ?b)))
      (forall (?z - seeds) (not (planted ?z ?b))))
    :effect (planted ?s ?b))

  ; Take a ripe fruit off; a tough one with something sharp in the other hand.
  (:action harvest
    :parameters (?c - crop ?b - bed ?a - area ?h - hand)
    :precondition (and (growing_in ?c ?b) (standing_in ?a) (in_area ?b ?a) (ripe ?c) (spare ?h)
      (or (not (tough ?c)) (exists (?t - tool ?g - hand) (and (cuts ?t) (sharp ?t) (in_hand ?t ?g)))))
    :effect (and (picked ?c) (in_hand ?c ?h) (not (spare ?h)) (not (growing_in ?c ?b))))

  ; Grind an edge on a tool.
  (:action sharpen
    :parameters (?t - tool ?g - grindstone ?a - area ?h - hand)
    :precondition (and (in_hand ?t ?h) (standing_in ?a) (in_area ?g ?a) (not (sharp ?t)))
    :effect (sharp ?t))

  ; Tip out what is in a barrow or a can; water wets what it is tipped on.
  (:action empty_out
    :parameters (?x - portable ?y - fixture ?a - area ?h - hand)
    :precondition (and (in_hand ?x ?h) (standing_in ?a) (in_area ?y ?a) (takes_load ?y)
      (or (exists (?s - stuff) (loaded_with ?x ?s)) (level ?x half) (level ?x full)))
    :effect (and
      (forall (?s - stuff) (when (loaded_with ?x ?s) (and (heaped_on ?s ?y) (not (loaded_with ?x ?s)))))
      (when (level ?x half) (and (level ?x empty) (not (level ?x half)) (soil_wet ?y)))
      (when (level ?x full) (and (level ?x empty) (not (level ?x full)) (soil_wet ?y)))))
)
