; Compiled from environments/lab1.yaml; only the goal is written by hand.
(define (problem spin_lab1)
  (:domain lab_bench)

  (:objects
    bench1 - bench
    rack1 - rack
    hotplate1 - hotplate
    hotplate1_knob - knob
    hotplate1_plate - plate
    centrifuge1 - centrifuge
    centrifuge1_lid - lid
    centrifuge1_start_button - button
    centrifuge1_rotor - rotor
    cold_cabinet1 - cold_cabinet
    cold_cabinet1_door - door
    beaker1 - beaker
    flask1 - flask
    sample_tube1 sample_tube2 - sample_tube
    buffer_bottle1 ethanol_bottle1 - reagent_bottle
    waste_bottle1 - waste_bottle
    pipette1 - pipette
    marker1 - marker
  )

  (:init
    (allows bench1 on)
    (allows centrifuge1 in)
    (allows cold_cabinet1 in)
    (allows hotplate1 on)
    (allows rack1 in)
    (at beaker1 bench1 on)
    (at buffer_bottle1 bench1 on)
    (at ethanol_bottle1 cold_cabinet1 in)
    (at flask1 bench1 on)
    (at marker1 bench1 on)
    (at pipette1 bench1 on)
    (at sample_tube1 rack1 in)
    (at sample_tube2 rack1 in)
    (at waste_bottle1 bench1 on)
    (contains buffer_bottle1 buffer)
    (contains ethanol_bottle1 ethanol)
    (contains flask1 water)
    (contains sample_tube1 sample)
    (controls centrifuge1_start_button centrifuge1_rotor)
    (controls hotplate1_knob hotplate1_plate)
    (drains waste_bottle1)
    (draws pipette1)
    (free pr2)
    (guards centrifuge1_lid centrifuge1_rotor)
    (heats hotplate1_plate hotplate1)
    (idle off)
    (offers hotplate1_knob high)
    (offers hotplate1_knob low)
    (offers hotplate1_knob off)
    (openable centrifuge1_lid)
    (openable cold_cabinet1_door)
    (part_of centrifuge1_lid centrifuge1)
    (part_of centrifuge1_rotor centrifuge1)
    (part_of centrifuge1_start_button centrifuge1)
    (part_of cold_cabinet1_door cold_cabinet1)
    (part_of hotplate1_knob hotplate1)
    (part_of hotplate1_plate hotplate1)
    (pressable centrifuge1_start_button)
    (set_to hotplate1_knob off)
    (shuts centrifuge1_lid centrifuge1)
    (shuts cold_cabinet1_door cold_cabinet1)
    (spins centrifuge1_rotor centrifuge1)
    (writes marker1)
  )

  (:goal (and (separated sample_tube1) (at sample_tube1 rack1 in)))
)
