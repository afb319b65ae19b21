(define (problem fridayShoot)
  (:domain photoStudio)
  (:objects
    mainSet windowCorner makeupRoom waitingArea storeCupboard - spot
    clara mrBell nina oskar - person
    digitalCamera filmCamera oldCamera - camera
    tallTripod shortTripod - tripod
    keyLight fillLight hairLight - light
    tableFan - fan
    whiteBackdrop greyBackdrop blueBackdrop - backdrop
    leftBlind rightBlind - blind)
  (:init
    (personAt clara waitingArea)
    (personAt mrBell waitingArea)
    (personAt nina makeupRoom)
    (personAt oskar windowCorner)
    (standsAt tallTripod mainSet)
    (standsAt shortTripod windowCorner)
    (standsAt keyLight mainSet)
    (standsAt fillLight mainSet)
    (standsAt hairLight mainSet)
    (standsAt tableFan storeCupboard)
    (switchedOn keyLight)
    (switchedOn hairLight)
    (rolledDown blueBackdrop)
    (blindShut rightBlind)
    (mounted filmCamera tallTripod)
    (loose digitalCamera)
    (loose oldCamera)
    (tripodFree shortTripod)
    (capOn digitalCamera)
    (capOn oldCamera)
    (lensDirty filmCamera)
    (batteryFlat oldCamera))
  (:goal (and (photographedWith clara digitalCamera) (not (rolledDown blueBackdrop))))
)
