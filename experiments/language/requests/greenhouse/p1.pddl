(define (problem spring-morning)
  (:domain greenhouse)
  (:objects
    north-bench south-bench potting-table entrance - place
    tomato basil orchid cactus - plant
    can1 - watering-can
    shears - pruner
    plant-food - fertilizer
    roof-vent side-vent - vent
    lamp-north lamp-south - grow-lamp)
  (:init
    (robot-at entrance) (hand-free)
    (has-tap entrance)
    (stands-at tomato north-bench) (stands-at basil north-bench)
    (stands-at orchid south-bench) (stands-at cactus south-bench)
    (stands-at can1 entrance) (stands-at shears potting-table) (stands-at plant-food potting-table)
    (vent-of roof-vent north-bench) (vent-of side-vent south-bench)
    (lamp-of lamp-north north-bench) (lamp-of lamp-south south-bench)
    (vent-open side-vent)
    (lamp-on lamp-north)
    (ripe tomato))
  (:goal (and (watered tomato))))
