"""Readers: a request becomes steps with candidate goals.

Begin with :mod:`tmd.readers.interface`. :mod:`tmd.readers.rules` is the offline reader (grammar and lexicon);
:mod:`tmd.readers.llm` asks a language model.
"""

from tmd.readers.interface import CandidateGoal, Dialogue, Reader, Refusal, Step

__all__ = ["CandidateGoal", "Dialogue", "Reader", "Refusal", "Step"]
