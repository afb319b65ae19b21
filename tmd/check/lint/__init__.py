"""Warnings on domains and problems that are legal PDDL and hardly ever meant.

Begin with :mod:`tmd.check.lint.domain`; :mod:`~tmd.check.lint.problem` also finds what may ever hold, without
grounding.
"""
