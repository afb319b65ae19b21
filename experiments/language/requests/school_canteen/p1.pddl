(define (problem monday-lunch)
  (:domain school-canteen)
  (:objects
    kitchen pantry scullery counter - place
    table-1 table-2 table-3 - table
    marta oskar - cook
    oven hob - heater
    dishwasher - washer
    lasagne tomato-soup fish-fingers green-salad apple-pie - food
    red-tray blue-tray yellow-tray - tray)
  (:init
    (stands-at marta kitchen) (hands-free marta)
    (stands-at oskar counter) (hands-free oskar)
    (installed oven kitchen) (installed hob kitchen) (installed dishwasher scullery)
    (switched-on hob)
    (heats oven lasagne) (heats oven fish-fingers) (heats oven apple-pie) (heats hob tomato-soup)
    (located lasagne pantry) (frozen lasagne)
    (located fish-fingers pantry) (frozen fish-fingers)
    (located apple-pie pantry)
    (located tomato-soup kitchen)
    (located green-salad counter)
    (located red-tray counter) (empty-tray red-tray) (dirty red-tray)
    (located blue-tray counter) (empty-tray blue-tray)
    (located yellow-tray table-2) (empty-tray yellow-tray) (dirty yellow-tray)
    (wiped table-3))
  (:goal (and (on-tray tomato-soup blue-tray) (warm tomato-soup) (located blue-tray table-1))))
