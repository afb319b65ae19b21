"""Watching, correcting and demonstrating.

==================  ==============================================================================
module              holds
==================  ==============================================================================
``pieces``          the text of a demonstration, cleaned and cut into clauses
``session``         one person's demonstration under way
``history``         undo and redo
``alignment``       which clause a step serves, as a proposal
``words``           facts and broken preconditions in plain words
==================  ==============================================================================
"""
