"""The PR2 in a simulated kitchen: scene, motion, skills, and the check after every instruction."""
