(define (problem pharmacy_saturday)
  (:domain pharmacy)
  (:objects
    front_counter back_shelf - place
    cold_cabinet safe - lockable
    ibuprofen amoxicillin cough_syrup insulin morphine eye_drops nasal_spray vitamin_tablets - medicine
    mrs_hall mr_okoye - customer)
  (:init
    (hand_free)
    (stored ibuprofen back_shelf) (stored amoxicillin back_shelf) (stored cough_syrup front_counter)
    (stored insulin cold_cabinet) (stored morphine safe)
    (locked safe)
    (labelled insulin)
    (prescribed amoxicillin mrs_hall) (prescribed cough_syrup mrs_hall) (prescribed insulin mr_okoye)
    (sold_out eye_drops) (sold_out nasal_spray) (sold_out vitamin_tablets)
    (ordered nasal_spray))
  (:goal (and (given_to insulin mr_okoye))))
