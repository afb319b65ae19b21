(define (problem library-p1)
  (:domain library)
  (:objects
    fiction_shelf history_shelf science_shelf - shelf
    front_desk reading_desk - desk
    returns_box - box
    cart1 - cart
    novel atlas dictionary cookbook biography comic thriller - book
    anna tom - patron)
  (:init
    (robot-at front_desk) (hand-empty)
    (cart-at cart1 front_desk)
    (on-shelf novel science_shelf)
    (on-desk atlas reading_desk)
    (on-shelf dictionary history_shelf) (damaged dictionary)
    (on-desk cookbook front_desk)
    (on-desk biography front_desk)
    (in-box comic returns_box) (damaged comic)
    (lent-to thriller tom)
    (waiting-at anna front_desk) (waiting-at tom front_desk)
    (has-lamp front_desk) (has-lamp reading_desk) (lamp-on front_desk)
    (has-tape front_desk))
  (:goal (and)))
