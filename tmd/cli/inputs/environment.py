"""The world that the command line names: an environment file, a PDDL problem, or a bundled environment."""

from __future__ import annotations

from pathlib import Path

from tmd.cli.inputs.paths import Roots
from tmd.diagnostics import TmdError
from tmd.pddl.reading.reader import read_problem
from tmd.veil.corpus import Corpus
from tmd.veil.world import World, make_world
from tmd.world.compile import compile_problem
from tmd.world.environment import load_environment


def load_scene(roots: Roots, environment: str, domain: str | None) -> tuple[Corpus, World]:
    """The environment, ready for grounding, and the corpus of its domain.

    Args:
        roots: Where domains and problems are.
        environment: A file, or the name of a bundled environment.
        domain: The domain, where the environment's own ``domain:`` is not to be asked.

    Raises:
        TmdError: One of them is missing or wrong.
    """
    path = roots.environment(environment, domain)
    if path.suffix == ".pddl":
        return _pddl(roots, path, domain)
    read = load_environment(path)
    corpus = roots.corpus(roots.folder(domain or read.domain))
    if path == corpus.directory / "environments" / f"{read.name}.yaml":
        return corpus, corpus.world(read.name)
    return corpus, make_world(read.name, compile_problem(read, corpus.folder), corpus.lexicon)


def _pddl(roots: Roots, path: Path, domain: str | None) -> tuple[Corpus, World]:
    if domain is None and path.parent.name != "environments":
        raise TmdError(f"{path}: a PDDL problem does not say where its domain is", hint="give --domain NAME")
    corpus = roots.corpus(roots.folder(domain or path.parent.parent.name))
    problem = read_problem(path, corpus.folder.domain)
    return corpus, make_world(path.stem if domain is None else problem.name, problem, corpus.lexicon)
