(define (problem zoo-monday)
  (:domain zoo)
  (:objects
    penguin-beach otter-creek - pool-enclosure
    giraffe-house monkey-house - heated-enclosure
    lion-den quarantine-pen - enclosure
    penguin otter giraffe monkey lion - animal
    herring beef hay bananas - feed)
  (:init
    (lives-in penguin penguin-beach) (lives-in otter otter-creek) (lives-in giraffe giraffe-house)
    (lives-in monkey monkey-house) (lives-in lion lion-den)
    (occupied penguin-beach) (occupied otter-creek) (occupied giraffe-house) (occupied monkey-house) (occupied lion-den)
    (gate-locked lion-den) (gate-locked monkey-house) (gate-locked penguin-beach)
    (heating-on monkey-house)
    (pool-filled penguin-beach)
    (eats penguin herring) (eats otter herring) (eats giraffe hay) (eats monkey bananas) (eats lion beef)
    (bucket-empty)
    (fed giraffe)
    (swept quarantine-pen))
  (:goal (and (fed lion))))
