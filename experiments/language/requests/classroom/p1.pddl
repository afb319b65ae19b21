(define (problem after-lunch)
  (:domain classroom)
  (:objects teacher-desk front-desk - desk
            bookshelf windowsill - shelf
            cupboard1 - cupboard
            window1 window2 door1 - openable
            projector lights - device
            blackboard whiteboard - board
            fern cactus - plant
            atlas dictionary - book
            globe scissors - item
            paper-bin - bin)
  (:init (at fern windowsill) (at cactus windowsill) (at scissors windowsill)
         (at globe front-desk) (at atlas front-desk)
         (at dictionary bookshelf)
         (at sponge teacher-desk)
         (at watering-can cupboard1)
         (is-open door1) (is-open cupboard1)
         (is-on lights)
         (full paper-bin)
         (has-door cupboard1))
  (:goal (watered fern)))
