"""Which tools take what ``tmd export`` writes: ``python -m experiments.interop``."""
