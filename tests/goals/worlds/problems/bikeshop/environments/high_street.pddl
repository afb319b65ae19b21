; A small shop on the high street: the store is locked, the tourer in the stand is half done, another waits outside.
(define (problem high_street)
  (:domain bikeshop)
  (:objects
    front_shop - shop
    repair_room - workroom
    back_store - storeroom
    courtyard - outdoors
    shop_door store_door - door
    shop_counter - counter
    oak_bench - workbench
    tool_drawer - drawer
    steel_cabinet - cabinet
    washer1 - parts_washer
    compressor1 - compressor
    ceiling_lamp store_lamp - lamp
    radio1 - radio
    tall_stand low_stand - stand
    left_hook right_hook - hook
    store_shelf - shelf
    red_tourer blue_tourer - tourer
    carbon_racer - racer
    red_front_wheel red_rear_wheel blue_front_wheel blue_rear_wheel racer_front_wheel racer_rear_wheel spare_wheel - wheel
    red_saddle blue_saddle racer_saddle - saddle
    red_chain blue_chain racer_chain - chain
    wrench1 - wrench
    hex_key1 - hex_key
    hand_pump - pump
    brush1 - brush
    rag1 - rag
    oil_can1 - oil_can
    patch_kit1 - patch_kit
    solvent1 - solvent
    store_key - door_key
    helmet1 - helmet)
  (:init
    (passage front_shop repair_room) (passage repair_room front_shop)
    (passage front_shop courtyard) (passage courtyard front_shop)
    (passage repair_room back_store) (passage back_store repair_room)
    (door_between shop_door front_shop courtyard) (door_between shop_door courtyard front_shop)
    (door_between store_door repair_room back_store) (door_between store_door back_store repair_room)
    (located shop_door front_shop) (located shop_door courtyard)
    (located store_door repair_room) (located store_door back_store)
    (openable shop_door) (openable store_door) (closed store_door) (locked store_door) (key_for store_key store_door)
    (handover front_shop)
    ; fittings
    (located shop_counter front_shop) (has_top shop_counter) (kept_clean shop_counter)
    (located radio1 front_shop) (has_switch radio1) (powered radio1)
    (located oak_bench repair_room) (has_top oak_bench)
    (located tool_drawer repair_room) (openable tool_drawer) (hollow tool_drawer) (closed tool_drawer)
    (located steel_cabinet repair_room) (openable steel_cabinet) (hollow steel_cabinet) (roomy steel_cabinet) (fireproof steel_cabinet) (closed steel_cabinet)
    (located washer1 repair_room) (openable washer1) (hollow washer1) (has_switch washer1) (washes washer1) (fireproof washer1)
    (located compressor1 repair_room) (has_switch compressor1)
    (located ceiling_lamp repair_room) (has_switch ceiling_lamp) (powered ceiling_lamp)
    (located tall_stand repair_room) (located low_stand repair_room) (vacant low_stand)
    (located left_hook repair_room) (located right_hook repair_room) (vacant right_hook)
    (located store_shelf back_store) (has_top store_shelf)
    (located store_lamp back_store) (has_switch store_lamp)
    ; the red tourer
    (clamped red_tourer tall_stand) (located red_tourer repair_room) (hangable red_tourer)
    (mounted_on red_front_wheel red_tourer) (tight red_front_wheel)
    (mounted_on red_rear_wheel red_tourer) (inflated red_rear_wheel)
    (mounted_on red_saddle red_tourer) (tight red_saddle)
    (mounted_on red_chain red_tourer)
    (goes_into red_front_wheel red_tourer front_fork) (goes_into spare_wheel red_tourer front_fork)
    (goes_into red_rear_wheel red_tourer rear_fork) (goes_into red_saddle red_tourer seat_post)
    (goes_into blue_saddle red_tourer seat_post) (goes_into red_chain red_tourer drive)
    (required red_tourer front_fork) (required red_tourer rear_fork) (required red_tourer seat_post) (required red_tourer drive)
    ; the blue tourer
    (parked blue_tourer courtyard) (located blue_tourer courtyard) (hangable blue_tourer)
    (mounted_on blue_front_wheel blue_tourer) (tight blue_front_wheel) (inflated blue_front_wheel)
    (mounted_on blue_rear_wheel blue_tourer) (tight blue_rear_wheel) (punctured blue_rear_wheel)
    (mounted_on blue_chain blue_tourer) (grimy blue_chain)
    (goes_into blue_front_wheel blue_tourer front_fork) (goes_into spare_wheel blue_tourer front_fork)
    (goes_into blue_rear_wheel blue_tourer rear_fork) (goes_into blue_saddle blue_tourer seat_post)
    (goes_into red_saddle blue_tourer seat_post) (goes_into blue_chain blue_tourer drive)
    (required blue_tourer front_fork) (required blue_tourer rear_fork) (required blue_tourer seat_post) (required blue_tourer drive)
    ; the racer
    (hung_from carbon_racer left_hook) (located carbon_racer repair_room) (hangable carbon_racer) (fragile_frame carbon_racer)
    (mounted_on racer_front_wheel carbon_racer) (tight racer_front_wheel) (inflated racer_front_wheel)
    (mounted_on racer_rear_wheel carbon_racer) (tight racer_rear_wheel) (inflated racer_rear_wheel)
    (mounted_on racer_saddle carbon_racer) (tight racer_saddle)
    (mounted_on racer_chain carbon_racer) (oiled racer_chain)
    (goes_into racer_front_wheel carbon_racer front_fork) (goes_into racer_rear_wheel carbon_racer rear_fork)
    (goes_into racer_saddle carbon_racer seat_post) (goes_into racer_chain carbon_racer drive)
    (required carbon_racer front_fork) (required carbon_racer rear_fork) (required carbon_racer seat_post) (required carbon_racer drive)
    ; bolts
    (turns wrench1 red_front_wheel) (turns wrench1 red_rear_wheel) (turns wrench1 blue_front_wheel) (turns wrench1 blue_rear_wheel)
    (turns wrench1 spare_wheel) (turns hex_key1 racer_front_wheel) (turns hex_key1 racer_rear_wheel)
    (turns hex_key1 red_saddle) (turns hex_key1 blue_saddle) (turns hex_key1 racer_saddle)
    (tool_free red_chain) (tool_free blue_chain) (tool_free racer_chain)
    (large red_front_wheel) (large red_rear_wheel) (large blue_front_wheel) (large blue_rear_wheel)
    (large racer_front_wheel) (large racer_rear_wheel) (large spare_wheel) (large helmet1)
    (hangable red_front_wheel) (hangable red_rear_wheel) (hangable blue_front_wheel) (hangable blue_rear_wheel)
    (hangable racer_front_wheel) (hangable racer_rear_wheel) (hangable spare_wheel) (hangable helmet1) (hangable store_key)
    ; what lies about
    (lying_on spare_wheel store_shelf) (located spare_wheel back_store)
    (lying_on blue_saddle store_shelf) (located blue_saddle back_store)
    (stowed_in wrench1 tool_drawer) (located wrench1 repair_room)
    (stowed_in patch_kit1 tool_drawer) (located patch_kit1 repair_room)
    (lying_on hex_key1 oak_bench) (located hex_key1 repair_room)
    (lying_on hand_pump oak_bench) (located hand_pump repair_room)
    (lying_on brush1 oak_bench) (located brush1 repair_room) (cleans brush1)
    (lying_on rag1 shop_counter) (located rag1 front_shop) (cleans rag1)
    (stowed_in oil_can1 steel_cabinet) (located oil_can1 repair_room)
    (stowed_in solvent1 steel_cabinet) (located solvent1 repair_room) (flammable solvent1)
    (lying_on store_key shop_counter) (located store_key front_shop)
    (lying_on helmet1 shop_counter) (located helmet1 front_shop)
    ; the mechanic
    (mechanic_in front_shop) (empty_handed))
  (:goal (and)))
