"""Explanation of a verb, as the offline reader knows it: ``tmd check --explain``.

English comes first: the classes of the word lists that the verb is in, the verbs that ask for the same, the words for
its outcome. Then, in a domain, the rows that are tried for it, in the order in which they are tried, and the rows of
base lexicons that are not used there, with reasons.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from tmd.diagnostics import Location, TmdError
from tmd.goals.sources.table import GoalRow, GoalTable, family
from tmd.goals.tables import condition_text, goal_tables, left_out
from tmd.knowledge import known
from tmd.language.lexicon.file import bases_near, read_lexicon
from tmd.language.lexicon.lexicon import Declared, Lexicon, builtin, data_text
from tmd.language.parser import parse
from tmd.pddl.reading.syntax import nearest
from tmd.world.corpus import Corpus

# The files of English words that are looked through, in ``tmd/language/data``.
_DATA = ("words.txt", "senses.txt", "wordnet_verbs.txt")
_MOST_NEAR = 6
# Verbs that are only so many families away are near in meaning.
_FARTHEST = 3


def explain(verb: str, corpora: Sequence[Corpus]) -> str:
    """Explain a verb, in English and in domains, as lines for people.

    It may be in any form, with its particle if it has one: ``turn on``, ``wiping``.

    Raises:
        TmdError: It is not a word, or a file of a domain is wrong.
    """
    stem = _stem(verb, corpora[0].lexicon if corpora else builtin())
    english, same = list(_mentions(stem)), family(stem)
    lines = [stem.replace("_", " "), "", "English", *(english or ["  not in any list of words"])]
    if same:
        lines += ["", "asks for the same, nearest first", f"  {', '.join(same)}"]
    if not corpora:
        lines += _section("rows of base lexicons", _of_bases(stem))
        near = () if english or same else _nearest(stem, _families())
        lines += ["", f"nearest known verbs: {', '.join(near)}"] if near else []
    for corpus in corpora:
        lines += _in_domain(stem, corpus)
    return "\n".join(lines) + "\n"


def _stem(said: str, lexicon: Lexicon) -> str:
    """Return the stem of a verb, with its particle joined to it."""
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


def _mentions(verb: str) -> Iterator[str]:
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
                place = Location(f"tmd/language/data/{file}", number, 1)
                yield _line(f"{section or 'WordNet'}: {text}", place)
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


def _of_bases(verb: str) -> Iterator[str]:
    """Yield the rows of the base lexicons for a verb as they are written."""
    for file in bases_near(Path("domains") / "any" / "lexicon.yaml").values():
        for entry in read_lexicon(file).goals:
            if verb in entry.pattern.partition(" ")[0].split("|"):
                yield _of_entry(entry)


# ---------------------------------------------------------------------- in a domain


def _in_domain(verb: str, corpus: Corpus) -> Iterator[str]:
    """Yield the meanings of a verb in a domain."""
    lexicon, domain = corpus.lexicon, corpus.folder.domain
    yield from ("", f"in {corpus.folder.name}")
    stands_for = lexicon.canonical_verb(verb)
    if stands_for != verb:
        section = "verb_synonyms" if verb in lexicon.verb_synonyms else "phrasal"
        yield _line(f"stands for '{stands_for}'", lexicon.places.get((section, verb)))
    serves = sorted(name for name, other in lexicon.verb_synonyms.items() if other == verb)
    if serves:
        yield f"  serves as well: {', '.join(serves)}"
    texts = (demonstration.text.replace("|", " ") for demonstration in corpus.demonstrations())
    clauses = [clause.verb for text in texts for clause in parse(text, lexicon).clauses]
    shown = sum(lexicon.canonical_verb(said) == stands_for for said in clauses)
    yield f"  demonstrations: {shown or 'none'} of {len(clauses)} clauses"
    yield from _rows(verb, lexicon, goal_tables(lexicon, domain, known(corpus).goals))
    own = {name for name, why in _asked(verb, lexicon) if why != _SAME}
    unused = (one for one in left_out(lexicon, domain) if own.intersection(one.verbs))
    yield from _section(
        "rows of base lexicons that are not used here",
        (f"{_of_entry(one.entry)}\n      {one.reason}" for one in unused),
    )


def _rows(verb: str, lexicon: Lexicon, tables: Sequence[GoalTable]) -> Iterator[str]:
    """Yield the rows that are tried for a verb, source after source, each once; or else the nearest verbs."""
    tried: dict[int, tuple[GoalRow, str, str]] = {}
    for table in tables:
        for name, why in _asked(verb, lexicon):
            for row in table.of(name):
                tried.setdefault(id(row), (row, name, why))
    yield from _section("rows that are tried, in this order", (_of_row(*one) for one in tried.values()))
    if not tried:
        yield "  no row of any source"
        near = _nearest(verb, (name for table in tables for name in table.verbs()))
        if near:
            yield f"  nearest known verbs: {', '.join(near)}"


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


# ---------------------------------------------------------------------- lines


def _section(title: str, lines: Iterable[str]) -> list[str]:
    found = list(lines)
    return ["", title, *found] if found else []


def _line(text: str, place: Location | None) -> str:
    return f"  {text}" + (f"   [{place.file}:{place.line}]" if place else "")


def _of_entry(entry: Declared) -> str:
    return _line(f"{entry.pattern}: {' '.join(entry.condition.split())}", entry.location)


def _of_row(row: GoalRow, name: str, why: str) -> str:
    how = row.source if row.location else f"{row.source}, {row.probability:.2f}: {row.evidence}"
    relation = "" if why == _ITSELF else f" of '{name}', {why};"
    return _line(f"{row.pattern}: {condition_text(row.condition)}  ({(relation + ' ' + how).strip()})", row.location)
