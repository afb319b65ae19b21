(define (problem guesthouse-laundry)
  (:domain laundry-room)
  (:objects
    washer-1 washer-2 - washer
    dryer-1 - dryer
    basket-1 basket-2 - basket
    folding-table - table
    ironing-board - ironing-table
    linen-shelf - closet
    clothesline - line
    pillowcase-a pillowcase-b pillowcase-c - bedding
    tablecloth apron silk-scarf - cloth
    bath-robe - towel)
  (:init
    (robot-at basket-1) (hand-free)
    (has-door washer-1) (has-door washer-2) (has-door dryer-1)
    (shut washer-1) (shut washer-2) (shut dryer-1)
    (airy clothesline)
    (has-detergent washer-2)
    (is-in pillowcase-a basket-1) (dirty pillowcase-a)
    (is-in pillowcase-b basket-1) (dirty pillowcase-b)
    (is-in pillowcase-c basket-2) (dirty pillowcase-c)
    (is-in apron basket-2) (dirty apron)
    (is-in silk-scarf folding-table) (dirty silk-scarf) (delicate silk-scarf)
    (is-in tablecloth washer-1) (wet tablecloth)
    (is-in bath-robe dryer-1))
  (:goal (and (folded bath-robe) (is-in bath-robe linen-shelf))))
