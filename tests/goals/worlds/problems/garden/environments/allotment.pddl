; An allotment: a lane, a fenced plot whose gate is latched, and a hut in it with a chest. The knife in the chest is blunt.
(define (problem allotment)
  (:domain garden)
  (:objects
    lane1 - lane
    plot1 - plot
    hut1 - shed
    tool_chest - chest
    workbench - bench
    water_tap - tap
    hut_lantern - light
    compost_heap - heap
    old_grindstone - grindstone
    old_scarecrow - scarecrow
    pumpkin_bed onion_bed potato_bed - bed
    red_can blue_can - watering_can
    fork1 - fork
    knife1 - knife
    wheelbarrow - barrow
    crate1 - crate
    onion_seeds leek_seeds - seeds
    big_pumpkin small_pumpkin - pumpkin
    weedkiller1 - weedkiller)
  (:init
    ; the place
    (path lane1 plot1) (path plot1 lane1) (path plot1 hut1) (path hut1 plot1)
    (latchable plot1) (latch_by plot1 lane1) (latch_by plot1 plot1)
    (latchable hut1) (latch_by hut1 plot1)
    (latchable tool_chest) (latch_by tool_chest hut1)
    (in_area tool_chest hut1) (in_area workbench hut1) (in_area hut_lantern hut1)
    (in_area old_grindstone hut1)
    (in_area water_tap lane1)
    (in_area compost_heap plot1) (in_area old_scarecrow plot1)
    (in_area pumpkin_bed plot1) (in_area onion_bed plot1) (in_area potato_bed plot1)
    (flat lane1) (flat plot1) (flat workbench)
    (hollow hut1) (hollow tool_chest) (hollow crate1)
    (takes_load pumpkin_bed) (takes_load onion_bed) (takes_load potato_bed) (takes_load compost_heap)
    (naked_flame hut_lantern)
    (for_food crate1)
    (dug onion_bed) (soil_wet potato_bed) (heaped_on weeds compost_heap)
    (gives_water water_tap) (fills_cans water_tap) (gives_light hut_lantern)
    ; the things
    (level red_can empty) (level blue_can half)
    (resting_on red_can lane1) (in_area red_can lane1)
    (inside blue_can hut1) (in_area blue_can hut1)
    (inside fork1 hut1) (in_area fork1 hut1) (digs fork1)
    (inside knife1 tool_chest) (in_area knife1 hut1) (cuts knife1)
    (resting_on wheelbarrow plot1) (in_area wheelbarrow plot1) (bulky wheelbarrow) (loaded_with wheelbarrow manure)
    (resting_on crate1 lane1) (in_area crate1 lane1)
    (inside onion_seeds tool_chest) (in_area onion_seeds hut1)
    (resting_on leek_seeds workbench) (in_area leek_seeds hut1)
    (growing_in big_pumpkin pumpkin_bed) (ripe big_pumpkin) (tough big_pumpkin)
    (growing_in small_pumpkin pumpkin_bed) (ripe small_pumpkin) (tough small_pumpkin)
    (resting_on weedkiller1 workbench) (in_area weedkiller1 hut1) (poisonous weedkiller1)
    (large red_can) (large blue_can) (large fork1) (large wheelbarrow) (large crate1)
    ; the gardener
    (standing_in lane1) (spare left_hand) (spare right_hand))
  (:goal (and)))
