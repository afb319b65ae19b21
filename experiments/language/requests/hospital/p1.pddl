(define (problem WardOneNoon)
  (:domain HospitalWard)
  (:objects
    Room101 Room102 - PatientRoom
    NurseStation Kitchenette - ServiceRoom
    BedA BedB BedC BedD - Bed
    MrSmith MrsJones MissBrown - Patient
    Aspirin CoughSyrup - Medicine
    SoupBowl PorridgeBowl - Meal
    LinenSet1 LinenSet2 - Linen
    WoolBlanket TeddyBear - Belonging)
  (:init
    (RobotIn NurseStation) (HandFree)
    (BedIn BedA Room101) (BedIn BedB Room101) (BedIn BedC Room102) (BedIn BedD Room102)
    (LiesIn MrSmith BedA) (Occupied BedA)
    (LiesIn MrsJones BedC) (Occupied BedC)
    (LiesIn MissBrown BedD) (Occupied BedD)
    (FreshSheets BedB) (FreshSheets BedC) (FreshSheets BedD)
    (ItemIn Aspirin NurseStation) (ItemIn CoughSyrup NurseStation)
    (ItemIn SoupBowl Kitchenette) (ItemIn PorridgeBowl Kitchenette)
    (ItemIn LinenSet1 NurseStation) (ItemIn LinenSet2 NurseStation)
    (ItemIn WoolBlanket NurseStation) (ItemIn TeddyBear Room101)
    (Prescribed Aspirin MrSmith) (Prescribed CoughSyrup MrsJones)
    (HasEaten MissBrown)
    (LampOn Room101) (LampOn Room102) (LampOn NurseStation)
    (WindowOpen Room102))
  (:goal (and (HasEaten MrSmith) (HasEaten MrsJones))))
