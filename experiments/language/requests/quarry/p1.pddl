(define (problem quarry-2-2-5)
  (:domain quarry)
  (:objects
    driver1 driver2 - driver
    truck1 truck2 - truck
    granite1 granite2 marble1 marble2 slate1 - slab
    north_pit south_pit saw_hall yard pier - location)
  (:init
    (at driver1 yard)
    (at driver2 pier)
    (at truck1 yard)
    (empty truck1)
    (at truck2 saw_hall)
    (empty truck2)
    (at granite1 north_pit)
    (at granite2 north_pit)
    (at marble1 south_pit)
    (at marble2 saw_hall)
    (in slate1 truck2)
    (saw_at saw_hall)
    (polisher_at saw_hall)
    (link yard north_pit) (link north_pit yard)
    (link yard south_pit) (link south_pit yard)
    (link yard saw_hall) (link saw_hall yard)
    (link saw_hall pier) (link pier saw_hall))
  (:goal (and (at marble1 pier) (polished marble1))))
