"""Plans to look at: one HTML page that needs nothing else, and the pieces that it is made of.

==================  ==============================================================================
module              holds
==================  ==============================================================================
``markup``          the templates, and the style that all pieces share
``phrases``         where in a text the words of a clause stand
``meaning``         what the nouns of a text came to mean in a plan
``clauses``         the text with its clauses lit up
``anatomy``         what is part of what, and which facts are states, edges and relations
``layout``          where the parts of an object are drawn
``graph``           the object graph of one object, as SVG
``candidates``      ranked plans: energies by factor, why each lost
==================  ==============================================================================

``clauses``, ``graph`` and ``candidates`` return fragments that stand in any page with :func:`tmd.view.markup.style`.
"""
