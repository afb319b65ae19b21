"""The panels of the studio's page: say, correct, demonstrate, and the object that was pointed at."""
