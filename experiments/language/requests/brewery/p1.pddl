(define (problem brewery_p1)
  (:domain brewery)
  (:objects
    otto lena - worker
    brewhouse cellar yard pub - location
    tank_a tank_b - tank
    keg1 keg2 keg3 keg4 - keg
    pale_malt dark_malt - sack
    pils stout wheat_beer - beer
    van1 - van)
  (:init
    (at otto brewhouse) (at lena yard) (free otto) (free lena)
    (at tank_a brewhouse) (at tank_b cellar)
    (contains tank_a pils) (clean tank_a) (cooling_on tank_a)
    (empty tank_b)
    (at keg1 cellar) (contains keg1 stout) (clean keg1)
    (at keg2 brewhouse) (empty keg2) (clean keg2)
    (at keg3 yard) (empty keg3)
    (loaded keg4 van1) (contains keg4 pils) (clean keg4) (labelled keg4)
    (at van1 yard)
    (at pale_malt yard) (at dark_malt cellar)
    (malt_for pale_malt pils) (malt_for dark_malt stout))
  (:goal (and (labelled keg1))))
