;; bakery robot: from dough to the shop window
(define (domain bakery)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    place product - object
    surface oven cold_room - place
    worktop rack display - surface
    bread cake - product
    loaf roll - bread)
  (:predicates
    (robot_at ?p - place)
    (located ?x - product ?p - place)
    (holding ?x - product)
    (gripper_empty)
    (kneaded ?b - bread)
    (baked ?x - product)
    (sliced ?l - loaf)
    (iced ?c - cake)
    (wrapped ?x - product)
    (price_tagged ?x - product)
    (hot_oven ?o - oven)
    (oven_open ?o - oven)
    (dirty ?s - surface))

  (:action go
    :parameters (?a ?b - place)
    :precondition (robot_at ?a)
    :effect (and (not (robot_at ?a)) (robot_at ?b)))

  (:action take_from
    :parameters (?x - product ?s - surface)
    :precondition (and (robot_at ?s) (located ?x ?s) (gripper_empty))
    :effect (and (holding ?x) (not (located ?x ?s)) (not (gripper_empty))))

  (:action put_on
    :parameters (?x - product ?s - surface)
    :precondition (and (robot_at ?s) (holding ?x))
    :effect (and (located ?x ?s) (gripper_empty) (not (holding ?x))))

  (:action fetch_from_cold
    :parameters (?x - product ?c - cold_room)
    :precondition (and (robot_at ?c) (located ?x ?c) (gripper_empty))
    :effect (and (holding ?x) (not (located ?x ?c)) (not (gripper_empty))))

  (:action store_cold
    :parameters (?x - product ?c - cold_room)
    :precondition (and (robot_at ?c) (holding ?x))
    :effect (and (located ?x ?c) (gripper_empty) (not (holding ?x))))

  (:action load_oven
    :parameters (?x - product ?o - oven)
    :precondition (and (robot_at ?o) (holding ?x) (oven_open ?o))
    :effect (and (located ?x ?o) (gripper_empty) (not (holding ?x))))

  (:action unload_oven
    :parameters (?x - product ?o - oven)
    :precondition (and (robot_at ?o) (located ?x ?o) (oven_open ?o) (gripper_empty))
    :effect (and (holding ?x) (not (located ?x ?o)) (not (gripper_empty))))

  (:action open_oven
    :parameters (?o - oven)
    :precondition (and (robot_at ?o) (gripper_empty) (not (oven_open ?o)))
    :effect (oven_open ?o))

  (:action close_oven
    :parameters (?o - oven)
    :precondition (and (robot_at ?o) (gripper_empty) (oven_open ?o))
    :effect (not (oven_open ?o)))

  (:action heat_up
    :parameters (?o - oven)
    :precondition (and (robot_at ?o) (not (hot_oven ?o)))
    :effect (hot_oven ?o))

  (:action switch_off
    :parameters (?o - oven)
    :precondition (and (robot_at ?o) (hot_oven ?o))
    :effect (not (hot_oven ?o)))

  (:action knead
    :parameters (?b - bread ?w - worktop)
    :precondition (and (robot_at ?w) (located ?b ?w) (gripper_empty) (not (kneaded ?b)) (not (baked ?b)))
    :effect (kneaded ?b))

  (:action bake_bread
    :parameters (?b - bread ?o - oven)
    :precondition (and (located ?b ?o) (kneaded ?b) (hot_oven ?o) (not (oven_open ?o)) (not (baked ?b)))
    :effect (baked ?b))

  (:action bake_cake
    :parameters (?c - cake ?o - oven)
    :precondition (and (located ?c ?o) (hot_oven ?o) (not (oven_open ?o)) (not (baked ?c)))
    :effect (baked ?c))

  (:action ice_cake
    :parameters (?c - cake ?w - worktop)
    :precondition (and (robot_at ?w) (located ?c ?w) (baked ?c) (not (iced ?c)) (not (wrapped ?c)))
    :effect (iced ?c))

  (:action slice
    :parameters (?l - loaf ?w - worktop)
    :precondition (and (robot_at ?w) (located ?l ?w) (baked ?l) (not (sliced ?l)) (not (wrapped ?l)))
    :effect (sliced ?l))

  (:action wrap
    :parameters (?x - product ?s - surface)
    :precondition (and (robot_at ?s) (located ?x ?s) (baked ?x) (not (wrapped ?x)))
    :effect (wrapped ?x))

  (:action attach_price
    :parameters (?x - product ?s - surface)
    :precondition (and (robot_at ?s) (located ?x ?s) (not (price_tagged ?x)))
    :effect (price_tagged ?x))

  (:action wipe
    :parameters (?s - surface)
    :precondition (and (robot_at ?s) (dirty ?s) (gripper_empty))
    :effect (not (dirty ?s))))
