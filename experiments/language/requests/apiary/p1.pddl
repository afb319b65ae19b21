(define (problem apiary_august)
  (:domain apiary)
  (:objects
    meadow orchard honey_house tool_shed - place
    willow_hive lime_hive plum_hive - hive
    brass_smoker - smoker
    syrup_jug - syrup
    white_bucket yellow_bucket - bucket)
  (:init
    (beekeeper_at tool_shed) (hand_empty)
    (hive_at willow_hive meadow) (hive_at lime_hive meadow) (hive_at plum_hive orchard)
    (roof_on willow_hive) (roof_on lime_hive)
    (fed lime_hive)
    (has_honey willow_hive) (has_honey lime_hive)
    (item_at brass_smoker meadow) (item_at syrup_jug honey_house)
    (item_at white_bucket tool_shed) (item_at yellow_bucket orchard)
    (full_of_honey yellow_bucket))
  (:goal (and (roof_on plum_hive))))
