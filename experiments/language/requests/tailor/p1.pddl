(define (problem fridayAfternoon)
  (:domain tailorShop)
  (:objects jacket skirt trousers shirt waistcoat eveningGown
            whiteThread blackThread blueThread
            oldSinger newBernina steamIron
            rail shopWindow)
  (:init
    (garment jacket) (garment skirt) (garment trousers) (garment shirt) (garment waistcoat) (garment eveningGown)
    (thread whiteThread) (thread blackThread) (thread blueThread)
    (sewingMachine oldSinger) (sewingMachine newBernina) (iron steamIron)
    (electric oldSinger) (electric newBernina) (electric steamIron)
    (place sewingTable) (place ironingBoard) (place counter) (place rail) (place shopWindow)

    (located jacket rail) (torn jacket) (buttonMissing jacket)
    (located shirt rail) (buttonMissing shirt)
    (located skirt sewingTable)
    (located trousers counter) (torn trousers)
    (located waistcoat counter)
    (located eveningGown shopWindow) (torn eveningGown)

    (suits blackThread jacket) (suits blackThread trousers) (suits blackThread waistcoat)
    (suits whiteThread shirt) (suits blueThread skirt)

    (threaded oldSinger whiteThread) (unthreaded newBernina)
    (pluggedIn oldSinger) (pluggedIn newBernina))
  (:goal (and (wrapped shirt) (hemmed skirt) (not (torn jacket)))))
