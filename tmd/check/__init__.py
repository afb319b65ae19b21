"""Diagnostics for authors of domains: every fault of their files at once, each with its place and a hint.

Begin with :mod:`tmd.check.report`, what ``tmd check`` calls; it runs :mod:`~tmd.check.checker` on each file. PDDL is
checked by :mod:`~tmd.check.pddl_file` and :mod:`~tmd.check.lint`, the lexicon by :mod:`~tmd.check.lexicon`, the other
files of a domain by :mod:`~tmd.check.data_files`. The codes and their meanings are in :mod:`~tmd.check.diagnostic`.
"""
