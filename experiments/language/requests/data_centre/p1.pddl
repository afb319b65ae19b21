(define (problem NightShift)
  (:domain DataCentre)
  (:objects
    HallA HallB StoreRoom ControlRoom - Room
    Rack1 Rack2 Rack3 - Rack
    MailServer WebServer FileServer TestServer - Server
    NorthCooler SouthCooler - Cooler
    OldDisk NewDisk SpareDisk - Disk
    RedTape BlueTape - Tape
    Toolbox Laptop - Tool)
  (:init
    (TechnicianIn ControlRoom) (HandsFree)
    (DoorClosed HallB)
    (RackIn Rack1 HallA) (RackIn Rack2 HallA) (RackIn Rack3 HallB)
    (RackLocked Rack1) (RackLocked Rack3)
    (MountedIn MailServer Rack1) (MountedIn WebServer Rack1)
    (MountedIn FileServer Rack2) (MountedIn TestServer Rack3)
    (ServerRunning MailServer) (ServerRunning WebServer) (ServerRunning FileServer)
    (BackedUp WebServer)
    (Patched TestServer)
    (DiskIn OldDisk FileServer)
    (DiskBayFree MailServer) (DiskBayFree WebServer) (DiskBayFree TestServer)
    (LyingIn NewDisk StoreRoom) (LyingIn SpareDisk ControlRoom)
    (LyingIn RedTape StoreRoom) (LyingIn BlueTape HallA)
    (LyingIn Toolbox HallB) (LyingIn Laptop ControlRoom)
    (CoolerIn NorthCooler HallA) (CoolerIn SouthCooler HallB)
    (CoolerRunning NorthCooler)
    (FilterClean SouthCooler))
  (:goal (and (BackedUp MailServer) (Patched MailServer))))
