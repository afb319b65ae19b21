"""Plans as text: what planners, services and people write, the plan files of the competitions, the functional notation.

A step of a plan is the name of an action before as many objects as the action has parameters. It is found wherever it
stands: ``(grasp mug1)``, ``grasp(mug1)``, or the words of a line, ``2: GRASP MUG1``, with or without a number or a time
in front and a cost or a duration behind. All other text is a remark.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import nullcontext, suppress
from dataclasses import dataclass, field, replace
from decimal import Decimal
from itertools import islice, pairwise
from pathlib import Path
from typing import Any

from tmd.diagnostics import Location, TmdError
from tmd.pddl.model import Instruction, Problem
from tmd.pddl.reading.foreign import blanks
from tmd.pddl.reading.syntax import NAME, read_text, shifted, split_lines

_CALL = re.compile(r"([^(]*)\((.*)\)\s*", re.DOTALL)
_TIME = r"([0-9]+(?:\.[0-9]+)?|\.[0-9]+)"
# Marks of Markdown, quotes and the lines of tables, which stand around steps; each is read as a blank.
_MARKS = {ord(mark): " " for mark in "`*\"'|•"}
# The number, letter or time of a step, as in ``Step 3:``, ``(3)``, ``c)`` and ``3 ``; a time has a colon behind it.
_HEAD = re.compile(
    rf"\s*(?:[-+>]\s+)?"
    rf"(?:(?:[A-Za-z]+\s+){{0,2}}[A-Za-z]+\s*{_TIME}\s*([:.)]|[-–—](?=\s))"
    rf"|[(\[#]?{_TIME}(?:\s*([:.),\]])|(?=\s))|[A-Za-z]\)(?=\s))?\s*(?:[-–—>:]+\s+)?"
)
# ``(name argument ...)`` or ``name(argument, ...)``, neither of them around another group.
_GROUP = re.compile(r"((?<![\w-])[A-Za-z0-9_][\w-]*)?(\s*)\(([^()]*)\)")
_BARE = re.compile(r"[A-Za-z0-9_][\w-]*(?:[\s,]+[A-Za-z0-9_][\w-]*)*")
# What stands between steps that are words on one line.
_BETWEEN = re.compile(r"(?:[\s,;.]|[-=]*>|[→⇒]|(?<![\w-])(?:and|then|first|finally)(?![\w-]))+", re.IGNORECASE)
# A remark behind the words of a step does not begin with a word.
_REMARK = re.compile(r"[\s,]*(?:[^\w\s,].*)?", re.DOTALL)
_DURATION = re.compile(rf"\s*\[\s*(?:D:)?\s*{_TIME}(?:[;\s][^\]]*)?\]", re.IGNORECASE)
_BRACKETS = re.compile(r"\[[^\]]*\]")
# A step in other brackets, or its arguments in them, and the name of a parameter before its object.
_OTHER_BRACKETS = re.compile(r"((?<![\w-])[A-Za-z0-9_][\w-]*)?[\[{<]([\s,\w-]+)[\]}>]")
_NAMED = re.compile(r"(?<![\w-])\??([A-Za-z_][\w-]*)\s*[=:]\s*\??(?=\w)")
# Steps as values of programs, ``Action('grasp', ['mug1'])``: a constructor, an action, and its arguments in brackets.
_CONSTRUCTOR = re.compile(r"(?<![\w.])([A-Za-z_][\w.]*)\((?=\s*(?:\w+\s*=\s*)?[\"']?([A-Za-z0-9_][\w-]*)[\"']?\s*[,)])")
_ARGUMENTS = re.compile(
    r"\(\s*(\w+\s*=\s*)?([\"']?([A-Za-z0-9_][\w-]*)(?![\w-])[\"']?\s*,?\s*)(\w+\s*=\s*)?[\[({]([^()\[\]{}]*)[\])}]\s*,?\s*\)"
)
# An object as plasp writes it; and the number of a step before or behind it in an atom, ``occurs(rest(mug1), 3)``.
_CONSTANT = re.compile(r"\bconstant\(\s*\"?([A-Za-z0-9_][\w-]*)\"?\s*\)")
_WITHOUT_OBJECTS = re.compile(r"\(\s*[0-9]+\s*,\s*([A-Za-z_]\w*)(?=\s*\))|\(\s*([A-Za-z_]\w*)(?=\s*,\s*[0-9]+\s*\))")
_NUMBER_BEFORE = re.compile(r"\w\(\s*(?:([0-9]{1,9})\s*,\s*)?(?:\w+\(\s*)?$")
_NUMBER_BEHIND = re.compile(r"[\s)]*,\s*([0-9]{1,9})\s*\)")
# A step behind another one and a ``;``, which is no comment then.
_NEXT = re.compile(r"(?<=\));(?=\s*\(([^()]*)\))")
_QUOTES = str.maketrans("\u201c\u201d\u2018\u2019", "\"\"''")
# The keys of steps that are numbered: ``1``, ``step_2``.
_NUMBER = re.compile(r"\D*([0-9]{1,9})")
# What language models think before they answer, and the blocks of their answers.
_THOUGHTS = re.compile(r"<think(?:ing)?>.*?</think(?:ing)?>", re.DOTALL | re.IGNORECASE)
_FENCED = re.compile(r"^[ \t]*```[^\n]*\n(.*?)```", re.DOTALL | re.MULTILINE)
_DATA = re.compile(r"[\[{].*[\]}]", re.DOTALL)
# What of data is in a text that has steps as well; the brackets of durations have numbers in them.
_MAY_BE_DATA = re.compile(r"[{`]|\[\s*[^\s\d]")
# Longer texts are logs, which have no data in them.
_MOST_DATA = 100_000
_OPEN = re.compile(r"\(\s*([A-Za-z0-9_][\w-]*)(?:[\s,]+[\w-]+)*\s*$")
# Partially ordered plans list the order of their steps in pairs.
_ORDER = re.compile(r"\)\s*<\s*\w")
# What stands before a comment; LPG has a ``;`` within the brackets of a duration.
_CODE = re.compile(r"[^;\[]*(?:\[[^\]]*\]?)?[^;]*")
# Times are printed with three decimals; what overlaps by less does not.
_TOLERANCE = Decimal("0.001")
_ANNOUNCED = re.compile(
    r"\b(?:found|better|new|best|improved)\b.*\b(?:plan|solution)\b|\b(?:plan|solution)\b.*\bfound\b"
    r"|plan[^:]*:\s*$|goal reached|^\s*==>\s*$",
    re.IGNORECASE,
)
_COST = re.compile(r"\s*;\s*cost\s*=", re.IGNORECASE)
_LENGTH = re.compile(r"plan[ -]?length\s*[:=]?\s*([0-9]{1,9})\b|\b([0-9]{1,9}) actions in the plan", re.IGNORECASE)
_EMPTY = re.compile(r"\bempty plan\b", re.IGNORECASE)
_FAILED = re.compile(
    r"\b(?:unsolvable|not solvable|no (?:plan|solution)s?)\b|without finding|simplified to false"
    r"|(?:time|memory) limit .*(?:reached|exceeded)|out of memory",
    re.IGNORECASE,
)
# Steps that planners add to a plan: Metric-FF where it compiles the goal away.
_ADDED = frozenset({"reach-goal"})
_HINT = (
    "write (name argument ...) or name(argument, ...), or name argument ... on a line; names are those of the domain"
)


@dataclass(frozen=True, slots=True)
class Plan:
    """A plan that was read: its instructions, where each of them stands, and warnings about the reading.

    Of several plans one is taken, and instructions that overlap in time follow one another in the order of their
    starts; a warning says so.
    """

    instructions: tuple[Instruction, ...] = ()
    locations: tuple[Location, ...] = field(default=(), compare=False, repr=False)
    warnings: tuple[str, ...] = field(default=(), compare=False, repr=False)


def read_plan(path: str | Path, problem: Problem | None = None) -> Plan:
    """Return the plan in the file at ``path``; as :func:`parse_plan`."""
    return parse_plan(read_text(path), str(path), problem)


def parse_plan(text: str, file: str = "<text>", problem: Problem | None = None) -> Plan:
    """Return the plan in a text or in JSON.

    Of several plans in a text the last whole one is taken, because planners go on to better ones; of those in JSON the
    first. Steps with times are put in the order of their times. Without the problem that the plan is for, only steps
    with parentheses are found, on lines where nothing else stands. ``file`` names the text in messages.

    Raises:
        TmdError: There is no plan, it is cut off, something in the place of a step is none, or only some steps have a
            time.
    """
    reader = _Reader(file, _Vocabulary.of(problem))
    text = reader.vocabulary.in_steps(_THOUGHTS.sub(lambda thought: blanks(thought[0]), text).translate(_QUOTES))
    plans, of_data = _plans(text, reader)
    whole = [plan for plan in plans if not plan.cut]
    if not plans:
        raise reader.no_plan(text)
    if not whole:
        raise plans[-1].cut_off()
    if of_data:  # a record of a text has clauses as well, which look like steps
        whole = [plan for plan in whole if reader.known(plan) == len(plan.steps)] or whole
        plans = [plan for plan in plans if plan in whole or plan.cut]
    chosen = whole[0 if of_data else -1]
    steps = _in_time([step for step in chosen.steps if not reader.vocabulary.added(step.instruction)])
    return Plan(
        tuple(step.instruction for step in steps),
        tuple(step.place for step in steps),
        (*_choice(chosen, plans, file), *_overlap(steps)),
    )


def _plans(text: str, reader: _Reader) -> tuple[list[_Found], bool]:
    """Return the plans in a text, and whether they stand in data."""
    value = _json(text)
    plans = [] if value is not None else reader.plans_of_text(text)
    data: list[_Found] = []
    if value is not None or not plans or _MAY_BE_DATA.search(text):
        with suppress(TmdError) if plans else nullcontext():  # what looks like data may be lists of Python
            data = list(_JsonReader(text, reader).plans(_data(text) if value is None else value))
    if max(map(reader.known, data), default=0) > max(map(reader.known, plans), default=-1):
        return data, True
    return plans, value is not None


def _json(text: str) -> Any | None:  # noqa: ANN401 - any JSON
    """Return the JSON value that ``text`` is, if it is an object or a list."""
    if not text.lstrip("\ufeff \t\r\n").startswith(("{", "[")):
        return None
    try:
        return json.loads(text.removeprefix("\ufeff"))
    except (ValueError, RecursionError):
        return None


def _data(text: str) -> list[Any]:
    """Return the values of JSON or YAML in a text: its blocks, itself, what has brackets, or single lines."""
    found: list[Any] = []
    for part in _FENCED.findall(text) or [text] if len(text) <= _MOST_DATA else ():
        if (value := _xml(part)) is not None:
            found.append(value)
            continue
        lines = [line for line in split_lines(part) if line.lstrip().startswith(("{", "["))]
        for candidates in ([part], _DATA.findall(part), lines):
            values = [value for value in map(_yaml, candidates) if isinstance(value, dict | list)]
            if values:
                found.append(values[0] if len(values) == 1 else values)
                break
    return found


def _xml(text: str) -> Any | None:  # noqa: ANN401 - any XML
    """Return the value of a text in XML: attributes and elements by name, all words as text; ``None`` for others."""
    if not text.lstrip("\ufeff \t\r\n").startswith("<") or "<!" in text:
        return None
    import xml.etree.ElementTree as ET

    def value(element: ET.Element) -> Any:  # noqa: ANN401
        if not element.attrib and not len(element):
            return element.text or ""
        elements: dict[str, list[Any]] = {}
        for inner in element:
            elements.setdefault(inner.tag, []).append(value(inner))
        return {**element.attrib, **elements, "": element.text or ""}

    with suppress(ET.ParseError, RecursionError):
        return value(ET.fromstring(text.strip()))
    return None


def _yaml(text: str) -> Any | None:  # noqa: ANN401 - any YAML
    """Return the value of a text in YAML, all words and numbers as text; ``None`` where it is none."""
    import yaml  # most plans are read without it

    from tmd.yaml_nodes import look_over

    try:
        look_over(text, "")
        return yaml.load(text, Loader=yaml.BaseLoader)
    except (TmdError, yaml.YAMLError):
        return None


@dataclass(frozen=True, slots=True)
class _Vocabulary:
    """The names that steps are made of; without actions, any name is one."""

    parameters: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Those of each action, without question marks."""
    predicates: frozenset[str] = frozenset()
    objects: frozenset[str] = frozenset()

    @classmethod
    def of(cls, problem: Problem | None) -> _Vocabulary:
        if problem is None:
            return cls()
        return cls(
            {a.name: tuple(p.name.removeprefix("?") for p in a.parameters) for a in problem.domain.actions},
            frozenset(predicate.name for predicate in problem.domain.predicates),
            frozenset(thing.name for thing in problem.all_objects()),
        )

    def has(self, words: Sequence[str]) -> bool:
        """Return whether ``words`` are an action before as many objects as it has parameters."""
        arguments = self.parameters.get(words[0])
        return arguments is not None and len(arguments) == len(words) - 1 and self.objects.issuperset(words[1:])

    def step_of(self, words: Sequence[str]) -> str:
        """Return the step that has these words, in any order and perhaps with others; the empty text for none."""
        arguments = [word for word in words if word in self.objects]
        known = [word for word in words if word in self.parameters]
        action = known or [word for word in words if arguments and word not in self.objects][:1]
        return f"({' '.join([*action, *arguments])})" if len(action) == 1 else ""

    def resembles(self, words: Sequence[str]) -> bool:
        """Return whether ``words`` begin with an action, or are objects behind a name of nothing else."""
        if words[0] in self.parameters:
            return True
        known = self.predicates | self.objects
        return len(words) > 1 and words[0] not in known and self.objects.issuperset(words[1:])

    def in_steps(self, text: str) -> str:
        """Return ``text`` with constructors of steps, such as ``Action("grasp", ["mug1"])``, as groups."""

        def constructor(found: re.Match[str]) -> str:
            known = found[1].lower() not in self.parameters and found[2].lower() in self.parameters
            return f"{blanks(found[1])}(" if known else found[0]

        def arguments(found: re.Match[str]) -> str:
            inner = re.split(r"\W", found[5].lstrip("\"' ").lower(), maxsplit=1)[0]
            if found[3].lower() not in self.parameters or inner in self.parameters:
                return found[0]
            before = f"({blanks(found[0][1 : found.start(2) - found.start()])}{found[2]}"
            start, end = found.start(5) - found.start(), found.end(5) - found.start()
            return f"{before.ljust(start)}{found[5]}{blanks(found[0][end:-1])})"

        def following(found: re.Match[str]) -> str:
            words = self.words(found[1])
            return " " if words and self.has(words) else found[0]

        def call(found: re.Match[str]) -> str:
            return found[0] if self.parameters.get((found[1] or found[2]).lower(), "no") else f"{found[0]}()"

        text = _WITHOUT_OBJECTS.sub(call, text)
        text = _CONSTANT.sub(lambda found: found[1].ljust(len(found[0])), text)
        text = text.replace("(!", "( ")  # so hierarchical planners write what an agent does
        return _NEXT.sub(following, _ARGUMENTS.sub(arguments, _CONSTRUCTOR.sub(constructor, text)))

    def words(self, text: str) -> list[str]:
        """Return the words of what may be a step.

        Objects may have the names of their parameters before them, in any order, and ``push-k1-b2`` is three words
        where it can only be these.
        """
        named = [name.lower() for name in _NAMED.findall(text)]
        words = [word for word in re.split(r"[\s,]+", _NAMED.sub("", text).lower()) if word]
        if len(words) == 1 and self.objects and words[0] not in self.parameters:
            found = list(islice(self._apart(words[0]), 2))
            return found[0] if len(found) == 1 else words
        parameters = self.parameters.get(words[0], ()) if words else ()
        if named and sorted(named) == sorted(parameters) and len(words) == len(named) + 1:
            words[1:] = (words[1 + named.index(parameter)] for parameter in parameters)
        return words

    def _apart(self, word: str) -> Iterator[list[str]]:
        """Yield the steps that ``word`` may be, joined by ``-`` or ``_``."""
        for name, parameters in self.parameters.items():
            if word.startswith(name):
                yield from ([name, *names] for names in self._arguments(word[len(name) :], len(parameters)))

    def _arguments(self, text: str, count: int) -> Iterator[list[str]]:
        if not count and not text:
            yield []
        for joint in re.finditer(r"[-_]|$", text[1:]) if count and text[:1] in ("-", "_") else ():
            end = joint.start() + 1
            if text[1:end] in self.objects:
                yield from ([text[1:end], *names] for names in self._arguments(text[end:], count - 1))

    def denies(self, name: str) -> bool:
        """Return whether ``name`` is that of a predicate, and of no action."""
        return name in self.predicates and name not in self.parameters

    def may_begin(self, name: str) -> bool:
        """Return whether ``name`` may be that of an action."""
        return not self.parameters or name in self.parameters

    def added(self, instruction: Instruction) -> bool:
        """Return whether a planner added the instruction, which is of no action of the domain."""
        return instruction.name in _ADDED and bool(self.parameters) and instruction.name not in self.parameters


