(define (problem heat-wave)
  (:domain greenhouse)
  (:objects
    shady-corner sunny-bench long-bench store-room - place
    lettuce chili pepper fern rose - plant
    small-can big-can - watering-can
    secateurs - pruner
    compost - fertilizer
    vent-a vent-b vent-c - vent
    lamp-a - grow-lamp)
  (:init
    (robot-at store-room) (hand-free)
    (has-tap store-room)
    (stands-at lettuce sunny-bench) (stands-at fern sunny-bench)
    (stands-at chili long-bench) (stands-at pepper long-bench) (stands-at rose long-bench)
    (stands-at small-can long-bench) (stands-at big-can store-room)
    (stands-at secateurs store-room) (stands-at compost store-room)
    (full big-can)
    (vent-of vent-a sunny-bench) (vent-of vent-b long-bench) (vent-of vent-c long-bench)
    (lamp-of lamp-a shady-corner)
    (lamp-on lamp-a)
    (watered rose) (pruned rose)
    (ripe chili) (ripe pepper))
  (:goal (watered lettuce)))
