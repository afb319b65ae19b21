; A bicycle repair workshop. One mechanic carries one thing at a time (a bike is wheeled along, with all that is mounted
; on it) and walks between a few rooms.
;
; Parts go on and off a bike that is clamped in a stand, and come off only when their bolt is loose; batteries and chains
; click on and off anywhere. A punctured wheel is patched on a workbench before it holds air. The parts washer runs only
; with its lid down, and nothing electric goes into it. A swollen battery never meets the charger, solvent is kept on or
; in metal only, and a bike is not handed over with a loose bolt, a soft tyre or a part missing.

(define (domain bikeshop)
  (:requirements :strips :typing :negative-preconditions :disjunctive-preconditions
                 :existential-preconditions :universal-preconditions :conditional-effects)

  (:types
    zone item position - object
    shop workroom storeroom outdoors - zone
    fitting movable - item
    door cabinet drawer parts_washer charger compressor lamp radio
      workbench counter shelf stand hook - fitting
    bike piece - movable                       ; pieces are all that is smaller than a bike
    tourer racer ebike kids_bike - bike
    part tool supply door_key helmet - piece
    wheel saddle chain battery - part
    wrench hex_key pump brush rag - tool
    oil_can patch_kit solvent - supply
  )

  (:constants
    front_fork rear_fork seat_post drive cradle - position
  )

  (:predicates
    ; the mechanic
    (mechanic_in ?z - zone)
    (carrying ?x - movable)
    (empty_handed)
    ; whereabouts
    (located ?x - item ?z - zone)              ; x is in the room z, not carried and not part of a bike
    (lying_on ?x - movable ?f - fitting)
    (stowed_in ?x - movable ?f - fitting)
    (hung_from ?x - movable ?h - hook)
    (parked ?b - movable ?z - zone)               ; b stands on its own wheels in z
    (clamped ?b - movable ?s - stand)
    (vacant ?f - fitting)                      ; no bike in the stand, nothing on the hook
    (mounted_on ?p - movable ?b - bike)
    ; conditions
    (tight ?p - part)                          ; the bolt of p is done up
    (inflated ?w - wheel)
    (punctured ?w - wheel)
    (oiled ?c - chain)
    (grimy ?x - movable)
    (charged ?x - battery)
    (closed ?f - fitting)
    (locked ?f - fitting)
    (powered ?f - fitting)                     ; it is switched on
    ; given once and for all
    (passage ?a - zone ?b - zone)
    (door_between ?d - door ?a - zone ?b - zone)
    (openable ?f - fitting)
    (key_for ?k - door_key ?f - fitting)
    (has_switch ?f - fitting)
    (has_top ?f - fitting)                     ; pieces can be laid on it
    (hollow ?f - fitting)                      ; pieces can be stowed in it
    (roomy ?f - fitting)                       ; even large ones
    (large ?x - piece)
    (hangable ?x - movable)
    (heavy ?b - movable)                       ; too heavy for a hook
    (fragile_frame ?b - bike)                  ; a clamp would crush the tube
    (goes_into ?p - part ?b - bike ?k - position)
    (required ?b - bike ?k - position)         ; no bike is handed over without a part there
    (tool_free ?p - part)                      ; clicks on and off
    (turns ?t - tool ?p - part)                ; t fits the bolt of p
    (cracked_rim ?w - wheel)
    (swollen ?x - battery)
    (cleans ?t - tool)
    (caked ?x - movable)                       ; the dirt is too hard for a brush
    (washes ?f - fitting)
    (charges ?f - fitting)
    (electric ?x - piece)
    (flammable ?x - piece)
    (fireproof ?f - fitting)
    (kept_clean ?f - fitting)                  ; nothing grimy is laid there
    (handover ?z - zone)                       ; customers collect their bikes there
  )

  ; Walk to the next room, if no door in between is closed.
  (:action go
    :parameters (?a - zone ?b - zone)
    :precondition (and (mechanic_in ?a) (passage ?a ?b)
      (forall (?d - door) (or (not (door_between ?d ?a ?b)) (not (closed ?d)))))
    :effect (and (mechanic_in ?b) (not (mechanic_in ?a))))

  ; An elbow will do for that. The lid of a running washer stays down.
  (:action open_up
    :parameters (?f - fitting ?z - zone)
    :precondition (and (mechanic_in ?z) (located ?f ?z) (openable ?f) (closed ?f) (not (locked ?f)) (not (powered ?f)))
    :effect (not (closed ?f)))

  (:action close_up
    :parameters (?f - fitting ?z - zone)
    :precondition (and (mechanic_in ?z) (located ?f ?z) (openable ?f) (not (closed ?f)))
    :effect (closed ?f))

  ; Locks what is unlocked and unlocks what is locked.
  (:action turn_key
    :parameters (?k - door_key ?f - fitting ?z - zone)
    :precondition (and (mechanic_in ?z) (located ?f ?z) (carrying ?k) (key_for ?k ?f) (closed ?f))
    :effect (and (when (locked ?f) (not (locked ?f))) (when (not (locked ?f)) (locked ?f))))

  ; Take something off its shelf, hook or stand, or out of an open drawer; or take hold of a bike.
  (:action take_up
    :parameters (?x - movable ?z - zone)
    :precondition (and (mechanic_in ?z) (located ?x ?z) (empty_handed)
      (forall (?f - fitting) (or (not (stowed_in ?x ?f)) (and (not (closed ?f)) (not (powered ?f))))))
    :effect (and (carrying ?x) (not (empty_handed)) (not (located ?x ?z)) (not (parked ?x ?z))
      (forall (?f - fitting) (and (not (lying_on ?x ?f)) (not (stowed_in ?x ?f))))
      (forall (?h - hook) (when (hung_from ?x ?h) (and (vacant ?h) (not (hung_from ?x ?h)))))
      (forall (?s - stand) (when (clamped ?x ?s) (and (vacant ?s) (not (clamped ?x ?s)))))))

  (:action lay_down
    :parameters (?x - piece ?f - fitting ?z - zone)
    :precondition (and (mechanic_in ?z) (located ?f ?z) (carrying ?x) (has_top ?f)
      (or (not (grimy ?x)) (not (kept_clean ?f)))
      (or (not (flammable ?x)) (fireproof ?f)))
    :effect (and (lying_on ?x ?f) (located ?x ?z) (empty_handed) (not (carrying ?x))))

  (:action stow
    :parameters (?x - piece ?f - fitting ?z - zone)
    :precondition (and (mechanic_in ?z) (located ?f ?z) (carrying ?x) (hollow ?f) (not (closed ?f)) (not (powered ?f))
      (or (not (large ?x)) (roomy ?f))
      (or (not (flammable ?x)) (fireproof ?f))
      (or (not (electric ?x)) (not (washes ?f)))
      (or (not (charges ?f)) (exists (?c - battery) (and (carrying ?c) (not (swollen ?c))))))
    :effect (and (stowed_in ?x ?f) (located ?x ?z) (empty_handed) (not (carrying ?x))))

  (:action hang_up
    :parameters (?x - movable ?h - hook ?z - zone)
    :precondition (and (mechanic_in ?z) (located ?h ?z) (carrying ?x) (vacant ?h) (hangable ?x) (not (heavy ?x)))
    :effect (and (hung_from ?x ?h) (located ?x ?z) (empty_handed) (not (vacant ?h)) (not (carrying ?x))))

  ; Where customers collect their bikes, only a bike that can be ridden is left.
  (:action park
    :parameters (?b - bike ?z - zone)
    :precondition (and (mechanic_in ?z) (carrying ?b)
      (or (not (handover ?z)) (and
        (forall (?p - part) (or (not (mounted_on ?p ?b)) (tight ?p) (tool_free ?p)))
        (forall (?w - wheel) (or (not (mounted_on ?w ?b)) (inflated ?w)))
        (forall (?k - position) (or (not (required ?b ?k))
          (exists (?p - part) (and (goes_into ?p ?b ?k) (mounted_on ?p ?b))))))))
    :effect (and (parked ?b ?z) (located ?b ?z) (empty_handed) (not (carrying ?b))))

  (:action clamp
    :parameters (?b - bike ?s - stand ?z - zone)
    :precondition (and (mechanic_in ?z) (located ?s ?z) (carrying ?b) (vacant ?s) (not (fragile_frame ?b)))
    :effect (and (clamped ?b ?s) (located ?b ?z) (empty_handed) (not (vacant ?s)) (not (carrying ?b))))

  (:action mount
    :parameters (?p - part ?b - bike ?k - position ?z - zone)
    :precondition (and (mechanic_in ?z) (located ?b ?z) (carrying ?p) (goes_into ?p ?b ?k)
      (or (tool_free ?p) (exists (?s - stand) (clamped ?b ?s)))
      (forall (?q - part) (or (not (goes_into ?q ?b ?k)) (not (mounted_on ?q ?b)))))
    :effect (and (mounted_on ?p ?b) (empty_handed) (not (carrying ?p))))

  (:action detach
    :parameters (?p - part ?b - bike ?z - zone)
    :precondition (and (mechanic_in ?z) (located ?b ?z) (empty_handed) (mounted_on ?p ?b) (not (tight ?p))
      (or (tool_free ?p) (exists (?s - stand) (clamped ?b ?s))))
    :effect (and (carrying ?p) (not (mounted_on ?p ?b)) (not (empty_handed))))

  (:action tighten
    :parameters (?p - part ?b - bike ?t - tool ?z - zone)
    :precondition (and (mechanic_in ?z) (located ?b ?z) (mounted_on ?p ?b) (carrying ?t) (turns ?t ?p) (not (tight ?p)))
    :effect (tight ?p))

  (:action loosen
    :parameters (?p - part ?b - bike ?t - tool ?z - zone)
    :precondition (and (mechanic_in ?z) (located ?b ?z) (mounted_on ?p ?b) (carrying ?t) (turns ?t ?p) (tight ?p))
    :effect (not (tight ?p)))

  ; With a pump, or with the hose of a running compressor. A cracked rim would burst.
  (:action inflate
    :parameters (?w - wheel ?z - zone)
    :precondition (and (mechanic_in ?z) (not (inflated ?w)) (not (punctured ?w)) (not (cracked_rim ?w))
      (or (located ?w ?z) (exists (?b - bike) (and (mounted_on ?w ?b) (located ?b ?z))))
      (or (exists (?t - pump) (carrying ?t))
          (and (empty_handed) (exists (?c - compressor) (and (located ?c ?z) (powered ?c))))))
    :effect (inflated ?w))

  (:action patch
    :parameters (?w - wheel ?f - workbench ?t - patch_kit ?z - zone)
    :precondition (and (mechanic_in ?z) (located ?f ?z) (lying_on ?w ?f) (carrying ?t) (punctured ?w))
    :effect (not (punctured ?w)))

  ; Oil on dirt makes paste: a grimy chain is cleaned before.
  (:action oil
    :parameters (?c - chain ?o - oil_can ?z - zone)
    :precondition (and (mechanic_in ?z) (carrying ?o) (not (grimy ?c))
      (exists (?b - bike) (and (mounted_on ?c ?b) (located ?b ?z))))
    :effect (oiled ?c))

  (:action scrub
    :parameters (?x - movable ?t - tool ?z - zone)
    :precondition (and (mechanic_in ?z) (carrying ?t) (cleans ?t) (grimy ?x) (not (caked ?x))
      (or (located ?x ?z) (exists (?b - bike) (and (mounted_on ?x ?b) (located ?b ?z)))))
    :effect (not (grimy ?x)))

  ; On or off. The washer cleans what is in it, and takes the oil off too; the charger charges what is in it.
  (:action flip_switch
    :parameters (?f - fitting ?z - zone)
    :precondition (and (mechanic_in ?z) (located ?f ?z) (has_switch ?f)
      (or (powered ?f) (not (openable ?f)) (closed ?f)))
    :effect (and
      (when (powered ?f) (not (powered ?f)))
      (when (not (powered ?f)) (powered ?f))
      (forall (?x - piece) (when (and (washes ?f) (not (powered ?f)) (stowed_in ?x ?f)) (not (grimy ?x))))
      (forall (?c - chain) (when (and (washes ?f) (not (powered ?f)) (stowed_in ?c ?f)) (not (oiled ?c))))
      (forall (?c - battery) (when (and (charges ?f) (not (powered ?f)) (stowed_in ?c ?f)) (charged ?c)))))
)
