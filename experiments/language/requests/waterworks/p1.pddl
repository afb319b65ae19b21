(define (problem shift1)
  (:domain waterWorks)
  (:objects
    northTank southTank towerTank - tank
    mainPump boosterPump sparePump - pump
    northOutlet southOutlet towerOutlet bypassValve - valve
    riverGate canalGate - sluiceGate
    sandFilter carbonFilter - filterUnit)
  (:init
    (fillLvl northTank half) (fillLvl southTank empty) (fillLvl towerTank full)
    (chlDosed towerTank)
    (feeds mainPump northTank) (feeds mainPump southTank)
    (feeds boosterPump towerTank)
    (feeds sparePump southTank) (feeds sparePump towerTank)
    (isRunning mainPump)
    (outletOf northOutlet northTank) (outletOf southOutlet southTank) (outletOf towerOutlet towerTank)
    (isOpen northOutlet) (isOpen bypassValve)
    (gateRaised riverGate)
    (fltOf sandFilter mainPump) (fltOf carbonFilter boosterPump)
    (fltClean carbonFilter))
  (:goal (and (fillLvl southTank full) (chlDosed southTank))))
