"""Demonstrations in the making: what was done step by step, drafts, corrections, and saving what is finished.

Begin with :mod:`tmd.studio.demonstrations.session`.
"""
