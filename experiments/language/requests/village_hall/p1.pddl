(define (problem hall-1)
  (:domain hall)
  (:objects
    r1 - robot
    hall office cellar store yard - room
    table1 table2 desk shelf - surface
    box1 box2 box3 - box
    vase projector cable kettle banner - item
    john mary - person)
  (:init
    (at r1 hall) (free r1)
    (link hall office) (link office hall)
    (link hall cellar) (link cellar hall)
    (link hall store) (link store hall)
    (link hall yard) (link yard hall)
    (locked store)
    (lit hall) (lit cellar)
    (at table1 hall) (at table2 hall) (at desk office) (at shelf cellar)
    (clear table2) (clear desk)
    (on vase table1) (on projector shelf)
    (at box1 hall) (at box2 office) (at box3 store)
    (brought john box1) (brought mary box2)
    (open box2)
    (in cable box1) (in banner box2)
    (at kettle yard))
  (:goal (and (on projector table2) (in vase box2))))
