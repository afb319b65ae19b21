(define (problem serve) (:domain cafe) (:objects cup - mug bun - food sink - place) (:init (at cup counter) (at bun counter) (tap sink)) (:goal (and (full cup) (at cup counter))))
