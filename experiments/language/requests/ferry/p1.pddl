(define (problem eight-o-clock-crossing)
  (:domain car-ferry)
  (:objects
    quay car-deck lounge bridge sun-deck - place
    blue-car yellow-car - car
    red-van - van
    old-motorbike - motorbike
    mrs-holm tim - passenger
    life-jacket-1 life-jacket-2 life-jacket-3 - life-jacket
    brown-suitcase - suitcase
    tea-thermos - thermos
    bow-ramp - ramp
    ship-horn - horn)
  (:init
    (hand-at car-deck) (hand-empty)
    (is-quay quay) (is-car-deck car-deck)
    (stairs quay car-deck) (stairs car-deck quay)
    (stairs car-deck lounge) (stairs lounge car-deck)
    (stairs lounge sun-deck) (stairs sun-deck lounge)
    (stairs lounge bridge) (stairs bridge lounge)
    (horn-at ship-horn bridge)
    (ashore red-van) (ashore blue-car) (ashore old-motorbike) (aboard yellow-car)
    (loose red-van) (loose blue-car) (loose old-motorbike) (loose yellow-car)
    (ramp-down bow-ramp)
    (sits-in mrs-holm lounge) (sits-in tim sun-deck)
    (lying-in life-jacket-1 bridge) (lying-in life-jacket-2 bridge) (lying-in life-jacket-3 lounge)
    (lying-in brown-suitcase quay) (lying-in tea-thermos lounge))
  (:goal (and (ramp-up bow-ramp))))
