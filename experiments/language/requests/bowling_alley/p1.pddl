(define (problem friday-evening)
  (:domain bowling-alley)
  (:objects
    lane-1 lane-2 lane-3 lane-4 - lane
    shoe-counter - counter
    ball-rack - rack
    red-ball blue-ball green-ball - ball
    kids-shoes ladies-shoes mens-shoes - shoes
    mia tom - staff)
  (:init
    (staff-at mia shoe-counter)
    (staff-at tom lane-3)
    (hands-free mia)
    (hands-free tom)
    (item-at red-ball lane-1)
    (item-at blue-ball lane-3)
    (item-at green-ball ball-rack)
    (item-at kids-shoes lane-2)
    (item-at ladies-shoes shoe-counter)
    (item-at mens-shoes shoe-counter)
    (lane-open lane-1)
    (lane-open lane-3)
    (lane-oiled lane-1)
    (lane-oiled lane-4)
    (bumpers-up lane-2)
    (bumpers-up lane-3)
    (disinfected ladies-shoes)
    (cracked green-ball))
  (:goal (and (lane-open lane-2) (item-at red-ball ball-rack))))
