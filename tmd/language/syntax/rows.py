"""Rows of data files: read with their places, and with conditions ready for use.

A file is a mapping: ``rows`` is a list of mappings of texts, every other section maps names to texts. A condition
joins atoms by ``&`` and ``|`` (between blanks); ``!`` negates, parentheses group. An atom is a term that the file
defines, a feature that the program computes, or one of these, in which ``|`` joins alternatives:

=====================  ===================================================================================
``left=DET|ADJ``       the class of the token before; the file may give several classes one name
``right:the|a``        its text
``word@nouns|verbs``   its text is in a section of ``words.txt``
``word~er|or``         its text ends so
``left.stem:go|run``   the same of its stem or its form: also ``right.form:s``, ``stem@intransitive``
``sure>=2``            its strength as a verb, with ``=``, ``>=`` or ``<``: also ``right.sure=3``
``right.capital``      it is written with a capital
=====================  ===================================================================================

The tokens are ``word``, which may be left out before an attribute, ``left`` and ``right`` (the nearest that are no
adverbs), ``beyond`` (behind *right*), and the very next ones: ``last``, ``last2`` (before *last*) and ``next``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Mapping
from typing import Any, NoReturn, TypeVar

import yaml

from tmd.diagnostics import Location, TmdError
from tmd.language.lexicon.lexicon import section, sections
from tmd.language.syntax.tokens import Kind
from tmd.yaml_nodes import compose

Test = Callable[[Any], bool]
_Read = TypeVar("_Read")

NEEDED = ("id", "example", "paraphrase")
"""Every row has these."""
LISTS = frozenset({"means"})
"""Keys with a list instead of a text; tests read them."""
_SIGNS = {"&": "and", "|": "or", "!": "not", "(": "(", ")": ")"}
_PIECE = re.compile(r"\s*([()&!]|\|(?=\s)|[^\s()&!]+)")
_ATOM = re.compile(
    r"(?:(?P<token>word|left|right|beyond|last2?|next)(?:\.|(?=[=:@~])))?"
    r"(?:(?P<text>stem|form)?(?P<sign>[:@~])|sure(?P<compared>>=|=|<)(?=\d\Z)|(?P<kind>)=|(?P<capital>capital)\Z)"
    r"(?P<values>.*)"
)


class Entry:
    """A row or a section as it is written: texts by key, each with its place."""

    def __init__(self, node: yaml.Node, file: str) -> None:
        """Read a mapping of texts."""
        self.values: dict[str, str] = {}
        self.places = {"": Location(file, node.start_mark.line + 1, node.start_mark.column + 1)}
        if not isinstance(node, yaml.MappingNode):
            self.fail("", "expected 'name: text' pairs here")
        for key, value in node.value:
            self.places[key.value] = Location(file, value.start_mark.line + 1, value.start_mark.column + 1)
            if not isinstance(value, yaml.ScalarNode) and key.value not in LISTS:
                self.fail(key.value, f"expected a text for '{key.value}'")
            self.values[key.value] = str(value.value)

    def __getitem__(self, key: str) -> str:
        """Return the text of a key, empty where there is none."""
        return self.values.get(key, "")

    def fail(self, key: str, message: str, hint: str | None = None) -> NoReturn:
        """Refuse what stands at a key."""
        raise TmdError(message, location=self.places.get(key, self.places[""]), hint=hint, code="bad-row")

    def checked(self, key: str, read: Callable[[str], _Read]) -> _Read:
        """Read the text of a key; a :class:`ValueError` is a fault at its place."""
        try:
            return read(self[key])
        except (ValueError, re.error) as error:
            self.fail(key, str(error))


def read_rows(node: yaml.Node | None, file: str, needed: Collection[str], further: Collection[str]) -> list[Entry]:
    """Read a list of rows.

    Args:
        node: The list.
        file: Names it in errors.
        needed: Keys that every row has beside :data:`NEEDED`.
        further: Keys that a row may have.

    Raises:
        TmdError: It is not a list of mappings, a row lacks something or has an unknown key, or two rows have one id.
    """
    if not isinstance(node, yaml.SequenceNode):
        place = Location(file, node.start_mark.line + 1 if node else 1, 1)
        raise TmdError("expected a list of rows here", location=place, code="bad-row")
    needed, lines = (*NEEDED, *needed), dict[str, int]()
    rows = [Entry(child, file) for child in node.value]
    for row in rows:
        for key in needed:
            if not row[key].strip():
                row.fail(key, f"a row without {key}", f"every row has {', '.join(needed)}")
        for key in row.values:
            if key not in (*needed, *further):
                row.fail(key, f"unknown key '{key}'", f"known keys: {', '.join((*needed, *further))}")
        if row["id"] in lines:
            row.fail("id", f"two rows have the id '{row['id']}'", f"the first is in line {lines[row['id']]}")
        lines[row["id"]] = row.places["id"].line
    return rows


def read_file(
    text: str, file: str, needed: Collection[str], further: Collection[str]
) -> tuple[list[Entry], dict[str, Entry]]:
    """Return the rows and the other sections of a file; the arguments are those of :func:`read_rows`."""
    root = compose(text, file)
    parts = {key.value: value for key, value in root.value} if isinstance(root, yaml.MappingNode) else {}
    rows = read_rows(parts.pop("rows", None), file, needed, further)
    return rows, {name: Entry(node, file) for name, node in parts.items()}


class Conditions:
    """Conditions as expressions of Python over a word, ``w``.

    Attributes:
        names: The expressions of features and terms.
        groups: Names of several classes.
    """

    def __init__(self, features: Mapping[str, str], functions: Mapping[str, Callable[..., Any]]) -> None:
        """Begin with features, which may call these functions."""
        self.names = dict(features)
        self._known = {f"_{name}": section(name) for name in sections()} | dict(functions)
        self.groups: dict[str, tuple[str, ...]] = {}

    def compiled(self, text: str) -> Test:
        """Compile a condition; an empty one always holds.

        Raises:
            ValueError: It is not well-formed, or names something unknown; in one line.
        """
        # the text can hold nothing but signs and the expressions made here, so eval is safe
        test: Test = eval(f"lambda w: {self.expression(text) if text else True}", self._known)
        return test

    def expression(self, text: str) -> str:
        """Return a condition as an expression.

        Raises:
            ValueError: As :meth:`compiled` does.
        """
        found = " ".join(_SIGNS.get(p) or self.names.get(p) or self._atom(p) for p in _PIECE.findall(text))
        try:
            compile(found, "", "eval")
        except SyntaxError as error:
            raise ValueError(f"this condition is not well-formed: {error.msg}") from None
        return f"({found})"

    def kinds(self, names: str) -> tuple[str, ...]:
        """Return classes by their names and names of groups, joined by ``|``."""
        found: list[str] = []
        for name in names.split("|"):
            if name not in self.groups and name not in Kind.__members__:
                raise ValueError(f"'{name}' is no class of words")
            found += self.groups.get(name, (name,))
        return tuple(found)

    def _atom(self, piece: str) -> str:
        match = _ATOM.fullmatch(piece)
        if match is None:
            raise ValueError(f"'{piece}' is no term, no feature and no comparison")
        token, values = f"w.{match['token'] or 'word'}", match["values"]
        if match["capital"]:
            return f"{token}.capital"
        if match["compared"]:
            sign = "==" if match["compared"] == "=" else match["compared"]
            return f"({token}.strength {sign} {values})"
        if match["kind"] is not None:
            return _among(f"{token}.kind", self.kinds(values))
        path = f"{token}.{match['text'] or 'text'}"
        if match["sign"] == "~":
            return f"{path}.endswith({tuple(values.split('|'))})"
        if match["sign"] == ":":
            return _among(path, values.split("|"))
        return "(" + " or ".join(f"{path} in _{name}" for name in section_names(values)) + ")"


def _among(path: str, values: Collection[str]) -> str:
    # a set of constants is made once, when the expression is compiled
    return f"({path} in {{{', '.join(map(repr, values))}}})"


def section_names(names: str) -> list[str]:
    """Return names of sections of ``words.txt``, joined by ``|``."""
    for name in names.split("|"):
        if name not in sections():
            raise ValueError(f"'{name}' is no section of words.txt")
    return names.split("|")
