(define (domain theatre-stage)
  (:requirements :adl)
  (:types
    zone colour - object
    movable device - object
    prop wagon - movable
    spotlight curtain trapdoor fog_machine - device)
  (:predicates
    (stagehand_in ?z - zone)
    (located ?m - movable ?z - zone)
    (loaded_on ?p - prop ?w - wagon)
    (held ?p - prop)
    (raised ?c - curtain)
    (lit ?s - spotlight)
    (aimed_at ?s - spotlight ?z - zone)
    (filter ?s - spotlight ?k - colour)
    (trap_in ?t - trapdoor ?z - zone)
    (gaping ?t - trapdoor)
    (fogging ?f - fog_machine)
    (desk_in ?z - zone)
    (rope_in ?c - curtain ?z - zone))

  (:action go
    :parameters (?from ?to - zone)
    :precondition (stagehand_in ?from)
    :effect (and (stagehand_in ?to) (not (stagehand_in ?from))))

  (:action lift
    :parameters (?p - prop ?z - zone)
    :precondition (and (stagehand_in ?z) (located ?p ?z) (forall (?q - prop) (not (held ?q))))
    :effect (and (held ?p) (not (located ?p ?z)) (forall (?w - wagon) (not (loaded_on ?p ?w)))))

  (:action set_down
    :parameters (?p - prop ?z - zone)
    :precondition (and (stagehand_in ?z) (held ?p) (forall (?t - trapdoor) (not (and (trap_in ?t ?z) (gaping ?t)))))
    :effect (and (located ?p ?z) (not (held ?p))))

  (:action load
    :parameters (?p - prop ?w - wagon ?z - zone)
    :precondition (and (stagehand_in ?z) (held ?p) (located ?w ?z))
    :effect (and (loaded_on ?p ?w) (located ?p ?z) (not (held ?p))))

  ; everything on the wagon comes along
  (:action push_wagon
    :parameters (?w - wagon ?from ?to - zone)
    :precondition (and (stagehand_in ?from) (located ?w ?from) (not (= ?from ?to))
                       (forall (?q - prop) (not (held ?q)))
                       (forall (?t - trapdoor) (not (and (trap_in ?t ?to) (gaping ?t)))))
    :effect (and (located ?w ?to) (not (located ?w ?from)) (stagehand_in ?to) (not (stagehand_in ?from))
                 (forall (?p - prop) (when (loaded_on ?p ?w) (and (located ?p ?to) (not (located ?p ?from)))))))

  (:action raise
    :parameters (?c - curtain ?z - zone)
    :precondition (and (stagehand_in ?z) (rope_in ?c ?z) (not (raised ?c)))
    :effect (raised ?c))

  (:action lower
    :parameters (?c - curtain ?z - zone)
    :precondition (and (stagehand_in ?z) (rope_in ?c ?z) (raised ?c))
    :effect (not (raised ?c)))

  (:action toggle_light
    :parameters (?s - spotlight ?z - zone)
    :precondition (and (stagehand_in ?z) (desk_in ?z))
    :effect (and (when (lit ?s) (not (lit ?s))) (when (not (lit ?s)) (lit ?s))))

  (:action aim
    :parameters (?s - spotlight ?target ?z - zone)
    :precondition (and (stagehand_in ?z) (desk_in ?z))
    :effect (and (aimed_at ?s ?target) (forall (?o - zone) (when (not (= ?o ?target)) (not (aimed_at ?s ?o))))))

  (:action change_filter
    :parameters (?s - spotlight ?k - colour ?z - zone)
    :precondition (and (stagehand_in ?z) (desk_in ?z) (not (lit ?s)))
    :effect (and (filter ?s ?k) (forall (?o - colour) (when (not (= ?o ?k)) (not (filter ?s ?o))))))

  (:action work_trap
    :parameters (?t - trapdoor ?z - zone)
    :precondition (and (stagehand_in ?z) (trap_in ?t ?z))
    :effect (and (when (gaping ?t) (not (gaping ?t))) (when (not (gaping ?t)) (gaping ?t))))

  (:action start_fog
    :parameters (?f - fog_machine ?z - zone)
    :precondition (and (stagehand_in ?z) (desk_in ?z) (not (fogging ?f)))
    :effect (fogging ?f))

  (:action stop_fog
    :parameters (?f - fog_machine ?z - zone)
    :precondition (and (stagehand_in ?z) (desk_in ?z) (fogging ?f))
    :effect (not (fogging ?f)))
)
