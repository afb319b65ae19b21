(define (problem dairy_morning)
  (:domain small_dairy)
  (:objects
    north_field south_field - field
    cow_barn sheep_pen - pen
    tool_shed - building
    bella daisy - cow
    dolly molly woolly - sheep
    bucket_1 bucket_2 - bucket
    old_shears - shears
    hay_bale - feed)
  (:init
    (dairyman_at tool_shed) (hands_free)
    (has_gate north_field) (has_gate south_field) (has_gate cow_barn) (has_gate sheep_pen)
    (gate_closed north_field) (gate_closed cow_barn) (gate_closed sheep_pen)
    (has_trough north_field) (has_trough south_field) (has_trough cow_barn) (has_trough sheep_pen)
    (trough_full north_field) (trough_full sheep_pen)
    (animal_at bella cow_barn) (animal_at daisy cow_barn)
    (animal_at dolly sheep_pen) (animal_at molly sheep_pen) (animal_at woolly north_field)
    (hungry bella) (hungry molly) (hungry woolly)
    (tool_at bucket_1 tool_shed) (tool_at bucket_2 tool_shed) (tool_at old_shears tool_shed)
    (tool_at hay_bale cow_barn))
  (:goal (and (milked bella) (milked daisy))))
