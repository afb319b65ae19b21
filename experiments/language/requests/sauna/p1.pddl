(define (problem Evening)
  (:domain SaunaHouse)
  (:objects FinnishSauna BioSauna - Sauna
            ColdPool WhirlPool - Pool
            Lounge Reception LaundryRoom - Room
            BlueTowel WhiteTowel - Towel
            SmallRobe LargeRobe - Robe
            CedarBucket - Bucket
            MrsBerg Tim Olga - Guest
            Cold Mild Hot - Level)
  (:init (isOpen FinnishSauna) (isOpen Lounge) (isOpen Reception) (isOpen LaundryRoom)
         (isOpen ColdPool) (isOpen WhirlPool)
         (isLaundry LaundryRoom)
         (heatedTo FinnishSauna Mild) (heatedTo BioSauna Cold)
         (covered ColdPool) (covered WhirlPool)
         (lightOn Lounge) (lightOn Reception) (lightOn FinnishSauna)
         (guestIn MrsBerg FinnishSauna) (guestIn Tim Reception) (guestIn Olga Lounge)
         (itemIn BlueTowel LaundryRoom) (itemIn WhiteTowel Lounge)
         (itemIn SmallRobe LaundryRoom) (itemIn LargeRobe Reception)
         (itemIn CedarBucket Reception)
         (isWet WhiteTowel) (isWet SmallRobe))
  (:goal (has Tim BlueTowel)))
