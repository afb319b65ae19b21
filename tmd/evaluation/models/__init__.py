"""What an experiment compares: the models of the paper and their rivals, each of which learns and predicts.

Begin with :mod:`tmd.evaluation.models.model`, the protocol; :mod:`~tmd.evaluation.models.paper_models` has the rows of
Table II.
"""
