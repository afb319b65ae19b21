; Repair cafe in the parish hall. Visitors bring broken things, volunteers mend them.
(define (domain repair_cafe)
  (:requirements :strips :negative-preconditions)

  (:constants multimeter)

  (:predicates
    (item ?i)
    (electrical ?i)
    (fabric ?i)
    (radio ?i)
    (tool ?t)
    (volunteer ?v)
    (visitor ?p)
    (place ?p)
    (table ?t)
    (lamp ?l)
    (portable ?x)
    (lamp_at ?l ?t)
    (belongs_to ?i ?p)
    (opens ?t ?i)
    (mends ?t ?i)
    (knows_how ?v ?i)

    (lies_on ?x ?p)
    (sits_at ?v ?t)
    (lit ?l)
    (broken ?i)
    (torn ?i)
    (opened_up ?i)
    (plugged_in ?i)
    (dusty ?i)
    (tested ?i)
    (has ?p ?i))

  (:action carry
    :parameters (?x ?from ?to)
    :precondition (and (portable ?x) (place ?from) (place ?to) (lies_on ?x ?from) (not (plugged_in ?x)))
    :effect (and (lies_on ?x ?to) (not (lies_on ?x ?from))))

  (:action change_seat
    :parameters (?v ?from ?to)
    :precondition (and (volunteer ?v) (table ?from) (table ?to) (sits_at ?v ?from))
    :effect (and (sits_at ?v ?to) (not (sits_at ?v ?from))))

  (:action plug_in
    :parameters (?i)
    :precondition (and (item ?i) (electrical ?i) (not (opened_up ?i)) (not (plugged_in ?i)))
    :effect (plugged_in ?i))

  (:action unplug
    :parameters (?i)
    :precondition (and (item ?i) (plugged_in ?i))
    :effect (not (plugged_in ?i)))

  (:action open_up
    :parameters (?i ?t ?p)
    :precondition (and (item ?i) (tool ?t) (table ?p) (opens ?t ?i) (lies_on ?i ?p) (lies_on ?t ?p)
                       (not (plugged_in ?i)) (not (opened_up ?i)))
    :effect (opened_up ?i))

  (:action close_up
    :parameters (?i)
    :precondition (and (item ?i) (opened_up ?i))
    :effect (not (opened_up ?i)))

  (:action repair
    :parameters (?v ?i ?t ?p)
    :precondition (and (volunteer ?v) (item ?i) (tool ?t) (table ?p) (sits_at ?v ?p) (lies_on ?i ?p) (lies_on ?t ?p)
                       (knows_how ?v ?i) (mends ?t ?i) (opened_up ?i) (broken ?i))
    :effect (not (broken ?i)))

  (:action sew_up
    :parameters (?v ?i ?t ?p)
    :precondition (and (volunteer ?v) (item ?i) (fabric ?i) (tool ?t) (table ?p) (sits_at ?v ?p) (lies_on ?i ?p)
                       (lies_on ?t ?p) (knows_how ?v ?i) (mends ?t ?i) (torn ?i))
    :effect (not (torn ?i)))

  (:action wipe_down
    :parameters (?i)
    :precondition (and (item ?i) (dusty ?i))
    :effect (not (dusty ?i)))

  (:action safety_test
    :parameters (?i ?p)
    :precondition (and (item ?i) (electrical ?i) (table ?p) (lies_on ?i ?p) (lies_on multimeter ?p)
                       (not (broken ?i)) (not (opened_up ?i)))
    :effect (tested ?i))

  (:action hand_back
    :parameters (?i ?p ?from)
    :precondition (and (item ?i) (visitor ?p) (place ?from) (belongs_to ?i ?p) (lies_on ?i ?from)
                       (not (opened_up ?i)) (not (plugged_in ?i)))
    :effect (and (has ?p ?i) (not (lies_on ?i ?from))))

  (:action lamp_on
    :parameters (?l)
    :precondition (and (lamp ?l) (not (lit ?l)))
    :effect (lit ?l))

  (:action lamp_off
    :parameters (?l)
    :precondition (and (lamp ?l) (lit ?l))
    :effect (not (lit ?l)))
)
