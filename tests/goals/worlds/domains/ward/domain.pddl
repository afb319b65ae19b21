; A hospital ward with a service robot. It has one gripper, drives from room to room, carries and hands over things,
; opens and locks doors and cupboards, switches devices, disinfects, strips and makes beds.
;
; Medicines are handed to a patient only after a scan, and only to the one they were prescribed for; sharps go into a
; sharps box and stay there; what is infectious comes near no clean room and no supplies; a machine that keeps somebody
; alive is not switched off; of two interlocked doors one is always closed.

(define (domain ward)
  (:requirements :strips :typing :negative-preconditions :disjunctive-preconditions :equality
                 :existential-preconditions :universal-preconditions :conditional-effects)

  (:types
    room thing - object
    corridor station bay pharmacy sluice kitchen storeroom single-room anteroom - room
    person piece - thing
    patient nurse doctor - person
    fixture item - piece
    surface closable device basin dock - fixture
    bed desk nightstand cart worktop - surface
    door container - closable
    cupboard fridge hamper sharps-box bin - container
    lamp monitor ventilator pump scanner television - device
    medicine linen keycard spray meal sample chart needle instrument drink - item
    sheet blanket pillow - linen
    jug cup - drink
  )

  (:predicates
    ; --- the robot
    (robot-in ?r - room)
    (holding ?i - item)
    (gripper-free)
    (gripper-soiled)                               ; it has touched something infectious or used bedding
    (charged)                                      ; the battery is full
    ; --- where things and people are
    (located ?t - thing ?r - room)
    (on-top ?i - item ?s - surface)
    (stored-in ?i - item ?c - container)
    (lies-in ?p - patient ?b - piece)
    (spread-on ?l - sheet ?b - bed)
    (delivered-to ?i - item ?p - person)
    ; --- what changes
    (opened ?g - closable)
    (locked ?g - closable)
    (powered ?d - piece)
    (disinfected ?x - piece)
    (made-up ?b - bed)
    (fresh ?l - sheet)                             ; l was not slept on since it was washed
    (scanned ?i - item)
    (infectious ?x - piece)
    ; --- what never changes
    (adjoins ?a - room ?b - room)                  ; no door between a and b
    (leads ?d - door ?a - room ?b - room)
    (interlocked ?d - closable ?e - closable)
    (fits ?k - keycard ?g - closable)
    (clean-zone ?r - room)
    (prescribed-for ?i - item ?p - person)
    (drug ?i - item)
    (controlled ?i - item)                         ; never left lying about
    (licensed ?p - person)                         ; may be given any drug
    (edible ?i - item)
    (fasting ?p - person)
    (sharp ?i - item)
    (sharps-safe ?c - container)
    (for-supplies ?c - container)
    (needs-cold ?i - item)
    (chilled ?c - container)
    (bulky ?i - item)
    (hazardous ?i - item)                          ; not for patients
    (faulty ?d - device)
    (keeps-alive ?d - device ?p - patient)
  )

  ; Drive to the next room. Nothing infectious and no soiled gripper comes into a clean room.
  (:action drive
    :parameters (?a - room ?b - room)
    :precondition (and (robot-in ?a)
      (or (adjoins ?a ?b) (exists (?d - door) (and (leads ?d ?a ?b) (opened ?d))))
      (or (not (clean-zone ?b))
          (and (not (gripper-soiled)) (forall (?i - item) (or (not (holding ?i)) (not (infectious ?i)))))))
    :effect (and (robot-in ?b) (not (robot-in ?a))))

  ; Push a cart with all that is on it to the next room; that takes a full battery.
  (:action push
    :parameters (?c - cart ?a - room ?b - room)
    :precondition (and (robot-in ?a) (located ?c ?a) (gripper-free) (charged)
      (or (adjoins ?a ?b) (exists (?d - door) (and (leads ?d ?a ?b) (opened ?d))))
      (or (not (clean-zone ?b))
          (and (not (gripper-soiled)) (forall (?i - item) (or (not (on-top ?i ?c)) (not (infectious ?i)))))))
    :effect (and (robot-in ?b) (not (robot-in ?a)) (located ?c ?b) (not (located ?c ?a))
      (forall (?i - item) (when (on-top ?i ?c) (and (located ?i ?b) (not (located ?i ?a)))))))

  ; Take something that lies here or is in an open container; never out of a sharps box.
  (:action pick-up
    :parameters (?i - item ?r - room)
    :precondition (and (robot-in ?r) (located ?i ?r) (gripper-free)
      (forall (?c - container) (or (not (stored-in ?i ?c)) (and (opened ?c) (not (sharps-safe ?c))))))
    :effect (and (holding ?i) (not (gripper-free)) (not (located ?i ?r))
      (forall (?s - surface) (not (on-top ?i ?s)))
      (forall (?c - container) (not (stored-in ?i ?c)))
      (when (infectious ?i) (gripper-soiled))))

  ; Put something on a bed, a desk, a cart, ... Sharps and controlled drugs are not left lying.
  (:action put-on
    :parameters (?i - item ?s - surface ?r - room)
    :precondition (and (holding ?i) (robot-in ?r) (located ?s ?r) (not (sharp ?i)) (not (controlled ?i)))
    :effect (and (on-top ?i ?s) (located ?i ?r) (not (holding ?i)) (gripper-free)
      (when (infectious ?i) (not (disinfected ?s)))))

  (:action put-in
    :parameters (?i - item ?c - container ?r - room)
    :precondition (and (holding ?i) (robot-in ?r) (located ?c ?r) (opened ?c) (not (bulky ?i))
      (or (not (sharp ?i)) (sharps-safe ?c))
      (or (sharp ?i) (not (sharps-safe ?c)))
      (or (not (infectious ?i)) (not (for-supplies ?c)))
      (or (not (needs-cold ?i)) (chilled ?c)))
    :effect (and (stored-in ?i ?c) (located ?i ?r) (not (holding ?i)) (gripper-free)))

  ; Hand something over to a person.
  (:action deliver
    :parameters (?i - item ?p - person ?r - room)
    :precondition (and (holding ?i) (robot-in ?r) (located ?p ?r) (not (sharp ?i))
      (or (not (gripper-soiled)) (licensed ?p))
      (or (not (hazardous ?i)) (licensed ?p))
      (or (not (infectious ?i)) (licensed ?p))
      (or (not (drug ?i)) (licensed ?p) (and (scanned ?i) (prescribed-for ?i ?p)))
      (or (not (edible ?i)) (not (fasting ?p))))
    :effect (and (delivered-to ?i ?p) (not (holding ?i)) (gripper-free)))

  ; Read the bar code of what the gripper holds.
  (:action scan
    :parameters (?i - item ?s - scanner ?r - room)
    :precondition (and (holding ?i) (robot-in ?r) (located ?s ?r) (powered ?s))
    :effect (scanned ?i))

  (:action open
    :parameters (?g - closable ?r - room)
    :precondition (and (robot-in ?r) (located ?g ?r) (gripper-free) (not (locked ?g)) (not (opened ?g))
      (forall (?h - closable) (or (not (interlocked ?g ?h)) (not (opened ?h)))))
    :effect (opened ?g))

  (:action close
    :parameters (?g - closable ?r - room)
    :precondition (and (robot-in ?r) (located ?g ?r) (opened ?g))
    :effect (not (opened ?g)))

  (:action lock
    :parameters (?g - closable ?k - keycard ?r - room)
    :precondition (and (robot-in ?r) (located ?g ?r) (holding ?k) (fits ?k ?g) (not (opened ?g)) (not (locked ?g)))
    :effect (locked ?g))

  (:action unlock
    :parameters (?g - closable ?k - keycard ?r - room)
    :precondition (and (robot-in ?r) (located ?g ?r) (holding ?k) (fits ?k ?g) (locked ?g))
    :effect (not (locked ?g)))

  (:action switch-on
    :parameters (?d - device ?r - room)
    :precondition (and (robot-in ?r) (located ?d ?r) (not (powered ?d)) (not (faulty ?d)))
    :effect (powered ?d))

  (:action switch-off
    :parameters (?d - device ?r - room)
    :precondition (and (robot-in ?r) (located ?d ?r) (powered ?d)
      (forall (?p - patient) (not (keeps-alive ?d ?p))))
    :effect (not (powered ?d)))

  ; Spray and wipe: no bed with somebody in it, no device that is running, no sample.
  (:action disinfect
    :parameters (?x - piece ?s - spray ?r - room)
    :precondition (and (holding ?s) (robot-in ?r) (located ?x ?r) (not (powered ?x))
      (forall (?m - sample) (not (= ?m ?x)))
      (forall (?p - patient) (not (lies-in ?p ?x))))
    :effect (and (disinfected ?x) (not (infectious ?x))))

  ; Pull the sheet off an empty bed.
  (:action strip-bed
    :parameters (?b - bed ?l - sheet ?r - room)
    :precondition (and (robot-in ?r) (located ?b ?r) (spread-on ?l ?b) (gripper-free)
      (forall (?p - patient) (not (lies-in ?p ?b))))
    :effect (and (holding ?l) (not (gripper-free)) (not (spread-on ?l ?b)) (not (made-up ?b)) (not (fresh ?l))
      (gripper-soiled)))

  ; Make an empty, bare and disinfected bed with a fresh sheet.
  (:action make-bed
    :parameters (?b - bed ?l - sheet ?r - room)
    :precondition (and (robot-in ?r) (located ?b ?r) (holding ?l) (fresh ?l) (disinfected ?b) (not (gripper-soiled))
      (forall (?m - sheet) (not (spread-on ?m ?b)))
      (forall (?p - patient) (not (lies-in ?p ?b))))
    :effect (and (made-up ?b) (spread-on ?l ?b) (not (holding ?l)) (gripper-free)))

  ; Wash the gripper at a basin.
  (:action wash-gripper
    :parameters (?w - basin ?r - room)
    :precondition (and (robot-in ?r) (located ?w ?r) (gripper-free))
    :effect (not (gripper-soiled)))

  (:action recharge
    :parameters (?d - dock ?r - room)
    :precondition (and (robot-in ?r) (located ?d ?r))
    :effect (charged))
)
