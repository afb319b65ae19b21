"""Plans to look at: one HTML page that needs nothing else, and the pieces that it is made of.

====================  ============================================================================
module                holds
====================  ============================================================================
``markup``            the templates, and the style that all pieces share
``phrases``           where in a text the words of a clause stand
``meaning``           what the nouns of a text came to mean in a plan
``clauses``           the text with its clauses lit up
``anatomy``           what is part of what, and which facts are states, edges and relations
``layout``            where the parts of an object are drawn
``graph``             the object graph of one object, as SVG
``candidates``        ranked plans: energies by factor, why each lost
``wording``           facts and conditions in plain words: the comments of the domain's predicates
``goals``             what the steps of a text ask for, in words, and where in a plan it comes to hold
``subject``           what a page is about
``demonstrated``      a demonstration as that
``grounding_record``  a grounded text as the record that `tmd ground --json` prints
``run_record``        what a robot made of a plan, from a record or a log of `tmd run`
``pictures``          the filmstrip of a run, picture by picture
``steps``             the plan step by step: facts, and objects before and after
``page``              the whole page
====================  ============================================================================

``clauses``, ``graph`` and ``candidates`` return fragments that stand in any page with :func:`tmd.view.markup.style`.
"""
