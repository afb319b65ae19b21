"""Checks of a lexicon: its words, the verbs that it serves, and the goals that it declares."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path

from tmd.check.diagnostic import SEVERITY, Severity
from tmd.check.lint import Possible, Scope, types_of
from tmd.diagnostics import Location, TmdError
from tmd.goals.sources.table import FIRST, PREPOSITIONS, RELATION, WAS, read_pattern, read_table
from tmd.goals.tables import declared_goals
from tmd.language import parse as parse_text
from tmd.language.lexicon.lexicon import Declared, Lexicon, verb_candidates
from tmd.pddl.model import OBJECT, And, Atom, Domain, Exists, Forall, Formula, Or, Problem, with_parts
from tmd.pddl.reading.checking import check_condition
from tmd.pddl.reading.formulas import read_condition
from tmd.pddl.reading.syntax import Document, Group, Node, Report, Source, nearest, parse, read_text, split_lines
from tmd.pddl.writer import format_formula

_WORD = re.compile(r"[a-z]+")
# A particle stands at most that many words behind its verb.
_PARTICLE_WITHIN = 5


def declared_verbs(lexicon: Lexicon, domain: Domain) -> frozenset[str]:
    """Return the verbs that rows of a lexicon, or rows of base lexicons that apply, say the meaning of."""
    try:
        return frozenset(declared_goals(lexicon, domain).verbs())
    except TmdError:
        return lexicon.goal_verbs  # faults are reported elsewhere


def check_lexicon(
    path: Path,
    lexicon: Lexicon,
    meant: Collection[str],
    actions: Collection[str],
    names: Collection[str],
    texts: Iterable[str],
) -> list[TmdError]:
    """Return the warnings on the words of a lexicon itself.

    ``meant`` are the verbs with a declared meaning, ``names`` what nouns may lead to, empty where that is not known,
    and ``texts`` those of the demonstrations.
    """
    source = Written(path)
    return [*_unknown_targets(lexicon, names, source), *_unserved(lexicon, meant, _Served(texts, actions), source)]


def _unknown_targets(lexicon: Lexicon, names: Collection[str], source: Written) -> Iterator[TmdError]:
    """Report nouns that mean names which the domain does not have."""
    for noun, targets in sorted(lexicon.nouns.items()) if names else ():
        for target in targets:
            if target not in names and lexicon.own("nouns", noun):
                hint = nearest(target, sorted(names))
                message = f"'{noun}' leads to '{target}', which is no class, part, substance or object of the domain"
                yield source.error(source.in_section("nouns", noun, target), message, hint, "unknown-target")


def _unserved(lexicon: Lexicon, meant: Collection[str], served: _Served, source: Written) -> Iterator[TmdError]:
    """Report verbs of the lexicon itself that no demonstration, no action and no row serves."""
    verbs = {verb: verb for verb in lexicon.verbs} | dict(lexicon.phrasal) | dict(lexicon.verb_synonyms)
    # one word of several that stand for the same verb is enough: its template serves all of them
    shown = {
        serving for verb, serving in verbs.items() if {verb, serving} & {*meant} or verb in served or serving in served
    }
    sections = ("verb_synonyms", "phrasal", "verbs")
    own = {verb: lexicon.places[name, verb] for name in sections for verb in verbs if _declares(lexicon, name, verb)}
    for verb, serving in sorted(verbs.items()) if served.texts else ():
        if serving not in shown and verb in own:
            message = f"no demonstration, no action and no goal serves the verb '{verb}'"
            if serving != verb:
                message += f", nor '{serving}', which it stands for"
            hint = "add a demonstration or a goal of it, let it stand for a verb that has one, or remove it"
            yield source.error(own[verb], message, hint, "unserved-verb")


def _declares(lexicon: Lexicon, section_name: str, verb: str) -> bool:
    """Return whether a section of the lexicon itself has a verb."""
    place = lexicon.places.get((section_name, verb))
    return place is not None and place.file == lexicon.source


def texts_of(path: Path) -> Iterator[str]:
    """Yield the texts of a corpus; lines that cannot be read are passed over."""
    try:
        lines = read_text(path).splitlines()
    except TmdError:
        return
    for line in lines:
        with suppress(ValueError, RecursionError):
            value = json.loads(line)
            if isinstance(value, dict) and isinstance(value.get("text"), str):
                yield value["text"]


def check_phrases(path: Path, lexicon: Lexicon) -> Iterator[TmdError]:
    """Yield a warning for each phrase row of a lexicon that does not fire on its own example, or on its paraphrase."""
    lines = read_text(path).splitlines() if lexicon.phrases else []
    for row in lexicon.phrases:
        for text, place in row.examples:
            trace: list[str] = []
            parse_text(text, lexicon, trace)
            if row.id not in trace and place.file == str(path):
                message = f"the phrase '{row.id}' can never fire on its own example"
                hint = "mend 'read' or the sentence; an earlier row may have taken its words"
                yield TmdError(message, location=place, hint=hint, source=lines[place.line - 1], code="idle-phrase")


class _Served:
    """The verbs that texts or actions have; a stem that a word may be a form of counts."""

    def __init__(self, texts: Iterable[str], actions: Collection[str]) -> None:
        self.texts = [_WORD.findall(text.lower()) for text in texts]
        self._actions = frozenset(actions)
        words = {word for text in self.texts for word in text}
        self._stems = {word: frozenset((word, *(stem for stem, _ in verb_candidates(word)))) for word in words}
        self._all = frozenset(stem for stems in self._stems.values() for stem in stems)

    def __contains__(self, verb: str) -> bool:
        if verb in self._actions or verb.replace("_", "") in self._actions:
            return True
        stem, *particles = verb.split("_")
        if not particles:
            return stem in self._all
        return any(self._has(text, stem, particles[0]) for text in self.texts)

    def _has(self, text: list[str], stem: str, particle: str) -> bool:
        return any(
            stem in self._stems[word] and particle in text[place + 1 : place + 1 + _PARTICLE_WITHIN]
            for place, word in enumerate(text)
        )


# The word of a pattern that a fault speaks of.
_NAMED = re.compile(r"'([^']+)'|slot ([A-Z])")
_ANY: tuple[str, ...] = (OBJECT,)


@dataclass(frozen=True, slots=True)
class _Sound:
    """A row or an adjective without faults."""

    entry: Declared
    formula: Formula
    variables: frozenset[str]
    # Those that ``?rel`` may stand for; none where the condition does not speak of it.
    prepositions: tuple[str, ...] = ()


def check_goals(
    path: Path, lexicon: Lexicon, domain: Domain, environments: Iterable[Problem], kinds: Callable[[], Collection[str]]
) -> list[TmdError]:
    """Return every fault of ``goals``, ``attributes`` and ``groups``.

    What can hold is looked up in the environments; no more are taken than needed. ``kinds`` returns what a group may
    name: classes, types, constants and objects; nothing where that is not known.
    """
    if not (lexicon.goals or lexicon.attributes or lexicon.groups or lexicon.restored):
        return []
    written = Written(path)
    reader = _Entries(written, domain)
    for row in lexicon.goals:
        reader.row(row)
    for condition in (*lexicon.attributes, *(lexicon.restored or ())):
        reader.adjective(condition)
    return [
        *reader.faults,
        *_never(reader.sound, environments, written),
        *(_unknown_kinds(lexicon, kinds(), written) if lexicon.groups else ()),
    ]


class Written:
    """The text of a lexicon, to point into its patterns and conditions."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.lines = split_lines(read_text(path))

    def error(self, place: Location, message: str, hint: str | None, code: str) -> TmdError:
        """Return a fault at ``place``, with its line."""
        source = self.lines[place.line - 1] if place.line <= len(self.lines) else None
        return TmdError(message, location=place, hint=hint, source=source, code=code)

    def in_pattern(self, entry: Declared, word: str = "") -> Location:
        """Return the place of a word in an entry's pattern, the last one if there are several."""
        begin = entry.location or Location(str(self.path), 1, 1)
        for number in range(begin.line, max(begin.line - 3, 0), -1):
            column = self.lines[number - 1].find(entry.pattern)
            if column >= 0:
                within = [m.start() for m in re.finditer(rf"(?<!\w){re.escape(word)}(?!\w)", entry.pattern) if word]
                return Location(str(self.path), number, column + 1 + (within[-1] if within else 0))
        return begin

    def in_condition(self, entry: Declared, place: Location | None) -> Location:
        """Return a place of an entry's condition in the file; blanks do not count, as YAML may have folded lines."""
        begin = entry.location or Location(str(self.path), 1, 1)
        said = split_lines(entry.condition)
        left = 0
        if place is not None:
            before = "".join(said[: place.line - 1]) + said[place.line - 1][: place.column - 1]
            left = len("".join(before.split()))
        for number, column in self._signs(begin):
            if left == 0:
                return Location(str(self.path), number, column)
            left -= 1
        return begin

    def _signs(self, begin: Location) -> Iterator[tuple[int, int]]:
        """Yield the places of what is not a blank, from ``begin`` on; the sign of a block (``>-``) is none of them."""
        block = self.lines[begin.line - 1][begin.column - 1 :].startswith(("|", ">"))
        for number in range(begin.line + block, len(self.lines) + 1):
            line = self.lines[number - 1]
            for column in range(begin.column if number == begin.line else 1, len(line) + 1):
                if not line[column - 1].isspace():
                    yield number, column

    def in_section(self, section: str, key: str, word: str) -> Location:
        """Return the place of a word after a key of a section."""
        inside = False
        for number, line in enumerate(self.lines, start=1):
            inside |= bool(re.match(rf"{section}\s*:", line))
            if inside and re.match(rf"\s+[\"']?{re.escape(key)}[\"']?\s*:", line):
                found = re.search(rf"(?<!\w){re.escape(word)}(?!\w)", line)
                return Location(str(self.path), number, found.start() + 1 if found else 1)
        return Location(str(self.path), 1, 1)