@dataclass(frozen=True, slots=True)
class _Step:
    """A step: its place and line, and when it starts and ends if that is given."""

    instruction: Instruction
    place: Location
    source: str
    start: Decimal | None = None
    end: Decimal | None = None


@dataclass(slots=True)
class _Found:
    """A plan in a text.

    Attributes:
        length: How many steps it has according to the text.
        closed: Whether all further steps belong to another plan.
        cut: Whether steps are missing at its end.
    """

    steps: list[_Step] = field(default_factory=list)
    length: int | None = None
    closed: bool = False
    cut: bool = False

    def cut_off(self) -> TmdError:
        """Return the error that steps are missing."""
        last = self.steps[-1]
        counted = f": it has {self.length} steps, and {len(self.steps)} stand here" if self.length else ""
        hint = "give all that the planner printed"
        return TmdError(f"the plan is cut off{counted}", location=last.place, source=last.source, hint=hint)


@dataclass(slots=True)
class _Line:
    """A line of a text: its steps; or words that are a step if the lines around it, written alike, are steps."""

    text: str
    form: tuple[object, ...] = ()
    steps: list[_Step] = field(default_factory=list)
    likely: _Step | None = None


class _Reader:
    """Finds plans in text."""

    def __init__(self, file: str, vocabulary: _Vocabulary) -> None:
        self.file = file
        self.vocabulary = vocabulary

    def plans_of_text(self, text: str) -> list[_Found]:
        """Return the plans in the order in which they stand; one without steps if the text is one."""
        lines = [self._line(line, number) for number, line in enumerate(split_lines(text), start=1)]
        _confirm(lines)
        split = _split(lines)
        plans = [plan for plan in split if plan.steps]
        if not plans:
            return split[:1] if self._is_empty_plan(lines, split) else []
        for plan in plans:
            plan.cut = len(plan.steps) < (plan.length or 0)
        # a planner that gives the length of each plan was stopped while it printed the last one
        plans[-1].cut |= plans[-1].length is None and any(plan.length for plan in plans)
        return plans

    def known(self, plan: _Found) -> int:
        """Return how many steps of a plan have the names of the problem."""
        return sum(self.vocabulary.has((s.instruction.name, *s.instruction.args)) for s in plan.steps)

    @staticmethod
    def _is_empty_plan(lines: Sequence[_Line], plans: Sequence[_Found]) -> bool:
        """Return whether lines without steps are a plan without steps: they say so, or there are comments only."""
        if any(_EMPTY.search(line.text) for line in lines):
            return True
        if any(_FAILED.search(line.text) for line in lines):
            return False
        remarks = (line.text for line in lines if re.search(r"\w", _code(line.text)))
        return any(plan.length == 0 for plan in plans) or all(_ANNOUNCED.search(text) for text in remarks)

    def no_plan(self, text: str) -> TmdError:
        """Return the error that there is no plan in ``text``, with the line in which the planner says so."""
        for number, line in enumerate(split_lines(text), start=1):
            if found := _FAILED.search(line):
                place = Location(self.file, number, found.start() + 1)
                hint = f'the planner says "{_shown(line.strip())}"'
                return TmdError("there is no plan here: none was found", location=place, source=line, hint=hint)
        return TmdError("there is no plan in this text", location=Location(self.file, 1, 1), hint=_HINT)

    def _line(self, source: str, number: int) -> _Line:
        """Read a line by itself."""
        code = _OTHER_BRACKETS.sub(self._round, _code(source).translate(_MARKS))
        head = _HEAD.match(code)
        assert head is not None  # it matches the empty text
        line = _Line(source)
        place = Location(self.file, number, 1)
        start = Decimal(head[1] or head[3]) if ":" in (head[2], head[4]) else None
        line.steps = [] if _ORDER.search(code) else self._groups(source, code, place, head, start)
        line.steps = line.steps or self._in_a_row(source, place, head.end())
        bare = self._bare(code, head.end())
        if bare and not any(
            self.vocabulary.has((step.instruction.name, *step.instruction.args)) for step in line.steps
        ):
            line.form = (head[2] or head[4], head[1] is head[3])
            step = _Step(_instruction(bare), shifted(place, head.end()), source, start)
            line.steps = [step] if self.vocabulary.has(bare) else line.steps
            line.likely = step if self.vocabulary.resembles(bare) else None
        return line

    def _bare(self, code: str, position: int) -> list[str]:
        """Return the words of a line, if it is words and perhaps a remark behind them."""
        found = _BARE.match(code, position)
        if found is None or not _REMARK.fullmatch(code, found.end()):
            return []
        return self.vocabulary.words(found[0])

    def _in_a_row(self, source: str, place: Location, position: int) -> list[_Step]:
        """Return the steps of a line that consists of several ones, in words."""
        text = source.translate(_MARKS)
        gaps = [match.span() for match in _BETWEEN.finditer(text, position) if match[0].strip()]
        starts, ends = [position, *(end for _, end in gaps)], [*(start for start, _ in gaps), len(text)]
        parts = [(start, text[start:end].lower().split()) for start, end in zip(starts, ends, strict=True)]
        parts = [(start, words) for start, words in parts if words]
        if len(parts) < 2 or not all(self.vocabulary.has(words) for _, words in parts):
            return []
        return [_Step(_instruction(words), shifted(place, start), source) for start, words in parts]

    def _round(self, brackets: re.Match[str]) -> str:
        """Return a step in round brackets; anything else as it is."""
        name, inside = brackets[1] or "", brackets[2]
        words = self.vocabulary.words(inside)
        if name:
            call = self.vocabulary.words(f"{name} {inside}")
            return f"{name}({inside})" if self.vocabulary.has(call) else brackets[0]
        return f"({inside})" if words and self.vocabulary.has(words) else brackets[0]

    def _groups(
        self, source: str, code: str, place: Location, head: re.Match[str], start: Decimal | None
    ) -> list[_Step]:
        """Return the steps of a line that have parentheses."""
        self._check_end(source, code, place, head.end())
        found = [self._group(group) for group in _GROUP.finditer(code)]
        known = any(words and self.vocabulary.has(words) for words, _, _ in found)
        rest = list(code)
        for _, begin, end in found:
            rest[begin:end] = " " * (end - begin)
        pure = not re.search(r"\w", _BRACKETS.sub("", "".join(rest[head.end() :])))
        steps = []
        for words, begin, end in found:
            if words and (pure or self.vocabulary.has(words) or (not known and self.vocabulary.resembles(words))):
                where = shifted(place, begin)
                if not self.vocabulary.has(words):  # names of the domain may be odd
                    _check_names(words, where, source)
                length = _DURATION.match(code, end)
                stop = start + Decimal(length[1]) if start is not None and length else None
                time = start if start is not None else _number_in_atom(code, begin, end)
                steps.append(_Step(_instruction(words), where, source, time, stop))
        return steps

    def _check_end(self, source: str, code: str, place: Location, position: int) -> None:
        """Make sure that the last step of a line is closed."""
        unclosed = _OPEN.search(code, position)
        if unclosed and self.vocabulary.may_begin(unclosed[1].lower()):
            hint = "add the missing ); if the text ends here, give all of it"
            where = shifted(place, unclosed.start())
            raise TmdError("this step is not closed", location=where, source=source, hint=hint)

    def _group(self, group: re.Match[str]) -> tuple[list[str], int, int]:
        """Return the words of a group, with a name in front if they are a call, and its columns from 0.

        There are no words if it cannot be a step.
        """
        inside = self.vocabulary.words(group[3])
        if group[1]:
            call = self.vocabulary.words(f"{group[1]} {group[3]}")
            known = bool(inside) and self.vocabulary.has(inside)
            if self.vocabulary.has(call) or (not group[2] and not known and not self.vocabulary.denies(call[0])):
                return call, group.start(), group.end()
        # numbers, keywords, variables and predicates are no actions
        step = bool(inside) and not re.match(r"[:?]|[0-9.]*$", inside[0]) and not self.vocabulary.denies(inside[0])
        return inside if step else [], group.start(3) - 1, group.end()


