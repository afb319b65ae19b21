"""Read a domain's ``lexicon.yaml`` with the base lexicons that it includes.

Every fault is reported with file, line and column. The format is described in ``docs/language.md``, base lexicons in
``docs/domains.md``.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import NoReturn, TypeVar

import yaml

from tmd.diagnostics import Location, TmdError
from tmd.files import bundled, read_bytes, real
from tmd.language.lexicon.lexicon import (
    TYPO_LENGTH,
    Base,
    Declared,
    Lexicon,
    PhraseRow,
    SharedPredicate,
    section,
    singular,
)
from tmd.language.lexicon.names import split_name
from tmd.yaml_nodes import compose

KEYS = (
    "include", "predicates", "types", "verbs", "phrasal", "nouns", "verb_synonyms", "goals", "attributes", "groups",
    "restored", "phrases",
)  # fmt: skip
BASES = "base"
"""The folder of base lexicons, beside the folders of domains."""
_NAME = re.compile(r"[a-z][a-z0-9_]*\Z")
_TERM = re.compile(r"\??[a-z][a-z0-9_-]*\Z")
_WORDS = ("types", "verbs", "phrasal", "nouns", "verb_synonyms", "groups")
"""The sections whose entries are words; for each the place is kept."""


_Part = TypeVar("_Part")


class _Source:
    """The text of the file, to point into it."""

    def __init__(self, path: Path, text: str) -> None:
        self.path = path
        self.lines = text.splitlines()

    def fail(self, mark: yaml.Mark | None, message: str, hint: str | None = None, code: str = "") -> NoReturn:
        place = self.place(mark)
        source = self.lines[place.line - 1] if place.line <= len(self.lines) else None
        raise TmdError(message, location=place, hint=hint, source=source, code=code)

    def place(self, mark: yaml.Mark | None) -> Location:
        """Return the place of a mark."""
        line, column = (mark.line, mark.column) if mark is not None else (0, 0)
        return Location(str(self.path), line + 1, column + 1)

    def name(self, node: yaml.Node) -> str:
        """Return a scalar that is a name: lower case, words joined by underscores."""
        if not isinstance(node, yaml.ScalarNode):
            self.fail(node.start_mark, "expected a name here", "a name is one word, such as crock_pot")
        if not _NAME.match(node.value):
            self.fail(
                node.start_mark,
                f"'{node.value}' is not a name",
                "use lower case, digits and underscores, and begin with a letter",
            )
        return str(node.value)

    def target(self, node: yaml.Node) -> str:
        """Return a scalar that names a class, an object or a substance of the domain, in its own spelling."""
        if not isinstance(node, yaml.ScalarNode) or not node.value.strip():
            self.fail(node.start_mark, "expected the name of a class, an object or a substance here")
        return str(node.value)

    def sequence(self, node: yaml.Node, item: Callable[[yaml.Node], str]) -> tuple[str, ...]:
        if not isinstance(node, yaml.SequenceNode):
            self.fail(node.start_mark, "expected a list here", "write [one, two]")
        return tuple(item(child) for child in node.value)

    def mapping(self, node: yaml.Node) -> list[tuple[str, yaml.Node, yaml.Node]]:
        """Return (key, key node, value node) triples."""
        if not isinstance(node, yaml.MappingNode):
            self.fail(node.start_mark, "expected 'name: value' pairs here")
        return [(self.name(key), key, value) for key, value in node.value]

    def condition(self, node: yaml.Node) -> tuple[str, Location]:
        """Return a scalar that is a PDDL condition, and where it begins."""
        if not isinstance(node, yaml.ScalarNode) or not node.value.strip():
            self.fail(node.start_mark, "expected a PDDL condition here", "write (opened ?x)")
        place = self.place(node.start_mark)
        return node.value, replace(place, column=place.column + (node.style in ("'", '"')))

    def aliases(self, node: yaml.Node) -> dict[str, tuple[str, ...]]:
        result = {}
        for name, _, value in self.mapping(node):
            single = isinstance(value, yaml.ScalarNode)
            result[name] = (self.target(value),) if single else self.sequence(value, self.target)
        return result


def read_lexicon(path: Path | str | None, kinds: Iterable[str] = ()) -> Lexicon:
    """Read a ``lexicon.yaml``; without a path there are the built-in words only.

    Args:
        path: The file.
        kinds: Names of types and constants of the domain.

    Raises:
        TmdError: The file cannot be read, is not valid YAML, has an unknown key or a value of the wrong kind.
    """
    lexicon = Lexicon() if path is None else _read(Path(path))
    named = [split_name(name) for name in kinds]
    between = section("particles") | section("prepositions")
    return replace(
        lexicon,
        names=frozenset(word for words in named for word in words if len(word) >= TYPO_LENGTH),
        kinds=frozenset(words[-1] for words in named) - section("static"),  # "on" is a relation, and no thing
        compounds=frozenset(words for words in named if between & {*words[:-1]} and words[-1] not in between),
    )


def _read(path: Path, above: tuple[Path, ...] = ()) -> Lexicon:
    """Read a file and those that it includes; ``above`` are the base lexicons that lead to it."""
    source, parts = _opened(path)
    lexicon = _declared(source, parts)
    for base in _included(source, parts["include"], above) if "include" in parts else ():
        lexicon = _with(lexicon, base)
    return lexicon


def _declared(source: _Source, parts: Mapping[str, yaml.Node]) -> Lexicon:
    """Return the entries of a file itself, without its includes."""

    def part(name: str, read: Callable[[_Source, yaml.Node], _Part]) -> _Part | None:
        return read(source, parts[name]) if name in parts else None

    nouns = part("nouns", _Source.aliases) or {}
    goals, place = part("goals", _goals) or ((), None)
    predicates, types = part("predicates", _predicates) or (), part("types", _Source.aliases) or {}
    return Lexicon(
        verbs=frozenset(part("verbs", lambda _, verbs: source.sequence(verbs, source.name)) or ()),
        phrasal=part("phrasal", _phrasal) or {},
        nouns={singular(noun): things for noun, things in nouns.items()} | nouns,  # "ear_muffs" names one as well
        verb_synonyms=part("verb_synonyms", _synonyms) or {},
        goals=goals,
        attributes=part("attributes", _attributes) or (),
        groups=part("groups", _Source.aliases) or {},
        restored=part("restored", _restored),
        source=str(source.path),
        base=Base(predicates=predicates, types=types, place=place),
        places=_places(source, parts),
        phrases=part("phrases", _phrases) or (),
    )


def bases_near(path: Path) -> dict[str, Path]:
    """Return the base lexicons that the lexicon ``path`` may include, by name: those beside its domain first."""
    folders = [path.parent if path.parent.name == BASES else path.parent.parent / BASES, Path("domains") / BASES]
    found: dict[str, Path] = {}
    for folder in (*folders, *(root / BASES for root in bundled("domains"))):
        for file in sorted(folder.glob("*.yaml")):
            found.setdefault(file.stem, file)
    return found


def _included(source: _Source, node: yaml.Node, above: tuple[Path, ...]) -> list[Lexicon]:
    """Read the base lexicons that a file names."""
    names = source.sequence(node, source.name)
    assert isinstance(node, yaml.SequenceNode)
    known = bases_near(source.path)
    chain = (*above, real(source.path))
    found = []
    for name, child in zip(names, node.value, strict=True):
        if name not in known:
            near = difflib.get_close_matches(name, sorted(known), 1)
            hint = f"did you mean '{near[0]}'?" if near else f"there are: {', '.join(sorted(known)) or 'none'}"
            source.fail(child.start_mark, f"there is no base lexicon '{name}'", hint, "unknown-base")
        if real(known[name]) in chain:
            links = [path.stem for path in chain[chain.index(real(known[name])) :]]
            message = f"'{name}' includes itself" + (f", by {' and '.join(links[1:])}" if len(links) > 1 else "")
            source.fail(child.start_mark, message, "remove one of the includes", "include-cycle")
        found.append(_read(known[name], chain))
    return found


def _with(own: Lexicon, other: Lexicon) -> Lexicon:
    """Add a base lexicon to a lexicon, whose own entries win."""
    return replace(
        own,
        verbs=own.verbs | other.verbs,
        phrasal={**other.phrasal, **own.phrasal},
        nouns={**other.nouns, **own.nouns},
        verb_synonyms=_merged(own.verb_synonyms, other.verb_synonyms),
        groups={**other.groups, **own.groups},
        base=Base(
            goals=(*own.base.goals, *other.goals, *other.base.goals),
            attributes=(*own.base.attributes, *other.attributes, *other.base.attributes),
            predicates=(*own.base.predicates, *other.base.predicates),
            types={**other.base.types, **own.base.types},
            place=own.base.place,
            restored=(*own.base.restored, *(other.restored or ()), *other.base.restored),
        ),
        included=tuple(dict.fromkeys((*own.included, other.source, *other.included))),
        places={**other.places, **own.places},
        phrases=(*own.phrases, *other.phrases),
    )


def _phrases(source: _Source, node: yaml.Node) -> tuple[PhraseRow, ...]:
    from tmd.language.syntax.phrases import read_phrases  # most lexicons have none, and need no tagger

    return read_phrases(node, str(source.path))


def _merged(own: Mapping[str, str], other: Mapping[str, str]) -> dict[str, str]:
    """Join synonyms: a synonym of a verb that ``own`` replaces by another one is a synonym of that one."""
    served = set(own.values())
    found = dict(own)
    for verb, target in other.items():
        meant = own.get(target, target)
        if verb not in own and verb not in served and meant != verb:
            found[verb] = meant
    return found


def _places(source: _Source, parts: Mapping[str, yaml.Node]) -> dict[tuple[str, str], Location]:
    """Return where each word of a file was declared."""
    found = {}
    for name in (name for name in _WORDS if isinstance(parts.get(name), yaml.CollectionNode)):
        for entry in parts[name].value:
            key = entry[0] if isinstance(entry, tuple) else entry
            found[name, str(key.value)] = source.place(key.start_mark)
    return found


def _predicates(source: _Source, node: yaml.Node) -> tuple[SharedPredicate, ...]:
    """Read a mapping of ``name ?x`` to a condition, or to several with ``|`` between them."""
    if not isinstance(node, yaml.MappingNode):
        source.fail(node.start_mark, "expected 'predicate: condition' pairs here", "write 'held ?x: (holding ?x)'")
    found = []
    for key, value in node.value:
        words = key.value.strip("()").split() if isinstance(key, yaml.ScalarNode) else []
        if not words or not _NAME.match(words[0]) or not all(_TERM.match(word) for word in words[1:]):
            source.fail(key.start_mark, "expected a predicate with its arguments here", "write 'held ?x: (holding ?x)'")
        text, place = source.condition(value)
        folded = value.end_mark.line > value.start_mark.line
        forms = tuple(
            Declared(" ".join(words), form, place if folded else replace(place, column=place.column + offset))
            for offset, form in _ways(text)
        )
        found.append(SharedPredicate(words[0], tuple(words[1:]), forms, source.place(key.start_mark)))
    return tuple(found)


def _ways(text: str) -> list[tuple[int, str]]:
    """Split a text at each ``|``; every piece with its offset."""
    found, begin = [], 0
    for piece in text.split("|"):
        lead = len(piece) - len(piece.lstrip())
        found.append((begin + lead, piece.strip()))
        begin += len(piece) + 1
    return found


def _opened(path: Path) -> tuple[_Source, dict[str, yaml.Node]]:
    """Return the text of a file, and its sections by name; empty ones are left out."""
    try:
        text = read_bytes(path).decode("utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not UTF-8 text"
        raise TmdError(f"cannot read the lexicon {path}: {reason}", hint="check the file; it is UTF-8 text") from None
    source = _Source(path, text)
    node = compose(text, str(path))
    parts = {}
    for name, key, value in source.mapping(node) if node is not None else ():
        if name not in KEYS:
            near = difflib.get_close_matches(name, KEYS, 1)
            hint = f"did you mean '{near[0]}'?" if near else f"known keys: {', '.join(KEYS)}"
            source.fail(key.start_mark, f"unknown key '{name}'", hint)
        if not (isinstance(value, yaml.ScalarNode) and value.tag.endswith(":null")):
            parts[name] = value
    return source, parts


RESTORED = "restored"
"""The section of conditions that no plan leaves behind."""
INCLUDED = "included"
"""The entry of ``goals`` that says where the rows of included lexicons are tried."""


def _goals(source: _Source, node: yaml.Node) -> tuple[tuple[Declared, ...], int | None]:
    """Read a list of ``- pattern: condition``; their order counts. And where included rows stand among them."""
    if not isinstance(node, yaml.SequenceNode):
        source.fail(node.start_mark, "expected a list of goals here", "write '- open X: (opened ?x)'")
    found: list[Declared] = []
    place = None
    for child in node.value:
        if isinstance(child, yaml.ScalarNode) and child.value == INCLUDED:
            place = len(found)
            continue
        if not isinstance(child, yaml.MappingNode) or len(child.value) != 1:
            source.fail(child.start_mark, "expected one 'pattern: condition' here", "write '- open X: (opened ?x)'")
        key, value = child.value[0]
        if not isinstance(key, yaml.ScalarNode):
            source.fail(key.start_mark, "expected a pattern here, such as 'place X in Y'")
        found.append(Declared(key.value, *source.condition(value)))
    return tuple(found), place


def _attributes(source: _Source, node: yaml.Node) -> tuple[Declared, ...]:
    return tuple(Declared(name, *source.condition(value)) for name, _, value in source.mapping(node))


def _restored(source: _Source, node: yaml.Node) -> tuple[Declared, ...]:
    if not isinstance(node, yaml.SequenceNode):
        source.fail(node.start_mark, "expected a list of conditions here", "write '- (opened ?x)'")
    return tuple(Declared(RESTORED, *source.condition(child)) for child in node.value)


def _phrasal(source: _Source, node: yaml.Node) -> dict[str, str]:
    result = {}
    for name, key, value in source.mapping(node):
        if "_" not in name:
            source.fail(key.start_mark, f"'{name}' has no particle", "write verb_particle, such as fire_up")
        own = isinstance(value, yaml.ScalarNode) and value.tag.endswith(":null")
        result[name] = name if own else source.name(value)
    return result


def _synonyms(source: _Source, node: yaml.Node) -> dict[str, str]:
    synonyms = {name: source.name(value) for name, _, value in source.mapping(node)}
    for name, key, _ in source.mapping(node):
        if synonyms[name] in synonyms:
            source.fail(
                key.start_mark,
                f"'{name}' stands for '{synonyms[name]}', which stands for another verb",
                f"write '{name}: {synonyms[synonyms[name]]}'",
            )
    return synonyms
