; A coaster in port: the main engine is cold, the generator hums away, the paint store is locked.
(define (problem coaster)
  (:domain engine_room)
  (:objects
    second_engineer - crew
    control_room engine_hall pump_room workshop paint_store - compartment
    hall_door pump_door workshop_door - door
    store_hatch - hatch
    main_engine - engine
    port_generator - generator
    fuel_pump bilge_pump - pump
    steering_pump - pump
    exhaust_fan - fan
    hall_lamp workshop_lamp - lamp
    fuel_valve cooling_valve bilge_valve - valve
    day_tank settling_tank ballast_tank wash_tank - tank
    tool_locker - locker
    workshop_bench control_desk - bench
    spares_rack paint_rack pump_room_rack - rack
    scrap_bin - bin
    coat_hook - hook
    workshop_basin - basin
    big_wrench small_wrench - wrench
    torch1 - torch
    mop1 - mop
    red_defenders - ear_defenders
    leather_gloves - gloves
    old_filter new_filter - filter
    black_hose - hose
    store_key - key
    white_paint green_paint - paint_tin
    oily_rag - rag)
  (:init
    (joins hall_door control_room engine_hall) (joins hall_door engine_hall control_room)
    (joins pump_door engine_hall pump_room) (joins pump_door pump_room engine_hall)
    (joins workshop_door control_room workshop) (joins workshop_door workshop control_room)
    (joins store_hatch workshop paint_store) (joins store_hatch paint_store workshop)
    (sited hall_door control_room) (sited hall_door engine_hall)
    (sited pump_door engine_hall) (sited pump_door pump_room)
    (sited workshop_door control_room) (sited workshop_door workshop)
    (sited store_hatch workshop) (sited store_hatch paint_store)
    (openable hall_door) (openable pump_door) (openable workshop_door) (openable store_hatch)
    (openable fuel_valve) (openable cooling_valve) (openable bilge_valve) (openable tool_locker)
    (opened workshop_door) (opened pump_door) (opened fuel_valve)
    (locked store_hatch) (key_to store_key store_hatch)
    ; control room
    (sited control_desk control_room) (sited coat_hook control_room) (sited steering_pump control_room)
    (stowed store_key control_desk) (at store_key control_room)
    (stowed red_defenders coat_hook) (at red_defenders control_room)
    (vital steering_pump) (running steering_pump) (powered_by steering_pump port_generator)
    ; engine hall
    (sited main_engine engine_hall) (sited port_generator engine_hall) (sited hall_lamp engine_hall)
    (sited fuel_valve engine_hall) (sited cooling_valve engine_hall) (sited scrap_bin engine_hall)
    (supplies fuel_valve main_engine) (supplies fuel_valve port_generator) (supplies cooling_valve main_engine)
    (takes_filter main_engine) (fitted old_filter main_engine) (at old_filter engine_hall) (clogged old_filter)
    (loud main_engine) (hot main_engine) (loud port_generator) (running port_generator)
    (powered_by hall_lamp port_generator)
    (oily engine_hall)
    ; pump room
    (sited fuel_pump pump_room) (sited bilge_pump pump_room) (sited bilge_valve pump_room) (sited pump_room_rack pump_room)
    (sited day_tank pump_room) (sited settling_tank pump_room) (sited ballast_tank pump_room) (sited wash_tank pump_room)
    (handles fuel_pump fuel) (handles bilge_pump sea_water) (supplies bilge_valve bilge_pump)
    (powered_by fuel_pump port_generator) (powered_by bilge_pump port_generator)
    (holds day_tank fuel) (empty day_tank) (holds settling_tank fuel) (full settling_tank)
    (holds ballast_tank sea_water) (full ballast_tank) (holds wash_tank fresh_water)
    (pollutes fuel) (pollutes lube_oil)
    (suits black_hose fuel) (suits black_hose sea_water) (stowed black_hose pump_room_rack) (at black_hose pump_room)
    ; workshop
    (sited tool_locker workshop) (sited workshop_bench workshop) (sited spares_rack workshop) (sited workshop_basin workshop)
    (sited workshop_lamp workshop) (running workshop_lamp) (powered_by workshop_lamp port_generator)
    (stowed big_wrench tool_locker) (at big_wrench workshop) (stowed torch1 tool_locker) (at torch1 workshop)
    (stowed small_wrench workshop_bench) (at small_wrench workshop) (stowed oily_rag workshop_bench) (at oily_rag workshop)
    (stowed mop1 spares_rack) (at mop1 workshop) (stowed new_filter spares_rack) (at new_filter workshop)
    (stowed leather_gloves spares_rack) (at leather_gloves workshop)
    (flammable oily_rag)
    ; paint store
    (sited paint_rack paint_store) (sited exhaust_fan paint_store) (powered_by exhaust_fan port_generator)
    (stowed white_paint paint_rack) (at white_paint paint_store) (flammable white_paint)
    (stowed green_paint paint_rack) (at green_paint paint_store) (flammable green_paint)
    (at second_engineer control_room) (free_handed second_engineer))
  (:goal (and)))
