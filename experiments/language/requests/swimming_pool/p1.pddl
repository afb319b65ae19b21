(define (problem morning_opening)
  (:domain public_swimming_pool)
  (:objects
    main_pool kids_pool outdoor_pool - pool
    entrance_hall changing_room shower_room plant_room equipment_store - location
    nadia oscar - lifeguard
    victor - technician
    lena tim mrs_patel - swimmer
    red_kickboard blue_kickboard green_kickboard - kickboard
    rescue_ring1 - rescue_ring
    chlorine_canister1 - chlorine_canister
  )
  (:init
    (path_exists_between entrance_hall changing_room) (path_exists_between changing_room entrance_hall)
    (path_exists_between changing_room shower_room) (path_exists_between shower_room changing_room)
    (path_exists_between shower_room main_pool) (path_exists_between main_pool shower_room)
    (path_exists_between main_pool kids_pool) (path_exists_between kids_pool main_pool)
    (path_exists_between main_pool outdoor_pool) (path_exists_between outdoor_pool main_pool)
    (path_exists_between main_pool equipment_store) (path_exists_between equipment_store main_pool)
    (path_exists_between entrance_hall plant_room) (path_exists_between plant_room entrance_hall)
    (person_is_at nadia entrance_hall) (person_is_at oscar main_pool) (person_is_at victor entrance_hall)
    (person_is_at lena changing_room) (person_is_at tim changing_room) (person_is_at mrs_patel entrance_hall)
    (employee_has_free_hands nadia) (employee_has_free_hands oscar) (employee_has_free_hands victor)
    (equipment_is_at red_kickboard equipment_store) (equipment_is_at blue_kickboard equipment_store)
    (equipment_is_at green_kickboard equipment_store)
    (equipment_is_at rescue_ring1 main_pool) (equipment_is_at chlorine_canister1 equipment_store)
    (pool_is_covered main_pool) (pool_is_covered outdoor_pool)
    (heating_system_serves_pool plant_room main_pool) (heating_system_serves_pool plant_room kids_pool)
    (shower_is_available_at shower_room)
  )
  (:goal (and (pool_is_open_to_public main_pool)))
)
