(define (problem WardTwoEvening)
  (:domain HospitalWard)
  (:objects
    Room201 Room202 Room203 - PatientRoom
    NurseStation - ServiceRoom
    Bed1 Bed2 Bed3 Bed4 - Bed
    Anna Ben Clara - Patient
    Ibuprofen Insulin - Medicine
    Sandwich - Meal
    LinenSet - Linen
    Crutches Wheelchair - Belonging)
  (:init
    (RobotIn NurseStation) (HandFree)
    (BedIn Bed1 Room201) (BedIn Bed2 Room202) (BedIn Bed3 Room203) (BedIn Bed4 Room203)
    (LiesIn Anna Bed1) (Occupied Bed1)
    (LiesIn Ben Bed2) (Occupied Bed2)
    (LiesIn Clara Bed3) (Occupied Bed3)
    (FreshSheets Bed1) (FreshSheets Bed2)
    (ItemIn Ibuprofen NurseStation) (ItemIn Insulin NurseStation) (ItemIn Sandwich NurseStation)
    (ItemIn LinenSet NurseStation) (ItemIn Crutches Room201) (ItemIn Wheelchair Room203)
    (Prescribed Insulin Anna) (Prescribed Ibuprofen Ben) (Prescribed Ibuprofen Clara)
    (LampOn Room203) (LampOn NurseStation)
    (WindowOpen Room202))
  (:goal (and (TookMedicine Anna Insulin) (not (WindowOpen Room202)))))
