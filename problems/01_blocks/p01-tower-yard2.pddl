; The environment yard2 with a goal.
(define (problem tower_yard2)
  (:domain blocks)
  (:objects red_block green_block blue_block - block)
  (:init
    (on_table red_block) (on_table green_block)
    (on blue_block red_block)
    (clear green_block) (clear blue_block)
    (hand_empty))
  (:goal (on red_block green_block)))
