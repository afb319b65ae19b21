(define (problem secondFloor)
  (:domain officeRobot)
  (:objects
    rosie - robot
    lobby meetingRoom copyRoom managerOffice - room
    meetingRoomDoor copyRoomDoor managerOfficeDoor - door
    frontDesk managerDesk - desk
    conferenceTable - table
    copyShelf - shelf
    redFolder blueFolder - folder
    smallParcel bigParcel - parcel
    ficus - plant
    laserPrinter - printer
    daniel sofia - person)
  (:init
    (robotAt rosie lobby) (handFree rosie)
    (doorBetween meetingRoomDoor lobby meetingRoom) (doorBetween meetingRoomDoor meetingRoom lobby)
    (doorBetween copyRoomDoor lobby copyRoom) (doorBetween copyRoomDoor copyRoom lobby)
    (doorBetween managerOfficeDoor lobby managerOffice) (doorBetween managerOfficeDoor managerOffice lobby)
    (doorOpen meetingRoomDoor) (doorOpen copyRoomDoor)
    (standsIn frontDesk lobby) (standsIn managerDesk managerOffice)
    (standsIn conferenceTable meetingRoom) (standsIn copyShelf copyRoom)
    (isOn redFolder frontDesk) (isOn smallParcel frontDesk)
    (isOn blueFolder copyShelf)
    (isOn bigParcel conferenceTable) (tooHeavy bigParcel)
    (lightOn lobby) (lightOn meetingRoom) (lightOn copyRoom)
    (plantIn ficus managerOffice)
    (printerIn laserPrinter copyRoom)
    (personIn daniel managerOffice) (personIn sofia meetingRoom))
  (:goal (and (isOn redFolder copyShelf))))
