(define (problem dairy_evening)
  (:domain small_dairy)
  (:objects
    upper_meadow lower_meadow - field
    cow_barn calf_pen - pen
    milk_room - building
    berta rosa lotte - cow
    sheep_1 sheep_2 - sheep
    pail_a pail_b - bucket
    clippers - shears
    oat_sack barley_sack - feed)
  (:init
    (dairyman_at cow_barn) (hands_free)
    (has_gate upper_meadow) (has_gate lower_meadow) (has_gate cow_barn) (has_gate calf_pen)
    (gate_closed upper_meadow) (gate_closed calf_pen) (gate_closed lower_meadow)
    (has_trough upper_meadow) (has_trough cow_barn)
    (trough_full cow_barn)
    (animal_at berta cow_barn) (animal_at rosa cow_barn) (animal_at lotte lower_meadow)
    (animal_at sheep_1 upper_meadow) (animal_at sheep_2 lower_meadow)
    (hungry berta) (hungry sheep_1)
    (tool_at pail_a milk_room) (tool_at pail_b cow_barn)
    (tool_at clippers lower_meadow) (tool_at oat_sack cow_barn) (tool_at barley_sack cow_barn))
  (:goal (and (animal_at lotte cow_barn) (gate_closed cow_barn))))
