(define (problem floor-one-morning)
  (:domain hotel-housekeeping)
  (:objects
    room-101 room-102 room-103 room-104 - guest-room
    corridor linen-closet reception - service-room
    sheets-1 sheets-2 - bed-sheets
    towels-1 towels-2 - towel-set
    cola mineral-water - drink
    vacuum-cleaner - vacuum
    floor-mop - mop
    umbrella sunglasses - lost-property)
  (:init
    (robot-at linen-closet) (hand-empty)
    (adjacent corridor room-101) (adjacent room-101 corridor)
    (adjacent corridor room-102) (adjacent room-102 corridor)
    (adjacent corridor room-103) (adjacent room-103 corridor)
    (adjacent corridor room-104) (adjacent room-104 corridor)
    (adjacent corridor linen-closet) (adjacent linen-closet corridor)
    (adjacent corridor reception) (adjacent reception corridor)
    (item-at sheets-1 linen-closet) (item-at sheets-2 linen-closet)
    (item-at towels-1 linen-closet) (item-at towels-2 linen-closet)
    (item-at cola linen-closet) (item-at mineral-water reception)
    (item-at vacuum-cleaner room-101) (item-at floor-mop linen-closet)
    (item-at umbrella room-102) (item-at sunglasses room-101)
    (door-locked room-104)
    (do-not-disturb room-103)
    (bed-made room-102) (bed-made room-103)
    (bathroom-clean room-101) (bathroom-clean room-103)
    (vacuumed reception)
    (bin-full room-101) (bin-full room-104) (bin-full reception)
    (curtains-open room-101) (curtains-open room-102)
    (heating-on room-102) (heating-on room-104))
  (:goal (and (bed-made room-101) (bed-made room-104))))
