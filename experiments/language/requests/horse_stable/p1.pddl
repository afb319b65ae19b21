(define (problem sunday_morning)
  (:domain horse_stable)
  (:objects
    bella storm nutmeg patches - horse
    anna ben clara - rider
    stall_1 stall_2 stall_3 stall_4 - stall
    big_paddock small_paddock - paddock
    riding_arena - arena
    jumping_saddle dressage_saddle - saddle)
  (:init
    (horse_is_in_location bella stall_1)
    (horse_is_in_location storm stall_2)
    (horse_is_in_location nutmeg big_paddock)
    (horse_is_in_location patches stall_4)
    (horse_has_been_fed bella)
    (horse_has_been_brushed bella)
    (horse_has_been_brushed storm)
    (horse_is_wearing_saddle storm dressage_saddle)
    (saddle_is_in_tack_room jumping_saddle)
    (horse_is_wearing_blanket nutmeg)
    (horse_is_injured patches)
    (rider_is_assigned_to_horse anna bella)
    (rider_is_assigned_to_horse ben storm)
    (rider_is_assigned_to_horse clara nutmeg)
    (stall_is_mucked_out stall_1)
    (paddock_gate_is_closed big_paddock)
    (water_trough_is_full big_paddock))
  (:goal (and (rider_is_mounted_on_horse anna bella)
              (horse_has_been_fed nutmeg))))