class _Entries:
    """The rows and adjectives of one lexicon, with their faults."""

    def __init__(self, written: Written, domain: Domain) -> None:
        self.written = written
        self.domain = domain
        self.faults: list[TmdError] = []
        self.sound: list[_Sound] = []

    def row(self, entry: Declared) -> None:
        """Check a row: its pattern, and then its condition."""
        try:
            _, _, slots, _ = read_pattern(entry)
        except TmdError as fault:
            self.faults.append(self._of_pattern(entry, fault))
            return
        prepositions = tuple(p for slot in slots for p in slot.prepositions)
        variables = {slot.variable for slot in slots} | ({RELATION} if prepositions else set())
        if self._condition(entry, frozenset(variables), prepositions):
            read_table([entry], (), {}, self.domain, self.faults)

    def adjective(self, entry: Declared) -> None:
        """Check the condition of an adjective, over ``?x``."""
        if self._condition(entry, frozenset({"?x"}), ()):
            read_table((), [entry], {}, self.domain, self.faults)

    def _condition(self, entry: Declared, variables: frozenset[str], prepositions: tuple[str, ...]) -> bool:
        """Check a condition over ``variables``; whether it has no faults."""
        found: list[TmdError] = []
        formula, source = _read(entry.condition, found.append)
        if formula is not None:
            found += check_condition(formula, variables, self.domain, source)
        faulty = any(SEVERITY.get(fault.code) is not Severity.WARNING for fault in found)
        self.faults += [self._of_condition(entry, fault) for fault in found]
        if faulty or formula is None:
            return False
        names = prepositions if RELATION in entry.condition else ()
        self.sound.append(_Sound(entry, formula, variables, names))
        return True

    def _of_pattern(self, entry: Declared, fault: TmdError) -> TmdError:
        named = _NAMED.search(fault.message)
        word = (named[1] or named[2]) if named else ""
        place = self.written.in_pattern(entry, word)
        return self.written.error(place, fault.message, _stands_for(word) or fault.hint, fault.code or "bad-goal")

    def _of_condition(self, entry: Declared, fault: TmdError) -> TmdError:
        place = self.written.in_condition(entry, fault.location)
        message = f"{fault.message}, in '{entry.pattern}'"
        return self.written.error(place, message, fault.hint, fault.code or "bad-goal")


