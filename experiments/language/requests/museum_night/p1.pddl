(define (problem after_closing)
  (:domain museum_night)
  (:objects
    east_gallery west_gallery upper_gallery - gallery
    entrance_hall storage_vault workshop - back_room
    bronze_horse marble_head - sculpture
    sunflower_painting harbor_painting duke_portrait - painting
    ming_vase greek_urn - vessel
    gold_coin roman_ring - jewel
    tall_case flat_case corner_case - display_case)
  (:init
    (robot_in entrance_hall) (gripper_empty)
    (connected entrance_hall east_gallery) (connected east_gallery entrance_hall)
    (connected entrance_hall west_gallery) (connected west_gallery entrance_hall)
    (connected entrance_hall upper_gallery) (connected upper_gallery entrance_hall)
    (connected entrance_hall storage_vault) (connected storage_vault entrance_hall)
    (connected storage_vault workshop) (connected workshop storage_vault)
    (case_in tall_case east_gallery) (case_in flat_case upper_gallery) (case_in corner_case west_gallery)
    (case_locked tall_case) (case_locked flat_case) (case_open corner_case)
    (glass_clean corner_case)
    (exhibit_in bronze_horse east_gallery) (exhibit_in marble_head west_gallery)
    (exhibit_in sunflower_painting west_gallery) (exhibit_in harbor_painting workshop)
    (exhibit_in duke_portrait storage_vault)
    (inside_case ming_vase tall_case) (inside_case gold_coin flat_case)
    (exhibit_in greek_urn east_gallery) (exhibit_in roman_ring workshop)
    (dusted marble_head) (dusted gold_coin)
    (labeled bronze_horse) (labeled ming_vase) (labeled sunflower_painting) (labeled gold_coin)
    (wrapped duke_portrait)
    (lights_on entrance_hall) (lights_on east_gallery) (lights_on storage_vault)
    (alarm_on upper_gallery)
    (blinds_down west_gallery)
    (floor_mopped entrance_hall))
  (:goal (and (dusted bronze_horse) (alarm_on east_gallery))))
