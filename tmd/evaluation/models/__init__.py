"""The models that experiments compare: those of the paper and their rivals.

Begin with :mod:`tmd.evaluation.models.model`, the protocol; :mod:`~tmd.evaluation.models.paper_models` has the rows of
Table II.
"""
