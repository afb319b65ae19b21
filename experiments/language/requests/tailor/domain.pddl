(define (domain tailorShop)
  (:requirements :strips :negative-preconditions)

  (:constants sewingTable ironingBoard counter)

  (:predicates
    (garment ?g)
    (thread ?t)
    (sewingMachine ?m)
    (iron ?i)
    (electric ?d)
    (place ?p)
    (located ?g ?p)
    (threaded ?m ?t)
    (unthreaded ?m)
    (pluggedIn ?d)
    (suits ?t ?g)
    (torn ?g)
    (buttonMissing ?g)
    (hemmed ?g)
    (pressed ?g)
    (wrapped ?g))

  (:action carryOver
    :parameters (?g ?from ?to)
    :precondition (and (garment ?g) (place ?from) (place ?to) (located ?g ?from))
    :effect (and (located ?g ?to) (not (located ?g ?from))))

  (:action plugIn
    :parameters (?d)
    :precondition (and (electric ?d) (not (pluggedIn ?d)))
    :effect (pluggedIn ?d))

  (:action unplug
    :parameters (?d)
    :precondition (and (electric ?d) (pluggedIn ?d))
    :effect (not (pluggedIn ?d)))

  (:action insertThread
    :parameters (?m ?t)
    :precondition (and (sewingMachine ?m) (thread ?t) (unthreaded ?m))
    :effect (and (threaded ?m ?t) (not (unthreaded ?m))))

  (:action removeThread
    :parameters (?m ?t)
    :precondition (and (sewingMachine ?m) (thread ?t) (threaded ?m ?t))
    :effect (and (unthreaded ?m) (not (threaded ?m ?t))))

  (:action mendTear
    :parameters (?g ?m ?t)
    :precondition (and (garment ?g) (sewingMachine ?m) (thread ?t) (located ?g sewingTable)
                       (pluggedIn ?m) (threaded ?m ?t) (suits ?t ?g) (torn ?g))
    :effect (not (torn ?g)))

  (:action takeUpHem
    :parameters (?g ?m ?t)
    :precondition (and (garment ?g) (sewingMachine ?m) (thread ?t) (located ?g sewingTable)
                       (pluggedIn ?m) (threaded ?m ?t) (suits ?t ?g) (not (torn ?g)))
    :effect (and (hemmed ?g) (not (pressed ?g))))

  (:action sewOnButton
    :parameters (?g ?t)
    :precondition (and (garment ?g) (thread ?t) (located ?g sewingTable) (suits ?t ?g) (buttonMissing ?g))
    :effect (not (buttonMissing ?g)))

  (:action pressGarment
    :parameters (?g ?i)
    :precondition (and (garment ?g) (iron ?i) (located ?g ironingBoard) (pluggedIn ?i) (not (torn ?g)))
    :effect (pressed ?g))

  (:action wrapUp
    :parameters (?g)
    :precondition (and (garment ?g) (located ?g counter) (pressed ?g) (not (torn ?g)) (not (buttonMissing ?g)))
    :effect (wrapped ?g))
)
