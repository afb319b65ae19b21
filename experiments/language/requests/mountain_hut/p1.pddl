(define (problem mountain_hut_saturday)
  (:domain mountain_hut)
  (:objects
    kitchen dormitory parlour hallway
    kitchen_stove dormitory_stove parlour_stove
    top_bunk bottom_bunk window_bunk
    red_rucksack grey_rucksack annas_rucksack)
  (:init
    (room kitchen) (room dormitory) (room parlour) (room hallway)
    (stove kitchen_stove) (stove dormitory_stove) (stove parlour_stove)
    (bunk top_bunk) (bunk bottom_bunk) (bunk window_bunk)
    (rucksack red_rucksack) (rucksack grey_rucksack) (rucksack annas_rucksack)
    (inside kitchen_stove kitchen)
    (inside dormitory_stove dormitory)
    (inside parlour_stove parlour)
    (inside top_bunk dormitory)
    (inside bottom_bunk dormitory)
    (inside window_bunk dormitory)
    (inside red_rucksack hallway)
    (inside grey_rucksack hallway)
    (inside annas_rucksack kitchen)
    (stocked kitchen_stove)
    (lit kitchen_stove)
    (chimney_blocked parlour_stove)
    (made_up top_bunk)
    (shuttered dormitory)
    (shuttered parlour)
    (swept hallway))
  (:goal (and (lit dormitory_stove) (made_up bottom_bunk))))
