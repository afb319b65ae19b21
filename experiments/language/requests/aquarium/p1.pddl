(define (problem AquariumP1)
  (:domain Aquarium)
  (:objects
    ReefTank ShoreTank QuarantineTank TouchPool - Tank
    Clownfish Seahorse - Fish
    LittleRay BigRay - Ray
    Octopus Turtle - Animal
    Shrimp Lettuce Pellets - Food)
  (:init
    (LivesIn Clownfish ReefTank) (LivesIn Seahorse ReefTank) (LivesIn LittleRay ReefTank)
    (LivesIn BigRay QuarantineTank) (LivesIn Octopus ShoreTank) (LivesIn Turtle ShoreTank)
    (Eats Clownfish Pellets) (Eats Clownfish Shrimp) (Eats Seahorse Shrimp) (Eats Octopus Shrimp)
    (Eats LittleRay Shrimp) (Eats BigRay Shrimp) (Eats Turtle Lettuce) (Eats Turtle Pellets)
    (IsSick Clownfish) (IsSick Seahorse)
    (GlassClean ShoreTank)
    (PumpRunning ReefTank) (PumpRunning ShoreTank) (PumpRunning TouchPool)
    (LightOn ReefTank) (LightOn ShoreTank) (LightOn QuarantineTank) (LightOn TouchPool)
    (LidClosed ReefTank) (LidClosed QuarantineTank))
  (:goal (GlassClean ReefTank)))
