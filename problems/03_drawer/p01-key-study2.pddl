; Compiled from environments/study2.yaml; only the goal is written by hand.
(define (problem key_study2)
  (:domain drawer)

  (:objects
    cabinet1 - cabinet
    cabinet1_top_drawer cabinet1_bottom_drawer - drawer
    table1 - table
    key1 - key
    pen1 - pen
    stapler1 - stapler
  )

  (:init
    (allows cabinet1 on)
    (allows cabinet1_bottom_drawer in)
    (allows cabinet1_top_drawer in)
    (allows table1 on)
    (at key1 cabinet1_top_drawer in)
    (at pen1 cabinet1_bottom_drawer in)
    (at stapler1 table1 on)
    (closes cabinet1_bottom_drawer)
    (closes cabinet1_top_drawer)
    (free pr2)
    (opened cabinet1_bottom_drawer)
    (part_of cabinet1_bottom_drawer cabinet1)
    (part_of cabinet1_top_drawer cabinet1)
  )

  (:goal (at key1 table1 on))
)
