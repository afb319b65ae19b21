"""A policy: a learned distribution over instruction sequences given the words of a clause.

It is the reward of the paper's Instruction-Tree baseline, and beyond the paper a second source of candidates for
inference (the preset ``policy``).

==================  ==============================================================================
module              holds
==================  ==============================================================================
``features``        the features of each instruction that may come next
``syntax``          which instructions may be tried at all
``reward``          likelihood, gradient, ascent
``policy``          what was learned, ready for one environment: proposing and judging sequences
``learn``           learning it from demonstrations
==================  ==============================================================================
"""
