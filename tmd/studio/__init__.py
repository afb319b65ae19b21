"""Watching, correcting and demonstrating.

==================  ==============================================================================
module              holds
==================  ==============================================================================
``pieces``          the text of a demonstration, cleaned and cut into clauses
``session``         one person's demonstration under way
``history``         undo and redo
``alignment``       which clause a step serves, as a proposal
``offers``          what may be done with an object, and why the rest may not
``words``           facts and broken preconditions in plain words
==================  ==============================================================================
"""
