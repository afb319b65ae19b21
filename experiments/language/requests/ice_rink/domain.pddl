; The steward of a small ice rink
(define (domain ice-rink)
  (:requirements :strips :typing)
  (:types
    place gate skater item machine - object
    rink - place
    skates penguin broom - item)

  (:predicates
    (steward-at ?p - place)
    (linked ?a ?b - place)
    (lies-at ?i - item ?p - place)
    (carrying ?i - item)
    (hands-free)
    (has-grinder ?p - place)
    (has-charger ?p - place)
    (blunt ?s - skates)
    (sharp ?s - skates)
    (fits ?s - skates ?k - skater)
    (waiting-at ?k - skater ?p - place)
    (in-socks ?k - skater)
    (wearing ?k - skater ?s - skates)
    (on-ice ?k - skater ?r - rink)
    (leads-to ?g - gate ?r - rink)
    (gate-open ?g - gate)
    (gate-closed ?g - gate)
    (rough ?r - rink)
    (smooth ?r - rink)
    (flat-battery ?m - machine)
    (charged ?m - machine))

  (:action go
    :parameters (?from ?to - place)
    :precondition (and (steward-at ?from) (linked ?from ?to))
    :effect (and (steward-at ?to) (not (steward-at ?from))))

  (:action pick-up
    :parameters (?i - item ?p - place)
    :precondition (and (steward-at ?p) (lies-at ?i ?p) (hands-free))
    :effect (and (carrying ?i) (not (lies-at ?i ?p)) (not (hands-free))))

  (:action put-down
    :parameters (?i - item ?p - place)
    :precondition (and (steward-at ?p) (carrying ?i))
    :effect (and (lies-at ?i ?p) (hands-free) (not (carrying ?i))))

  (:action sharpen
    :parameters (?s - skates ?p - place)
    :precondition (and (steward-at ?p) (has-grinder ?p) (carrying ?s) (blunt ?s))
    :effect (and (sharp ?s) (not (blunt ?s))))

  (:action lace-up
    :parameters (?k - skater ?s - skates ?p - place)
    :precondition (and (steward-at ?p) (waiting-at ?k ?p) (in-socks ?k) (carrying ?s) (sharp ?s) (fits ?s ?k))
    :effect (and (wearing ?k ?s) (hands-free) (not (in-socks ?k)) (not (carrying ?s))))

  (:action lead-onto-ice
    :parameters (?k - skater ?s - skates ?p - place ?g - gate ?r - rink)
    :precondition (and (steward-at ?p) (waiting-at ?k ?p) (wearing ?k ?s) (leads-to ?g ?r) (gate-open ?g) (linked ?p ?r))
    :effect (and (on-ice ?k ?r) (steward-at ?r) (not (waiting-at ?k ?p)) (not (steward-at ?p))))

  (:action open-gate
    :parameters (?g - gate ?r - rink)
    :precondition (and (steward-at ?r) (leads-to ?g ?r) (gate-closed ?g))
    :effect (and (gate-open ?g) (not (gate-closed ?g))))

  (:action close-gate
    :parameters (?g - gate ?r - rink)
    :precondition (and (steward-at ?r) (leads-to ?g ?r) (gate-open ?g))
    :effect (and (gate-closed ?g) (not (gate-open ?g))))

  (:action charge
    :parameters (?m - machine ?p - place)
    :precondition (and (steward-at ?p) (has-charger ?p) (flat-battery ?m))
    :effect (and (charged ?m) (not (flat-battery ?m))))

  (:action resurface
    :parameters (?r - rink ?m - machine ?g - gate)
    :precondition (and (steward-at ?r) (rough ?r) (charged ?m) (leads-to ?g ?r) (gate-closed ?g))
    :effect (and (smooth ?r) (not (rough ?r)))))
