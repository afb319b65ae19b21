"""Explanation of a verb, as the offline reader knows it: ``tmd check --explain``.

English comes first: the classes of the word lists that the verb is in, the verbs that ask for the same, the words for
its outcome. Then, in a domain, the rows that are tried for it, in the order in which they are tried, and the rows of
base lexicons that are not used there, with reasons.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

from tmd.diagnostics import Location, TmdError
from tmd.goals.sources.table import GoalTable, family
from tmd.goals.tables import condition_text, goal_tables, left_out
from tmd.json_record import JsonRecord
from tmd.knowledge import known
from tmd.language.clause import Clause
from tmd.language.lexicon.file import bases_near, read_lexicon
from tmd.language.lexicon.lexicon import Declared, Lexicon, builtin, data_text
from tmd.language.parser import parse
from tmd.pddl.reading.syntax import nearest
from tmd.world.corpus import Corpus

# The files of English words that are looked through, in ``tmd/language/data``.
_DATA = ("words.txt", "senses.txt", "wordnet_verbs.txt")
_MOST_NEAR = 6
# Rows of verbs that ask for the same are printed for people only so many.
_MOST_OTHERS = 8
# Verbs that are only so many families away are near in meaning.
_FARTHEST = 3


class Mention(JsonRecord):
    """Line of the word lists that has a verb; ``section`` is a class of words or a table, such as ``families``."""

    section: str
    text: str
    file: str
    line: int


class BaseRow(JsonRecord):
    """Row of a base lexicon."""

    pattern: str
    condition: str
    file: str | None
    line: int | None

    @property
    def written(self) -> str:
        """The row as it is written."""
        return f"{self.pattern}: {self.condition}"


class Tried(JsonRecord):
    """Row that is tried for a verb; ``verb`` is the verb that it is looked up by, ``why`` its relation to the other."""

    verb: str
    why: str
    source: str
    pattern: str
    condition: str
    probability: float
    evidence: str
    file: str | None
    line: int | None


class Unused(BaseRow):
    """Row of a base lexicon that is not used for a verb, or not in this domain."""

    reason: str


class Canonical(JsonRecord):
    """Verb that another one stands for, and the line of the lexicon that says so."""

    verb: str
    file: str | None
    line: int | None


class Shown(JsonRecord):
    """Number of clauses in the demonstrations with the verb, or one of the same meaning, and of all clauses."""

    shown: int
    clauses: int


class InDomain(JsonRecord):
    """Meanings of a verb in a domain; ``nearest`` are known verbs, where no row is tried."""

    domain: str
    stands_for: Canonical | None
    serves: tuple[str, ...]
    demonstrations: Shown
    rows: tuple[Tried, ...]
    unused: tuple[Unused, ...]
    nearest: tuple[str, ...]


class Explanation(JsonRecord):
    """Everything that is known of a verb, as ``tmd check --explain --json`` prints it.

    ``bases`` are rows of base lexicons where no domain is named; ``nearest`` are known verbs near one that no list has.
    """

    verb: str
    known: bool
    english: tuple[Mention, ...]
    same: tuple[str, ...]
    bases: tuple[BaseRow, ...]
    nearest: tuple[str, ...]
    domains: tuple[InDomain, ...]


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
        verb=stem,
        known=bool(english),
        english=english,
        same=family(stem),
        bases=() if corpora else tuple(_of_bases(stem)),
        nearest=_nearest(stem, sorted(_families())) if unknown and not corpora else (),
        domains=tuple(_in_domain(stem, corpus) for corpus in corpora),
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
                text = line if whole or not section else verb
                yield Mention(section=section or "WordNet", text=text, file=f"tmd/language/data/{file}", line=number)
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


def _of_bases(verb: str) -> Iterator[BaseRow]:
    """Yield the rows of the base lexicons for a verb as they are written."""
    for file in bases_near(Path("domains") / "any" / "lexicon.yaml").values():
        for entry in read_lexicon(file).goals:
            if verb in entry.pattern.partition(" ")[0].split("|"):
                yield BaseRow(**_entry(entry))


# ---------------------------------------------------------------------- in a domain


def _in_domain(verb: str, corpus: Corpus) -> InDomain:
    """Return the meanings of a verb in a domain."""
    lexicon, domain = corpus.lexicon, corpus.folder.domain
    tables = goal_tables(lexicon, domain, known(corpus).goals)
    asked = list(_asked(verb, lexicon))
    rows = tuple(_tried(tables, asked))
    own = {name for name, why in asked if why != _SAME}
    unused = tuple(
        Unused(**_entry(one.entry), reason=one.reason)
        for one in left_out(lexicon, domain)
        if own.intersection(one.verbs)
    )
    stands_for = lexicon.canonical_verb(verb)
    section = "verb_synonyms" if verb in lexicon.verb_synonyms else "phrasal"
    clauses = [
        clause.verb for demonstration in corpus.demonstrations() for clause in _clauses(demonstration.text, lexicon)
    ]
    shown = sum(lexicon.canonical_verb(said) == stands_for for said in clauses)
    known_verbs = {name for table in tables for name in table.verbs()}
    other = Canonical(verb=stands_for, **_place(lexicon.places.get((section, verb)))) if stands_for != verb else None
    return InDomain(
        domain=corpus.folder.name,
        stands_for=other,
        serves=tuple(sorted(name for name, other in lexicon.verb_synonyms.items() if other == verb)),
        demonstrations=Shown(shown=shown, clauses=len(clauses)),
        rows=rows,
        unused=unused,
        nearest=() if rows else _nearest(verb, known_verbs),
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
                    yield Tried(
                        verb=name,
                        why=why,
                        source=row.source,
                        pattern=row.pattern,
                        condition=condition_text(row.condition),
                        probability=row.probability,
                        evidence=row.evidence,
                        **_place(row.location),
                    )


def _clauses(text: str, lexicon: Lexicon) -> Sequence[Clause]:
    return parse(text.replace("|", " "), lexicon).clauses


def _entry(entry: Declared) -> dict[str, Any]:
    return {
        "pattern": entry.pattern,
        "condition": " ".join(entry.condition.split()),
        **_place(entry.location),
    }


def _place(place: Location | None) -> dict[str, Any]:
    return {"file": place.file if place else None, "line": place.line if place else None}


# ---------------------------------------------------------------------- for people


def explanation_text(explanation: Explanation) -> str:
    """Return an explanation as lines for people."""
    lines = [explanation.verb.replace("_", " ")]
    lines += _section("English", (_line(f"{m.section}: {m.text}", m) for m in explanation.english))
    if not explanation.english:
        lines += ["", "English", "  not in any list of words"]
    if explanation.same:
        lines += ["", "asks for the same, nearest first", f"  {', '.join(explanation.same)}"]
    lines += _section("rows of base lexicons", (_line(entry.written, entry) for entry in explanation.bases))
    if explanation.nearest:
        lines += ["", f"nearest known verbs: {', '.join(explanation.nearest)}"]
    for meaning in explanation.domains:
        lines += _domain_lines(explanation.verb, meaning)
    return "\n".join(lines) + "\n"


def _domain_lines(verb: str, meaning: InDomain) -> Iterator[str]:
    yield from ("", f"in {meaning.domain}")
    if meaning.stands_for is not None:
        yield _line(f"stands for '{meaning.stands_for.verb}'", meaning.stands_for)
    if meaning.serves:
        yield f"  serves as well: {', '.join(meaning.serves)}"
    yield f"  demonstrations: {meaning.demonstrations.shown or 'none'} of {meaning.demonstrations.clauses} clauses"
    others = [one for one in meaning.rows if one.why == _SAME]
    hidden = others[_MOST_OTHERS:]
    yield from _section(
        "rows that are tried, in this order", (_of_tried(verb, one) for one in meaning.rows if one not in hidden)
    )
    if hidden:
        yield f"  and {len(hidden)} more of verbs that ask for the same (--json has all)"
    if not meaning.rows:
        yield "  no row of any source"
    if meaning.nearest:
        yield f"  nearest known verbs: {', '.join(meaning.nearest)}"
    yield from _section(
        "rows of base lexicons that are not used here",
        (f"{_line(one.written, one)}\n      {one.reason}" for one in meaning.unused),
    )


def _section(title: str, lines: Iterable[str]) -> list[str]:
    found = list(lines)
    return ["", title, *found] if found else []


def _line(text: str, at: Mention | BaseRow | Tried | Canonical) -> str:
    return f"  {text}" + (f"   [{at.file}:{at.line}]" if at.file is not None else "")


def _of_tried(verb: str, row: Tried) -> str:
    how = row.source if row.file is not None else f"{row.source}, {row.probability:.2f}: {row.evidence}"
    why = "" if row.verb == verb else f" of '{row.verb}', {row.why};"
    return _line(f"{row.pattern}: {row.condition}  ({(why + ' ' + how).strip()})", row)
