(define (problem after-the-show)
  (:domain theatre-stage)
  (:objects
    forestage backstage balcony workshop lighting_booth - zone
    white green violet - colour
    bench lantern umbrella suitcase parrot - prop
    flat_wagon tree_wagon - wagon
    follow_spot moon_spot - spotlight
    house_curtain back_curtain - curtain
    grave_trap - trapdoor
    fog1 fog2 - fog_machine)
  (:init
    (stagehand_in forestage) (desk_in lighting_booth) (rope_in house_curtain backstage) (rope_in back_curtain backstage)
    (located bench forestage) (located lantern forestage) (located umbrella forestage)
    (located suitcase balcony) (located parrot balcony)
    (located flat_wagon forestage) (located tree_wagon backstage) (loaded_on bench flat_wagon)
    (raised house_curtain) (raised back_curtain)
    (lit follow_spot) (lit moon_spot) (aimed_at follow_spot forestage) (aimed_at moon_spot balcony)
    (filter follow_spot white) (filter moon_spot violet)
    (trap_in grave_trap backstage)
    (fogging fog1))
  (:goal (not (raised house_curtain))))
