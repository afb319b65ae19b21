; Every corner of ADL that is easily got wrong, in a row of lamps, without types.
(define (domain lamps)
  (:requirements :adl)
  (:constants master)
  (:predicates
    (lit ?l)          ; lamp l shines
    (next ?l ?m)      ; static: m stands right of l
    (marked ?l)
    (broken ?l)       ; no action mends or breaks a lamp
    (painted ?l)      ; nothing paints a lamp
    (done)
    (ready)           ; holds at the start and always
    (counted ?l ?m))
  ; reads the old state: the two lamps swap
  (:action swap
    :parameters (?l ?m)
    :precondition (and (next ?l ?m) (ready))
    :effect (and
      (when (lit ?l) (lit ?m))
      (when (not (lit ?l)) (not (lit ?m)))
      (when (lit ?m) (lit ?l))
      (when (not (lit ?m)) (not (lit ?l)))))
  ; deleted and added: added
  (:action renew
    :parameters (?l)
    :precondition (not (broken ?l))
    :effect (and (forall (?x) (not (marked ?x))) (marked ?l) (when (lit master) (not (marked ?l)))))
  ; when within when, forall within when
  (:action shine
    :parameters (?l)
    :precondition (or (and (marked ?l) (not (lit ?l))) (and (not (marked ?l)) (lit ?l) (not (done))))
    :effect (when (marked ?l)
              (and (lit ?l)
                   (forall (?x)
                     (and (when (next ?l ?x) (when (not (broken ?x)) (lit ?x)))
                          (forall (?y) (when (and (next ?x ?y) (lit ?y)) (counted ?x ?y))))))))
  (:action finish
    :parameters ()
    :precondition (and (forall (?x) (or (lit ?x) (broken ?x)))
                       (exists (?x ?y) (and (counted ?x ?y) (not (= ?x ?y)) (marked ?y))))
    :effect (done))
  (:action quench
    :parameters (?l)
    :precondition (imply (broken ?l) (done))
    :effect (and (not (lit ?l)) (when (or (marked ?l) (not (exists (?x) (marked ?x)))) (marked master))
                 (when (not (ready)) (not (done)))))
  ; never applies: it needs what never holds, or what always does not hold
  (:action paint :parameters (?l) :precondition (painted ?l) :effect (not (ready)))
  (:action unready :parameters (?l) :precondition (and (lit ?l) (not (ready))) :effect (painted ?l))
)
