"""Learning from demonstrations while more of them come.

Begin with :mod:`tmd.studio.learning.teaching`.
"""
