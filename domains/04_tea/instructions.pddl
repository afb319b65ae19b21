; Making tea. The fourth step of the ladder: working one part acts on another, and things happen while one waits.

(define (domain tea)
  (:requirements :strips :typing :negative-preconditions :equality :existential-preconditions
                 :conditional-effects)

  (:types
    thing robot relation setting substance - object
    fixture item - thing            ; fixtures stay where they are, items can be carried
    furniture part - fixture        ; parts are vertices of an object graph
    vessel supply - item            ; supply: goods as they are bought
  )

  (:constants
    pr2 - robot
    on in - relation
    off high - setting
  )

  (:predicates
    ; --- the robot
    (near ?r - robot ?x - fixture)              ; x is within reach
    (holding ?r - robot ?x - item)              ; x is in the hand
    (free ?r - robot)                           ; nothing is in the hand
    ; --- the world as it changes
    (at ?x - thing ?y - fixture ?rel - relation) ; x is on or in y
    (set_to ?x - part ?s - setting)             ; the knob x stands at s
    (active ?x - part)                          ; the plate glows, the tap runs
    (contains ?x - vessel ?s - substance)       ; there is some s in x
    (hot ?x - vessel)                           ; what is in x is hot
    ; --- edges of the object graphs; they never change
    (part_of ?x - thing ?y - thing)             ; x is a part of y
    (controls ?x - part ?y - part)              ; turning x starts and stops y
    (heats ?x - part ?y - furniture)            ; x heats what stands on y
    (pours_into ?x - part ?y - furniture ?s - substance) ; x, when open, fills what stands in y with s
    ; --- what things are good for; these never change either
    (allows ?x - fixture ?rel - relation)       ; things can be put on or in x
    (offers ?x - part ?s - setting)             ; the knob x has this setting
    (idle ?s - setting)                         ; at this setting nothing works
    (holds ?x - supply ?s - substance)          ; x is a portion of s
  )

  ; Go and stand before x, or before what x is a part of, or is on or in; all the parts there come into reach.
  (:action moveto
    :parameters (?x - thing)
    :precondition (and)
    :effect (and
      (forall (?y - fixture) (not (near pr2 ?y)))
      (forall (?y - furniture) (when (= ?x ?y) (near pr2 ?y)))
      (forall (?y - furniture) (when (part_of ?x ?y) (near pr2 ?y)))
      (forall (?y - part) (when (part_of ?y ?x) (near pr2 ?y)))
      (forall (?y - part ?z - furniture) (when (and (part_of ?x ?z) (part_of ?y ?z)) (near pr2 ?y)))
      (forall (?y - furniture ?rel - relation) (when (at ?x ?y ?rel) (near pr2 ?y)))
      (forall (?y - part ?z - furniture ?rel - relation)
        (when (and (at ?x ?z ?rel) (part_of ?y ?z)) (near pr2 ?y)))))

  ; Take x from where it stands.
  (:action grasp
    :parameters (?x - item)
    :precondition (and (free pr2) (exists (?y - furniture ?rel - relation) (and (near pr2 ?y) (at ?x ?y ?rel))))
    :effect (and (holding pr2 ?x) (not (free pr2))
      (forall (?y - furniture ?rel - relation) (not (at ?x ?y ?rel)))))

  ; Put x on or in y. Under an open tap a vessel fills.
  (:action keep
    :parameters (?x - item ?y - furniture ?rel - relation)
    :precondition (and (holding pr2 ?x) (near pr2 ?y) (allows ?y ?rel))
    :effect (and
      (at ?x ?y ?rel) (free pr2) (not (holding pr2 ?x))
      (forall (?v - vessel ?p - part ?s - substance)
        (when (and (= ?v ?x) (= ?rel in) (pours_into ?p ?y ?s) (active ?p)) (contains ?v ?s)))))

  ; Turn the knob x to s. What it controls starts or stops, and a tap fills what stands under it.
  (:action turn
    :parameters (?x - part ?s - setting)
    :precondition (and (near pr2 ?x) (offers ?x ?s) (not (set_to ?x ?s)))
    :effect (and
      (forall (?t - setting) (not (set_to ?x ?t)))
      (set_to ?x ?s)
      (forall (?p - part) (when (and (controls ?x ?p) (not (idle ?s))) (active ?p)))
      (forall (?p - part) (when (and (controls ?x ?p) (idle ?s)) (not (active ?p))))
      (forall (?p - part ?y - furniture ?v - vessel ?w - substance)
        (when (and (controls ?x ?p) (not (idle ?s)) (pours_into ?p ?y ?w) (at ?v ?y in)) (contains ?v ?w)))))

  ; Give the stove its time: what stands on a glowing plate gets hot.
  (:action wait
    :parameters ()
    :precondition (and)
    :effect (forall (?v - vessel ?p - part ?y - furniture)
      (when (and (at ?v ?y on) (heats ?p ?y) (active ?p)) (hot ?v))))

  ; Pour what is in x into y. What is poured hot stays hot.
  (:action pour
    :parameters (?x - vessel ?y - vessel)
    :precondition (and (holding pr2 ?x) (exists (?z - furniture) (and (near pr2 ?z) (at ?y ?z on))))
    :effect (and
      (forall (?s - substance) (when (contains ?x ?s) (and (contains ?y ?s) (not (contains ?x ?s)))))
      (when (hot ?x) (and (hot ?y) (not (hot ?x))))))

  ; Put the portion x into the vessel y. The portion is gone.
  (:action add
    :parameters (?x - supply ?y - vessel)
    :precondition (and (holding pr2 ?x) (exists (?z - furniture) (and (near pr2 ?z) (at ?y ?z on))))
    :effect (and
      (forall (?s - substance) (when (holds ?x ?s) (contains ?y ?s)))
      (not (holding pr2 ?x)) (free pr2)))
)
