; A technician robot in a data centre.
(define (domain DataCentre)
  (:requirements :strips :typing :negative-preconditions)
  (:types
    Room Rack Device Movable - object
    Cooler - Device
    Server Portable - Movable
    Disk Tape Tool - Portable)
  (:predicates
    (TechnicianIn ?r - Room)
    (Holding ?m - Movable)
    (HandsFree)
    (LyingIn ?p - Movable ?r - Room)
    (RackIn ?k - Rack ?r - Room)
    (RackLocked ?k - Rack)
    (MountedIn ?s - Server ?k - Rack)
    (ServerRunning ?s - Server)
    (BackedUp ?s - Server)
    (Patched ?s - Server)
    (DiskIn ?d - Disk ?s - Server)
    (DiskBayFree ?s - Server)
    (CoolerIn ?c - Cooler ?r - Room)
    (CoolerRunning ?c - Cooler)
    (FilterClean ?c - Cooler)
    (DoorClosed ?r - Room))

  (:action Walk
    :parameters (?from ?to - Room)
    :precondition (and (TechnicianIn ?from) (not (DoorClosed ?to)) (not (DoorClosed ?from)))
    :effect (and (TechnicianIn ?to) (not (TechnicianIn ?from))))

  (:action OpenDoor
    :parameters (?r - Room)
    :precondition (DoorClosed ?r)
    :effect (not (DoorClosed ?r)))

  (:action CloseDoor
    :parameters (?r - Room)
    :precondition (not (DoorClosed ?r))
    :effect (DoorClosed ?r))

  (:action PickUp
    :parameters (?m - Movable ?r - Room)
    :precondition (and (TechnicianIn ?r) (LyingIn ?m ?r) (HandsFree))
    :effect (and (Holding ?m) (not (LyingIn ?m ?r)) (not (HandsFree))))

  (:action PutDown
    :parameters (?m - Movable ?r - Room)
    :precondition (and (TechnicianIn ?r) (Holding ?m))
    :effect (and (LyingIn ?m ?r) (HandsFree) (not (Holding ?m))))

  (:action UnlockRack
    :parameters (?k - Rack ?r - Room)
    :precondition (and (TechnicianIn ?r) (RackIn ?k ?r) (RackLocked ?k))
    :effect (not (RackLocked ?k)))

  (:action LockRack
    :parameters (?k - Rack ?r - Room)
    :precondition (and (TechnicianIn ?r) (RackIn ?k ?r) (not (RackLocked ?k)))
    :effect (RackLocked ?k))

  (:action StartServer
    :parameters (?s - Server ?k - Rack ?r - Room)
    :precondition (and (TechnicianIn ?r) (RackIn ?k ?r) (MountedIn ?s ?k) (not (RackLocked ?k)) (not (ServerRunning ?s)))
    :effect (ServerRunning ?s))

  (:action ShutDownServer
    :parameters (?s - Server ?k - Rack ?r - Room)
    :precondition (and (TechnicianIn ?r) (RackIn ?k ?r) (MountedIn ?s ?k) (not (RackLocked ?k)) (ServerRunning ?s))
    :effect (not (ServerRunning ?s)))

  (:action BackUpServer
    :parameters (?s - Server ?t - Tape ?k - Rack ?r - Room)
    :precondition (and (TechnicianIn ?r) (RackIn ?k ?r) (MountedIn ?s ?k) (not (RackLocked ?k)) (Holding ?t) (ServerRunning ?s))
    :effect (BackedUp ?s))

  (:action InstallPatch
    :parameters (?s - Server ?k - Rack ?r - Room)
    :precondition (and (TechnicianIn ?r) (RackIn ?k ?r) (MountedIn ?s ?k) (not (RackLocked ?k)) (ServerRunning ?s) (not (Patched ?s)))
    :effect (Patched ?s))

  (:action InsertDisk
    :parameters (?d - Disk ?s - Server ?k - Rack ?r - Room)
    :precondition (and (TechnicianIn ?r) (RackIn ?k ?r) (MountedIn ?s ?k) (not (RackLocked ?k)) (Holding ?d) (DiskBayFree ?s) (not (ServerRunning ?s)))
    :effect (and (DiskIn ?d ?s) (HandsFree) (not (Holding ?d)) (not (DiskBayFree ?s))))

  (:action RemoveDisk
    :parameters (?d - Disk ?s - Server ?k - Rack ?r - Room)
    :precondition (and (TechnicianIn ?r) (RackIn ?k ?r) (MountedIn ?s ?k) (not (RackLocked ?k)) (DiskIn ?d ?s) (HandsFree) (not (ServerRunning ?s)))
    :effect (and (Holding ?d) (DiskBayFree ?s) (not (DiskIn ?d ?s)) (not (HandsFree))))

  (:action UnmountServer
    :parameters (?s - Server ?k - Rack ?r - Room)
    :precondition (and (TechnicianIn ?r) (RackIn ?k ?r) (MountedIn ?s ?k) (not (RackLocked ?k)) (HandsFree) (not (ServerRunning ?s)))
    :effect (and (Holding ?s) (not (MountedIn ?s ?k)) (not (HandsFree))))

  (:action MountServer
    :parameters (?s - Server ?k - Rack ?r - Room)
    :precondition (and (TechnicianIn ?r) (RackIn ?k ?r) (Holding ?s) (not (RackLocked ?k)))
    :effect (and (MountedIn ?s ?k) (HandsFree) (not (Holding ?s))))

  (:action StartCooler
    :parameters (?c - Cooler ?r - Room)
    :precondition (and (TechnicianIn ?r) (CoolerIn ?c ?r) (not (CoolerRunning ?c)))
    :effect (CoolerRunning ?c))

  (:action StopCooler
    :parameters (?c - Cooler ?r - Room)
    :precondition (and (TechnicianIn ?r) (CoolerIn ?c ?r) (CoolerRunning ?c))
    :effect (not (CoolerRunning ?c)))

  (:action CleanFilter
    :parameters (?c - Cooler ?r - Room)
    :precondition (and (TechnicianIn ?r) (CoolerIn ?c ?r) (HandsFree) (not (CoolerRunning ?c)))
    :effect (FilterClean ?c)))
