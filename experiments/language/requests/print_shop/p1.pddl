(define (problem print_shop_thursday)
  (:domain print_shop)
  (:objects
    big_press small_press - machine
    wedding_invitations concert_posters parish_magazine business_cards lost_cat_flyers - job
    glossy_paper plain_paper stiff_card - paper)
  (:init
    (switched_on big_press)
    (loaded big_press glossy_paper)
    (tray_empty small_press)
    (needs wedding_invitations stiff_card) (needs concert_posters glossy_paper) (needs parish_magazine plain_paper)
    (needs business_cards stiff_card) (needs lost_cat_flyers plain_paper)
    (approved wedding_invitations) (approved concert_posters) (approved parish_magazine) (approved business_cards)
    (printed parish_magazine) (printed business_cards)
    (trimmed business_cards) (boxed business_cards))
  (:goal (and (printed concert_posters))))
