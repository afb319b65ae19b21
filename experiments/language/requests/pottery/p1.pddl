(define (problem studio_week_12)
  (:domain pottery)
  (:objects
    jug teapot salad_bowl flower_vase plate_1 plate_2 plate_3 - piece
    cobalt honey white_matt - glaze
    wheel_1 wheel_2 - wheel
    big_kiln small_kiln - kiln
    drying_rack - rack
    work_table display_shelf - spot)
  (:init
    (at jug work_table) (bare jug)
    (at salad_bowl work_table) (shaped salad_bowl) (bare salad_bowl)
    (at teapot drying_rack) (shaped teapot) (dry teapot) (bare teapot)
    (at plate_1 drying_rack) (shaped plate_1) (dry plate_1) (bare plate_1)
    (at plate_2 drying_rack) (shaped plate_2) (dry plate_2) (bare plate_2)
    (at plate_3 display_shelf) (shaped plate_3) (dry plate_3) (glazed plate_3 honey) (fired plate_3)
    (at flower_vase small_kiln) (shaped flower_vase) (dry flower_vase) (glazed flower_vase cobalt)
    (tin-open cobalt)
    (hot small_kiln))
  (:goal (and (fired flower_vase) (glazed teapot white_matt))))
