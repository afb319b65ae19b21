(define (problem garage_p1)
  (:domain garage)
  (:objects
    joe maria - mechanic
    bay1 bay2 - bay
    yard storeroom wash_box - location
    fiat volvo - car
    transit - van
    vespa - motorbike
    old_battery new_battery - battery
    wrench torch oil_can - tool
  )
  (:init
    (at joe bay1) (at maria storeroom)
    (hands_free joe) (hands_free maria)
    (at fiat bay1) (at volvo yard) (at transit wash_box) (at vespa yard)
    (raised fiat) (hood_open fiat) (hood_open transit)
    (installed old_battery fiat) (dead old_battery)
    (has_battery fiat) (has_battery volvo) (has_battery transit) (has_battery vespa)
    (compatible old_battery fiat) (compatible new_battery fiat) (compatible new_battery volvo)
    (at new_battery storeroom) (at oil_can storeroom)
    (at wrench bay1) (at torch bay2)
    (is_oil oil_can)
    (has_hose wash_box)
  )
  (:goal (and (oil_changed fiat)))
)