def _stands_for(word: str) -> str | None:
    """Return a hint for a preposition that another one covers."""
    known = next((name for name, members in PREPOSITIONS.items() if word in members and word not in PREPOSITIONS), None)
    return f'write "{known}", which is read for "{word}" as well' if known else None


def _read(text: str, report: Report) -> tuple[Formula | None, Source]:
    """Read a condition without the operators ``was`` and ``first``; ``None`` where it has faults."""
    told: list[TmdError] = []
    document = parse(text, "", told.append)
    formula = None if told else document.source.recover(None, _one_condition, document)
    for fault in told:
        report(fault)
    return formula, document.source


def _one_condition(document: Document) -> Formula:
    """Return the condition that a text consists of."""
    document.check_depth()
    if len(document.groups) != 1:
        place = document.groups[1].location if document.groups else None
        hint = "write (and (…) (…)) for several"
        raise TmdError("a goal is one condition", location=place, hint=hint, code="bad-goal")
    return read_condition(_plain(document.groups[0]), document.source)


def _plain(node: Node) -> Node:
    """Return a group without ``was`` and ``first``: their argument must be a condition all the same."""
    if not isinstance(node, Group):
        return node
    if node.head in (WAS, FIRST) and len(node.parts) == 2 and isinstance(node.parts[1], Group):
        return _plain(node.parts[1])
    return replace(node, parts=tuple(_plain(part) for part in node.parts))


