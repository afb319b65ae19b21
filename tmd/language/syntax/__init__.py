"""The passes from text to clauses, which :mod:`tmd.language.parser` calls in order. Begin with that.

Words and their classes: :mod:`~tmd.language.syntax.tokens`, :mod:`~tmd.language.syntax.tagger` with
:mod:`~tmd.language.syntax.rows`. Turns of phrase: :mod:`~tmd.language.syntax.phrases`. Terminals of the grammar:
:mod:`~tmd.language.syntax.joins`, :mod:`~tmd.language.syntax.brackets`, :mod:`~tmd.language.syntax.grammar`. Clauses:
:mod:`~tmd.language.syntax.reading`, :mod:`~tmd.language.syntax.antecedents`.
"""
