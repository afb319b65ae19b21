"""From text to tagged tokens: words and their places, and which of them are verbs, nouns or adjectives.

Begin with :mod:`tmd.language.tagging.first_tags`; :mod:`~tmd.language.tagging.readings` decides what words lists leave
open.
"""
