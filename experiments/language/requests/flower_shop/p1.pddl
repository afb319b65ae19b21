(define (problem monday)
(:domain flowershop)
(:objects greta milo - florist
          mrs-hill - customer
          counter window backroom doorstep - spot
          red-rose white-rose yellow-tulip pink-tulip lily - flower
          cactus fern orchid - potplant
          tall-vase small-vase - vase
          bucket1 - bucket)
(:init
 (path counter window) (path window counter)
 (path counter backroom) (path backroom counter)
 (path counter doorstep) (path doorstep counter)
 (tap backroom)
 (is-at greta counter) (is-at milo backroom) (is-at mrs-hill counter)
 (lies red-rose backroom) (lies white-rose backroom)
 (lies yellow-tulip backroom) (lies pink-tulip backroom)
 (lies lily window) (wilted lily)
 (lies cactus window) (lies fern counter) (thirsty fern)
 (lies orchid window) (thirsty orchid)
 (lies tall-vase counter) (lies small-vase backroom)
 (lies bucket1 doorstep) (full bucket1))
(:goal (and (sold red-rose mrs-hill)))
)
