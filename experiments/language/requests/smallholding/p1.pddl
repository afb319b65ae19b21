(define (problem smallholding-2-3-5)
(:domain smallholding)
(:objects
 tractor1 tractor2 - tractor
 plough1 drill1 reaper1 - tool
 yard barn lane - loc
 field1 field2 field3 field4 field5 - field
 wheat oats clover barley - crop)
(:init
 (link yard barn) (link barn yard) (link yard lane) (link lane yard)
 (link lane field1) (link field1 lane) (link lane field2) (link field2 lane)
 (link lane field3) (link field3 lane) (link field3 field4) (link field4 field3)
 (link lane field5) (link field5 lane)
 (at tractor1 yard) (bare tractor1)
 (at tractor2 barn) (hitched plough1 tractor2)
 (at drill1 barn) (free drill1) (empty drill1)
 (at reaper1 yard) (free reaper1)
 (ploughs plough1) (drills drill1) (reaps reaper1)
 (seed wheat barn) (seed oats barn) (seed clover barn)
 (fallow field1) (ploughed field2) (sown field3 wheat) (ripe field3) (sown field4 barley) (fallow field5))
(:goal (and (sown field1 oats) (reaped field3) (at tractor1 barn))))
