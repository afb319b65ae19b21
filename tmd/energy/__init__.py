"""The energy of a grounding and its minimisation (sections IV and VI of the paper).

==================  ==============================================================================
module              holds
==================  ==============================================================================
``factors``         the factors Δ, one short function each
``statistics``      what is counted in the training data for priors and consistency
``energy``          the factors of a choice, and their weighing
``weights``         what each factor weighs: a text file
``constraints``     getConstraints: what a sequence needs of the state it begins in
``infer``           Algorithm 1, and a policy that may propose and judge beside the templates
``plans``           the ranked plans that come out of it, and why each lost
``learn``           the weights by descent on the structured hinge
``journal``         what learning has proposed so far, on disk: after a kill it goes on
==================  ==============================================================================
"""
