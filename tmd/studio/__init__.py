"""Watching, correcting and demonstrating.

==================  ==============================================================================
module              holds
==================  ==============================================================================
``pieces``          the text of a demonstration, cleaned and cut into clauses
``session``         one person's demonstration under way
``history``         undo and redo
``alignment``       which clause a step serves, as a proposal
``offers``          what may be done with an object, and why the rest may not
``correction``      a proposed plan: edits, what breaks, what a planner puts in
``tasks``           texts to draw from
``archive``         saving a session in a corpus of demonstrations
``drafts``          what is not saved yet, kept for when its visitor returns
``teaching``        what is known of a domain while demonstrations come
``training``        learning everything again, in a process of its own
``lock``            one writer at a time, among threads and processes
``about``           what there is to know of an object
``words``           facts and broken preconditions in plain words
==================  ==============================================================================
"""
