"""What was said, as PDDL goals: a clause becomes a condition that must hold when it is done.

Begin with :mod:`tmd.goals.reading.reader` (one clause) and :mod:`tmd.goals.text_following` (a whole text, clause by
clause).

==================  ==============================================================================
``table``           rows: a verb with its slots and its condition, as authors declare them
``sources``         the sources of rows for one environment: declared, learned, read off the actions
``learned``         rows that demonstrations teach
``actions``         rows that the names of a domain's actions and predicates suggest
``senses``          what English verbs have in common, whatever the domain
``nouns``           noun phrases: candidates, adjectives, relations, how many are meant
``grounder``        conditions of rows over the facts of one environment; parts stand in for wholes
``reading``         a clause as a goal, or the reason why it has none here
``why``             what forbids a condition in an environment
``steps``           the clauses of a text in the order of doing
``commitments``     what later clauses must not undo
``follow``          which goal each step has in the state reached so far
==================  ==============================================================================
"""
