(define (problem christmas-rush)
  (:domain post-office)
  (:objects
    counter-1 counter-2 weigh-station van-dock - location
    santa-letter bill invitation love-letter - letter
    wine-box toy-parcel shoe-box - parcel
    hole-a hole-b hole-c - pigeonhole
    airmail-sack express-sack - sack)
  (:init
    (agent-in counter-1) (empty-handed)
    (stamps-at counter-1) (stamps-at counter-2) (scale-at weigh-station)
    (shutter-of counter-1) (shutter-up counter-1) (shutter-of counter-2) (shutter-down counter-2)
    (item-at santa-letter counter-1) (item-at invitation counter-2) (item-at love-letter counter-2)
    (inside bill hole-b)
    (item-at wine-box counter-2) (item-at toy-parcel weigh-station)
    (inside shoe-box express-sack)
    (container-at hole-a weigh-station) (container-at hole-b weigh-station) (container-at hole-c weigh-station)
    (container-at airmail-sack van-dock) (container-at express-sack van-dock)
    (untied airmail-sack) (tied express-sack)
    (unstamped santa-letter) (stamped bill) (unstamped invitation) (stamped love-letter)
    (uncancelled santa-letter) (cancelled bill) (uncancelled invitation) (uncancelled love-letter)
    (unstamped wine-box) (stamped toy-parcel) (stamped shoe-box)
    (unweighed wine-box) (unweighed toy-parcel) (weighed shoe-box)
    (fragile wine-box) (registered love-letter))
  (:goal (and (tied airmail-sack))))
