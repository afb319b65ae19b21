; A rehearsal: several things of a kind, the robot has the broom in its hand, and the fluid can was lent out.
(define (problem rehearsal)
  (:domain theatre)
  (:objects
    prop_table shelf costume_rail - place
    stage wings green_room - area
    prop_trunk - trunk
    chair1 chair2 chair3 mask1 mask2 mask3 drum umbrella - prop
    coat1 coat2 coat3 hat - costume
    red_gel yellow_gel - gel
    spotlight1 spotlight2 spotlight3 - spotlight
    fog_machine heater - device
    main_curtain - curtain)
  (:init
    (robot_at stage) (holding broom)
    (at chair1 stage) (at chair2 stage) (at chair3 wings)
    (at mask1 prop_table) (at mask2 prop_trunk) (at mask3 shelf) (closed prop_trunk)
    (at drum stage) (at umbrella green_room)
    (at coat1 costume_rail) (steamed coat1)
    (at coat2 green_room) (at coat3 prop_trunk) (at hat shelf)
    (at red_gel shelf) (fitted yellow_gel spotlight2)
    (at spotlight1 stage) (switched_on spotlight1)
    (at spotlight2 stage)
    (at spotlight3 wings) (switched_on spotlight3)
    (at fog_machine wings) (takes_fluid fog_machine)
    (at heater green_room) (switched_on heater)
    (at main_curtain stage) (raised main_curtain)
    (at steamer shelf)
    (swept wings))
  (:goal (and)))
