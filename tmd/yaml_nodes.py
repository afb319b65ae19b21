"""YAML as nodes that know where they stand: the one reader of YAML text, within bounds of size, depth and number.

Only plain data is accepted: no aliases (an alias can blow a small file up), no key twice, no list or mapping as a key.
``on``, ``off``, ``yes`` and ``no`` are words, as in YAML 1.2, because they are words of our domains.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NoReturn, Protocol

import yaml

from tmd.diagnostics import Location, TmdError

MAX_CHARACTERS = 10_000_000
"""Longer texts are refused: no environment or class file comes near."""
MAX_LEVELS = 50
"""Lists and mappings inside one another; our formats need five."""
MAX_NODES = 500_000
"""Values and keys of one file, read in 3 s; an environment of ten thousand objects has 100,000."""


class YamlMark(Protocol):
    """A place as both of PyYAML's parsers give it: counted from 0."""

    line: int
    column: int


if TYPE_CHECKING:
    from yaml import SafeLoader as _Base
else:  # libyaml's scanner where PyYAML was built with it: ten times as fast, the same places and words
    _Base = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class Loader(_Base):
    """The safe loader with YAML 1.2's idea of a truth value."""

    def construct_object(self, node: yaml.Node, deep: bool = False) -> Any:  # noqa: ANN401 - any value of YAML
        """The value of a node; one that Python cannot hold (the 30th of February, 5,000 digits) is a fault of it."""
        try:
            return super().construct_object(node, deep=deep)
        except ValueError as error:
            # not Python's own words: those on long integers name a setting of the interpreter
            why = "a number of so many digits cannot be read" if "digits" in str(error) else "no number and no date"
            raise yaml.constructor.ConstructorError(None, None, why, node.start_mark) from None


Loader.yaml_implicit_resolvers = {
    first: [(tag, regexp) for tag, regexp in resolvers if tag != "tag:yaml.org,2002:bool"]
    for first, resolvers in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
Loader.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile(r"^(?:true|false)$"), list("tf"))


def compose(text: str, file: str) -> yaml.Node | None:
    """The root node of a text; ``None`` where it has nothing but comments.

    Args:
        text: The text.
        file: Names it in errors.

    Raises:
        TmdError: It is not YAML of the accepted kind, or beyond the bounds; with its place.
    """
    reader = _Reader(text, file)
    if len(text) > MAX_CHARACTERS:
        hint = "this is not a file of tmd"
        raise TmdError(f"{file}: larger than {MAX_CHARACTERS // 1_000_000} MB", hint=hint, code="too-large")
    try:
        reader.look_over(aliases=False)
        root = yaml.compose(text, Loader=Loader)
    except yaml.MarkedYAMLError as error:
        raise reader.from_yaml(error) from None
    except yaml.YAMLError as error:
        raise reader.unreadable(error) from None
    reader.refuse_keys(root)
    return root


def look_over(text: str, file: str) -> None:
    """Refuse a text that is deeper or has more values than anything of ours; it may have aliases.

    Raises:
        TmdError: It is, or it is not YAML; with its place.
    """
    reader = _Reader(text, file)
    try:
        reader.look_over(aliases=True)
    except yaml.MarkedYAMLError as error:
        raise reader.from_yaml(error) from None
    except yaml.YAMLError as error:
        raise reader.unreadable(error) from None


def from_yaml(error: yaml.MarkedYAMLError, text: str, file: str) -> TmdError:
    """Return the fault that PyYAML found in a text, with its place."""
    return _Reader(text, file).from_yaml(error)


_REWRITE = "indent with blanks, close every bracket, and put text with : # [ or { into quotes"
_PLAIN = "write plain values: text, numbers, [ ] and { }, a few levels of them"
_CODES = {"could not determine a constructor": "yaml-tag", "maximum nesting depth": "nested-too-deeply"}
"""What is a kind of its own among the problems that PyYAML and libyaml tell."""


@dataclass(slots=True)
class _Mark:
    """A place, counted from 0."""

    line: int
    column: int


class _Reader:
    """A text and its name, to point into it."""

    def __init__(self, text: str, file: str) -> None:
        self.text = text
        self.file = file

    def error(self, mark: YamlMark | None, message: str, code: str, hint: str | None = None) -> TmdError:
        line, column = (mark.line, mark.column) if mark is not None else (0, 0)
        lines = self.text.splitlines()
        source = lines[line] if line < len(lines) else None
        return TmdError(
            message, location=Location(self.file, line + 1, column + 1), hint=hint, source=source, code=code
        )

    def fail(self, mark: YamlMark | None, message: str, code: str, hint: str | None = None) -> NoReturn:
        raise self.error(mark, message, code, hint)

    def from_yaml(self, error: yaml.MarkedYAMLError) -> TmdError:
        problem = (error.problem or error.context or "not YAML").replace("\n", " ")
        code = next((code for words, code in _CODES.items() if words in problem), "yaml-syntax")
        mark = error.problem_mark or error.context_mark
        return self.error(mark, f"not YAML: {problem}", code, _REWRITE if code == "yaml-syntax" else _PLAIN)

    def unreadable(self, error: yaml.YAMLError) -> TmdError:
        """Return the fault of a problem without a place: a character that YAML does not allow."""
        number = getattr(error, "character", None)
        if not isinstance(number, int):
            return self.error(None, f"not YAML: {' '.join(str(error).split())}", "yaml-syntax", _REWRITE)
        before = self.text.partition(chr(number))[0].splitlines()
        mark = _Mark(max(len(before) - 1, 0), len(before[-1]) if before else 0)
        return self.error(mark, f"not YAML: the character U+{number:04X} is not allowed", "yaml-syntax", "remove it")

    def look_over(self, aliases: bool) -> None:
        depth = nodes = 0
        for event in yaml.parse(self.text, Loader=Loader):
            if isinstance(event, yaml.AliasEvent) and not aliases:
                self.fail(event.start_mark, "aliases are not accepted", "yaml-alias", "write the value out")
            nodes += isinstance(event, yaml.NodeEvent)
            depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
            if depth > MAX_LEVELS:
                message = f"nested more than {MAX_LEVELS} levels deep"
                self.fail(event.start_mark, message, "nested-too-deeply", "a YAML file here needs five levels")
            if nodes > MAX_NODES:
                self.fail(event.start_mark, f"more than {MAX_NODES:,} values", "too-large", "this is not a file of tmd")

    def refuse_keys(self, root: yaml.Node | None) -> None:
        """Refuse keys that stand twice, or that are no words."""
        waiting: list[yaml.Node] = [root] if root is not None else []
        while waiting:
            node = waiting.pop()
            if isinstance(node, yaml.SequenceNode):
                waiting.extend(node.value)
            if isinstance(node, yaml.MappingNode):
                seen: dict[str, int] = {}
                for key, value in node.value:
                    if not isinstance(key, yaml.ScalarNode):
                        message = f"a {'list' if isinstance(key, yaml.SequenceNode) else 'mapping'} cannot be a key"
                        hint = "write a word before the colon; text with brackets or braces goes into quotes"
                        self.fail(key.start_mark, message, "bad-value", hint)
                    if key.value in seen:
                        message = f"the key '{key.value}' stands here twice"
                        hint = f"remove one of the two; the first is in line {seen[key.value]}"
                        self.fail(key.start_mark, message, "duplicate-key", hint)
                    seen[key.value] = key.start_mark.line + 1
                    waiting.append(value)
