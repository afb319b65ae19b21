"""Read a domain's ``lexicon.yaml``; every fault is reported with file, line and column.

The format is described in ``docs/language.md``.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterable
from dataclasses import replace
from pathlib import Path
from typing import NoReturn

import yaml

from tmd.diagnostics import Location, TmdError
from tmd.language.lexicon.lexicon import Declared, Lexicon, section, singular
from tmd.yaml_nodes import compose

KEYS = ("verbs", "phrasal", "nouns", "verb_synonyms", "goals", "attributes", "groups")
_NAME = re.compile(r"[a-z][a-z0-9_]*\Z")


class _Source:
    """The text of the file, to point into it."""

    def __init__(self, path: Path, text: str) -> None:
        self.path = path
        self.lines = text.splitlines()

    def fail(self, mark: yaml.Mark | None, message: str, hint: str | None = None) -> NoReturn:
        line, column = (mark.line, mark.column) if mark is not None else (0, 0)
        source = self.lines[line] if line < len(self.lines) else None
        place = Location(str(self.path), line + 1, column + 1)
        raise TmdError(message, location=place, hint=hint, source=source)

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
        quoted = node.style in ("'", '"')
        return node.value, Location(str(self.path), node.start_mark.line + 1, node.start_mark.column + 1 + quoted)

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
    named = [tuple(name.lower().replace("-", "_").split("_")) for name in kinds]
    between = section("particles") | section("prepositions")
    return replace(
        lexicon,
        kinds=frozenset(words[-1] for words in named) - section("static"),  # "on" is a relation, and no thing
        compounds=frozenset(words for words in named if between & {*words[:-1]} and words[-1] not in between),
    )


def _read(path: Path) -> Lexicon:
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not UTF-8 text"
        raise TmdError(f"cannot read the lexicon {path}: {reason}", hint="check the file; it is UTF-8 text") from None
    source = _Source(path, text)
    node = compose(text, str(path))
    if node is None:
        return Lexicon(source=str(path))
    parts = _parts(source, node)
    verbs = source.sequence(parts["verbs"], source.name) if "verbs" in parts else ()
    nouns = source.aliases(parts["nouns"]) if "nouns" in parts else {}
    return Lexicon(
        verbs=frozenset(verbs),
        phrasal=_phrasal(source, parts["phrasal"]) if "phrasal" in parts else {},
        nouns={singular(noun): things for noun, things in nouns.items()} | nouns,  # "ear_muffs" is said of one as well
        verb_synonyms=_synonyms(source, parts["verb_synonyms"]) if "verb_synonyms" in parts else {},
        goals=_goals(source, parts["goals"]) if "goals" in parts else (),
        attributes=_attributes(source, parts["attributes"]) if "attributes" in parts else (),
        groups=source.aliases(parts["groups"]) if "groups" in parts else {},
        source=str(path),
    )


def _parts(source: _Source, node: yaml.Node) -> dict[str, yaml.Node]:
    parts = {}
    for name, key, value in source.mapping(node):
        if name not in KEYS:
            near = difflib.get_close_matches(name, KEYS, 1)
            hint = f"did you mean '{near[0]}'?" if near else f"known keys: {', '.join(KEYS)}"
            source.fail(key.start_mark, f"unknown key '{name}'", hint)
        if not (isinstance(value, yaml.ScalarNode) and value.tag.endswith(":null")):
            parts[name] = value
    return parts


def _goals(source: _Source, node: yaml.Node) -> tuple[Declared, ...]:
    """A list of ``- pattern: condition``; their order counts."""
    if not isinstance(node, yaml.SequenceNode):
        source.fail(node.start_mark, "expected a list of goals here", "write '- open X: (opened ?x)'")
    found = []
    for child in node.value:
        if not isinstance(child, yaml.MappingNode) or len(child.value) != 1:
            source.fail(child.start_mark, "expected one 'pattern: condition' here", "write '- open X: (opened ?x)'")
        key, value = child.value[0]
        if not isinstance(key, yaml.ScalarNode):
            source.fail(key.start_mark, "expected a pattern here, such as 'place X in|on Y'")
        found.append(Declared(key.value, *source.condition(value)))
    return tuple(found)


def _attributes(source: _Source, node: yaml.Node) -> tuple[Declared, ...]:
    return tuple(Declared(name, *source.condition(value)) for name, _, value in source.mapping(node))


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
