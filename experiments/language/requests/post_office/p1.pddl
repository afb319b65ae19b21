(define (problem before-opening)
  (:domain post-office)
  (:objects
    front-desk back-room sorting-table loading-bay - location
    letter-smith letter-jones postcard - letter
    red-parcel big-parcel - parcel
    pigeonhole-north pigeonhole-south - pigeonhole
    mail-sack - sack)
  (:init
    (agent-in back-room) (empty-handed)
    (stamps-at front-desk) (scale-at back-room)
    (shutter-of front-desk) (shutter-down front-desk)
    (shutter-of loading-bay) (shutter-up loading-bay)
    (item-at letter-smith front-desk) (item-at letter-jones front-desk) (item-at postcard sorting-table)
    (item-at red-parcel front-desk) (item-at big-parcel loading-bay)
    (container-at pigeonhole-north sorting-table) (container-at pigeonhole-south sorting-table)
    (container-at mail-sack loading-bay) (tied mail-sack)
    (unstamped letter-smith) (unstamped letter-jones) (stamped postcard) (unstamped red-parcel) (stamped big-parcel)
    (uncancelled letter-smith) (uncancelled letter-jones) (uncancelled postcard)
    (unweighed red-parcel) (unweighed big-parcel)
    (fragile red-parcel) (registered letter-jones))
  (:goal (and (stamped letter-smith))))
