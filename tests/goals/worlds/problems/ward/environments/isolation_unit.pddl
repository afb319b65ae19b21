; Two isolation rooms behind an anteroom whose doors are interlocked, with a kitchen and a storeroom off the corridor.
(define (problem isolation_unit)
  (:domain ward)
  (:objects
    back-corridor - corridor
    anteroom-1 - anteroom
    room-1 room-2 - single-room
    ward-kitchen - kitchen
    storeroom-1 - storeroom
    outer-door inner-door kitchen-door storeroom-door - door
    mr-novak mrs-bell - patient
    doctor-reyes - doctor
    bed-1 bed-2 - bed
    kitchen-worktop - worktop
    steel-nightstand wooden-nightstand - nightstand
    tea-cart supply-cart - cart
    steel-locker - cupboard
    milk-fridge - fridge
    yellow-bin - bin
    sharps-box-2 - sharps-box
    night-lamp desk-lamp - lamp
    infusion-pump feeding-pump - pump
    wall-tv - television
    oxygen-monitor - monitor
    hand-scanner - scanner
    small-basin kitchen-basin - basin
    wall-charger - dock
    aspirin cough-syrup antibiotic - medicine
    green-sheet yellow-sheet - sheet
    red-blanket brown-blanket - blanket
    flat-pillow - pillow
    blue-card white-card - keycard
    bleach-spray - spray
    breakfast-tray sandwich - meal
    water-jug - jug
    tea-cup coffee-cup - cup
    swab urine-sample - sample
    admission-chart - chart
    clean-needle dirty-needle - needle
    stethoscope - instrument)
  (:init
    (leads outer-door back-corridor anteroom-1) (leads outer-door anteroom-1 back-corridor)
    (leads inner-door anteroom-1 room-1) (leads inner-door room-1 anteroom-1)
    (leads kitchen-door back-corridor ward-kitchen) (leads kitchen-door ward-kitchen back-corridor)
    (leads storeroom-door back-corridor storeroom-1) (leads storeroom-door storeroom-1 back-corridor)
    (adjoins back-corridor room-2) (adjoins room-2 back-corridor)
    (located outer-door back-corridor) (located outer-door anteroom-1) (opened outer-door)
    (located inner-door anteroom-1) (located inner-door room-1)
    (located kitchen-door back-corridor) (located kitchen-door ward-kitchen) (opened kitchen-door)
    (located storeroom-door back-corridor) (located storeroom-door storeroom-1) (locked storeroom-door)
    (interlocked outer-door inner-door) (interlocked inner-door outer-door)
    (clean-zone ward-kitchen)
    (fits blue-card storeroom-door) (fits white-card steel-locker) (fits blue-card kitchen-door)
    ; furniture and devices
    (located bed-1 room-1) (located steel-nightstand room-1) (located night-lamp room-1)
    (located infusion-pump room-1) (located oxygen-monitor room-1) (located yellow-bin room-1)
    (located bed-2 room-2) (located wooden-nightstand room-2) (located wall-tv room-2) (located feeding-pump room-2)
    (located small-basin anteroom-1) (located sharps-box-2 anteroom-1) (located hand-scanner back-corridor)
    (located supply-cart back-corridor) (located wall-charger back-corridor)
    (located kitchen-worktop ward-kitchen) (located milk-fridge ward-kitchen) (located tea-cart ward-kitchen)
    (located kitchen-basin ward-kitchen)
    (located steel-locker storeroom-1) (locked steel-locker) (located desk-lamp storeroom-1)
    (opened sharps-box-2) (sharps-safe sharps-box-2)
    (for-supplies milk-fridge) (for-supplies steel-locker) (chilled milk-fridge)
    (powered infusion-pump) (powered wall-tv) (powered oxygen-monitor) (powered night-lamp) (powered hand-scanner)
    (keeps-alive infusion-pump mr-novak)
    (faulty feeding-pump)
    ; people
    (located mr-novak room-1) (lies-in mr-novak bed-1)
    (located mrs-bell room-2)
    (located doctor-reyes back-corridor) (licensed doctor-reyes)
    ; beds and linen
    (spread-on yellow-sheet bed-2)
    (stored-in green-sheet steel-locker) (located green-sheet storeroom-1) (fresh green-sheet)
    (on-top red-blanket bed-2) (located red-blanket room-2)
    (on-top brown-blanket supply-cart) (located brown-blanket back-corridor)
    (on-top flat-pillow supply-cart) (located flat-pillow back-corridor)
    ; other things
    (on-top blue-card kitchen-worktop) (located blue-card ward-kitchen)
    (on-top white-card wooden-nightstand) (located white-card room-2)
    (on-top bleach-spray supply-cart) (located bleach-spray back-corridor) (hazardous bleach-spray)
    (on-top breakfast-tray tea-cart) (located breakfast-tray ward-kitchen) (edible breakfast-tray) (bulky breakfast-tray)
    (on-top sandwich kitchen-worktop) (located sandwich ward-kitchen) (edible sandwich)
    (stored-in water-jug milk-fridge) (located water-jug ward-kitchen) (edible water-jug)
    (on-top tea-cup tea-cart) (located tea-cup ward-kitchen) (edible tea-cup)
    (on-top coffee-cup kitchen-worktop) (located coffee-cup ward-kitchen) (edible coffee-cup)
    (on-top aspirin supply-cart) (located aspirin back-corridor) (drug aspirin) (prescribed-for aspirin mrs-bell)
    (scanned aspirin)
    (on-top cough-syrup supply-cart) (located cough-syrup back-corridor) (drug cough-syrup)
    (prescribed-for cough-syrup mr-novak)
    (stored-in antibiotic steel-locker) (located antibiotic storeroom-1) (drug antibiotic)
    (prescribed-for antibiotic mr-novak)
    (on-top swab steel-nightstand) (located swab room-1) (infectious swab)
    (on-top urine-sample wooden-nightstand) (located urine-sample room-2) (infectious urine-sample)
    (on-top admission-chart wooden-nightstand) (located admission-chart room-2)
    (on-top dirty-needle steel-nightstand) (located dirty-needle room-1) (sharp dirty-needle) (infectious dirty-needle)
    (on-top clean-needle supply-cart) (located clean-needle back-corridor) (sharp clean-needle)
    (on-top stethoscope wooden-nightstand) (located stethoscope room-2)
    (robot-in back-corridor) (gripper-free) (charged))
  (:goal (and)))
