(define (problem tuesday-evening)
  (:domain fitness-studio)
  (:objects
    cardio-room weight-room yoga-room laundry-room - room
    dumbbell-rack - rack
    treadmill-1 treadmill-2 - treadmill
    rowing-machine-1 - rowing-machine
    ceiling-fan - fan
    light-dumbbell heavy-dumbbell - dumbbell
    blue-mat green-mat - mat
    white-towel striped-towel - towel
    water-bottle - bottle
    laura martin - member
    yoga-window cardio-window - window)
  (:init
    (has-washing-machine laundry-room)
    (has-water-tap laundry-room)
    (located-in treadmill-1 cardio-room)
    (located-in treadmill-2 cardio-room)
    (located-in rowing-machine-1 cardio-room)
    (located-in ceiling-fan weight-room)
    (window-of yoga-window yoga-room)
    (window-of cardio-window cardio-room)
    (window-open yoga-window)
    (switched-on treadmill-1)
    (switched-on rowing-machine-1)
    (out-of-order treadmill-2)
    (present-in laura cardio-room)
    (working-out-on laura treadmill-1)
    (present-in martin weight-room)
    (stored-in light-dumbbell dumbbell-rack)
    (stored-in heavy-dumbbell weight-room)
    (stored-in blue-mat yoga-room)
    (stored-in green-mat cardio-room)
    (stored-in white-towel laundry-room)
    (stored-in striped-towel weight-room)
    (dirty striped-towel)
    (stored-in water-bottle cardio-room))
  (:goal (and (wiped-down rowing-machine-1))))
