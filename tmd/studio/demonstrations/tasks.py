"""Texts to demonstrate: those that the domain's problems and demonstrations have, one for each task and environment."""

from __future__ import annotations

from dataclasses import dataclass

from tmd.diagnostics import TmdError
from tmd.pddl.reading.syntax import read_text
from tmd.studio.demonstrations.clause_spans import clean
from tmd.world.corpus import Corpus
from tmd.world.demonstration import read_demonstrations


@dataclass(frozen=True, slots=True)
class TaskText:
    """Text of a task in an environment.

    Attributes:
        task: The task it is an example of; empty for the text of a problem.
        environment: Where it can be done.
        text: What to do.
    """

    task: str
    environment: str
    text: str


def task_texts(corpus: Corpus) -> tuple[TaskText, ...]:
    """Return the texts of a domain, by environment, then by task: always the same, in the same order.

    Of the demonstrations it is the first of each task in each environment, so each text can be carried out there.
    ``pNN-*.pddl`` with its ``.nl`` names its environment at the end of its name. What cannot be read is left out.
    """
    found: dict[tuple[str, str], TaskText] = {}
    for task in corpus.tasks():
        try:
            demonstrations = read_demonstrations(corpus.directory / task / "demonstrations.jsonl")
        except TmdError:
            continue
        for d in demonstrations:
            found.setdefault((d.environment, task), TaskText(task, d.environment, d.text))
    environments = set(corpus.environments())
    for path in sorted(corpus.directory.glob("*.nl")):
        environment = path.stem.rpartition("-")[2]
        try:
            text = clean(read_text(path))
        except TmdError:
            continue
        found[environment, f"~{path.stem}"] = TaskText("", environment, text)
    texts: dict[tuple[str, str], TaskText] = {}
    for _, entry in sorted(found.items()):
        if entry.environment in environments:
            texts.setdefault((entry.environment, entry.text), entry)
    return tuple(texts.values())
