"""Readers: a request becomes steps with candidate goals.

Begin with :mod:`tmd.readers.interface`. :mod:`tmd.readers.rules` is the offline reader
(grammar and lexicon).
"""
