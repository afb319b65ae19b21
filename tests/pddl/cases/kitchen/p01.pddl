(define (problem hot-coffee)
  (:domain tiny-kitchen)
  (:objects
    mug1 mug2 - mug pot1 - pot spoon1 - tool
    counter1 sink1 - place
    stove1 microwave1 fridge1 - appliance
    knob1 - knob)
  (:init
    (at mug1 counter1) (at mug2 counter1) (at pot1 stove1) (at spoon1 counter1)
    (contains mug2 coffee)
    (clean mug1) (clean pot1)
    (near counter1)
    (sink sink1)
    (controls knob1 stove1)
    (locked fridge1)
    (= (total-cost) 0)
    (= (distance counter1 counter1) 0) (= (distance counter1 sink1) 1) (= (distance counter1 stove1) 2)
    (= (distance counter1 microwave1) 3) (= (distance counter1 fridge1) 4)
    (= (distance sink1 counter1) 1) (= (distance sink1 sink1) 0) (= (distance sink1 stove1) 1)
    (= (distance sink1 microwave1) 2) (= (distance sink1 fridge1) 3)
    (= (distance stove1 counter1) 2) (= (distance stove1 sink1) 1) (= (distance stove1 stove1) 0)
    (= (distance stove1 microwave1) 1) (= (distance stove1 fridge1) 2)
    (= (distance microwave1 counter1) 3) (= (distance microwave1 sink1) 2) (= (distance microwave1 stove1) 1)
    (= (distance microwave1 microwave1) 0) (= (distance microwave1 fridge1) 1)
    (= (distance fridge1 counter1) 4) (= (distance fridge1 sink1) 3) (= (distance fridge1 stove1) 2)
    (= (distance fridge1 microwave1) 1) (= (distance fridge1 fridge1) 0))
  (:goal (and (contains mug1 water) (hot mug1) (not (clean mug1))
              (exists (?p - place) (at mug1 ?p))))
  (:metric minimize (total-cost)))
