"""Every slip an author can make is told with its place, its line and what to do."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tmd.diagnostics import TmdError
from tmd.pddl.reading.checking import check_domain, check_problem
from tmd.pddl.reading.reader import (
    parse_domain,
    parse_domain_unchecked,
    parse_problem,
    parse_problem_unchecked,
    read_domain,
    read_problem,
)

DOMAIN = """\
(define (domain cafe)
  (:requirements :strips :typing :negative-preconditions :conditional-effects :equality)
  (:types mug - item item place - object)
  (:constants table - place)
  (:predicates (at ?i - item ?p - place) (held ?i - item) (full ?m - mug))
  (:action grasp
    :parameters (?i - item ?p - place)
    :precondition (and (at ?i ?p) (not (held ?i)))
    :effect (and (held ?i) (not (at ?i ?p))))
  (:action fill
    :parameters (?m - mug)
    :precondition (held ?m)
    :effect (and (forall (?n - mug) (when (at ?n table) (full ?n))) (full ?m)))
)
"""
PROBLEM = """\
(define (problem one)
  (:domain cafe)
  (:objects cup - mug shelf - place spoon - item)
  (:init (at cup shelf) (at spoon table))
  (:goal (and (full cup) (held spoon))))
"""

# what to replace, by what, line and column of the fault, a part of the message, a part of the hint
DOMAIN_FAULTS = {
    "missing parenthesis in a precondition": (
        "(not (held ?i)))",
        "(not (held ?i))",
        8,
        19,
        "never closed",
        "add",
    ),
    "missing parenthesis of an action": (
        "(not (at ?i ?p))))",
        "(not (at ?i ?p)))",
        6,
        3,
        "never closed",
        "add",
    ),
    "missing parenthesis at the end": ("(full ?m)))\n)", "(full ?m)))\n", 1, 1, "never closed", "add"),
    "extra parenthesis at the end": ("(full ?m)))\n)", "(full ?m)))\n))", 14, 2, "no opening", "remove"),
    "extra parenthesis in the middle": (
        "(not (at ?i ?p))))",
        "(not (at ?i ?p)))))",
        9,
        46,
        "too early",
        "too many",
    ),
    "extra parenthesis in a precondition": (
        "(not (held ?i)))",
        "(not (held ?i))))",
        9,
        5,
        "outside its action",
        "too many",
    ),
    "undeclared predicate": ("(held ?m)", "(hald ?m)", 12, 20, 'unknown predicate "hald"', '"held"'),
    "wrong arity": ("(at ?n table)", "(at ?n)", 13, 43, "takes 2 argument(s), found 1", "(at ?i ?p)"),
    "unknown type of a parameter": ("(?m - mug)\n", "(?m - mugg)\n", 11, 23, 'unknown type "mugg"', '"mug"'),
    "unknown parent type": ("mug - item item", "mug - itm item", 3, 17, 'unknown type "itm"', '"item"'),
    "undeclared constant": ("(at ?n table)", "(at ?n tabel)", 13, 50, 'unknown object "tabel"', '"table"'),
    "forgotten question mark": ("(held ?m)\n", "(held m)\n", 12, 25, 'unknown object "m"', '"?m"'),
    "free variable": (
        ":precondition (held ?m)",
        ":precondition (held ?x)",
        12,
        25,
        'free variable "?x"',
        "?m",
    ),
    "argument of the wrong type": ("(held ?m)\n", "(at ?m ?m)\n", 12, 26, 'needs "place"', None),
    "predicate twice": (
        "(full ?m - mug))",
        "(full ?m - mug) (at ?m))",
        5,
        75,
        '"at" is declared twice',
        "rename",
    ),
    "action twice": ("(:action fill", "(:action grasp", 10, 12, 'action "grasp" is declared twice', "rename"),
    "parameter twice": (
        "(?i - item ?p - place)\n    :pre",
        "(?i - item ?i - place)\n    :pre",
        7,
        28,
        "twice",
        "rename",
    ),
    "shadowed variable": ("(?n - mug)", "(?m - mug)", 13, 27, '"?m" is declared twice', "rename"),
    "type cycle": ("item place", "item - mug place", 3, 11, "its own ancestor", "mug < item < mug"),
    "unknown section": (
        "(:predicates",
        "(:predicate",
        5,
        3,
        '"(:predicate ...)" is not a section',
        '":predicates"',
    ),
    "section twice": ("(:constants", "(:types", 4, 3, '":types" appears twice', None),
    "unknown keyword": (
        ":precondition (held",
        ":precond (held",
        12,
        5,
        '":precond" is not a part',
        '":precondition"',
    ),
    "word for atom": (
        ":precondition (held ?m)",
        ":precondition held",
        12,
        19,
        "expected a condition",
        "(held)",
    ),
    "unknown requirement": (":equality", ":equalty", 2, 79, "not a known requirement", '":equality"'),
    "derived and changed": (
        "(:action grasp",
        "(:derived (held ?i) (at ?i table)) (:action grasp",
        9,
        18,
        "is derived",
        "remove",
    ),
    "derived from its negation": (
        "(:action fill",
        "(:derived (spare ?i - mug) (not (spare ?i))) (:action fill",
        10,
        3,
        "its own negation",
        "without what it helps to derive",
    ),
    "derived without a condition": ("(:action fill", "(:derived (full ?m)) (:action fill", 10, 3, "condition", "write"),
    "durative actions": ("(:action fill", "(:durative-action fill", 10, 3, '":durative-action"', None),
    "numeric fluents": ("(held ?i) (not", "(increase (fuel) 1) (not", 9, 18, "numeric fluents", "total-cost"),
    "object fluents": ("(held ?i) (not", "(assign (f) ?i) (not", 9, 18, "object fluents", None),
    "preference": (
        ":precondition (held ?m)",
        ":precondition (preference p (held ?m))",
        12,
        19,
        "preferences",
        None,
    ),
    "constraints": (
        "(:constants table - place)",
        "(:constraints (and))",
        4,
        3,
        "trajectory constraints",
        None,
    ),
    "numeric condition": (
        ":precondition (held ?m)",
        ":precondition (> (f) 1)",
        12,
        19,
        "numeric conditions",
        None,
    ),
    "when in a precondition": (
        ":precondition (held ?m)",
        ":precondition (when (a) (b))",
        12,
        19,
        '"when"',
        "imply",
    ),
    "or in an effect": ("(held ?i) (not", "(or (held ?i)) (not", 9, 18, "cannot be an effect", None),
    "not around two": (
        "(not (held ?i))",
        "(not (held ?i) (held ?i))",
        8,
        35,
        "takes 1 part(s), found 2",
        None,
    ),
    "either for a constant": ("table - place", "table - (either item place)", 4, 15, "one type", "parent"),
    "bad name": ("(domain cafe)", "(domain !cafe)", 1, 17, '"!cafe" is not', "begin with a letter"),
    "reserved name": ("(held ?i - item)", "(when ?i - item)", 5, 43, '"when" is a word of PDDL', None),
    "captured variable": (
        "(forall (?n - mug) (when (at ?n table) (full ?n)))",
        "(when (full ?n) (forall (?n - mug) (full ?n)))",
        13,
        43,
        "already stands in a condition",
        "another name",
    ),
}

PROBLEM_FAULTS = {
    "another domain": ("(:domain cafe)", "(:domain caffe)", 2, 12, 'is of domain "caffe"', 'did you mean "cafe"?'),
    "undeclared object": ("(at cup shelf)", "(at cub shelf)", 4, 14, 'unknown object "cub"', '"cup"'),
    "undeclared object in the goal": ("(full cup)", "(full cop)", 5, 21, 'unknown object "cop"', '"cup"'),
    "unknown type of an object": ("cup - mug", "cup - mub", 3, 19, 'unknown type "mub"', '"mug"'),
    "object twice": ("spoon - item", "cup - item", 3, 37, 'object "cup" is declared twice', "rename"),
    "object like a constant": ("spoon - item", "table - item", 3, 37, "constant of another type", "rename"),
    "wrong type in init": ("(at cup shelf)", "(at shelf cup)", 4, 14, "are swapped", "(at cup shelf)"),
    "wrong arity in init": ("(at cup shelf)", "(at cup)", 4, 10, "takes 2 argument(s), found 1", None),
    "unknown predicate in init": (
        "(at cup shelf)",
        "(att cup shelf)",
        4,
        11,
        'unknown predicate "att"',
        '"at"',
    ),
    "variable in init": ("(at cup shelf)", "(at ?c shelf)", 4, 10, 'variable "?c" in :init', "object"),
    "free variable in the goal": ("(full cup)", "(full ?c)", 5, 21, 'free variable "?c"', None),
    "no goal": ("(:goal (and (full cup) (held spoon))))", ")", 1, 18, "no (:goal ...)", None),
    "timed literal": ("(at cup shelf)", "(at 5 (full cup))", 4, 10, "timed initial literals", None),
    "contradiction": (
        "(at cup shelf)",
        "(at cup shelf) (not (at cup shelf))",
        4,
        10,
        "to hold and not to hold",
        None,
    ),
    "metric": ("(:goal", "(:metric maximize (total-cost)) (:goal", 5, 3, "other metrics", "total-cost"),
    "no cost to minimise": (
        "(:goal",
        "(:metric minimize (total-cost)) (:goal",
        5,
        3,
        'the function "total-cost"',
        ":functions",
    ),
    "missing parenthesis": ("(at spoon table))", "(at spoon table)", 4, 3, "never closed", "add"),
    "unknown section": ("(:objects", "(:object", 3, 3, "is not a section", '":objects"'),
    "an atom in two pairs": ("(at cup shelf)", "((at cup shelf))", 4, 10, "no parentheses around", "remove them"),
    "a domain instead": ("(problem one)", "(domain one)", 1, 9, "found (domain ...)", None),
}


def _expect(error: TmdError, text: str, line: int, column: int, message: str, hint: str | None) -> None:
    assert error.location is not None
    assert message in error.message
    assert (error.location.line, error.location.column) == (line, column), str(error)
    assert error.source == text.splitlines()[line - 1]
    assert "\n" not in str(error)
    if hint:
        assert error.hint and hint in error.hint


@pytest.mark.parametrize("fault", DOMAIN_FAULTS)
def test_fault_of_a_domain(fault: str) -> None:
    old, new, line, column, message, hint = DOMAIN_FAULTS[fault]
    assert DOMAIN.count(old) >= 1
    text = DOMAIN.replace(old, new, 1)
    with pytest.raises(TmdError) as caught:
        parse_domain(text, "cafe.pddl")
    _expect(caught.value, text, line, column, message, hint)


@pytest.mark.parametrize("fault", PROBLEM_FAULTS)
def test_fault_of_a_problem(fault: str) -> None:
    old, new, line, column, message, hint = PROBLEM_FAULTS[fault]
    assert PROBLEM.count(old) >= 1
    text = PROBLEM.replace(old, new, 1)
    with pytest.raises(TmdError) as caught:
        parse_problem(text, parse_domain(DOMAIN), "one.pddl")
    _expect(caught.value, text, line, column, message, hint)


def test_without_faults() -> None:
    domain = parse_domain(DOMAIN)
    problem = parse_problem(PROBLEM, domain)
    assert check_domain(domain) == []
    assert check_problem(problem) == []


def test_all_faults_are_listed_in_order() -> None:
    text = DOMAIN.replace("(held ?m)", "(hald ?m)").replace("table - place", "table - plaice").replace(" :typing", "")
    domain, source = parse_domain_unchecked(text, "f")
    faults = check_domain(domain)
    assert [f.location.line for f in faults if f.location] == [3, 4, 12]
    assert "needs :typing" in faults[0].message
    problem, _ = parse_problem_unchecked(
        PROBLEM.replace("cup shelf", "cub shelf").replace("(full cup)", "(ful cup)"), parse_domain(DOMAIN)
    )
    assert len(check_problem(problem)) == 2
    assert source.line(faults[0].location) == text.splitlines()[2]


@pytest.mark.parametrize(
    ("old", "line", "column", "message"),
    [
        (" :negative-preconditions", 8, 35, '"not" needs :negative-preconditions'),
        (" :typing", 3, 11, "needs :typing"),
        (" :conditional-effects", 13, 57, "needs :conditional-effects"),
    ],
)
def test_a_missing_requirement_is_told_and_let_pass(old: str, line: int, column: int, message: str) -> None:
    faults = check_domain(parse_domain(DOMAIN.replace(old, "")))
    assert [(f.code, f.location.line, f.location.column) for f in faults if f.location] == [
        ("missing-requirement", line, column)
    ]
    assert message in faults[0].message


def test_a_name_that_planners_take_is_read() -> None:
    assert parse_domain(DOMAIN.replace("(domain cafe)", "(domain 1cafe)")).name == "1cafe"


def test_a_domain_without_requirements_is_strips() -> None:
    strips = "(define (domain d) (:predicates (p) (q)) (:action a :precondition (p) :effect (and (q) (not (p)))))"
    assert parse_domain(strips).requirements == ()
    more = parse_domain(strips.replace(":precondition (p)", ":precondition (not (p))"))
    assert [fault.code for fault in check_domain(more)] == ["missing-requirement"]


@pytest.mark.parametrize(
    ("data", "line", "column", "message"),
    [
        (b"(define \xff", 1, 9, "is not UTF-8: byte 0xff"),
        (b"(define\r\n  (dom\xe4in", 2, 7, "is not UTF-8: byte 0xe4"),
        (b"\x7fELF\x00\x01", 1, 1, "is not a text file"),
        (DOMAIN.encode("utf-16"), 1, 1, "is UTF-16, not UTF-8"),
        (b"(define \x1b[31m", 1, 9, "control character 0x1b"),
        (b"", 1, 1, "there is no domain here"),
        (b"; only a comment\n", 1, 1, "there is no domain here"),
        (b"hello", 1, 1, "this is prose, not PDDL"),
        (b"hello ()", 1, 1, "stands outside all parentheses"),
        (b"(define)", 1, 1, "expected (define (domain name) ...)"),
        (b"()", 1, 1, "expected (define (domain name) ...)"),
    ],
)
def test_files_that_are_no_domain(tmp_path: Path, data: bytes, line: int, column: int, message: str) -> None:
    file = tmp_path / "d.pddl"
    file.write_bytes(data)
    with pytest.raises(TmdError) as caught:
        read_domain(file)
    assert message in caught.value.message
    assert caught.value.location is not None
    assert (caught.value.location.file, caught.value.location.line, caught.value.location.column) == (
        str(file),
        line,
        column,
    )


def test_files_that_are_not_there(tmp_path: Path) -> None:
    for path in (tmp_path / "none.pddl", tmp_path):
        with pytest.raises(TmdError, match="cannot be read"):
            read_domain(path)
        with pytest.raises(TmdError, match="cannot be read"):
            read_problem(path, parse_domain(DOMAIN))


def test_byte_order_mark_and_line_ends(tmp_path: Path) -> None:
    file = tmp_path / "d.pddl"
    for text in (DOMAIN.replace("\n", "\r\n"), DOMAIN.replace("\n", "\r"), DOMAIN.upper()):
        file.write_bytes(b"\xef\xbb\xbf" + text.encode())
        assert read_domain(file) == parse_domain(DOMAIN)


def test_deep_nesting_is_refused_not_a_crash() -> None:
    deep = "(and " * 10_000 + "(held ?m)" + ")" * 10_000
    with pytest.raises(TmdError, match="levels deep"):
        parse_domain(DOMAIN.replace("(held ?m)", deep, 1))
    with pytest.raises(TmdError, match="never closed"):
        parse_domain("(" * 100_000)


def test_ninety_levels_are_fine() -> None:
    deep = "(and " * 90 + "(held ?m)" + ")" * 90
    assert parse_domain(DOMAIN.replace("(held ?m)", deep, 1)).actions


TOKENS = [
    "(",
    ")",
    ":action",
    ":effect",
    "define",
    "domain",
    "(and",
    "when",
    "forall",
    "?x",
    "-",
    "mug",
    "either",
    "; c\n",
]


@settings(max_examples=300, deadline=None)
@given(st.data())
def test_damaged_domains_give_clear_errors(data: st.DataObject) -> None:
    """Cut, doubled or mixed-up text is either read or refused with a place; never a traceback."""
    start = data.draw(st.integers(0, len(DOMAIN)))
    end = data.draw(st.integers(start, min(len(DOMAIN), start + 30)))
    middle = " ".join(data.draw(st.lists(st.sampled_from(TOKENS), max_size=4)))
    try:
        parse_domain(DOMAIN[:start] + middle + DOMAIN[end:])
    except TmdError as error:
        assert error.location is not None
        assert error.source is not None


@settings(max_examples=300, deadline=None)
@given(st.data())
def test_damaged_problems_give_clear_errors(data: st.DataObject) -> None:
    start = data.draw(st.integers(0, len(PROBLEM)))
    end = data.draw(st.integers(start, min(len(PROBLEM), start + 30)))
    middle = " ".join(data.draw(st.lists(st.sampled_from(TOKENS), max_size=4)))
    try:
        parse_problem(PROBLEM[:start] + middle + PROBLEM[end:], parse_domain(DOMAIN))
    except TmdError as error:
        assert error.location is not None
        assert error.source is not None
