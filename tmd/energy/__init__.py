"""The energy of a grounding and its minimisation (sections IV and VI of the paper).

==================  ==============================================================================
module              holds
==================  ==============================================================================
``factors``         the factors Δ, one short function each
``weights``         what each factor weighs: a text file
``constraints``     getConstraints: what a sequence needs of the state it begins in
``infer``           Algorithm 1, and the ranked plans that come out of it
==================  ==============================================================================
"""
