"""Sources of the meanings of verbs: the lexicon, demonstrations, and the actions of the domain.

Begin with :mod:`tmd.goals.sources.table`, the form that all three have.
"""
