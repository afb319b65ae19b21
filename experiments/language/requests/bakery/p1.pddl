(define (problem bakery_before_six)
  (:domain bakery)
  (:objects
    workbench side_table - worktop
    cooling_rack - rack
    shop_counter shop_window - display
    deck_oven stone_oven - oven
    fridge_room - cold_room
    sourdough_loaf rye_loaf white_loaf spelt_loaf - loaf
    poppy_roll sesame_roll - roll
    carrot_cake cheesecake birthday_cake - cake)
  (:init
    (robot_at shop_counter) (gripper_empty)
    (located sourdough_loaf workbench)
    (located rye_loaf cooling_rack) (baked rye_loaf) (kneaded rye_loaf)
    (located white_loaf cooling_rack) (baked white_loaf) (kneaded white_loaf)
    (located spelt_loaf shop_counter) (baked spelt_loaf) (kneaded spelt_loaf)
    (located poppy_roll cooling_rack) (baked poppy_roll) (kneaded poppy_roll)
    (located sesame_roll stone_oven) (baked sesame_roll) (kneaded sesame_roll)
    (located carrot_cake side_table) (baked carrot_cake)
    (located cheesecake fridge_room) (baked cheesecake)
    (located birthday_cake shop_window) (baked birthday_cake) (iced birthday_cake) (price_tagged birthday_cake)
    (price_tagged spelt_loaf)
    (hot_oven stone_oven) (oven_open stone_oven)
    (dirty workbench) (dirty shop_counter))
  (:goal (and (baked sourdough_loaf) (located sourdough_loaf shop_counter))))
