"""Which slips of domain authors which tool catches: ``python -m experiments.checkers``."""
