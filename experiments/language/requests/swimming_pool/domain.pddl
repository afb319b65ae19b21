;; Domain: Public Swimming Pool
;; Models the daily operation of a public swimming pool: staff prepare the pools, swimmers use them.
(define (domain public_swimming_pool)
  (:requirements :strips :typing :negative-preconditions)

  (:types
    location person equipment - object
    pool - location
    employee swimmer - person
    lifeguard technician - employee
    kickboard rescue_ring chlorine_canister - equipment
  )

  (:predicates
    (path_exists_between ?from - location ?to - location)
    (person_is_at ?p - person ?l - location)
    (equipment_is_at ?e - equipment ?l - location)
    (employee_is_carrying ?p - employee ?e - equipment)
    (employee_has_free_hands ?p - employee)
    (pool_is_covered ?pool - pool)
    (pool_is_open_to_public ?pool - pool)
    (pool_is_chlorinated ?pool - pool)
    (pool_is_heated ?pool - pool)
    (heating_system_serves_pool ?l - location ?pool - pool)
    (lifeguard_is_on_duty_at ?g - lifeguard ?pool - pool)
    (shower_is_available_at ?l - location)
    (swimmer_has_showered ?s - swimmer)
    (swimmer_is_swimming_in ?s - swimmer ?pool - pool)
  )

  (:action walk_from_location_to_location
    :parameters (?p - person ?from - location ?to - location)
    :precondition (and (person_is_at ?p ?from) (path_exists_between ?from ?to))
    :effect (and (not (person_is_at ?p ?from)) (person_is_at ?p ?to))
  )

  (:action pick_up_equipment_at_location
    :parameters (?p - employee ?e - equipment ?l - location)
    :precondition (and (person_is_at ?p ?l) (equipment_is_at ?e ?l) (employee_has_free_hands ?p))
    :effect (and (employee_is_carrying ?p ?e) (not (equipment_is_at ?e ?l)) (not (employee_has_free_hands ?p)))
  )

  (:action put_down_equipment_at_location
    :parameters (?p - employee ?e - equipment ?l - location)
    :precondition (and (person_is_at ?p ?l) (employee_is_carrying ?p ?e))
    :effect (and (equipment_is_at ?e ?l) (employee_has_free_hands ?p) (not (employee_is_carrying ?p ?e)))
  )

  (:action remove_protective_cover_from_pool
    :parameters (?p - employee ?pool - pool)
    :precondition (and (person_is_at ?p ?pool) (employee_has_free_hands ?p) (pool_is_covered ?pool))
    :effect (not (pool_is_covered ?pool))
  )

  (:action put_protective_cover_on_pool
    :parameters (?p - employee ?pool - pool)
    :precondition (and (person_is_at ?p ?pool) (employee_has_free_hands ?p) (not (pool_is_covered ?pool)) (not (pool_is_open_to_public ?pool)))
    :effect (pool_is_covered ?pool)
  )

  (:action add_chlorine_to_pool_water
    :parameters (?p - employee ?c - chlorine_canister ?pool - pool)
    :precondition (and (person_is_at ?p ?pool) (employee_is_carrying ?p ?c) (not (pool_is_covered ?pool)))
    :effect (pool_is_chlorinated ?pool)
  )

  (:action turn_on_pool_heating
    :parameters (?t - technician ?l - location ?pool - pool)
    :precondition (and (person_is_at ?t ?l) (heating_system_serves_pool ?l ?pool) (not (pool_is_heated ?pool)))
    :effect (pool_is_heated ?pool)
  )

  (:action start_lifeguard_duty_at_pool
    :parameters (?g - lifeguard ?pool - pool)
    :precondition (and (person_is_at ?g ?pool) (employee_has_free_hands ?g))
    :effect (and (lifeguard_is_on_duty_at ?g ?pool) (not (person_is_at ?g ?pool)))
  )

  (:action end_lifeguard_duty_at_pool
    :parameters (?g - lifeguard ?pool - pool)
    :precondition (and (lifeguard_is_on_duty_at ?g ?pool) (not (pool_is_open_to_public ?pool)))
    :effect (and (person_is_at ?g ?pool) (not (lifeguard_is_on_duty_at ?g ?pool)))
  )

  (:action open_pool_to_public
    :parameters (?g - lifeguard ?pool - pool)
    :precondition (and (lifeguard_is_on_duty_at ?g ?pool) (pool_is_chlorinated ?pool) (not (pool_is_covered ?pool)))
    :effect (pool_is_open_to_public ?pool)
  )

  (:action take_shower_before_swimming
    :parameters (?s - swimmer ?l - location)
    :precondition (and (person_is_at ?s ?l) (shower_is_available_at ?l))
    :effect (swimmer_has_showered ?s)
  )

  (:action enter_pool_for_swimming
    :parameters (?s - swimmer ?pool - pool)
    :precondition (and (person_is_at ?s ?pool) (swimmer_has_showered ?s) (pool_is_open_to_public ?pool))
    :effect (and (swimmer_is_swimming_in ?s ?pool) (not (person_is_at ?s ?pool)))
  )
)
