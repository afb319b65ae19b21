; Before the matinee: props lie about, the curtain is down, and the black trunk is locked.
(define (problem matinee)
  (:domain theatre)
  (:objects
    prop_table gel_shelf costume_rail - place
    stage wings balcony dressing_room - area
    wicker_trunk black_trunk - trunk
    skull lantern crown goblet throne sword pistol - prop
    red_cloak wedding_dress uniform - costume
    red_gel amber_gel blue_gel - gel
    front_spotlight side_spotlight - spotlight
    work_light fog_machine - device
    main_curtain - curtain)
  (:init
    (robot_at wings) (hand_free)
    (at skull prop_table) (at lantern prop_table)
    (at crown stage) (at goblet stage) (at throne stage) (heavy throne)
    (at sword wicker_trunk) (at red_cloak wicker_trunk) (closed wicker_trunk)
    (at pistol black_trunk) (closed black_trunk) (locked black_trunk)
    (at wedding_dress costume_rail) (steamed wedding_dress)
    (at uniform dressing_room)
    (at red_gel gel_shelf) (at amber_gel gel_shelf) (fitted blue_gel front_spotlight)
    (at front_spotlight balcony) (switched_on front_spotlight)
    (at side_spotlight wings)
    (at work_light stage) (switched_on work_light)
    (at fog_machine wings) (takes_fluid fog_machine)
    (at main_curtain stage)
    (at broom wings) (at steamer dressing_room) (at fluid_can gel_shelf)
    (swept balcony))
  (:goal (and)))
