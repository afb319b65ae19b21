(define (problem tuesday-session)
  (:domain recording-studio)
  (:objects
    control-room live-room vocal-booth store-cupboard - room
    acoustic-guitar bass-guitar violin - instrument
    ribbon-microphone condenser-microphone stage-microphone - microphone
    studio-headphones - headphones
    opening-song slow-ballad - song)
  (:init
    (engineer-in control-room) (hands-free)
    (gear-in acoustic-guitar live-room) (gear-in bass-guitar store-cupboard) (gear-in violin vocal-booth)
    (gear-in ribbon-microphone vocal-booth) (gear-in condenser-microphone live-room)
    (gear-in stage-microphone store-cupboard) (gear-in studio-headphones control-room)
    (tuned violin)
    (plugged-in ribbon-microphone)
    (door-closed vocal-booth) (door-closed store-cupboard)
    (recorded opening-song))
  (:goal (and (recorded slow-ballad))))
