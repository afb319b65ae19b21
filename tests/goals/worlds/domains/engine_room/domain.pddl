; The engine room of a ship: compartments joined by doors, machines, valves, tanks, and one engineer who can carry one
; thing at a time (what is worn does not count).
;
; Nobody enters a compartment with a loud machine running unless ears are covered. A machine starts when everything that
; feeds it is open, its source of power runs, and its filter, if it takes one, is in place and clean. Hot machines do not
; start above an oily deck, and what burns is kept away from them. Liquids go from tank to tank of the same kind through a
; hose; oil and fuel are never drained into the bilge. Of two interlocked doors only one can be open.

(define (domain engine_room)
  (:requirements :strips :typing :equality :negative-preconditions :disjunctive-preconditions
                 :existential-preconditions :universal-preconditions :conditional-effects)

  (:types
    compartment fixture movable fluid - object
    crew item - movable
    tool gear filter hose key consumable - item
    wrench torch mop oil_can - tool
    ear_defenders gloves goggles - gear
    paint_tin rag gasket - consumable
    barrier valve storage machine tank basin - fixture
    door hatch - barrier
    locker bench rack bin hook - storage
    engine generator pump purifier boiler fan lamp alarm - machine)

  (:constants
    fuel lube_oil fresh_water sea_water - fluid)

  (:predicates
    ; positions
    (at ?x - movable ?c - compartment)
    (carrying ?e - crew ?i - item)
    (free_handed ?e - crew)
    (wearing ?e - crew ?g - gear)
    (stowed ?i - item ?s - storage)          ; in a locker or bin, on a bench, rack or hook
    (sited ?x - fixture ?c - compartment)
    (joins ?d - barrier ?a - compartment ?b - compartment)
    ; doors, lids, valves
    (openable ?x - fixture)
    (opened ?x - fixture)
    (locked ?x - fixture)
    (key_to ?k - key ?x - fixture)
    (interlocked ?d - fixture ?o - fixture)
    (scalding ?v - fixture)                   ; not to be touched with bare hands
    ; machines
    (running ?m - machine)
    (loud ?m - machine)
    (hot ?m - machine)
    (vital ?m - machine)                     ; may stop only while a standby runs
    (standby ?b - machine ?m - machine)
    (powered_by ?m - machine ?g - machine)
    (supplies ?v - fixture ?m - machine)
    (takes_filter ?m - machine)
    (fitted ?f - filter ?m - machine)
    (clogged ?f - filter)
    (flammable ?i - item)
    (oily ?c - compartment)                  ; oil on the deck
    ; tanks; neither full nor empty is in between
    (holds ?t - tank ?f - fluid)
    (full ?t - tank)
    (empty ?t - tank)
    (cracked ?t - tank)
    (pollutes ?f - fluid)
    (handles ?p - pump ?f - fluid)
    (suits ?h - hose ?f - fluid)
    (linked ?h - hose ?s - tank ?t - tank))

  (:action move
    :parameters (?e - crew ?a - compartment ?b - compartment ?d - barrier)
    :precondition (and (at ?e ?a) (joins ?d ?a ?b) (opened ?d)
      (or (exists (?g - ear_defenders) (wearing ?e ?g))
          (forall (?m - machine) (or (not (loud ?m)) (not (sited ?m ?b)) (not (running ?m)))))
      (forall (?i - item ?m - machine)
        (or (not (flammable ?i)) (not (carrying ?e ?i)) (not (hot ?m)) (not (sited ?m ?b)) (not (running ?m)))))
    :effect (and (at ?e ?b) (not (at ?e ?a))))

  ; Doors, hatches, lockers and valves.
  (:action open
    :parameters (?e - crew ?x - fixture ?c - compartment)
    :precondition (and (at ?e ?c) (sited ?x ?c) (openable ?x) (not (opened ?x)) (not (locked ?x))
      (forall (?o - barrier) (or (not (interlocked ?x ?o)) (not (opened ?o))))
      (or (not (scalding ?x)) (exists (?g - gloves) (wearing ?e ?g))))
    :effect (opened ?x))

  ; A valve that feeds a running machine stays open.
  (:action close
    :parameters (?e - crew ?x - fixture ?c - compartment)
    :precondition (and (at ?e ?c) (sited ?x ?c) (openable ?x) (opened ?x)
      (forall (?m - machine) (or (not (supplies ?x ?m)) (not (running ?m))))
      (or (not (scalding ?x)) (exists (?g - gloves) (wearing ?e ?g))))
    :effect (not (opened ?x)))

  (:action unlock
    :parameters (?e - crew ?x - fixture ?k - key ?c - compartment)
    :precondition (and (at ?e ?c) (sited ?x ?c) (key_to ?k ?x) (carrying ?e ?k) (locked ?x))
    :effect (not (locked ?x)))

  (:action lock
    :parameters (?e - crew ?x - fixture ?k - key ?c - compartment)
    :precondition (and (at ?e ?c) (sited ?x ?c) (key_to ?k ?x) (carrying ?e ?k) (not (locked ?x)) (not (opened ?x)))
    :effect (locked ?x))

  (:action take
    :parameters (?e - crew ?i - item ?s - storage ?c - compartment)
    :precondition (and (at ?e ?c) (sited ?s ?c) (stowed ?i ?s) (free_handed ?e)
      (or (not (openable ?s)) (opened ?s)))
    :effect (and (carrying ?e ?i) (not (free_handed ?e)) (not (stowed ?i ?s)) (not (at ?i ?c))))

  ; What burns is never left in a compartment with a hot machine.
  (:action stow
    :parameters (?e - crew ?i - item ?s - storage ?c - compartment)
    :precondition (and (at ?e ?c) (sited ?s ?c) (carrying ?e ?i)
      (or (not (openable ?s)) (opened ?s))
      (forall (?m - machine) (or (not (flammable ?i)) (not (hot ?m)) (not (sited ?m ?c)))))
    :effect (and (stowed ?i ?s) (at ?i ?c) (free_handed ?e) (not (carrying ?e ?i))))

  (:action don
    :parameters (?e - crew ?g - gear)
    :precondition (carrying ?e ?g)
    :effect (and (wearing ?e ?g) (free_handed ?e) (not (carrying ?e ?g))))

  (:action doff
    :parameters (?e - crew ?g - gear ?c - compartment)
    :precondition (and (wearing ?e ?g) (free_handed ?e) (at ?e ?c)
      (forall (?m - machine) (or (not (loud ?m)) (not (sited ?m ?c)) (not (running ?m)))))
    :effect (and (carrying ?e ?g) (not (wearing ?e ?g)) (not (free_handed ?e))))

  (:action start
    :parameters (?e - crew ?m - machine ?c - compartment)
    :precondition (and (at ?e ?c) (sited ?m ?c) (not (running ?m))
      (forall (?v - valve) (or (not (supplies ?v ?m)) (opened ?v)))
      (forall (?g - generator) (or (not (powered_by ?m ?g)) (running ?g)))
      (or (not (takes_filter ?m)) (exists (?f - filter) (and (fitted ?f ?m) (not (clogged ?f)))))
      (or (not (loud ?m)) (exists (?g - ear_defenders) (wearing ?e ?g)))
      (or (not (hot ?m)) (not (oily ?c))))
    :effect (running ?m))

  ; A generator stops when nothing hangs on it any more.
  (:action stop
    :parameters (?e - crew ?m - machine ?c - compartment)
    :precondition (and (at ?e ?c) (sited ?m ?c) (running ?m)
      (forall (?x - machine) (or (not (powered_by ?x ?m)) (not (running ?x))))
      (or (not (vital ?m)) (exists (?b - machine) (and (standby ?b ?m) (running ?b)))))
    :effect (not (running ?m)))

  ; Connect two tanks of the same kind with a hose.
  (:action couple
    :parameters (?e - crew ?h - hose ?s - tank ?t - tank ?f - fluid ?c - compartment)
    :precondition (and (at ?e ?c) (carrying ?e ?h) (suits ?h ?f) (sited ?s ?c) (sited ?t ?c) (not (= ?s ?t)) (holds ?s ?f) (holds ?t ?f))
    :effect (and (linked ?h ?s ?t) (at ?h ?c) (free_handed ?e) (not (carrying ?e ?h))))

  (:action uncouple
    :parameters (?e - crew ?h - hose ?s - tank ?t - tank ?c - compartment)
    :precondition (and (at ?e ?c) (at ?h ?c) (linked ?h ?s ?t) (free_handed ?e))
    :effect (and (carrying ?e ?h) (not (linked ?h ?s ?t)) (not (at ?h ?c)) (not (free_handed ?e))))

  ; Fill tank t from tank s.
  (:action transfer
    :parameters (?e - crew ?p - pump ?h - hose ?s - tank ?t - tank ?f - fluid ?c - compartment)
    :precondition (and (at ?e ?c) (sited ?p ?c) (sited ?s ?c) (running ?p) (handles ?p ?f) (linked ?h ?s ?t) (holds ?s ?f)
      (not (empty ?s)) (not (full ?t)) (not (cracked ?t)))
    :effect (and (full ?t) (not (empty ?t)) (not (full ?s))
      (when (not (full ?s)) (empty ?s))))

  ; Let a tank run out into the bilge.
  (:action drain
    :parameters (?e - crew ?t - tank ?f - fluid ?c - compartment)
    :precondition (and (at ?e ?c) (sited ?t ?c) (holds ?t ?f) (not (pollutes ?f)) (not (empty ?t)))
    :effect (and (empty ?t) (not (full ?t))))

  (:action fit
    :parameters (?e - crew ?f - filter ?m - machine ?c - compartment)
    :precondition (and (at ?e ?c) (sited ?m ?c) (carrying ?e ?f) (takes_filter ?m) (not (running ?m))
      (forall (?o - filter) (not (fitted ?o ?m))))
    :effect (and (fitted ?f ?m) (at ?f ?c) (free_handed ?e) (not (carrying ?e ?f))))

  (:action remove
    :parameters (?e - crew ?f - filter ?m - machine ?c - compartment)
    :precondition (and (at ?e ?c) (sited ?m ?c) (fitted ?f ?m) (free_handed ?e) (not (running ?m)))
    :effect (and (carrying ?e ?f) (not (fitted ?f ?m)) (not (at ?f ?c)) (not (free_handed ?e))))

  (:action wash
    :parameters (?e - crew ?f - filter ?b - basin ?c - compartment)
    :precondition (and (at ?e ?c) (sited ?b ?c) (carrying ?e ?f) (clogged ?f))
    :effect (not (clogged ?f)))

  (:action mop_up
    :parameters (?e - crew ?m - mop ?c - compartment)
    :precondition (and (at ?e ?c) (carrying ?e ?m) (oily ?c))
    :effect (not (oily ?c)))
)
