(define (problem hair-salon-p1)
  (:domain hair-salon)
  (:objects
    sally - helper
    mrs-lane mr-okafor jenny tim - client
    basin-chair window-chair mirror-chair - chair
    waiting-sofa - sofa
    scissors clippers hairbrush - tool
    tail-comb wide-comb - comb
    trolley drawer steriliser - place
    coffee tea - drink)
  (:init
    (seated mrs-lane waiting-sofa) (seated mr-okafor waiting-sofa) (seated tim waiting-sofa)
    (seated jenny mirror-chair) (taken mirror-chair)
    (has-basin basin-chair)
    (washed jenny) (wet jenny)
    (cuts-hair scissors) (cuts-hair clippers)
    (kept-in scissors trolley) (kept-in clippers trolley) (kept-in hairbrush drawer)
    (kept-in tail-comb trolley) (kept-in wide-comb drawer)
    (dirty scissors) (dirty clippers) (dirty wide-comb))
  (:goal (paid jenny)))
