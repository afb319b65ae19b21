"""From tagged tokens to clauses: chunks, the grammar, attachment of prepositions, subordinate clauses, pronouns.

Begin with :mod:`tmd.language.syntax.attachment`, whose rules ``docs/language.md`` has.
"""
