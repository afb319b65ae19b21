; A yard behind a house: the shed is latched, a heater burns in the greenhouse, and the rain butt is half empty.
(define (problem yard)
  (:domain garden)
  (:objects
    terrace1 - terrace
    kitchen_garden1 - kitchen_garden
    shed1 - shed
    greenhouse1 - greenhouse
    garden_table - table
    shed_shelf - shelf
    potting_bench - bench
    rain_butt - butt
    lawn_sprinkler - sprinkler
    shed_lamp - light
    greenhouse_heater - heater
    bean_bed herb_bed tomato_bed - bed
    spade1 - spade
    rake1 - rake
    trowel1 - trowel
    green_can - watering_can
    basket1 - basket
    carrot_seeds pea_seeds - seeds
    red_tomato green_tomato - tomato
    petrol_can1 - petrol_can)
  (:init
    ; the place
    (path terrace1 kitchen_garden1) (path kitchen_garden1 terrace1)
    (path terrace1 shed1) (path shed1 terrace1)
    (path kitchen_garden1 greenhouse1) (path greenhouse1 kitchen_garden1)
    (latchable shed1) (latch_by shed1 terrace1)
    (latchable greenhouse1) (latch_by greenhouse1 kitchen_garden1) (gate_open greenhouse1)
    (in_area garden_table terrace1)
    (in_area shed_shelf shed1) (in_area shed_lamp shed1)
    (in_area potting_bench greenhouse1) (in_area greenhouse_heater greenhouse1) (in_area tomato_bed greenhouse1)
    (in_area rain_butt kitchen_garden1) (in_area lawn_sprinkler kitchen_garden1)
    (in_area bean_bed kitchen_garden1) (in_area herb_bed kitchen_garden1)
    (flat terrace1) (flat kitchen_garden1) (flat garden_table) (flat shed_shelf) (flat potting_bench)
    (hollow shed1) (hollow greenhouse1) (hollow basket1)
    (takes_load bean_bed) (takes_load herb_bed) (takes_load tomato_bed)
    (sprays lawn_sprinkler bean_bed) (sprays lawn_sprinkler herb_bed)
    (level rain_butt half) (level green_can empty)
    (naked_flame greenhouse_heater) (lit greenhouse_heater)
    (no_fuel greenhouse1) (no_fuel potting_bench) (no_fuel basket1)
    (for_food basket1) (for_food garden_table)
    (gives_water lawn_sprinkler) (gives_light shed_lamp) (gives_light greenhouse_heater)
    ; the things
    (inside spade1 shed1) (in_area spade1 shed1) (digs spade1)
    (resting_on rake1 terrace1) (in_area rake1 terrace1)
    (resting_on trowel1 potting_bench) (in_area trowel1 greenhouse1)
    (resting_on green_can potting_bench) (in_area green_can greenhouse1)
    (resting_on basket1 garden_table) (in_area basket1 terrace1)
    (resting_on carrot_seeds shed_shelf) (in_area carrot_seeds shed1)
    (resting_on pea_seeds garden_table) (in_area pea_seeds terrace1)
    (growing_in red_tomato tomato_bed) (ripe red_tomato)
    (growing_in green_tomato tomato_bed)
    (resting_on petrol_can1 terrace1) (in_area petrol_can1 terrace1) (inflammable petrol_can1)
    (large spade1) (large rake1) (large green_can) (large basket1)
    ; the gardener
    (standing_in terrace1) (spare left_hand) (spare right_hand))
  (:goal (and)))
