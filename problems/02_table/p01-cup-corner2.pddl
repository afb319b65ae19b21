; Compiled from environments/corner2.yaml; only the goal is written by hand.
(define (problem cup_corner2)
  (:domain table)

  (:objects
    table1 table2 - table
    shelf1 - shelf
    cup1 - cup
    book1 - book
  )

  (:init
    (at book1 shelf1 on)
    (at cup1 shelf1 on)
    (free pr2)
  )

  (:goal (at cup1 table1 on))
)
