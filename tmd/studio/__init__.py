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
``energies``        ranked plans side by side, in a narrow panel
``about``           what there is to know of an object
``words``           facts and broken preconditions in plain words
``studio``          what all visitors share: the domain, its environments made ready, the teacher
``setting``         an environment made ready: its world, and what there is to see of it
``reel``            the states that are stepped through, and how each looks
``meshes``          from URDF to meshes for the browser
``figure``          the PR2 as a figure
``scenery``         the 3D view of one visitor
``performance``     the simulated robot carries a plan out, and a visitor watches
``visitor``         one browser: its view, its panels, its keys
``*_panel``         say, demonstrate, correct, object
``page``            the HTML of the panels
``widgets``         small things about inputs
``server``          the web server
==================  ==============================================================================
"""
