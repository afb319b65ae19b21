"""Fuzzing and killing ``tmd``: ``python -m experiments.robustness --minutes 5``."""
