; Three blocks, each on the table.
(define (problem yard1)
  (:domain blocks)
  (:objects red_block green_block blue_block - block)
  (:init
    (on_table red_block) (on_table green_block) (on_table blue_block)
    (clear red_block) (clear green_block) (clear blue_block)
    (hand_empty))
  (:goal (and)))