def _never(sound: Collection[_Sound], environments: Iterable[Problem], written: Written) -> Iterator[TmdError]:
    """Report conditions that hold in no environment; those with ``?rel`` for each preposition."""
    waiting = {(one, preposition): "" for one in sound for preposition in one.prepositions or ("",)}
    looked = False
    for problem in environments if waiting else ():
        looked, world = True, Possible(problem)
        # slots are of any type, because a part is taken where the thing itself does not fit
        lacking = {
            (one, preposition): _lacking(_related(one.formula, preposition), dict.fromkeys(one.variables, _ANY), world)
            for one, preposition in waiting
        }
        waiting = {key: atom for key, atom in lacking.items() if atom is not None}
        if not waiting:
            return
    for (one, preposition), atom in waiting.items() if looked else ():
        place = written.in_pattern(one.entry, preposition)
        said = f"'{one.entry.pattern}'" + (f" with '{preposition}'" if preposition else "")
        message = f"{said} can be fulfilled in no environment: {atom} can hold of nothing there"
        hint = "fix the condition, or add an environment in which it can hold"
        yield written.error(place, message, hint, "impossible-goal")


def _related(formula: Formula, preposition: str) -> Formula:
    """Return a condition with a preposition for ``?rel``."""
    if isinstance(formula, Atom):
        return replace(formula, terms=tuple(preposition if term == RELATION else term for term in formula.terms))
    return with_parts(formula, lambda part: _related(part, preposition))


def _lacking(formula: Formula, scope: Scope, world: Possible) -> str | None:
    """Return an atom without which a condition cannot hold and that never holds; ``None`` where there is none."""
    match formula:
        case Atom():
            return None if world.may_hold(formula, scope) else format_formula(formula)
        case And(parts):
            return next((found for part in parts if (found := _lacking(part, scope, world))), None)
        case Or(parts):
            ways = [_lacking(part, scope, world) for part in parts]
            return None if None in ways or not ways else ways[0]
        case Forall(parameters, part) if all(world.objects.of(p.types) for p in parameters):
            return _lacking(part, {**scope, **types_of(parameters)}, world)
        case Exists(parameters, part):
            missing = next((p.types[0] for p in parameters if not world.objects.of(p.types)), None)
            return f"a {missing}" if missing else _lacking(part, {**scope, **types_of(parameters)}, world)
    return None


def _unknown_kinds(lexicon: Lexicon, kinds: Collection[str], written: Written) -> Iterator[TmdError]:
    """Report names in groups that nothing has."""
    for group, names in lexicon.groups.items():
        for name in names if kinds else ():
            if name not in kinds:
                place = written.in_section("groups", group, name)
                message = f"the group '{group}' names '{name}', which is no class, type, constant or object"
                yield written.error(place, message, nearest(name, sorted(kinds)), "unknown-class")
