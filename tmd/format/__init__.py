"""Formatting of PDDL and JSON: the same layout everywhere; comments and the author's own line breaks stay.

Begin with :mod:`tmd.format.files`.
"""
