"""Everything that the offline reader takes for granted about a verb: ``tmd check --explain``.

English comes first: the classes of the word lists that the verb is in, the verbs that ask for the same, the words for
its outcome. Then, in a domain, the rows that are tried for it, in the order in which they are tried, and the rows of
base lexicons that are not used there, with reasons.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from tmd.diagnostics import Location, TmdError
from tmd.goals.base import condition_text
from tmd.goals.sources.table import GoalRow, GoalTable, family
from tmd.goals.tables import goal_tables, left_out
from tmd.knowledge import known
from tmd.language.clause import Clause
from tmd.language.lexicon.file import bases_near, read_lexicon
from tmd.language.lexicon.lexicon import Declared, Lexicon, builtin, data_text
from tmd.language.parser import parse
from tmd.pddl.reading.syntax import nearest
from tmd.veil.corpus import Corpus

_DATA = ("words.txt", "senses.txt", "wordnet_verbs.txt")
"""The files of English words that are looked through, in ``tmd/language/data``."""
_MOST_NEAR = 6
_MOST_OTHERS = 8
"""Rows of verbs that ask for the same are printed for people only so many."""
_FARTHEST = 3
"""Verbs that are only so many families away are near in meaning."""


@dataclass(frozen=True, slots=True)
class Mention:
    """A line of the word lists that a verb stands in.

    Attributes:
        place: The line.
        section: The class, or the table: ``verbs``, ``families``.
        text: The entry: the verb itself in a list of words, the whole line in a table.
    """

    place: Location
    section: str
    text: str


@dataclass(frozen=True, slots=True)
class Tried:
    """A row that is tried for a verb.

    Attributes:
        verb: The verb that it is looked up by.
        why: The relation of that verb to the explained one.
        row: The row.
    """

    verb: str
    why: str
    row: GoalRow


@dataclass(frozen=True, slots=True)
class Unused:
    """A row of a base lexicon that is not used for a verb, or not in this domain."""

    entry: Declared
    reason: str


@dataclass(frozen=True, slots=True)
class InDomain:
    """The meanings of a verb in a domain.

    Attributes:
        domain: Its name.
        stands_for: The verb that it stands for, where it stands for another one, and the place that says so.
        serves: The verbs that stand for it.
        rows: The rows that are tried for it, in order.
        unused: The rows of base lexicons for it that are not used.
        shown: How many clauses of the demonstrations have the verb, or one that stands for the same.
        clauses: How many clauses there are in all.
        nearest: Where nothing is known, verbs that the domain knows, nearest first.
    """

    domain: str
    stands_for: tuple[str, Location | None] | None
    serves: tuple[str, ...]
    rows: tuple[Tried, ...]
    unused: tuple[Unused, ...]
    shown: int
    clauses: int
    nearest: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Explanation:
    """Everything that is taken for granted about a verb.

    Attributes:
        verb: The verb: its stem, with its particle.
        english: The lines of the word lists that it stands in.
        same: The verbs that ask for the same, nearest first.
        bases: Where no domain is named, the rows of base lexicons for it.
        domains: Its meanings in each domain that was named.
        nearest: For a verb that no list has, the nearest known verbs.
    """

    verb: str
    english: tuple[Mention, ...]
    same: tuple[str, ...]
    bases: tuple[Declared, ...]
    domains: tuple[InDomain, ...]
    nearest: tuple[str, ...] = ()


def explain(verb: str, corpora: Sequence[Corpus]) -> Explanation:
    """Explain a verb, in English and in domains.

    Args:
        verb: The verb in any form, with its particle if it has one: ``turn on``, ``wiping``.
        corpora: The domains, each with its demonstrations.

    Raises:
        TmdError: It is not a word, or a file of a domain is wrong.
    """
    stem = _stem(verb, corpora[0].lexicon if corpora else builtin())
    english = tuple(_mentions(stem))
    unknown = not english and not family(stem)
    return Explanation(
        stem,
        english,
        family(stem),
        () if corpora else tuple(_of_bases(stem)),
        tuple(_in_domain(stem, corpus) for corpus in corpora),
        _nearest(stem, sorted(_families())) if unknown and not corpora else (),
    )


def _stem(said: str, lexicon: Lexicon) -> str:
    """Return the stem of a verb, with its particle joined to it.

    Raises:
        TmdError: It is not a word.
    """
    head, *particles = said.lower().replace("-", "_").replace("_", " ").split() or [""]
    if not all(word.isalpha() for word in (head, *particles)):
        raise TmdError(f"'{said}' is not a verb", hint="write it as it is said: tidy, 'turn on'")
    found = lexicon.verb(head)
    return "_".join((found[0] if found is not None else head, *particles))


# ---------------------------------------------------------------------- English


def _lines(file: str) -> Iterator[tuple[int, str, str]]:
    """Yield number, section and text of the lines of a word list."""
    section = ""
    for number, line in enumerate(data_text(file).splitlines(), start=1):
        if line.startswith("["):
            section = line.strip("[]")
        elif line and not line.startswith("#"):
            yield number, section, line


def _mentions(verb: str) -> Iterator[Mention]:
    """Yield the lines of the word lists that a verb stands in; those of WordNet only where no other list has it."""
    found = False
    for file in _DATA:
        if found and file == _DATA[-1]:
            return
        for number, section, line in _lines(file):
            head, colon, _ = line.partition(":")
            words = [word.strip(":!>-") for word in line.split()]
            if verb in (words[:1] if file == _DATA[-1] else words):
                whole = bool(colon) and "_" not in section and " " not in head.strip()
                place = Location(f"tmd/language/data/{file}", number, line.find(verb) + 1)
                yield Mention(place, section or "WordNet", line if whole or not section else verb)
                found = True


def _families() -> dict[str, set[str]]:
    """Return for each verb those that a line of families joins it with."""
    joined: dict[str, set[str]] = {}
    for _, section, line in _lines(_DATA[1]):
        if section == "families":
            words = {word.strip(":>") for word in line.split()}
            for word in words:
                joined.setdefault(word, set()).update(words - {word})
    return joined


def _nearest(verb: str, known_verbs: Iterable[str]) -> tuple[str, ...]:
    """Return verbs of those that are known, nearest in meaning first; where none is near, the nearest in spelling."""
    wanted, joined = set(known_verbs), _families()
    reached, edge = {verb}, {verb, verb.partition("_")[0]}
    found: list[str] = []
    for _ in range(_FARTHEST):
        edge = {other for one in edge for other in joined.get(one, ())} - reached
        reached |= edge
        found += sorted(edge & wanted)
    if not found:
        alike = nearest(verb, sorted(wanted))
        found = [word for word in sorted(wanted) if alike and f'"{word}"' in alike]
    return tuple(found[:_MOST_NEAR])


def _of_bases(verb: str) -> Iterator[Declared]:
    """Yield the rows of the base lexicons for a verb as they are written."""
    for file in bases_near(Path("domains") / "any" / "lexicon.yaml").values():
        for entry in read_lexicon(file).goals:
            if verb in entry.pattern.partition(" ")[0].split("|"):
                yield entry


# ---------------------------------------------------------------------- in a domain


def _in_domain(verb: str, corpus: Corpus) -> InDomain:
    """Return the meanings of a verb in a domain."""
    lexicon, domain = corpus.lexicon, corpus.folder.domain
    tables = goal_tables(lexicon, domain, known(corpus).goals)
    asked = list(_asked(verb, lexicon))
    rows = tuple(_tried(tables, asked))
    own = {name for name, why in asked if why != _SAME}
    unused = tuple(Unused(one.entry, one.reason) for one in left_out(lexicon, domain) if own.intersection(one.verbs))
    stands_for = lexicon.canonical_verb(verb)
    section = "verb_synonyms" if verb in lexicon.verb_synonyms else "phrasal"
    clauses = [
        clause.verb for demonstration in corpus.demonstrations() for clause in _clauses(demonstration.text, lexicon)
    ]
    shown = sum(lexicon.canonical_verb(said) == stands_for for said in clauses)
    known_verbs = {name for table in tables for name in table.verbs()}
    return InDomain(
        corpus.folder.name,
        (stands_for, lexicon.places.get((section, verb))) if stands_for != verb else None,
        tuple(sorted(name for name, other in lexicon.verb_synonyms.items() if other == verb)),
        rows,
        unused,
        shown,
        len(clauses),
        () if rows else _nearest(verb, known_verbs),
    )


_ITSELF, _STANDS_FOR, _PLAIN, _SAME = "itself", "it stands for it", "without its particle", "it asks for the same"


def _asked(verb: str, lexicon: Lexicon) -> Iterator[tuple[str, str]]:
    """Yield the verbs whose rows are tried for a verb, in order, and why."""
    plain = verb.partition("_")[0]
    chosen: dict[str, str] = {verb: _ITSELF}
    chosen.setdefault(lexicon.canonical_verb(verb), _STANDS_FOR)
    if verb.count("_") == 1:
        chosen.setdefault(plain, _PLAIN)
        chosen.setdefault(lexicon.canonical_verb(plain), _PLAIN)
    for own in list(chosen):
        for other in family(own):
            chosen.setdefault(other, _SAME)
    yield from chosen.items()


def _tried(tables: Sequence[GoalTable], asked: Sequence[tuple[str, str]]) -> Iterator[Tried]:
    """Yield the rows that are tried, source after source, each once."""
    for table in tables:
        told: set[int] = set()
        for name, why in asked:
            for row in table.of(name):
                if id(row) not in told:
                    told.add(id(row))
                    yield Tried(name, why, row)


def _clauses(text: str, lexicon: Lexicon) -> Sequence[Clause]:
    return parse(text.replace("|", " "), lexicon).clauses


# ---------------------------------------------------------------------- for people and programs


def explanation_text(explanation: Explanation) -> str:
    """Return an explanation as lines for people."""
    lines = [explanation.verb.replace("_", " ")]
    lines += _section("English", ((f"{m.section}: {m.text}", m.place) for m in explanation.english))
    if not explanation.english:
        lines += ["", "English", "  not in any list of words"]
    if explanation.same:
        lines += ["", "asks for the same, nearest first", f"  {', '.join(explanation.same)}"]
    lines += _section("rows of base lexicons", ((_written(e), e.location) for e in explanation.bases))
    if explanation.nearest:
        lines += ["", f"nearest known verbs: {', '.join(explanation.nearest)}"]
    for meaning in explanation.domains:
        lines += _domain_lines(explanation.verb, meaning)
    return "\n".join(lines) + "\n"


def _domain_lines(verb: str, meaning: InDomain) -> Iterator[str]:
    yield from ("", f"in {meaning.domain}")
    if meaning.stands_for is not None:
        other, place = meaning.stands_for
        yield _line(f"stands for '{other}'", place)
    if meaning.serves:
        yield f"  serves as well: {', '.join(meaning.serves)}"
    if meaning.shown:
        yield f"  demonstrations: {meaning.shown} of {meaning.clauses} clauses"
    else:
        yield f"  demonstrations: none of {meaning.clauses} clauses"
    nearer = [one for one in meaning.rows if one.why != _SAME]
    others = [one for one in meaning.rows if one.why == _SAME]
    shown = [*nearer, *others[:_MOST_OTHERS]]
    yield from _section(
        "rows that are tried, in this order", (_of_tried(verb, one) for one in meaning.rows if one in shown)
    )
    if len(others) > _MOST_OTHERS:
        yield f"  and {len(others) - _MOST_OTHERS} more of verbs that ask for the same (--json has all)"
    if not meaning.rows:
        yield "  no row of any source"
    if meaning.nearest:
        yield f"  nearest known verbs: {', '.join(meaning.nearest)}"
    yield from _section(
        "rows of base lexicons that are not used here",
        ((f"{_written(one.entry)}\n      {one.reason}", one.entry.location) for one in meaning.unused),
    )


def _section(title: str, entries: Iterable[tuple[str, Location | None]]) -> list[str]:
    lines = [_line(text, place) for text, place in entries]
    return ["", title, *lines] if lines else []


def _line(text: str, place: Location | None) -> str:
    first, newline, rest = text.partition("\n")
    return f"  {first}" + (f"   [{place.file}:{place.line}]" if place is not None else "") + newline + rest


def _written(entry: Declared) -> str:
    return f"{entry.pattern}: {' '.join(entry.condition.split())}"


def _of_tried(verb: str, tried: Tried) -> tuple[str, Location | None]:
    row = tried.row
    how = row.source if row.location is not None else f"{row.source}, {row.probability:.2f}: {row.evidence}"
    why = "" if tried.verb == verb else f" of '{tried.verb}', {tried.why};"
    return f"{row.pattern}: {condition_text(row.condition)}  ({(why + ' ' + how).strip()})", row.location


def explanation_json(explanation: Explanation) -> dict[str, object]:
    """Return an explanation for programs."""
    return {
        "verb": explanation.verb,
        "known": bool(explanation.english),
        "english": [
            {"section": m.section, "text": m.text, "file": m.place.file, "line": m.place.line}
            for m in explanation.english
        ],
        "same": list(explanation.same),
        "bases": [_entry_json(entry) for entry in explanation.bases],
        "nearest": list(explanation.nearest),
        "domains": [_domain_json(meaning) for meaning in explanation.domains],
    }


def _domain_json(meaning: InDomain) -> dict[str, object]:
    stands_for = None
    if meaning.stands_for is not None:
        other, place = meaning.stands_for
        stands_for = {"verb": other, **_place_json(place)}
    return {
        "domain": meaning.domain,
        "stands_for": stands_for,
        "serves": list(meaning.serves),
        "demonstrations": {"shown": meaning.shown, "clauses": meaning.clauses},
        "rows": [
            {
                "verb": one.verb,
                "why": one.why,
                "source": one.row.source,
                "pattern": one.row.pattern,
                "condition": condition_text(one.row.condition),
                "probability": one.row.probability,
                "evidence": one.row.evidence,
                **_place_json(one.row.location),
            }
            for one in meaning.rows
        ],
        "unused": [{**_entry_json(one.entry), "reason": one.reason} for one in meaning.unused],
        "nearest": list(meaning.nearest),
    }


def _entry_json(entry: Declared) -> dict[str, object]:
    condition = " ".join(entry.condition.split())
    return {"pattern": entry.pattern, "condition": condition, **_place_json(entry.location)}


def _place_json(place: Location | None) -> dict[str, object]:
    return {"file": place.file if place else None, "line": place.line if place else None}
