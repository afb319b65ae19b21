(define (problem saturday)
  (:domain ski-rental)
  (:objects
    red-skis blue-skis kids-skis - skis
    snowboard-1 snowboard-2 - snowboard
    boots-38 boots-41 boots-43 - boots
    helmet-s helmet-l - helmet
    front-rack back-rack - place
    anna ben mr-keller - customer)
  (:init
    (in red-skis front-rack) (in kids-skis workshop)
    (in snowboard-1 front-rack) (in snowboard-2 workshop)
    (in boots-38 drying-room) (in boots-41 drying-room)
    (in helmet-s back-rack) (in helmet-l front-rack)
    (rented blue-skis ben) (rented boots-43 ben)
    (fits red-skis anna) (fits red-skis ben) (fits red-skis mr-keller)
    (fits blue-skis anna) (fits blue-skis ben) (fits blue-skis mr-keller)
    (fits snowboard-1 anna) (fits snowboard-1 ben) (fits snowboard-2 anna) (fits snowboard-2 ben)
    (fits boots-38 anna) (fits boots-41 mr-keller) (fits boots-43 ben)
    (fits helmet-s anna) (fits helmet-l ben) (fits helmet-l mr-keller)
    (broken snowboard-2)
    (waxed red-skis)
    (dry boots-41) (dry helmet-s) (dry helmet-l)
    (heater-on))
  (:goal (waxed kids-skis)))
