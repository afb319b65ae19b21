"""PDDL: its nouns, its semantics, reading, writing, grounding and validating.

==================  ==============================================================================
module              holds
==================  ==============================================================================
``model``           types, objects, atoms, formulas, effects, action schemas, domain, problem
``semantics``       what PDDL means: ``holds``, ``apply`` (the paper's Φ), ``regress``
``task``            the ground form that searching uses: states and conditions as bit sets
==================  ==============================================================================
"""
