(define (problem saturday-morning)
  (:domain ice-rink)
  (:objects
    skate-desk workshop cloakroom cafe - place
    main-rink kids-rink - rink
    main-gate kids-gate - gate
    red-skates blue-skates hockey-skates - skates
    penguin-1 penguin-2 - penguin
    old-broom - broom
    nora felix - skater
    ice-machine - machine)
  (:init
    (steward-at skate-desk) (hands-free)
    (linked skate-desk workshop) (linked workshop skate-desk)
    (linked skate-desk cloakroom) (linked cloakroom skate-desk)
    (linked cloakroom cafe) (linked cafe cloakroom)
    (linked cloakroom main-rink) (linked main-rink cloakroom)
    (linked cloakroom kids-rink) (linked kids-rink cloakroom)
    (has-grinder workshop) (has-charger workshop)
    (lies-at red-skates cloakroom) (lies-at blue-skates cafe) (lies-at hockey-skates workshop)
    (lies-at penguin-1 main-rink) (lies-at penguin-2 cloakroom) (lies-at old-broom main-rink)
    (blunt red-skates) (blunt blue-skates) (sharp hockey-skates)
    (fits red-skates felix) (fits hockey-skates felix) (fits blue-skates nora)
    (waiting-at nora cloakroom) (waiting-at felix cloakroom)
    (in-socks nora) (in-socks felix)
    (leads-to main-gate main-rink) (leads-to kids-gate kids-rink)
    (gate-closed main-gate) (gate-open kids-gate)
    (rough main-rink) (rough kids-rink)
    (flat-battery ice-machine))
  (:goal (and (smooth main-rink))))
