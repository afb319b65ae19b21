(define (problem friday_evening)
  (:domain small_cinema)
  (:objects
    store_room - room
    hall_1 hall_2 hall_3 - hall
    anna mehmet - staff
    space_cats the_last_train silent_river dragon_school - film)
  (:init
    (is_in anna foyer) (has_keys anna)
    (is_in mehmet hall_1)
    (door_locked hall_3) (door_locked store_room)
    (loaded the_last_train hall_1)
    (loaded space_cats hall_2) (playing space_cats hall_2)
    (projector_free hall_3)
    (on_shelf silent_river) (on_shelf dragon_school)
    (lights_on hall_1) (lights_on hall_3)
    (swept hall_1)
    (for_children space_cats) (for_children dragon_school)
    (big hall_1) (small hall_3))
  (:goal (and (playing dragon_school hall_3) (swept hall_2))))
