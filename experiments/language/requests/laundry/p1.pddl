(define (problem saturday-laundry)
  (:domain laundry-room)
  (:objects
    washing-machine - washer
    tumble-dryer - dryer
    laundry-basket - basket
    folding-table - table
    ironing-board - ironing-table
    wardrobe - closet
    clothesline - line
    blue-shirt white-shirt - shirt
    red-towel green-towel - towel
    bed-sheet - bedding
    work-jeans - trousers
    wool-socks - socks)
  (:init
    (robot-at folding-table) (hand-free)
    (has-door washing-machine) (has-door tumble-dryer) (has-door wardrobe)
    (shut washing-machine) (shut tumble-dryer) (shut wardrobe)
    (airy clothesline)
    (is-in blue-shirt laundry-basket) (dirty blue-shirt)
    (is-in red-towel laundry-basket) (dirty red-towel)
    (is-in green-towel laundry-basket) (dirty green-towel)
    (is-in wool-socks laundry-basket) (dirty wool-socks) (delicate wool-socks)
    (is-in white-shirt folding-table)
    (is-in bed-sheet washing-machine) (wet bed-sheet)
    (is-in work-jeans clothesline))
  (:goal (and (not (dirty blue-shirt)) (is-in blue-shirt wardrobe))))
