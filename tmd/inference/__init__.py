"""The energy of a grounding and its minimisation (sections IV and VI of the paper).

==================  ==============================================================================
module              holds
==================  ==============================================================================
``factors``         the factors Δ, one short function each
``statistics``      what is counted in the training data for priors and consistency
``energy``          the factors of a choice, and their weighing
``weights``         what each factor weighs: a text file
``constraints``     getConstraints: what a sequence needs of the state it begins in
``config``          one definition of each model: the presets
``proposers``       what may be done for a clause: templates, a policy, the planner
``algorithm1``      Algorithm 1 over the clauses
``plans``           the ways through the clauses, the ranked plans that come of them, and why each lost
``learn``           the weights by descent on the structured hinge
``journal``         what learning has proposed so far, on disk: after a kill it goes on
==================  ==============================================================================
"""
