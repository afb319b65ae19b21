(define (problem yard-p1)
  (:domain recycling_yard)
  (:objects
    glass_skip metal_skip paper_skip - skip
    hazard_locker - locker
    crusher shredder baler - machine
    sorting_belt - belt
    charging_dock - dock
    wash_tap - tap
    main_gate - gate
    jam_jar pickle_jar - jar
    green_bottle - bottle
    soup_can cola_can paint_tin - can
    newspaper cardboard_box - paper
    car_battery - battery)
  (:init
    (truck-at sorting_belt) (gripper-free)
    (lying-at jam_jar sorting_belt) (lying-at pickle_jar sorting_belt)
    (lying-at green_bottle sorting_belt)
    (lying-at soup_can sorting_belt) (lying-at cola_can sorting_belt) (lying-at paint_tin sorting_belt)
    (lying-at newspaper sorting_belt)
    (in cardboard_box glass_skip)
    (lying-at car_battery charging_dock)
    (locked hazard_locker)
    (running crusher) (can-crush crusher) (can-shred shredder) (running shredder)
    (crushable soup_can) (crushable cola_can) (crushable paint_tin)
    (shreddable newspaper) (shreddable cardboard_box)
    (gate-open main_gate)
    (scale-at sorting_belt))
  (:goal (and)))
