"""The knowledge learned of a domain, and the directories that keep it: that of `tmd learn`, and the user's cache.

``library.json``, ``policy.json`` and ``policy.bin`` hold what was learned, ``weights.txt`` the learned weights if there
are any. ``learned.json`` is written last and has checksums: of what everything was made from, and of the other files.
Where one of them does not fit, nothing of the directory is used.

What nobody saved is learned when it is first asked for, and kept in the user's cache directory, a directory for each
:mod:`digest <tmd.knowledge.digest>`. Where there is no place for it, it is learned each time.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from types import TracebackType
from typing import Annotated, Any, Self, TypeAlias, TypeVar

import numpy as np
import numpy.typing as npt
from pydantic import Field, TypeAdapter

from tmd.diagnostics import OutputError, TmdError
from tmd.files import cache_directory, make_directory, write_bytes
from tmd.goals.sources.demonstrations import learn_goals, table_from_json, table_to_json
from tmd.goals.sources.table import GoalTable
from tmd.inference.energy import Weights, format_weights, parse_weights
from tmd.inference.policy.features import Features, Syntax
from tmd.inference.policy.learning import learn_policy
from tmd.inference.policy.model import Reward
from tmd.language.clause import Clause
from tmd.language.lexicon.lexicon import Lexicon
from tmd.library.library import Library, learn
from tmd.library.template import Template
from tmd.pddl.model import Instruction
from tmd.short_repr import short_repr
from tmd.world.corpus import Corpus
from tmd.world.demonstration import Demonstration
from tmd.world.world import Profile

_T = TypeVar("_T")
Floats: TypeAlias = npt.NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class TemplateRecord:
    """A template as ``library.json`` has it; profiles are numbers of :attr:`LibraryRecord.profiles`.

    ``instructions`` have the name of the action first; ``variables`` have object, class, and the profiles before and
    after; ``links`` two variables and the names of the relations between them.
    """

    source: str
    clause: Clause
    environment: str
    instructions: list[list[str]]
    variables: dict[str, tuple[str, str, int, int]]
    wanted: dict[str, list[list[str]]]
    links: list[list[str]]
    mentions: dict[str, str]
    subjects: list[tuple[str, int]]


@dataclass(frozen=True, slots=True)
class LibraryRecord:
    """``library.json``: a profile is a list of atoms, each with whether it holds at its end."""

    unaligned: list[tuple[str, str]]
    templates: list[TemplateRecord]
    profiles: list[list[list[str | bool]]]


@dataclass(frozen=True, slots=True)
class PolicyRecord:
    """``policy.json``: everything of a policy but its weights."""

    words: list[str]
    properties: list[tuple[str, ...]]
    shapes: list[tuple[str, tuple[str, ...]]]
    needs: list[tuple[str, int, tuple[str, ...]]]
    longest: Annotated[int, Field(ge=0, le=10_000)]
    facts: list[tuple[str, int]]
    before: Annotated[float, Field(allow_inf_nan=False)]
    after: Annotated[float, Field(allow_inf_nan=False)]


def read_record(kind: type[_T], data: bytes) -> _T:
    """Return the value of the dataclass ``kind`` in a JSON text.

    Raises:
        ValueError: It is not that; values are not converted.
    """
    found: _T = TypeAdapter(kind).validate_json(data, strict=True)
    return found


def record_value(record: Any) -> Any:  # noqa: ANN401 - any dataclass, and any value of JSON
    """Return the JSON value that :func:`read_record` reads; fields with their default are left out."""
    return TypeAdapter(type(record)).dump_python(record, mode="json", exclude_defaults=True)


def library_to_json(library: Library) -> dict[str, Any]:
    """Return the JSON value that :func:`library_from_json` reads."""
    numbers: dict[tuple[tuple[tuple[str, ...], bool], ...], int] = {}

    def number(profile: Profile) -> int:
        return numbers.setdefault(tuple(profile.items()), len(numbers))

    templates = [_template(t, number) for verb in library.verbs() for t in library.templates(verb)]
    profiles: list[list[list[str | bool]]] = [[[*name, holds] for name, holds in profile] for profile in numbers]
    found: dict[str, Any] = record_value(LibraryRecord(list(library.unaligned), templates, profiles))
    return found


def library_from_json(data: bytes, lexicon: Lexicon) -> Library:
    """Return the library.

    Raises:
        KeyError, TypeError, ValueError, IndexError: It is not one.
    """
    record = read_record(LibraryRecord, data)
    profiles = [_profile(lines) for lines in record.profiles]
    library = Library(lexicon, record.unaligned)
    for entry in record.templates:
        library.add(_read_template(entry, profiles))
    return library


def _profile(lines: Sequence[Sequence[str | bool]]) -> Profile:
    found: dict[tuple[str, ...], bool] = {}
    for *name, holds in lines:
        if not isinstance(holds, bool) or not all(isinstance(word, str) for word in name):
            raise TypeError("this is not a profile")
        found[tuple(map(str, name))] = holds
    return found


def _template(template: Template, number: Callable[[Profile], int]) -> TemplateRecord:
    return TemplateRecord(
        source=template.source,
        clause=template.clause,
        environment=template.environment,
        instructions=[[i.name, *i.args] for i in template.instructions],
        variables={
            z: (name, template.classes[z], number(template.profiles[z]), number(template.ends[z]))
            for z, name in template.grounding.items()
        },
        wanted={z: [list(types) for types in wanted] for z, wanted in template.wanted.items()},
        links=[[a, b, *sorted(names)] for (a, b), names in template.links.items()],
        mentions=dict(template.mentions),
        subjects=[(kind, number(profile)) for kind, profile in template.subjects],
    )


def _read_template(data: TemplateRecord, profiles: Sequence[Profile]) -> Template:
    variables = data.variables
    if not _named(data) <= variables.keys() or data.wanted.keys() != variables.keys():
        raise ValueError("a variable has no object")
    return Template(
        source=data.source,
        clause=data.clause,
        environment=data.environment,
        instructions=tuple(Instruction(name, tuple(args)) for name, *args in data.instructions),
        grounding={z: entry[0] for z, entry in variables.items()},
        classes={z: entry[1] for z, entry in variables.items()},
        wanted={z: tuple(tuple(types) for types in wanted) for z, wanted in data.wanted.items()},
        profiles={z: profiles[entry[2]] for z, entry in variables.items()},
        links={(a, b): frozenset(names) for a, b, *names in data.links},
        mentions=dict(data.mentions),
        ends={z: profiles[entry[3]] for z, entry in variables.items()},
        subjects=tuple((kind, profiles[number]) for kind, number in data.subjects),
    )


def _named(data: TemplateRecord) -> set[str]:
    """Return the variables that a template names."""
    named = {word for _, *args in data.instructions for word in args if word.startswith("?")}
    return named | {*data.wanted, *data.mentions.values(), *(z for link in data.links for z in link[:2])}


def reward_to_json(reward: Reward) -> bytes:
    """Return all but the weights, as JSON."""
    features, syntax = reward.features, reward.features.syntax
    return _json(
        record_value(
            PolicyRecord(
                words=list(features.words),
                properties=list(features.properties),
                shapes=list(syntax.shapes),
                needs=[(name, place, earlier) for (name, place), earlier in syntax.needs.items()],
                longest=syntax.longest,
                facts=list(features.facts),
                before=reward.before,
                after=reward.after,
            )
        )
    )


# A thousand times what training ever gave; sums of such weights are far from overflowing.
_LARGEST_WEIGHT = 1e6


def reward_from_json(data: bytes, weights: bytes) -> Reward:
    """Return the policy that :func:`reward_to_json` wrote.

    Raises:
        ValueError: It is not one.
    """
    record = read_record(PolicyRecord, data)
    needs = {(name, place): earlier for name, place, earlier in record.needs}
    features = Features(
        record.words, record.properties, Syntax(tuple(record.shapes), needs, record.longest), record.facts
    )
    if not {name for names in needs.values() for name in names} <= features.actions.keys():
        raise ValueError("an action is needed that none of the sequences has")
    theta = np.frombuffer(weights, "<f8").astype(np.float64)
    if theta.shape != (features.size,):
        raise ValueError("the weights are of another policy")
    if not (np.abs(theta) <= _LARGEST_WEIGHT).all():
        raise ValueError("the weights are no numbers that training gives")
    return Reward(features, theta, record.before, record.after)


# Seconds of work before progress is shown.
_PATIENCE = 2.0


class Progress:
    """Progress of work that has taken two seconds: the share done on a terminal, one line elsewhere.

    ``what`` is the work, such as *learning from the demonstrations of kitchen*.
    """

    def __init__(self, what: str) -> None:
        self._what = what
        self._begun = time.monotonic()
        self._shown = ""

    def tell(self, share: float) -> None:
        """Show the share that is done, from 0 to 1."""
        if sys.stderr is None or time.monotonic() - self._begun < _PATIENCE:
            return
        if sys.stderr.isatty():
            self._show(f"\r{self._what}: {share:4.0%}")
        elif not self._shown:
            self._show(f"{self._what} …\n")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        if self._shown.startswith("\r"):
            self._show("\r" + " " * len(self._shown) + "\r")

    def _show(self, text: str) -> None:
        if text != self._shown:
            self._shown = text
            with suppress(OSError):  # a full disk, or nobody reads it any more: the work goes on
                sys.stderr.write(text)
                sys.stderr.flush()


_ROOT = Path(__file__).resolve().parent
# The packages and modules of ``tmd`` whose code decides what is learned from a demonstration.
_SOURCES = ("pddl", "world", "language", "library", "goals", "inference/policy", "knowledge.py")
_DOMAIN = ("objects.yaml", "lexicon.yaml")


def digest(corpus: Corpus) -> str:
    """Return the checksum; the same wherever the folders lie."""
    found = hashlib.sha256(_program().encode())
    for name, path in _files(corpus):
        content = path.read_bytes()
        found.update(f"{name} {len(content)}\n".encode())
        found.update(content)
    return found.hexdigest()


def _files(corpus: Corpus) -> Iterator[tuple[str, Path]]:
    for name in (corpus.folder.file, *_DOMAIN):
        path = corpus.folder.path / name
        if path.is_file():
            yield name, path
    for included in corpus.lexicon.included:
        yield f"include/{Path(included).name}", Path(included)
    for pattern in ("environments/*.yaml", "environments/*.pddl", "*/demonstrations.jsonl"):
        for path in sorted(corpus.directory.glob(pattern)):
            yield path.relative_to(corpus.directory).as_posix(), path


@lru_cache(maxsize=1)
def _program() -> str:
    """Return a digest of the code and the word lists of :data:`_SOURCES`."""
    found = hashlib.sha256()
    for source in (_ROOT / name for name in _SOURCES):
        for path in [source] if source.is_file() else sorted(source.rglob("*")):
            if path.is_file() and path.suffix != ".pyc":
                content = path.read_bytes()
                found.update(f"{path.relative_to(_ROOT).as_posix()} {len(content)}\n".encode())
                found.update(content)
    return found.hexdigest()


# The seed of the policy is fixed, so that the same demonstrations teach the same.
_SEED = 0
# The share of the work that the library takes, roughly; the policy is the rest.
_LIBRARY = 0.15


@short_repr(lambda known: known.library)
@dataclass(frozen=True, slots=True)
class Knowledge:
    """The knowledge learned of a domain.

    Attributes:
        reward: What the policy was learned to be; ``None`` where there are no demonstrations.
        weights: Weights that were learned on the demonstrations, if any were.
        goals: What verbs were learned to mean; ``None`` where there are no demonstrations.
    """

    library: Library
    reward: Reward | None = None
    weights: Weights | None = None
    goals: GoalTable | None = None


def study(corpus: Corpus, tell: Callable[[float], None] = lambda share: None) -> Knowledge:
    """Learn library and policy from all demonstrations of a domain.

    ``tell`` is called with the share of the work that is done.

    Raises:
        TmdError: A demonstration is wrong, or cannot be executed in its environment.
    """
    demonstrations = corpus.demonstrations()

    def counted() -> Iterator[Demonstration]:
        for number, demonstration in enumerate(demonstrations):
            tell(_LIBRARY * number / len(demonstrations))
            yield demonstration

    library = learn(counted(), corpus.world, corpus.lexicon)
    if not len(library):
        return Knowledge(library)
    goals = learn_goals(demonstrations, corpus.world, corpus.lexicon)
    random = np.random.default_rng(_SEED)
    reward = learn_policy(
        demonstrations, corpus.world, random, tell=lambda share: tell(_LIBRARY + (1 - _LIBRARY) * share)
    )
    return Knowledge(library, reward, goals=goals)


# The directory beside a domain's demonstrations, and its files.
FOLDER = "learned"
MANIFEST, LIBRARY, POLICY, THETA, WEIGHTS = "learned.json", "library.json", "policy.json", "policy.bin", "weights.txt"
GOALS = "goals.json"
# The number of directories of the cache that are kept for each domain: those that were used last.
_KEPT = 3
# The number of digits of a digest that name a directory of the cache.
_DIGITS = 16


def place(corpus: Corpus, root: Path | None = None) -> Path:
    """Return the directory for a domain: its own below ``root``, or the one beside its demonstrations."""
    return root / corpus.folder.name if root is not None else corpus.directory / FOLDER


def save(knowledge: Knowledge, corpus: Corpus, directory: Path, made_from: str | None = None) -> None:
    """Write what was learned; a reader finds all of it or, until the last file is there, none.

    ``made_from`` is the :func:`~tmd.knowledge.digest` of the corpus before it was read, where others may write to it
    meanwhile; what it is now where none is given.

    Raises:
        OutputError: It cannot be written.
    """
    files = {LIBRARY: _json(library_to_json(knowledge.library))}
    if knowledge.reward is not None:
        files[POLICY] = reward_to_json(knowledge.reward)
        files[THETA] = knowledge.reward.theta.astype("<f8").tobytes()
    if knowledge.goals is not None:
        files[GOALS] = (json.dumps(table_to_json(knowledge.goals), ensure_ascii=False, indent=1) + "\n").encode()
    if knowledge.weights is not None:
        files[WEIGHTS] = format_weights(knowledge.weights).encode()
    manifest = {
        "domain": corpus.folder.name,
        "made_from": made_from or digest(corpus),
        "files": {name: _checksum(content) for name, content in sorted(files.items())},
    }
    make_directory(directory)
    for name, content in files.items():
        write_bytes(directory / name, content)
    write_bytes(directory / MANIFEST, (json.dumps(manifest, indent=2) + "\n").encode())


def recall(corpus: Corpus, directory: Path) -> Knowledge | None:
    """Read saved knowledge; ``None`` where there is none, or it is damaged or out of date."""
    try:
        manifest = json.loads((directory / MANIFEST).read_bytes())
        if manifest["made_from"] != digest(corpus):
            return None
        files = {name: (directory / name).read_bytes() for name in manifest["files"]}
        if any(_checksum(files[name]) != checksum for name, checksum in manifest["files"].items()):
            return None
        library = library_from_json(files[LIBRARY], corpus.lexicon)
        reward = reward_from_json(files[POLICY], files[THETA]) if POLICY in files else None
        goals = table_from_json(json.loads(files[GOALS]), corpus.folder.domain) if GOALS in files else None
        weights = parse_weights(files[WEIGHTS].decode(), str(directory / WEIGHTS)) if WEIGHTS in files else None
    except (OSError, ValueError, KeyError, TypeError, IndexError, AttributeError, RecursionError, TmdError):
        return None
    return Knowledge(library, reward, weights, goals)


def known(corpus: Corpus, root: Path | None = None, tell: Callable[[float], None] | None = None) -> Knowledge:
    """Return the saved or cached knowledge of a domain, or else learn it now and cache it.

    ``root`` is where ``tmd learn --out`` saved; beside the demonstrations where none is given. ``tell`` is called with
    the share of the learning that is done; without it, learning that takes long is reported on standard error.

    Raises:
        TmdError: Nothing was saved that still holds, and a demonstration is wrong.
    """
    saved = recall(corpus, place(corpus, root))
    if saved is not None:
        return saved
    made_from, cache = digest(corpus), cache_directory("learned")
    kept = cache / corpus.folder.name / made_from[:_DIGITS] if cache is not None else None
    found = recall(corpus, kept) if kept is not None else None
    if found is None:
        with Progress(f"learning from the demonstrations of {corpus.folder.name}") as progress:
            found = study(corpus, tell or progress.tell)
        if kept is not None and len(found.library):
            with suppress(OutputError):
                save(found, corpus, kept, made_from)
    if kept is not None:
        _tidy(kept)
    return found


def _tidy(kept: Path) -> None:
    """Remove what was kept longest without being used; ``kept`` is what is used now."""
    with suppress(OSError):
        os.utime(kept)
        ages = {path: path.stat().st_mtime_ns for path in kept.parent.iterdir() if len(path.name) == _DIGITS}
        for path in sorted(ages, key=lambda path: (path != kept, -ages[path]))[_KEPT:]:
            shutil.rmtree(path, ignore_errors=True)


def _json(data: dict[str, Any]) -> bytes:
    return (json.dumps(data, ensure_ascii=False, separators=(",", ":")) + "\n").encode()


def _checksum(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
