(define (problem monday-morning)
  (:domain vet-clinic)
  (:objects
    bella rex - dog
    whiskers luna - cat
    thumper - rabbit
    cage-1 cage-2 cage-3 cage-4 cage-5 cage-6 - cage
    scalpel forceps clippers - instrument
    rabies distemper - vaccine)
  (:init
    (in-cage bella cage-1) (in-cage rex cage-2) (in-cage whiskers cage-3) (in-cage thumper cage-5)
    (on-table luna)
    (vacant cage-4) (vacant cage-6)
    (cage-open cage-2) (cage-open cage-4) (cage-open cage-6)
    (clean cage-2) (clean cage-3) (clean cage-5) (clean cage-6)
    (fed thumper) (fed luna)
    (vaccinated bella rabies)
    (wearing-cone luna)
    (sterile clippers))
  (:goal (and (weighed luna))))
