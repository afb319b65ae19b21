; Two bays off a hallway, with a nurses' station, a locked pharmacy and a sluice room. The robot's battery is low.
(define (problem east_wing)
  (:domain ward)
  (:objects
    hallway - corridor
    nurses-station - station
    bay-a bay-b - bay
    pharmacy-room - pharmacy
    sluice-room - sluice
    pharmacy-door sluice-door - door
    mrs-hill mr-okafor miss-lang - patient
    nurse-joy - nurse
    bed-1 bed-2 bed-3 bed-4 - bed
    reception-desk - desk
    nightstand-1 nightstand-3 - nightstand
    meal-trolley drug-trolley - cart
    linen-cupboard drug-cabinet - cupboard
    drug-fridge - fridge
    laundry-hamper - hamper
    sharps-box-1 - sharps-box
    reading-lamp bedside-lamp ceiling-lamp - lamp
    heart-monitor - monitor
    ventilator-1 - ventilator
    barcode-scanner - scanner
    sluice-basin - basin
    charging-dock - dock
    paracetamol penicillin insulin morphine - medicine
    white-sheet blue-sheet striped-sheet grey-sheet - sheet
    wool-blanket - blanket
    spare-pillow - pillow
    master-key - keycard
    spray-bottle - spray
    lunch-tray soup-bowl - meal
    blood-sample - sample
    red-chart green-chart - chart
    used-needle - needle
    thermometer - instrument)
  (:init
    (adjoins hallway nurses-station) (adjoins nurses-station hallway)
    (adjoins hallway bay-a) (adjoins bay-a hallway) (adjoins hallway bay-b) (adjoins bay-b hallway)
    (leads pharmacy-door hallway pharmacy-room) (leads pharmacy-door pharmacy-room hallway)
    (leads sluice-door hallway sluice-room) (leads sluice-door sluice-room hallway)
    (located pharmacy-door hallway) (located pharmacy-door pharmacy-room) (locked pharmacy-door)
    (located sluice-door hallway) (located sluice-door sluice-room)
    (clean-zone pharmacy-room)
    (fits master-key pharmacy-door) (fits master-key drug-cabinet)
    ; furniture and devices
    (located bed-1 bay-a) (located bed-2 bay-a) (located nightstand-1 bay-a) (located reading-lamp bay-a)
    (located bed-3 bay-b) (located bed-4 bay-b) (located nightstand-3 bay-b) (located bedside-lamp bay-b)
    (located heart-monitor bay-b) (located ventilator-1 bay-b)
    (located ceiling-lamp hallway) (located meal-trolley hallway) (located linen-cupboard hallway)
    (located reception-desk nurses-station) (located barcode-scanner nurses-station)
    (located drug-trolley nurses-station) (located charging-dock nurses-station)
    (located drug-cabinet pharmacy-room) (locked drug-cabinet) (located drug-fridge pharmacy-room)
    (located laundry-hamper sluice-room) (opened laundry-hamper)
    (located sharps-box-1 sluice-room) (opened sharps-box-1) (sharps-safe sharps-box-1)
    (located sluice-basin sluice-room)
    (for-supplies linen-cupboard) (for-supplies drug-cabinet) (for-supplies drug-fridge) (chilled drug-fridge)
    (powered ceiling-lamp) (powered bedside-lamp) (powered heart-monitor) (powered ventilator-1)
    (keeps-alive ventilator-1 mr-okafor)
    ; people
    (located mrs-hill bay-a) (lies-in mrs-hill bed-1)
    (located mr-okafor bay-b) (lies-in mr-okafor bed-3)
    (located miss-lang bay-a)
    (located nurse-joy nurses-station) (licensed nurse-joy)
    (fasting mr-okafor)
    ; beds and linen
    (spread-on white-sheet bed-2) (fresh white-sheet) (made-up bed-2) (disinfected bed-2)
    (spread-on grey-sheet bed-4)
    (stored-in blue-sheet linen-cupboard) (located blue-sheet hallway) (fresh blue-sheet)
    (stored-in striped-sheet linen-cupboard) (located striped-sheet hallway) (fresh striped-sheet)
    (on-top wool-blanket bed-4) (located wool-blanket bay-b)
    (stored-in spare-pillow linen-cupboard) (located spare-pillow hallway)
    ; other things
    (on-top master-key reception-desk) (located master-key nurses-station)
    (on-top red-chart reception-desk) (located red-chart nurses-station)
    (on-top green-chart nightstand-3) (located green-chart bay-b)
    (on-top paracetamol drug-trolley) (located paracetamol nurses-station) (drug paracetamol)
    (prescribed-for paracetamol mrs-hill)
    (on-top penicillin drug-trolley) (located penicillin nurses-station) (drug penicillin)
    (prescribed-for penicillin mr-okafor)
    (stored-in insulin drug-fridge) (located insulin pharmacy-room) (drug insulin) (needs-cold insulin)
    (prescribed-for insulin miss-lang)
    (stored-in morphine drug-cabinet) (located morphine pharmacy-room) (drug morphine) (controlled morphine)
    (prescribed-for morphine mr-okafor)
    (on-top lunch-tray meal-trolley) (located lunch-tray hallway) (edible lunch-tray)
    (on-top soup-bowl meal-trolley) (located soup-bowl hallway) (edible soup-bowl)
    (on-top spray-bottle nightstand-1) (located spray-bottle bay-a) (hazardous spray-bottle)
    (on-top used-needle nightstand-3) (located used-needle bay-b) (sharp used-needle) (infectious used-needle)
    (on-top blood-sample nightstand-1) (located blood-sample bay-a) (infectious blood-sample)
    (on-top thermometer nightstand-1) (located thermometer bay-a)
    (bulky lunch-tray) (bulky wool-blanket)
    (robot-in hallway) (gripper-free))
  (:goal (and)))
