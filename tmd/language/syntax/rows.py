"""Tables of rows that say what words are, from data files; every fault is told with its place.

A file is a mapping: ``rows`` is a list of mappings of texts, every other section maps names to texts.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from typing import Any, NoReturn, TypeVar

import yaml

from tmd.diagnostics import Location, TmdError
from tmd.language.lexicon.lexicon import section
from tmd.language.syntax.conditions import Condition, Test, Vocabulary, of_sections
from tmd.language.syntax.tokens import Kind
from tmd.yaml_nodes import compose

_Read = TypeVar("_Read")

NEEDED = ("id", "reason", "example", "paraphrase")
"""Every row has these."""
_OWN = ("table", "class", "when", "pattern", "phrases", "unless", "form", "text")
_NEVER = Condition(lambda _: False)
_ALWAYS = Condition(lambda _: True)


@dataclass(frozen=True, slots=True)
class Entry:
    """A row, or a section, as it is written: texts by key, each with its place."""

    values: dict[str, str]
    places: dict[str, Location]

    def __getitem__(self, key: str) -> str:
        """Return the text of a key, empty where there is none."""
        return self.values.get(key, "")

    def fail(self, key: str, message: str, hint: str | None = None) -> NoReturn:
        """Refuse the row for what is wrong at one of its keys."""
        raise TmdError(message, location=self.places.get(key) or self.places[""], hint=hint, code="bad-row")

    def checked(self, key: str, read: Callable[[str], _Read]) -> _Read:
        """Read the text of a key; a :class:`ValueError` is a fault at its place."""
        try:
            return read(self[key])
        except (ValueError, re.error) as error:
            self.fail(key, str(error))


def read_entries(text: str, file: str, keys: Collection[str]) -> tuple[list[Entry], dict[str, Entry]]:
    """Read the rows and the other sections of a file.

    Args:
        text: The text of the file.
        file: Names it in errors.
        keys: What a row may have beside what every row has (:data:`NEEDED`).

    Raises:
        TmdError: The file is not YAML of this form, a row lacks something, has no word between asterisks in its
            examples or has an unknown key, or two rows have one id.
    """

    def entry(node: yaml.Node) -> Entry:
        found = Entry({}, {"": Location(file, node.start_mark.line + 1, node.start_mark.column + 1)})
        if not isinstance(node, yaml.MappingNode):
            found.fail("", "expected 'name: text' pairs here")
        for key, value in node.value:
            found.places[key.value] = Location(file, value.start_mark.line + 1, value.start_mark.column + 1)
            if not isinstance(value, yaml.ScalarNode):
                found.fail(key.value, f"expected a text for '{key.value}'")
            found.values[key.value] = str(value.value)
        return found

    root = compose(text, file)
    rows: list[Entry] = []
    sections: dict[str, Entry] = {}
    for key, value in root.value if isinstance(root, yaml.MappingNode) else ():
        if key.value == "rows" and isinstance(value, yaml.SequenceNode):
            rows = [entry(node) for node in value.value]
        else:
            sections[key.value] = entry(value)
    lines: dict[str, int] = {}
    for row in rows:
        for key in (key for key in NEEDED if not row[key].strip()):
            row.fail(key, f"a row without {key}", f"every row has {', '.join(NEEDED)}")
        for key in (key for key in row.values if key not in (*NEEDED, *keys)):
            row.fail(key, f"unknown key '{key}'", f"known keys: {', '.join((*NEEDED, *keys))}")
        for key in (key for key in NEEDED[2:] if row[key].count("*") != 2):
            row.fail(key, f"the {key} has no word between asterisks")
        if row["id"] in lines:
            row.fail("id", f"two rows have the id '{row['id']}'", f"the first is in line {lines[row['id']]}")
        lines[row["id"]] = row.places["id"].line
    return rows, sections


@dataclass(frozen=True, slots=True)
class Row:
    """A row that says what a word or a run of words is.

    Attributes:
        id: Its name.
        kind: The class it gives.
        when: Its condition.
        form: The form of the token from now on, where the row says one.
        text: Its text from now on.
        phrases: The section of entries of several words that have this class too ...
        unless: ... but not where this holds.
        pattern: The words of a run, with a blank behind each.
        entry: The row as it is written.
    """

    id: str
    kind: Kind
    when: Condition
    form: str
    text: str
    phrases: str
    unless: Condition
    pattern: re.Pattern[str]
    entry: Entry


@dataclass(slots=True)
class Table:
    """Rows in the order in which they are asked, found by the word and the class before it."""

    rows: list[Row] = field(default_factory=list)
    _named: set[str] = field(default_factory=set)
    _found: dict[tuple[str, Kind], tuple[Row, ...]] = field(default_factory=dict)

    def add(self, row: Row) -> None:
        """Append a row."""
        self.rows.append(row)
        self._named |= row.when.words or set()

    def first(self, word: Any) -> Row | None:  # noqa: ANN401 - what a condition looks at
        """Return the first row that holds for a word."""
        key = word.word.text if word.word.text in self._named else "", word.left.kind
        rows = self._found.get(key)
        if rows is None:
            rows = self._found[key] = tuple(row for row in self.rows if row.when.possible(*key))
        for row in rows:
            if row.when.holds(word):
                return row
        return None


@dataclass(slots=True)
class Tables:
    """Everything a file says.

    Attributes:
        rows: All rows in the order of the file.
        tables: The rows by the table they stand in.
        terms: The conditions that have a name.
        phrases: The rows that give classes to entries of several words.
        runs: The rows that have a pattern.
        parts: Pieces of patterns.
    """

    rows: list[Row]
    tables: dict[str, Table]
    terms: dict[str, Condition]
    phrases: list[Row]
    runs: list[Row]
    parts: dict[str, str]


def read_tables(text: str, file: str, features: Mapping[str, Test]) -> Tables:
    """Read the rows that decide classes of words.

    Args:
        text: The text of the file.
        file: Names it in errors.
        features: What conditions may name.

    Raises:
        TmdError: The file is not well-formed, or names a class, a table, a term or a section that does not exist.
    """
    rows, sections = read_entries(text, file, _OWN)
    vocabulary = Vocabulary(features)
    parts: dict[str, str] = {}

    def pattern(text: str) -> str:
        return re.sub(r"\{([a-z_|]+)\}", lambda match: parts.get(match[1]) or _words(match[1]), text)

    for name, read, into in (
        ("groups", vocabulary.kinds, vocabulary.groups),
        ("terms", vocabulary.condition, vocabulary.terms),
        ("parts", pattern, parts),
    ):
        if name in sections:
            for key in sections[name].values:
                into[key] = sections[name].checked(key, read)
    found = Tables([], {}, vocabulary.terms, [], [], parts)
    known = sections["tables"].values if "tables" in sections else {}
    found.tables.update((name, Table()) for name in known)
    for entry in rows:
        row = Row(
            entry["id"],
            entry.checked("class", lambda name: next(iter(vocabulary.kinds(name)))),
            entry.checked("when", vocabulary.condition) if entry["when"] else _ALWAYS,
            entry["form"],
            entry["text"],
            entry["phrases"],
            entry.checked("unless", vocabulary.condition) if entry["unless"] else _NEVER,
            re.compile(entry.checked("pattern", pattern)),
            entry,
        )
        found.rows.append(row)
        for name in entry["table"].split("|"):
            if name not in known:
                entry.fail("table", f"'{name}' is no table", f"tables: {', '.join(known)}")
            found.tables[name].add(row)
        if row.phrases:
            entry.checked("phrases", of_sections)
            found.phrases.append(row)
        if entry["pattern"]:
            found.runs.append(row)
    return found


def _words(names: str) -> str:
    """The pattern of a word of these sections of ``words.txt``, the longest first."""
    words = sorted(of_sections(names), key=lambda word: (-len(word), word))
    return f"(?:{'|'.join(map(re.escape, words))}) "
