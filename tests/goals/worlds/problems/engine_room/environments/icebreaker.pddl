; An icebreaker at anchor: two engines, a boiler behind an air lock, and fresh water to be moved about.
(define (problem icebreaker)
  (:domain engine_room)
  (:objects
    oiler - crew
    mess lobby boiler_room tank_space engine_space - compartment
    mess_door inner_door engine_door - door
    tank_hatch - hatch
    port_engine starboard_engine - engine
    main_generator emergency_generator - generator
    water_pump oil_pump - pump
    oil_purifier - purifier
    steam_boiler - boiler
    tank_fan boiler_fan - fan
    mess_lamp lobby_lamp - lamp
    fire_alarm - alarm
    steam_valve feed_valve port_fuel_valve starboard_fuel_valve - valve
    potable_tank reserve_tank cracked_tank clean_oil_tank waste_oil_tank - tank
    mess_locker gear_locker - locker
    mess_table engine_bench - bench
    lobby_rack tank_rack - rack
    rubbish_bin - bin
    lobby_hook - hook
    mess_sink - basin
    torque_wrench - wrench
    big_torch small_torch - torch
    string_mop - mop
    yellow_defenders spare_defenders - ear_defenders
    heat_gloves - gloves
    goggles1 - goggles
    purifier_filter spare_filter - filter
    water_hose oil_hose - hose
    locker_key - key
    copper_gasket rubber_gasket - gasket
    petrol_rag - rag
    grey_paint - paint_tin)
  (:init
    (joins mess_door mess lobby) (joins mess_door lobby mess)
    (joins inner_door lobby boiler_room) (joins inner_door boiler_room lobby)
    (joins engine_door lobby engine_space) (joins engine_door engine_space lobby)
    (joins tank_hatch engine_space tank_space) (joins tank_hatch tank_space engine_space)
    (sited mess_door mess) (sited mess_door lobby) (sited inner_door lobby) (sited inner_door boiler_room)
    (sited engine_door lobby) (sited engine_door engine_space) (sited tank_hatch engine_space) (sited tank_hatch tank_space)
    (openable mess_door) (openable inner_door) (openable engine_door) (openable tank_hatch)
    (openable steam_valve) (openable feed_valve) (openable port_fuel_valve) (openable starboard_fuel_valve)
    (openable mess_locker) (openable gear_locker)
    (interlocked mess_door inner_door) (interlocked inner_door mess_door)
    (opened mess_door) (opened engine_door)
    (locked gear_locker) (key_to locker_key gear_locker)
    ; mess
    (sited mess_table mess) (sited mess_locker mess) (sited mess_lamp mess) (sited mess_sink mess) (sited rubbish_bin mess)
    (running mess_lamp) (powered_by mess_lamp emergency_generator)
    (stowed locker_key mess_table) (at locker_key mess) (stowed big_torch mess_table) (at big_torch mess)
    (stowed copper_gasket mess_locker) (at copper_gasket mess) (stowed goggles1 mess_locker) (at goggles1 mess)
    ; lobby
    (sited lobby_rack lobby) (sited lobby_hook lobby) (sited gear_locker lobby) (sited lobby_lamp lobby) (sited fire_alarm lobby)
    (sited emergency_generator lobby) (running emergency_generator)
    (powered_by lobby_lamp emergency_generator)
    (stowed heat_gloves gear_locker) (at heat_gloves lobby)
    (stowed spare_defenders gear_locker) (at spare_defenders lobby)
    (stowed yellow_defenders lobby_hook) (at yellow_defenders lobby)
    (stowed string_mop lobby_rack) (at string_mop lobby) (stowed grey_paint lobby_rack) (at grey_paint lobby)
    (stowed petrol_rag lobby_rack) (at petrol_rag lobby) (flammable petrol_rag) (flammable grey_paint)
    ; boiler room
    (sited steam_boiler boiler_room) (sited steam_valve boiler_room) (sited feed_valve boiler_room) (sited boiler_fan boiler_room)
    (hot steam_boiler) (supplies feed_valve steam_boiler) (scalding steam_valve) (opened steam_valve) (oily boiler_room)
    (powered_by boiler_fan main_generator)
    ; engine space
    (sited port_engine engine_space) (sited starboard_engine engine_space) (sited main_generator engine_space)
    (sited port_fuel_valve engine_space) (sited starboard_fuel_valve engine_space) (sited oil_purifier engine_space)
    (sited engine_bench engine_space)
    (supplies port_fuel_valve port_engine) (supplies starboard_fuel_valve starboard_engine)
    (loud port_engine) (loud starboard_engine) (hot port_engine) (hot starboard_engine)
    (opened starboard_fuel_valve) (running starboard_engine)
    (vital port_engine) (vital starboard_engine) (standby port_engine starboard_engine) (standby starboard_engine port_engine)
    (takes_filter oil_purifier) (fitted purifier_filter oil_purifier) (at purifier_filter engine_space) (clogged purifier_filter)
    (powered_by oil_purifier main_generator)
    (stowed torque_wrench engine_bench) (at torque_wrench engine_space)
    (stowed small_torch engine_bench) (at small_torch engine_space)
    (stowed rubber_gasket engine_bench) (at rubber_gasket engine_space)
    ; tank space
    (sited water_pump tank_space) (sited oil_pump tank_space) (sited tank_fan tank_space) (sited tank_rack tank_space)
    (powered_by water_pump main_generator) (powered_by oil_pump main_generator) (powered_by tank_fan main_generator)
    (handles water_pump fresh_water) (handles oil_pump lube_oil) (pollutes lube_oil) (pollutes fuel)
    (sited potable_tank tank_space) (sited reserve_tank tank_space) (sited cracked_tank tank_space)
    (sited clean_oil_tank tank_space) (sited waste_oil_tank tank_space)
    (holds potable_tank fresh_water) (empty potable_tank) (holds reserve_tank fresh_water) (full reserve_tank)
    (holds cracked_tank fresh_water) (empty cracked_tank) (cracked cracked_tank)
    (holds clean_oil_tank lube_oil) (empty clean_oil_tank) (holds waste_oil_tank lube_oil)
    (suits water_hose fresh_water) (suits oil_hose lube_oil) (stowed water_hose tank_rack) (at water_hose tank_space) (stowed oil_hose tank_rack) (at oil_hose tank_space)
    (stowed spare_filter tank_rack) (at spare_filter tank_space)
    (at oiler lobby) (free_handed oiler))
  (:goal (and)))
