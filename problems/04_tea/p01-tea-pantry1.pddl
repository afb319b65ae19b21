; Compiled from environments/pantry1.yaml; only the goal is written by hand.
(define (problem tea_pantry1)
  (:domain tea)

  (:objects
    counter1 - counter
    stove1 - stove
    stove1_knob - knob
    stove1_plate - plate
    sink1 - sink
    sink1_handle - knob
    sink1_tap - tap
    kettle1 - kettle
    cup1 - cup
    tea_bag1 - tea_bag
    milk_portion1 - milk_portion
  )

  (:init
    (allows counter1 on)
    (allows sink1 in)
    (allows stove1 on)
    (at cup1 counter1 on)
    (at kettle1 counter1 on)
    (at milk_portion1 counter1 on)
    (at tea_bag1 counter1 on)
    (controls sink1_handle sink1_tap)
    (controls stove1_knob stove1_plate)
    (free pr2)
    (heats stove1_plate stove1)
    (holds milk_portion1 milk)
    (holds tea_bag1 tea)
    (idle off)
    (offers sink1_handle high)
    (offers sink1_handle off)
    (offers stove1_knob high)
    (offers stove1_knob off)
    (part_of sink1_handle sink1)
    (part_of sink1_tap sink1)
    (part_of stove1_knob stove1)
    (part_of stove1_plate stove1)
    (pours_into sink1_tap sink1 water)
    (set_to sink1_handle off)
    (set_to stove1_knob off)
  )

  (:goal (and (contains cup1 water) (contains cup1 tea) (hot cup1)))
)