def _number_in_atom(code: str, begin: int, end: int) -> Decimal | None:
    """Return the number of the step in these columns, where the step stands in an atom of logic programs."""
    before, behind = _NUMBER_BEFORE.search(code[:begin]), _NUMBER_BEHIND.match(code, end)
    number = before and (before[1] or (behind and behind[1]))
    return Decimal(number) if number else None


def _confirm(lines: Sequence[_Line]) -> None:
    """Take the words of a line for a step where the line before or behind it is one and is written alike."""
    for order in (lines, lines[::-1]):
        form: tuple[object, ...] | None = None
        for line in order:
            if line.likely and not line.steps and line.form == form:
                line.steps = [line.likely]
            if line.text.strip():
                form = line.form if line.steps else None


def _split(lines: Iterable[_Line]) -> list[_Found]:
    """Return the plans of a text: each goes up to its cost, to where another one is announced, or times begin again."""
    plans = [_Found()]
    apart = False
    for line in lines:
        plan = plans[-1]
        if line.steps:
            first = plan.steps[0].start if len(plan.steps) > 1 else None
            if plan.closed or (apart and first is not None and line.steps[0].start == first):
                plans.append(plan := _Found())
            plan.steps += line.steps
        elif length := _LENGTH.search(line.text):
            plan.length = int(length[1] or length[2])
        elif _COST.match(line.text):
            plan.closed = bool(plan.steps)
        elif _ANNOUNCED.search(line.text) and not _FAILED.search(line.text):
            plans.append(_Found())
        apart = not line.steps
    return plans


