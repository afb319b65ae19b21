"""The reader of YAML text: nodes with their places, within bounds of size, depth and number.

Only plain data is accepted: no aliases (an alias can blow a small file up), no key twice, no list or mapping as a key.
``on``, ``off``, ``yes`` and ``no`` are words, as in YAML 1.2, because they are words of our domains.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import yaml

from tmd.diagnostics import Location, TmdError

# Longer texts are refused: no environment or class file comes near.
MAX_CHARACTERS = 10_000_000
# Lists and mappings inside one another; our formats need five.
MAX_LEVELS = 50
# Values and keys of one file, read in 3 s; an environment of ten thousand objects has 100,000.
MAX_NODES = 500_000


if TYPE_CHECKING:
    from yaml import SafeLoader as _Base
else:  # libyaml's scanner where PyYAML was built with it: ten times as fast, the same places and words
    _Base = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class Loader(_Base):
    """The safe loader with YAML 1.2's idea of a truth value."""

    def construct_object(self, node: yaml.Node, deep: bool = False) -> Any:  # noqa: ANN401 - any value of YAML
        """Return the value of a node; one that Python cannot hold (the 30th of February, 5,000 digits) is a fault."""
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
    """Return the root node of a text; ``None`` where it has nothing but comments.

    Raises:
        TmdError: It is not YAML of the accepted kind, or beyond the bounds; with its place.
    """
    if len(text) > MAX_CHARACTERS:
        hint = "this is not a file of tmd"
        raise TmdError(f"{file}: larger than {MAX_CHARACTERS // 1_000_000} MB", hint=hint, code="too-large")
    look_over(text, file)
    try:
        root = yaml.compose(text, Loader=Loader)
    except yaml.YAMLError as error:
        raise from_yaml(error, text, file) from None
    _refuse_keys(root, text, file)
    return root


def look_over(text: str, file: str) -> None:
    """Refuse a text that has aliases, is deeper or has more values than any file of ours; ``file`` names it in errors.

    Raises:
        TmdError: It is, or it is not YAML; with its place.
    """
    depth = nodes = 0
    try:
        for event in yaml.parse(text, Loader=Loader):
            nodes += isinstance(event, yaml.NodeEvent)
            depth += isinstance(event, yaml.CollectionStartEvent) - isinstance(event, yaml.CollectionEndEvent)
            if isinstance(event, yaml.AliasEvent):
                fault = "aliases are not accepted", "yaml-alias", "write the value out"
            elif depth > MAX_LEVELS:
                message = f"nested more than {MAX_LEVELS} levels deep"
                fault = message, "nested-too-deeply", "a YAML file here needs five levels"
            elif nodes > MAX_NODES:
                fault = f"more than {MAX_NODES:,} values", "too-large", "this is not a file of tmd"
            else:
                continue
            raise _fault(event.start_mark, *fault, text, file)
    except yaml.YAMLError as error:
        raise from_yaml(error, text, file) from None


def from_yaml(error: yaml.YAMLError, text: str, file: str) -> TmdError:
    """Return the fault that PyYAML found in a text, with its place."""
    if isinstance(error, yaml.MarkedYAMLError):
        problem = (error.problem or error.context or "not YAML").replace("\n", " ")
        code = next((code for words, code in _CODES.items() if words in problem), "yaml-syntax")
        mark = error.problem_mark or error.context_mark
        return _fault(mark, f"not YAML: {problem}", code, _REWRITE if code == "yaml-syntax" else _PLAIN, text, file)
    number = getattr(error, "character", None)
    if not isinstance(number, int):
        return _fault(None, f"not YAML: {' '.join(str(error).split())}", "yaml-syntax", _REWRITE, text, file)
    # a character that YAML does not allow, without its place
    message = f"not YAML: the character U+{number:04X} is not allowed"
    before = text.partition(chr(number))[0].splitlines() or [""]
    return _fault((len(before) - 1, len(before[-1])), message, "yaml-syntax", "remove it", text, file)


_REWRITE = "indent with blanks, close every bracket, and put text with : # [ or { into quotes"
_PLAIN = "write plain values: text, numbers, [ ] and { }, a few levels of them"
# Problems of PyYAML and libyaml with a code other than that of a syntax error.
_CODES = {"could not determine a constructor": "yaml-tag", "maximum nesting depth": "nested-too-deeply"}


def _fault(mark: object, message: str, code: str, hint: str, text: str, file: str) -> TmdError:
    """Return a fault at a mark of PyYAML or libyaml, at a line and column counted from 0, or else at the beginning."""
    line, column = mark if isinstance(mark, tuple) else (getattr(mark, "line", 0), getattr(mark, "column", 0))
    lines = text.splitlines()
    source = lines[line] if line < len(lines) else None
    return TmdError(message, location=Location(file, line + 1, column + 1), hint=hint, source=source, code=code)


def _refuse_keys(root: yaml.Node | None, text: str, file: str) -> None:
    """Refuse keys that stand twice, or that are not words."""
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
                    raise _fault(key.start_mark, message, "bad-value", hint, text, file)
                if key.value in seen:
                    message = f"the key '{key.value}' stands here twice"
                    hint = f"remove one of the two; the first is in line {seen[key.value]}"
                    raise _fault(key.start_mark, message, "duplicate-key", hint, text, file)
                seen[key.value] = key.start_mark.line + 1
                waiting.append(value)
