"""Words: the built-in lists, a domain's own lexicon, WordNet, word forms, and which object a noun names.

Begin with :mod:`tmd.language.lexicon.lexicon`.
"""
