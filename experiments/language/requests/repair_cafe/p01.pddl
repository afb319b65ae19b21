(define (problem saturday)
  (:domain repair_cafe)
  (:objects toaster kitchen_radio travel_radio coffee_grinder alarm_clock gramophone teddy
            screwdriver soldering_iron sewing_kit
            olga ben farid
            mrs_lund mr_costa jill
            front_table window_table sewing_table collection_shelf tool_board
            front_lamp window_lamp sewing_lamp)
  (:init
    (item toaster) (item kitchen_radio) (item travel_radio) (item coffee_grinder)
    (item alarm_clock) (item gramophone) (item teddy)
    (electrical toaster) (electrical kitchen_radio) (electrical travel_radio)
    (electrical coffee_grinder) (electrical alarm_clock)
    (fabric teddy)
    (radio kitchen_radio) (radio travel_radio)
    (tool screwdriver) (tool soldering_iron) (tool sewing_kit) (tool multimeter)
    (volunteer olga) (volunteer ben) (volunteer farid)
    (visitor mrs_lund) (visitor mr_costa) (visitor jill)
    (place front_table) (place window_table) (place sewing_table) (place collection_shelf) (place tool_board)
    (table front_table) (table window_table) (table sewing_table)
    (lamp front_lamp) (lamp window_lamp) (lamp sewing_lamp)
    (lamp_at front_lamp front_table) (lamp_at window_lamp window_table) (lamp_at sewing_lamp sewing_table)
    (portable toaster) (portable kitchen_radio) (portable travel_radio) (portable coffee_grinder)
    (portable alarm_clock) (portable gramophone) (portable teddy)
    (portable screwdriver) (portable soldering_iron) (portable sewing_kit) (portable multimeter)

    (belongs_to toaster mrs_lund) (belongs_to coffee_grinder mrs_lund)
    (belongs_to kitchen_radio mr_costa) (belongs_to gramophone mr_costa)
    (belongs_to alarm_clock jill) (belongs_to teddy jill)

    (opens screwdriver toaster) (opens screwdriver kitchen_radio) (opens screwdriver travel_radio)
    (opens screwdriver coffee_grinder) (opens screwdriver alarm_clock) (opens screwdriver gramophone)
    (mends screwdriver toaster) (mends screwdriver coffee_grinder) (mends soldering_iron kitchen_radio)
    (mends sewing_kit teddy) (mends screwdriver gramophone)
    (knows_how ben toaster) (knows_how ben coffee_grinder) (knows_how farid kitchen_radio)
    (knows_how farid coffee_grinder) (knows_how olga teddy)

    (lies_on toaster front_table) (lies_on alarm_clock front_table)
    (lies_on kitchen_radio window_table) (lies_on gramophone window_table) (lies_on screwdriver window_table)
    (lies_on teddy sewing_table) (lies_on sewing_kit tool_board)
    (lies_on travel_radio collection_shelf)
    (lies_on coffee_grinder front_table)
    (lies_on soldering_iron tool_board) (lies_on multimeter tool_board)

    (sits_at ben front_table) (sits_at farid front_table) (sits_at olga sewing_table)
    (lit front_lamp) (lit sewing_lamp)
    (broken toaster) (broken kitchen_radio) (broken coffee_grinder) (broken gramophone)
    (torn teddy)
    (opened_up kitchen_radio) (opened_up alarm_clock)
    (plugged_in coffee_grinder)
    (dusty travel_radio) (dusty alarm_clock) (dusty gramophone))
  (:goal (and (has mrs_lund toaster) (not (broken toaster)) (not (torn teddy))))
)
