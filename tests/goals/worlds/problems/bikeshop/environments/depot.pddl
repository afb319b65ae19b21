; The depot of a hire company: electric bikes, a room for their batteries, a locked tool locker.
(define (problem depot)
  (:domain bikeshop)
  (:objects
    dispatch_bay - shop
    garage_hall - workroom
    battery_room - storeroom
    wash_yard - outdoors
    roller_door battery_door - door
    dispatch_desk - counter
    steel_bench - workbench
    tool_locker - cabinet
    spares_drawer - drawer
    washer2 - parts_washer
    charger1 - charger
    compressor2 - compressor
    hall_lamp desk_lamp battery_lamp - lamp
    floor_stand - stand
    wall_hook key_hook yard_hook - hook
    battery_shelf - shelf
    green_ebike black_ebike - ebike
    yellow_bike - kids_bike
    silver_racer - racer
    green_front_wheel green_rear_wheel black_front_wheel black_rear_wheel
      yellow_front_wheel yellow_rear_wheel silver_front_wheel silver_rear_wheel - wheel
    green_saddle black_saddle yellow_saddle silver_saddle - saddle
    green_chain black_chain yellow_chain - chain
    green_battery black_battery spare_battery - battery
    big_wrench small_wrench - wrench
    hex_key2 - hex_key
    floor_pump - pump
    brush2 - brush
    oil_can2 - oil_can
    patch_kit2 - patch_kit
    solvent2 - solvent
    locker_key roller_key - door_key
    white_helmet orange_helmet - helmet)
  (:init
    (passage garage_hall dispatch_bay) (passage dispatch_bay garage_hall)
    (passage garage_hall battery_room) (passage battery_room garage_hall)
    (passage garage_hall wash_yard) (passage wash_yard garage_hall)
    (door_between roller_door garage_hall dispatch_bay) (door_between roller_door dispatch_bay garage_hall)
    (door_between battery_door garage_hall battery_room) (door_between battery_door battery_room garage_hall)
    (located roller_door garage_hall) (located roller_door dispatch_bay)
    (located battery_door garage_hall) (located battery_door battery_room)
    (openable roller_door) (closed roller_door) (key_for roller_key roller_door)
    (openable battery_door) (closed battery_door)
    (handover dispatch_bay)
    ; fittings
    (located dispatch_desk dispatch_bay) (has_top dispatch_desk) (kept_clean dispatch_desk)
    (located desk_lamp dispatch_bay) (has_switch desk_lamp) (powered desk_lamp)
    (located steel_bench garage_hall) (has_top steel_bench) (fireproof steel_bench)
    (located tool_locker garage_hall) (openable tool_locker) (hollow tool_locker) (roomy tool_locker) (fireproof tool_locker)
    (closed tool_locker) (locked tool_locker) (key_for locker_key tool_locker)
    (located spares_drawer garage_hall) (openable spares_drawer) (hollow spares_drawer)
    (located compressor2 garage_hall) (has_switch compressor2) (powered compressor2)
    (located hall_lamp garage_hall) (has_switch hall_lamp) (powered hall_lamp)
    (located floor_stand garage_hall)
    (located wall_hook garage_hall) (located key_hook garage_hall) (vacant key_hook)
    (located charger1 battery_room) (has_switch charger1) (hollow charger1) (charges charger1)
    (located battery_shelf battery_room) (has_top battery_shelf)
    (located battery_lamp battery_room) (has_switch battery_lamp)
    (located washer2 wash_yard) (openable washer2) (hollow washer2) (has_switch washer2) (washes washer2) (closed washer2) (powered washer2)
    (located yard_hook wash_yard) (vacant yard_hook)
    ; the green e-bike
    (parked green_ebike dispatch_bay) (located green_ebike dispatch_bay) (hangable green_ebike) (heavy green_ebike)
    (mounted_on green_front_wheel green_ebike) (inflated green_front_wheel)
    (mounted_on green_rear_wheel green_ebike) (tight green_rear_wheel) (inflated green_rear_wheel)
    (mounted_on green_saddle green_ebike) (tight green_saddle)
    (mounted_on green_chain green_ebike) (oiled green_chain)
    (mounted_on green_battery green_ebike)
    ; the black e-bike
    (parked black_ebike garage_hall) (located black_ebike garage_hall) (hangable black_ebike) (heavy black_ebike) (grimy black_ebike)
    (mounted_on black_front_wheel black_ebike) (tight black_front_wheel)
    (mounted_on black_rear_wheel black_ebike) (tight black_rear_wheel)
    (mounted_on black_saddle black_ebike) (tight black_saddle)
    (mounted_on black_chain black_ebike)
    ; the yellow children's bike
    (clamped yellow_bike floor_stand) (located yellow_bike garage_hall) (hangable yellow_bike)
    (mounted_on yellow_front_wheel yellow_bike) (tight yellow_front_wheel) (inflated yellow_front_wheel)
    (mounted_on yellow_saddle yellow_bike)
    (mounted_on yellow_chain yellow_bike) (grimy yellow_chain) (caked yellow_chain)
    ; the silver racer
    (hung_from silver_racer wall_hook) (located silver_racer garage_hall) (hangable silver_racer)
    (mounted_on silver_rear_wheel silver_racer) (tight silver_rear_wheel) (inflated silver_rear_wheel)
    (mounted_on silver_saddle silver_racer) (tight silver_saddle)
    ; what fits where
    (goes_into green_front_wheel green_ebike front_fork) (goes_into green_rear_wheel green_ebike rear_fork)
    (goes_into green_saddle green_ebike seat_post) (goes_into green_chain green_ebike drive)
    (goes_into black_front_wheel black_ebike front_fork) (goes_into black_rear_wheel black_ebike rear_fork)
    (goes_into black_saddle black_ebike seat_post) (goes_into black_chain black_ebike drive)
    (goes_into green_battery green_ebike cradle) (goes_into black_battery green_ebike cradle) (goes_into spare_battery green_ebike cradle)
    (goes_into green_battery black_ebike cradle) (goes_into black_battery black_ebike cradle) (goes_into spare_battery black_ebike cradle)
    (goes_into yellow_front_wheel yellow_bike front_fork) (goes_into yellow_rear_wheel yellow_bike rear_fork)
    (goes_into yellow_saddle yellow_bike seat_post) (goes_into yellow_chain yellow_bike drive)
    (goes_into silver_front_wheel silver_racer front_fork) (goes_into silver_rear_wheel silver_racer rear_fork)
    (goes_into silver_saddle silver_racer seat_post)
    (required green_ebike front_fork) (required green_ebike rear_fork) (required green_ebike seat_post) (required green_ebike cradle)
    (required black_ebike front_fork) (required black_ebike rear_fork) (required black_ebike seat_post) (required black_ebike cradle)
    (required yellow_bike front_fork) (required yellow_bike rear_fork) (required yellow_bike seat_post) (required yellow_bike drive)
    (required silver_racer front_fork) (required silver_racer rear_fork) (required silver_racer seat_post)
    (turns big_wrench green_front_wheel) (turns big_wrench green_rear_wheel) (turns big_wrench black_front_wheel) (turns big_wrench black_rear_wheel)
    (turns small_wrench yellow_front_wheel) (turns small_wrench yellow_rear_wheel) (turns small_wrench silver_front_wheel) (turns small_wrench silver_rear_wheel)
    (turns hex_key2 green_saddle) (turns hex_key2 black_saddle) (turns hex_key2 yellow_saddle) (turns hex_key2 silver_saddle)
    (tool_free green_chain) (tool_free black_chain) (tool_free yellow_chain)
    (tool_free green_battery) (tool_free black_battery) (tool_free spare_battery)
    (electric green_battery) (electric black_battery) (electric spare_battery) (swollen black_battery)
    (large green_front_wheel) (large green_rear_wheel) (large black_front_wheel) (large black_rear_wheel)
    (large silver_front_wheel) (large silver_rear_wheel) (large yellow_front_wheel) (large yellow_rear_wheel) (large floor_pump)
    (hangable white_helmet) (hangable orange_helmet) (hangable locker_key) (hangable roller_key)
    (hangable silver_front_wheel) (hangable silver_rear_wheel) (hangable yellow_front_wheel) (hangable yellow_rear_wheel)
    ; what lies about
    (lying_on yellow_rear_wheel steel_bench) (located yellow_rear_wheel garage_hall) (punctured yellow_rear_wheel)
    (lying_on silver_front_wheel steel_bench) (located silver_front_wheel garage_hall) (cracked_rim silver_front_wheel)
    (lying_on black_battery battery_shelf) (located black_battery battery_room)
    (stowed_in spare_battery charger1) (located spare_battery battery_room)
    (stowed_in big_wrench tool_locker) (located big_wrench garage_hall)
    (stowed_in small_wrench tool_locker) (located small_wrench garage_hall) (grimy small_wrench)
    (stowed_in oil_can2 tool_locker) (located oil_can2 garage_hall)
    (stowed_in patch_kit2 spares_drawer) (located patch_kit2 garage_hall)
    (stowed_in hex_key2 spares_drawer) (located hex_key2 garage_hall)
    (lying_on solvent2 steel_bench) (located solvent2 garage_hall) (flammable solvent2)
    (lying_on floor_pump steel_bench) (located floor_pump garage_hall)
    (lying_on brush2 battery_shelf) (located brush2 battery_room) (cleans brush2)
    (lying_on locker_key dispatch_desk) (located locker_key dispatch_bay)
    (lying_on roller_key dispatch_desk) (located roller_key dispatch_bay)
    (lying_on white_helmet dispatch_desk) (located white_helmet dispatch_bay)
    (lying_on orange_helmet steel_bench) (located orange_helmet garage_hall) (grimy orange_helmet)
    ; the mechanic
    (mechanic_in garage_hall) (empty_handed))
  (:goal (and)))
