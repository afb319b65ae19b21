(define (problem saturday-afternoon)
  (:domain boardgame-cafe)
  (:objects
    priya oskar tom june mrs-lindqvist - guest
    chess backgammon dominoes mahjong scrabble - game
    window-table corner-table round-table bar-table - table
    lemonade mint-tea ginger-beer hot-chocolate - drink)
  (:init
    (waiting priya)
    (waiting oskar)
    (seated tom window-table)
    (seated june corner-table)
    (seated mrs-lindqvist round-table)
    (on-table chess window-table)
    (on-table dominoes corner-table)
    (in-cabinet backgammon)
    (in-cabinet mahjong)
    (lent-to scrabble mrs-lindqvist)
    (knows tom chess)
    (knows june dominoes)
    (knows mrs-lindqvist scrabble)
    (knows mrs-lindqvist backgammon)
    (served tom mint-tea)
    (clean round-table)
    (clean bar-table))
  (:goal (and (clean window-table) (clean corner-table))))
