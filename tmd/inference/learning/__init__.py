"""Learning the weights of the energy from demonstrations (section VI-F), and the statistics of its priors.

Begin with :mod:`tmd.inference.learning.weight_learning`.
"""
