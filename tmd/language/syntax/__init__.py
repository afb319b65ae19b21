"""The passes from text to clauses, which :mod:`tmd.language.parser` calls in order. Begin with that.

Words and their classes from lists: :mod:`~tmd.language.syntax.tokens`; from their neighbours:
:mod:`~tmd.language.syntax.part_of_speech`. Before that, turns of phrase are put plainly:
:mod:`~tmd.language.syntax.sentences` with :mod:`~tmd.language.syntax.idioms`. Clauses:
:mod:`~tmd.language.syntax.requests`, :mod:`~tmd.language.syntax.subordinate` (conditions and what hangs on a clause),
:mod:`~tmd.language.syntax.chunking`, :mod:`~tmd.language.syntax.attachment`, :mod:`~tmd.language.syntax.antecedents`.
"""
