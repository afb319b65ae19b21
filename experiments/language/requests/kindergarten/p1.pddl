(define (problem noon)
  (:domain kindergarten)
  (:objects mrs_hill ben lea tom mia
            playroom dining_room quiet_room garden
            teddy drum red_ball blue_ball
            toy_chest wicker_basket)
  (:init
    (teacher mrs_hill)
    (child ben) (child lea) (child tom) (child mia)
    (room playroom) (room dining_room) (room quiet_room) (room garden)
    (toy teddy) (toy drum) (toy red_ball) (toy blue_ball)
    (box toy_chest) (box wicker_basket)
    (dining_area dining_room) (has_beds quiet_room)
    (in_room mrs_hill playroom) (in_room lea playroom) (in_room tom playroom)
    (in_room mia garden) (in_room ben quiet_room)
    (asleep ben)
    (hungry lea) (hungry tom) (hungry mia)
    (in_room toy_chest playroom) (in_room wicker_basket garden) (box_open wicker_basket)
    (in_room drum playroom) (in_room red_ball garden)
    (inside teddy toy_chest) (inside blue_ball wicker_basket))
  (:goal (and (not (hungry mia)) (asleep tom))))
