"""Turns of phrase in plain words: wishes, questions, passives and states become imperatives before they are parsed.

Begin with :mod:`tmd.language.rewriting.sentences`; a new turn of phrase goes into
:mod:`~tmd.language.rewriting.idioms`.
"""
