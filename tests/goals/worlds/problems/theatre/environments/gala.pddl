; The opera gala: two curtains, three spotlights, and the fog is running. The fluid can is in the oak trunk.
(define (problem gala)
  (:domain theatre)
  (:objects
    prop_table costume_rail hat_stand - place
    stage orchestra_pit dressing_room foyer gallery - area
    travel_trunk oak_trunk - trunk
    candlestick violin love_letter ransom_letter rose piano lantern - prop
    ball_gown tailcoat veil - costume
    red_gel green_gel blue_gel - gel
    left_spotlight right_spotlight centre_spotlight - spotlight
    fog_machine snow_machine chandelier - device
    main_curtain back_curtain - curtain)
  (:init
    (robot_at dressing_room) (hand_free)
    (at candlestick prop_table)
    (at violin orchestra_pit) (at piano orchestra_pit) (heavy piano)
    (at love_letter stage) (at ransom_letter travel_trunk)
    (at rose foyer) (at lantern oak_trunk) (at fluid_can oak_trunk) (closed oak_trunk)
    (at ball_gown costume_rail) (steamed ball_gown)
    (at tailcoat travel_trunk) (at veil stage)
    (fitted red_gel left_spotlight) (fitted green_gel right_spotlight) (at blue_gel prop_table)
    (at left_spotlight stage)
    (at right_spotlight stage) (switched_on right_spotlight)
    (at centre_spotlight gallery)
    (at fog_machine stage) (takes_fluid fog_machine) (filled fog_machine) (switched_on fog_machine)
    (at snow_machine stage) (takes_fluid snow_machine)
    (at chandelier foyer) (switched_on chandelier)
    (at main_curtain stage) (raised main_curtain)
    (at back_curtain stage)
    (at broom foyer) (at steamer dressing_room)
    (swept stage) (swept foyer))
  (:goal (and)))
