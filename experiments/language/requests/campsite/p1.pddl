(define (problem CampsiteAugust)
  (:domain Campsite)
  (:objects
    LakePitch ForestPitch HillPitch - Pitch
    Shed - Store
    UpperFirePit LowerFirePit - FirePit
    FamilyTent DomeTent - Tent
    RedLantern GreenLantern - Lantern
    GasStove CoolBox SleepingBag AirMattress - Gear)
  (:init
    (PitchedOn FamilyTent LakePitch) (Taken LakePitch)
    (Packed DomeTent)
    (ZippedUp FamilyTent)
    (KeptAt RedLantern Shed) (KeptAt GasStove Shed) (KeptAt CoolBox HillPitch) (KeptAt AirMattress Shed)
    (KeptAt GreenLantern UpperFirePit)
    (KeptInside SleepingBag FamilyTent)
    (Burning LowerFirePit))
  (:goal (and (Burning UpperFirePit))))
