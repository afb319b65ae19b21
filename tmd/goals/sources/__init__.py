"""Where the meaning of verbs comes from: declared in the lexicon, learned from demonstrations, read off the actions.

Begin with :mod:`tmd.goals.sources.table`, the form that all three have.
"""
