(define (problem easter-batch)
  (:domain chocolate-factory)
  (:objects
    ines paul - worker
    kitchen shop - room
    heart-tray star-tray egg-tray - tray
    milk dark white - chocolate
    copper-kettle steel-kettle - kettle
    cooler wrapping-machine - machine)
  (:init
    (worker-at ines kitchen) (hands-free ines)
    (worker-at paul shop) (hands-free paul)
    (stands-in copper-kettle kitchen) (stands-in steel-kettle kitchen)
    (stands-in cooler cold-room) (stands-in wrapping-machine packing-room)
    (switched-on copper-kettle) (switched-on cooler)
    (melted-in milk copper-kettle) (kettle-empty steel-kettle)
    (tray-at heart-tray packing-room) (filled-with heart-tray dark) (firm heart-tray)
    (tray-at star-tray kitchen) (tray-empty star-tray)
    (tray-at egg-tray kitchen) (filled-with egg-tray white))
  (:goal (and (wrapped egg-tray) (wrapped heart-tray))))
