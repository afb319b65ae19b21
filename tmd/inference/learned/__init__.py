"""What was learned from a domain's demonstrations, and keeping it.

==================  ==============================================================================
module              holds
==================  ==============================================================================
``knowledge``       library, policy and weights of a domain, learned from its demonstrations
``library_json``    a library as JSON
``plain``           dataclasses as JSON, whatever fields they have
``reward_json``     what a policy was learned to be, as JSON and an array
``digest``          what it was made from, as a checksum: is what was saved still true?
``store``           directories that hold all of it, written so that half of it is never used: saved, or in a cache
``progress``        learning that takes long is told of
==================  ==============================================================================
"""