def _code(line: str) -> str:
    """Return ``line`` without its comment."""
    found = _CODE.match(line)
    return found[0] if found else ""


def _instruction(words: Sequence[str]) -> Instruction:
    return Instruction(words[0], tuple(words[1:]))


def _check_names(words: Sequence[str], place: Location, source: str) -> None:
    for word in words:
        if not NAME.fullmatch(word):
            found = source.lower().find(word, place.column - 1)
            where = replace(place, column=found + 1) if found >= 0 else place
            hint = "a name has letters, digits, _ and -, a letter first"
            raise TmdError(f'"{_shown(word)}" is not a name', location=where, source=source, hint=hint)


class _JsonReader:
    """Finds plans in a JSON value: lists of steps, and texts that hold steps.

    A step is a text, a list of its words, or an object with the one or the other.
    """

    def __init__(self, text: str, reader: _Reader) -> None:
        self._text = text
        self._reader = reader
        self._position = 0

    def plans(self, value: Any) -> Iterator[_Found]:  # noqa: ANN401 - any JSON
        """Yield the plans in ``value``, in the order in which they stand."""
        before = self._position
        if isinstance(value, dict) and len(value) > 1 and all(map(_NUMBER.fullmatch, value)):
            value = list(value.values())
        found = self._of_list(value) if isinstance(value, list) else []
        if isinstance(value, str):
            place = self._place(value)
            found = [plan for plan in self._reader.plans_of_text(value) if plan.steps]
            for plan in found:
                plan.steps = [replace(step, place=place) for step in plan.steps]
        yield from found
        if not found and isinstance(value, dict | list):
            self._position = before
            for inner in value.values() if isinstance(value, dict) else value:
                yield from self.plans(inner)

    def _of_list(self, value: Sequence[Any]) -> list[_Found]:
        """Return the plan that a list is, if each of its items is a text or a step."""
        named = self._reader.vocabulary.parameters.keys()
        keyed = (isinstance(item, dict) and len(item) == 1 and named & item.keys() for item in value)
        value = [list(*item.items()) if key else item for item, key in zip(value, keyed, strict=True)]
        places = [self._place(item) for item in value]
        lines = [self._as_line(item) for item in value]
        if not all(line or isinstance(item, str) for line, item in zip(lines, value, strict=True)):
            return []
        found = [plan for plan in self._reader.plans_of_text("\n".join(lines)) if plan.steps]
        for plan in found:
            plan.steps = [replace(step, place=places[step.place.line - 1]) for step in plan.steps]
        return found

    def _place(self, value: Any) -> Location:  # noqa: ANN401 - any JSON
        """Return where ``value`` stands, which is behind all that was looked for before."""
        for text in _texts(value)[:1]:
            self._position = max(self._position, self._text.find(json.dumps(text)[1:-1], self._position))
        line = self._text.count("\n", 0, self._position) + 1
        return Location(self._reader.file, line, self._position - self._text.rfind("\n", 0, self._position))

    def _as_line(self, value: Any) -> str:  # noqa: ANN401 - any JSON
        """Return a step as a line of text; the empty line for anything else."""
        if isinstance(value, str):
            return _on_a_line(value)
        return self._of_named(value) or self._of_words(value) or self._of_texts(value)

    def _of_texts(self, value: Any) -> str:  # noqa: ANN401 - any JSON
        """Return the step that is one of the texts in ``value``, or whose words may be, with names of nothing too."""
        steps = [text for text in map(_on_a_line, _texts(value, 1)) if self._reader.plans_of_text(text)]
        if isinstance(value, dict) and len(steps) == 1:
            (plan,) = self._reader.plans_of_text(steps[0])[:1]
            acts = all(self._reader.vocabulary.may_begin(step.instruction.name) for step in plan.steps)
            return steps[0] if acts else ""  # a goal is no step
        words = [text.lower() for text in _texts(value, 2)]
        if any(self._reader.plans_of_text(text) for text in words if not NAME.fullmatch(text)):
            return ""  # a list of steps
        return self._reader.vocabulary.step_of([word for word in words if NAME.fullmatch(word)])

    def _of_words(self, value: Any) -> str:  # noqa: ANN401 - any JSON
        """Return the step whose words are the texts of an object, some in one text; the empty text for none."""
        if not isinstance(value, dict):
            return ""
        vocabulary = self._reader.vocabulary
        split = [re.split(r"[\s,]+", _NAMED.sub("", text.lower())) for text in _texts(value, 4)]
        words = [word for part in split if len(part) == 1 or vocabulary.objects.issuperset(part) for word in part]
        others = (" ".join(part) for part in split if len(part) > 1 and not vocabulary.objects.issuperset(part))
        step = "" if any(map(self._reader.plans_of_text, others)) else vocabulary.step_of(words)
        return step if step and vocabulary.has(step[1:-1].split()) else ""

    def _of_named(self, value: Any) -> str:  # noqa: ANN401 - any JSON
        """Return the step whose objects have the names of its parameters, in any order; the empty text for none."""
        vocabulary = self._reader.vocabulary
        named = {key.lower().removeprefix("?"): word.lower() for key, word in _pairs(value, 3)}
        for action in (text.lower() for text in _texts(value, 2)):
            parameters = vocabulary.parameters.get(action, ())
            words = [action, *(named.get(parameter, "") for parameter in parameters)]
            if parameters and vocabulary.has(words):
                return f"({' '.join(words)})"
        return ""


