"""The passes from text to clauses, which :mod:`tmd.language.parser` calls in order.

Words: :mod:`~tmd.language.syntax.tokens`, :mod:`~tmd.language.syntax.sentences` with the turns of phrase of
:mod:`~tmd.language.syntax.idioms`. Their classes: :mod:`~tmd.language.syntax.tokens` from lists,
:mod:`~tmd.language.syntax.part_of_speech` from the neighbours. Clauses: :mod:`~tmd.language.syntax.requests`,
:mod:`~tmd.language.syntax.subordinate`, :mod:`~tmd.language.syntax.chunking`,
:mod:`~tmd.language.syntax.attachment`, :mod:`~tmd.language.syntax.subordinate`,
:mod:`~tmd.language.syntax.pronouns`.
"""
