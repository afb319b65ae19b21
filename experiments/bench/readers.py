"""Time of one utterance with a kept reply of a language model beside that with rules.

``python experiments/bench/readers.py [EVERY]``: every so many-th feasible request of one clause among the kitchen's
sentence tests, each by default. The reply of the model is the goal of the test, put into a cache of its own before the
clock starts. Prints the median of both times, processor seconds, and the ratio.
"""

from __future__ import annotations

import json
import os
import statistics
import sys
import tempfile
import time

from tmd.domain_kit import DomainKit
from tmd.language import parse
from tmd.readers.llm.client import ModelClient, ModelSettings
from tmd.readers.llm.prompt import one_line
from tmd.world.corpus import Corpus
from tmd.world.folder import find_domain, find_problems
from tmd.world.sentence_file import SentenceTest, domain_sentences

EVERY = 1
SETTINGS = ModelSettings("kept", "http://127.0.0.1:9/v1")


def main(every: int) -> None:
    """Print one line."""
    corpus = Corpus(find_domain("kitchen"), find_problems("kitchen"))
    kit = DomainKit(corpus)
    feasible = (test for test in domain_sentences(corpus.directory) if test.goal is not None)
    tests = [test for test in feasible if len(parse(test.text, corpus.lexicon).clauses) == 1][::every]
    kit.ground(tests[0].text, tests[0].environment)  # learn, and compile the search
    home = os.environ.get("XDG_CACHE_HOME")
    with tempfile.TemporaryDirectory() as cache:
        os.environ["XDG_CACHE_HOME"] = cache
        replies = {one_line(test.text): reply(test) for test in tests}
        ModelClient._ask = lambda self, messages, name, schema: (answer(messages, replies), (0, 0))  # type: ignore[method-assign]
        for test in tests:
            kit.ground(test.text, test.environment, reader="llm", llm=SETTINGS)
        both = [[seconds(kit, test, reader) for test in tests] for reader in ("rules", "llm")]
    if home is not None:
        os.environ["XDG_CACHE_HOME"] = home
    rules, kept = map(statistics.median, both)
    print(f"{len(tests)} requests: rules {rules:.3f} s, a kept reply {kept:.3f} s, {kept / rules:.2f} times")


def seconds(kit: DomainKit, test: SentenceTest, reader: str) -> float:
    """Return the processor time of one utterance."""
    began = time.process_time()
    kit.ground(test.text, test.environment, reader=reader, llm=SETTINGS if reader == "llm" else None)
    return time.process_time() - began


def reply(test: SentenceTest) -> str:
    """Return a reply with one step for the whole request."""
    step = {
        "text": test.text, "verb": "do", "objects": [], "when": None, "otherwise": False, "via": [], "goal": test.goal
    }  # fmt: skip
    return json.dumps(
        {"thoughts": "", "refusal": None, "steps": [step], "final": None, "constraints": [], "questions": []}
    )


def answer(messages: object, replies: dict[str, str]) -> str:
    """Return the reply to a prompt."""
    text = str(messages)
    return next(kept for request, kept in replies.items() if f"\\n{request}\\n</request>" in text)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else EVERY)
