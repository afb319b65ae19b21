"""What is allowed in PDDL and hardly ever meant: warnings on domains and problems.

Begin with :mod:`tmd.check.lint.domain`; :mod:`~tmd.check.lint.reachable` says what may ever hold, told without
grounding.
"""
