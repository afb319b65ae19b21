"""Tables of rows that say what words are, from data files; every fault is told with its place.

A file is a mapping: ``rows`` is a list of mappings of texts, every other section maps names to texts.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NoReturn, TypeVar

import yaml

from tmd.diagnostics import Location, TmdError
from tmd.language.syntax.conditions import Condition, Test, Vocabulary, of_sections
from tmd.language.syntax.tokens import Kind
from tmd.yaml_nodes import compose

_Read = TypeVar("_Read")

NEEDED = ("id", "reason", "example", "paraphrase")
"""Every row has these."""
_OWN = ("table", "class", "when", "pattern", "phrases", "unless", "form")


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
            if not isinstance(value, yaml.ScalarNode):
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

    def check(self, keys: Collection[str]) -> None:
        """Refuse a row that lacks what every row has, or has something else than these keys."""
        for key in NEEDED:
            if not self[key].strip():
                self.fail(key, f"a row without {key}", f"every row has {', '.join(NEEDED)}")
        for key in self.values:
            if key not in (*NEEDED, *keys):
                self.fail(key, f"unknown key '{key}'", f"known keys: {', '.join((*NEEDED, *keys))}")


def read_entries(text: str, file: str, keys: Collection[str]) -> tuple[list[Entry], dict[str, Entry]]:
    """Read the rows and the other sections of a file.

    Args:
        text: The text of the file.
        file: Names it in errors.
        keys: What a row may have beside what every row has (:data:`NEEDED`).

    Raises:
        TmdError: The file is not YAML of this form, a row lacks something or has an unknown key, or two have one id.
    """
    root = compose(text, file)
    parts = {key.value: value for key, value in root.value} if isinstance(root, yaml.MappingNode) else {}
    listed = parts.pop("rows", None)
    rows = [Entry(node, file) for node in listed.value] if isinstance(listed, yaml.SequenceNode) else []
    lines: dict[str, int] = {}
    for row in rows:
        row.check(keys)
        if row["id"] in lines:
            row.fail("id", f"two rows have the id '{row['id']}'", f"the first is in line {lines[row['id']]}")
        lines[row["id"]] = row.places["id"].line
    return rows, {name: Entry(node, file) for name, node in parts.items()}


@dataclass(frozen=True, slots=True)
class Row:
    """A row that says what a word or a run of words is.

    Attributes:
        id: Its name.
        kind: The class it gives.
        when: Its condition.
        form: The form of the token from now on, where the row says one.
        phrases: The section of entries of several words that have this class too ...
        unless: ... but not where this holds.
        pattern: The words of a run, with a blank behind each.
        entry: The row as it is written.
    """

    id: str
    kind: Kind
    when: Condition
    form: str
    phrases: str
    unless: Condition
    pattern: re.Pattern[str]
    entry: Entry


@dataclass
class Table:
    """Rows in the order in which they are asked, found by the word and the class before it."""

    rows: list[Row] = field(default_factory=list)
    _found: dict[tuple[str, Kind], tuple[Row, ...]] = field(default_factory=dict)

    @cached_property
    def named(self) -> frozenset[str]:
        """The words that a row is for."""
        return frozenset().union(*(row.when.words or () for row in self.rows))

    @cached_property
    def open(self) -> bool:
        """A row is for any word."""
        return any(row.when.words is None for row in self.rows)

    def first(self, word: Any) -> Row | None:  # noqa: ANN401 - what conditions look at
        """Return the first row that holds for a word."""
        text, left = word.word.text, word.left.kind
        key = text if text in self.named else "", left
        rows = self._found.get(key)
        if rows is None:
            rows = self._found[key] = tuple(row for row in self.rows if row.when.possible(text, left))
        for row in rows:
            if row.when.holds(word):
                return row
        return None


class Tables:
    """Everything a file says of classes of words.

    Attributes:
        rows: All rows in the order of the file.
        tables: The rows by the table they stand in.
        terms: The conditions that have a name.
        parts: Pieces of patterns.
    """

    def __init__(self, text: str, file: str, features: Mapping[str, Test]) -> None:
        """Read a file.

        Args:
            text: The text of the file.
            file: Names it in errors.
            features: What conditions may name.

        Raises:
            TmdError: It is not well-formed, or names a class, a table, a term or a section that does not exist.
        """
        entries, self._sections = read_entries(text, file, _OWN)
        self._vocabulary = Vocabulary(features)
        self.terms, self.parts = self._vocabulary.terms, dict[str, str]()
        self._read("groups", self._vocabulary.kinds, self._vocabulary.groups)
        self._read("terms", self._vocabulary.condition, self.terms)
        self._read("parts", self._pattern, self.parts)
        self.tables: dict[str, Table] = {}
        self._read("tables", lambda _: Table(), self.tables)
        self.rows = [self._row(entry) for entry in entries]

    def _read(self, section: str, read: Callable[[str], _Read], into: dict[str, _Read]) -> None:
        if entry := self._sections.get(section):
            for name in entry.values:  # one may name those before it
                into[name] = entry.checked(name, read)

    def _row(self, entry: Entry) -> Row:
        condition = self._vocabulary.condition
        row = Row(
            entry["id"],
            next(iter(entry.checked("class", self._vocabulary.kinds))),
            entry.checked("when", condition) if entry["when"] else Condition(lambda _: True),
            entry["form"],
            entry["phrases"],
            entry.checked("unless", condition) if entry["unless"] else Condition(lambda _: False),
            re.compile(entry.checked("pattern", self._pattern)),
            entry,
        )
        if row.phrases:
            entry.checked("phrases", of_sections)
        for name in entry["table"].split("|"):
            if name not in self.tables:
                entry.fail("table", f"'{name}' is no table", f"tables: {', '.join(self.tables)}")
            self.tables[name].rows.append(row)
        return row

    def _pattern(self, text: str) -> str:
        """Fill pieces of patterns in, or words of sections of ``words.txt``, the longest first."""

        def filled(match: re.Match[str]) -> str:
            if match[1] in self.parts:
                return self.parts[match[1]]
            words = sorted(of_sections(match[1]), key=lambda word: (-len(word), word))
            return f"(?:{'|'.join(map(re.escape, words))}) "

        return re.sub(r"\{([a-z_|]+)\}", filled, text)
