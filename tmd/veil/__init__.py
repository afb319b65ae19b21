"""The verb-environment-instruction library (section V of the paper).

==================  ==============================================================================
module              holds
==================  ==============================================================================
``demonstration``   texts with the instruction sequences that people gave for them, aligned
``goal``            what such a text asks for, as a condition; faults of it in their place
``split``           which instructions of a segment served which of its clauses
``tidy``            leaving out the detours of a sequence
``states``          what can be said of one object in a state: its own states, its relations
``template``        generalising a demonstrated sequence: objects become variables
``library``         the templates of a corpus, by verb; what a demonstration shows, clause by clause
``mentions``        nouns of a clause to the objects of an environment
``world``           an environment, ground, with its objects' states, kinds and nouns
``instantiate``     a template in a new environment: the three rules of section V-A
``roots``           where domains, problems and environments are looked for
``corpus``          the bundled environments and demonstrations of a domain
``replay``          playing a demonstration step by step
==================  ==============================================================================
"""