def _on_a_line(text: str) -> str:
    return " ".join(text.split())


def _texts(value: Any, depth: int = 99) -> list[str]:  # noqa: ANN401 - any JSON
    """Return the texts in ``value`` that are within so many others."""
    if isinstance(value, str):
        return [value]
    inner = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return [text for item in inner for text in _texts(item, depth - 1)] if depth else []


def _pairs(value: Any, depth: int) -> Iterator[tuple[str, str]]:  # noqa: ANN401 - any JSON
    """Yield the keys with a text, and what is written as ``key=text``, within so many others."""
    listed = value if isinstance(value, list) else ()
    inner = value.items() if isinstance(value, dict) else ((None, item) for item in listed)
    for key, item in inner:
        if isinstance(item, str):
            found = _NAMED.match(item)
            yield (found[1], item[found.end() :].strip()) if found else (key or "", item)
        elif isinstance(item, dict | list) and depth:
            yield from _pairs(item, depth - 1)


def _choice(chosen: _Found, plans: Sequence[_Found], file: str) -> list[str]:
    """Return the warning that there are several plans, or that the last one is not whole."""
    different = {tuple(step.instruction for step in plan.steps) for plan in plans}
    if len(different) < 2:
        return []
    which = "last whole" if plans[-1].cut else "last" if chosen is plans[-1] else "first"
    return [f"{chosen.steps[0].place}: {len(plans)} plans are in {file}; the {which} one is taken"]


