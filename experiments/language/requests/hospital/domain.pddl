;; Ward robot. Names as in the ward's data base.
(define (domain HospitalWard)
  (:requirements :adl)
  (:types
    Room Bed Patient Item - object
    PatientRoom ServiceRoom - Room
    Medicine Meal Linen Belonging - Item)
  (:predicates
    (RobotIn ?r - Room)
    (BedIn ?b - Bed ?r - Room)
    (LiesIn ?p - Patient ?b - Bed)
    (Occupied ?b - Bed)
    (FreshSheets ?b - Bed)
    (ItemIn ?i - Item ?r - Room)
    (Holds ?i - Item)
    (HandFree)
    (Prescribed ?m - Medicine ?p - Patient)
    (TookMedicine ?p - Patient ?m - Medicine)
    (Served ?p - Patient ?m - Meal)
    (HasEaten ?p - Patient)
    (LampOn ?r - Room)
    (WindowOpen ?r - Room))
  (:action GoTo
    :parameters (?from ?to - Room)
    :precondition (and (RobotIn ?from) (not (= ?from ?to)))
    :effect (and (not (RobotIn ?from)) (RobotIn ?to)))
  (:action TakeItem
    :parameters (?i - Item ?r - Room)
    :precondition (and (RobotIn ?r) (ItemIn ?i ?r) (HandFree))
    :effect (and (Holds ?i) (not (ItemIn ?i ?r)) (not (HandFree))))
  (:action PutItem
    :parameters (?i - Item ?r - Room)
    :precondition (and (RobotIn ?r) (Holds ?i))
    :effect (and (ItemIn ?i ?r) (HandFree) (not (Holds ?i))))
  (:action GiveMedicine
    :parameters (?m - Medicine ?p - Patient ?b - Bed ?r - Room)
    :precondition (and (RobotIn ?r) (BedIn ?b ?r) (LiesIn ?p ?b) (Holds ?m) (Prescribed ?m ?p)
                       (not (TookMedicine ?p ?m)))
    :effect (TookMedicine ?p ?m))
  (:action ServeMeal
    :parameters (?m - Meal ?p - Patient ?b - Bed ?r - Room)
    :precondition (and (RobotIn ?r) (BedIn ?b ?r) (LiesIn ?p ?b) (Holds ?m) (not (HasEaten ?p)))
    :effect (and (Served ?p ?m) (HasEaten ?p) (not (Holds ?m)) (HandFree)))
  (:action ChangeSheets
    :parameters (?b - Bed ?l - Linen ?r - Room)
    :precondition (and (RobotIn ?r) (BedIn ?b ?r) (Holds ?l) (not (Occupied ?b)))
    :effect (and (FreshSheets ?b) (not (Holds ?l)) (HandFree)))
  (:action MovePatient
    :parameters (?p - Patient ?b1 - Bed ?r1 - Room ?b2 - Bed ?r2 - Room)
    :precondition (and (RobotIn ?r1) (HandFree) (LiesIn ?p ?b1) (BedIn ?b1 ?r1) (BedIn ?b2 ?r2)
                       (not (Occupied ?b2)))
    :effect (and (LiesIn ?p ?b2) (Occupied ?b2) (not (LiesIn ?p ?b1)) (not (Occupied ?b1))
                 (not (RobotIn ?r1)) (RobotIn ?r2)))
  (:action FlipLampSwitch
    :parameters (?r - Room)
    :precondition (RobotIn ?r)
    :effect (and (when (LampOn ?r) (not (LampOn ?r)))
                 (when (not (LampOn ?r)) (LampOn ?r))))
  (:action OpenWindow
    :parameters (?r - PatientRoom)
    :precondition (and (RobotIn ?r) (not (WindowOpen ?r)))
    :effect (WindowOpen ?r))
  (:action CloseWindow
    :parameters (?r - PatientRoom)
    :precondition (and (RobotIn ?r) (WindowOpen ?r))
    :effect (not (WindowOpen ?r))))
