(define (problem act-one)
  (:domain theatre-stage)
  (:objects
    stage_left stage_right centre_stage wings prop_room - zone
    red blue amber - colour
    throne sword skull candlestick - prop
    wagon1 - wagon
    spot1 spot2 - spotlight
    main_curtain - curtain
    trap1 - trapdoor
    fogger - fog_machine)
  (:init
    (stagehand_in wings) (desk_in wings) (rope_in main_curtain wings)
    (located throne prop_room) (located sword prop_room) (located skull stage_left) (located candlestick stage_right)
    (located wagon1 prop_room)
    (aimed_at spot1 stage_left) (filter spot1 red) (lit spot1)
    (aimed_at spot2 centre_stage) (filter spot2 amber)
    (trap_in trap1 centre_stage) (gaping trap1))
  (:goal (raised main_curtain)))
