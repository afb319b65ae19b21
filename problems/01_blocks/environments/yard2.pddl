; The blue block stands on the red one, which is in the way more often than not.
(define (problem yard2)
  (:domain blocks)
  (:objects red_block green_block blue_block - block)
  (:init
    (on_table red_block) (on_table green_block)
    (on blue_block red_block)
    (clear green_block) (clear blue_block)
    (hand_empty))
  (:goal (and)))
