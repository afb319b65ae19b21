(define (problem observatory-3-5)
  (:domain observatory)
  (:objects
    telescope1 telescope2 telescope3 - telescope
    camera1 camera2 camera3 spectrograph1 thermograph2 - instrument
    visible infrared spectrum - mode
    vega polaris - star
    mars jupiter saturn - planet
    orion_nebula - nebula
    andromeda whirlpool - galaxy
    zenith - direction)
  (:init
    (on_board camera1 telescope1) (on_board spectrograph1 telescope1)
    (on_board camera2 telescope2) (on_board thermograph2 telescope2)
    (on_board camera3 telescope3)
    (supports camera1 visible) (supports camera2 visible) (supports camera3 visible)
    (supports spectrograph1 spectrum)
    (supports thermograph2 infrared)
    (pointing telescope1 zenith)
    (pointing telescope2 jupiter)
    (pointing telescope3 polaris)
    (dome_closed telescope1)
    (dome_open telescope2)
    (dome_open telescope3)
    (power_on spectrograph1)
    (power_on camera2) (calibrated camera2)
    (power_avail telescope3)
    (have_image jupiter visible))
  (:goal (and (have_image andromeda spectrum) (have_image mars infrared) (pointing telescope2 zenith))))
