(define (domain observatory)
  (:requirements :strips :typing)
  (:types telescope instrument mode direction - object
          star planet nebula galaxy - direction)
  (:predicates
    (on_board ?i - instrument ?t - telescope)
    (supports ?i - instrument ?m - mode)
    (pointing ?t - telescope ?d - direction)
    (power_avail ?t - telescope)
    (power_on ?i - instrument)
    (calibrated ?i - instrument)
    (have_image ?d - direction ?m - mode)
    (dome_open ?t - telescope)
    (dome_closed ?t - telescope))

  (:action open_dome
    :parameters (?t - telescope)
    :precondition (dome_closed ?t)
    :effect (and (dome_open ?t) (not (dome_closed ?t))))

  (:action close_dome
    :parameters (?t - telescope)
    :precondition (dome_open ?t)
    :effect (and (dome_closed ?t) (not (dome_open ?t))))

  (:action turn_to
    :parameters (?t - telescope ?d_new ?d_prev - direction)
    :precondition (pointing ?t ?d_prev)
    :effect (and (not (pointing ?t ?d_prev)) (pointing ?t ?d_new)))

  (:action switch_on
    :parameters (?i - instrument ?t - telescope)
    :precondition (and (on_board ?i ?t) (power_avail ?t))
    :effect (and (power_on ?i) (not (calibrated ?i)) (not (power_avail ?t))))

  (:action switch_off
    :parameters (?i - instrument ?t - telescope)
    :precondition (and (on_board ?i ?t) (power_on ?i))
    :effect (and (not (power_on ?i)) (power_avail ?t)))

  (:action calibrate
    :parameters (?t - telescope ?i - instrument ?d - star)
    :precondition (and (on_board ?i ?t) (power_on ?i) (pointing ?t ?d) (dome_open ?t))
    :effect (calibrated ?i))

  (:action take_image
    :parameters (?t - telescope ?d - direction ?i - instrument ?m - mode)
    :precondition (and (on_board ?i ?t) (supports ?i ?m) (power_on ?i) (calibrated ?i)
                       (pointing ?t ?d) (dome_open ?t))
    :effect (have_image ?d ?m)))