def _in_time(steps: list[_Step]) -> list[_Step]:
    """Return the steps in the order of their times; as they are where there are none."""
    timed = [step for step in steps if step.start is not None]
    if not timed:
        return steps
    if len(timed) < len(steps):
        stray = next(step for step in steps if step.start is None)
        raise TmdError(
            "this line has no time, and others have", location=stray.place, source=stray.source, hint="give all or none"
        )
    return sorted(timed, key=lambda step: step.start or Decimal(0))


def _overlap(steps: Sequence[_Step]) -> list[str]:
    """Return the warning for the first step that starts before its predecessor ends."""
    for before, after in pairwise(steps):
        if before.end is not None and after.start is not None and after.start < before.end - _TOLERANCE:
            return [f"{after.place}: instructions overlap in time; they are taken one after the other"]
    return []


def parse_instruction(text: str) -> Instruction:
    """Return the instruction written as ``keep(mug1, counter1, on)``; ``str`` of it gives the text back.

    Raises:
        TmdError: It is not an instruction.
    """
    hint = "write name(argument, ...)"
    call = _CALL.fullmatch(text)
    if call is None:
        raise TmdError(f'"{_shown(text.strip())}" is not an instruction', hint=hint)
    arguments = call[2].split(",") if call[2].strip() else []
    words = [word.strip().lower() for word in (call[1], *arguments)]
    for word in words:
        if not NAME.fullmatch(word):
            raise TmdError(f'"{_shown(word)}" is not a name' if word else "a name is missing", hint=hint)
    return _instruction(words)


def _shown(text: str) -> str:
    line = "".join(c if c.isprintable() else " " for c in text)
    return line if len(line) <= 40 else f"{line[:37]}..."
