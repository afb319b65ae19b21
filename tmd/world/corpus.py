"""The bundled problems of a domain: environments by name, and the demonstrations of its tasks."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from pathlib import Path

from tmd.diagnostics import TmdError
from tmd.language.lexicon.lexicon import Lexicon
from tmd.pddl.model import Instruction, Problem, State
from tmd.pddl.reading.formulas import read_only_condition
from tmd.pddl.reading.reader import read_problem
from tmd.pddl.reading.syntax import nearest, parse
from tmd.pddl.semantics import apply, first_broken, holds
from tmd.world.compile import compile_problem
from tmd.world.demonstration import Demonstration, check_goal, not_executable, read_demonstrations, step_fault
from tmd.world.environment import load_environment
from tmd.world.folder import DomainFolder
from tmd.world.world import World, make_world, run


class Corpus:
    """The content of ``<problems>/<domain>/``: ``environments/`` and ``<task>/demonstrations.jsonl``.

    An environment is a YAML file, or, in a domain without object graphs, a PDDL problem whose goal is not looked at.
    """

    def __init__(self, folder: DomainFolder, directory: Path) -> None:
        self.folder = folder
        self.directory = directory
        self._worlds: dict[str, World] = {}
        self._demonstrations: dict[str, list[Demonstration]] = {}

    @property
    def lexicon(self) -> Lexicon:
        """The built-in words with those of the domain."""
        return self.folder.lexicon

    def environments(self) -> list[str]:
        """Return the names of the environments, sorted."""
        return sorted(self._files)

    def world(self, environment: str | Path) -> World:
        """Return an environment, ground.

        ``environment`` is its name or its file; those with a name are made once.

        Raises:
            TmdError: There is none, or it is wrong.
        """
        if is_environment_file(environment):
            problem = self.read(Path(environment))
            return make_world(problem.name, problem, self.lexicon, costs=self.folder.costs)
        name = str(environment)
        if name not in self._worlds:
            self._worlds[name] = make_world(name, self.read(self.file(name)), self.lexicon, costs=self.folder.costs)
        return self._worlds[name]

    def file(self, environment: str | Path) -> Path:
        """Return the file of an environment that is given by its name or file.

        Raises:
            TmdError: There is none of that name.
        """
        if is_environment_file(environment):
            return Path(environment)
        name = str(environment)
        if name not in self._files:
            raise TmdError(
                f"there is no environment '{name}' in {self.directory / 'environments'}",
                hint=nearest(name, self.environments()),
            )
        return self._files[name]

    @cached_property
    def _files(self) -> dict[str, Path]:
        """The file of each environment; the YAML where there are both."""
        directory = self.directory / "environments"
        return {path.stem: path for suffix in ("pddl", "yaml") for path in sorted(directory.glob(f"*.{suffix}"))}

    def read(self, path: Path) -> Problem:
        """Return the environment in a file, which need not be one of the bundled ones.

        Raises:
            TmdError: It is missing or wrong.
        """
        if path.suffix == ".pddl":
            return read_problem(path, self.folder.domain)
        return compile_problem(load_environment(path), self.folder)

    def tasks(self) -> list[str]:
        """Return the tasks there are demonstrations of, sorted."""
        return sorted(path.parent.name for path in self.directory.glob("*/demonstrations.jsonl"))

    def demonstrations(self, task: str | None = None) -> list[Demonstration]:
        """Return the demonstrations of one task, or of all, in the order of the files.

        Raises:
            TmdError: There is no such task, a file is wrong, or a demonstration cannot be executed.
        """
        if task is not None and task not in self.tasks():
            raise TmdError(
                f"there are no demonstrations of '{task}' in {self.directory}",
                hint=nearest(task, self.tasks()),
            )
        tasks = self.tasks() if task is None else [task]
        return [demonstration for name in tasks for demonstration in self._of_task(name)]

    def reread(self) -> None:
        """Forget which demonstrations were read: their files may have grown. Environments are kept."""
        self._demonstrations = {}

    def _of_task(self, task: str) -> list[Demonstration]:
        """Return the demonstrations of one task, read and checked once."""
        if task not in self._demonstrations:
            found = read_demonstrations(self.directory / task / "demonstrations.jsonl")
            for demonstration in found:
                check_executable(demonstration, self.world(demonstration.environment))
            self._demonstrations[task] = found
        return self._demonstrations[task]


def is_environment_file(environment: str | Path) -> bool:
    """Return whether an environment is given by its file, not by its name."""
    return Path(environment).suffix in (".yaml", ".yml", ".pddl")


def replay(demonstration: Demonstration, problem: Problem) -> list[State]:
    """Return the states before the first and after each instruction.

    Raises:
        TmdError: An instruction is not executable (with its place and the first broken precondition), or a
            literal of the stated end state or the goal does not hold.
    """
    states = [problem.init]
    for number, instruction in enumerate(demonstration.instructions, start=1):
        wrong = _wrong(instruction, states[-1], problem)
        if wrong is not None:
            raise step_fault(demonstration, number, wrong)
        states.append(apply(instruction, states[-1], problem))
    for literal in demonstration.end_state:
        if not holds(read_only_condition(parse(literal, "end_state")), states[-1], problem):
            raise not_executable(demonstration, f"the stated end {literal} is not reached")
    check_goal(demonstration, problem, states[-1])
    return states


def final_state(demonstration: Demonstration, world: World) -> State:
    """Return the state after all instructions of a demonstration that can be executed."""
    return world.task.decode(run(world, world.task.init, demonstration.instructions))


def check_executable(demonstration: Demonstration, world: World) -> None:
    """Make sure that a demonstration can be executed in its environment.

    Raises:
        TmdError: An instruction is not executable; with its place, and the first broken precondition.
    """
    state = world.task.init
    for instruction in demonstration.instructions:
        operator = world.task.by_instruction.get(instruction)
        if operator is None or not operator.applicable(state):
            break
        state = operator.apply(state)
    else:
        return
    replay(replace(demonstration, end_state=(), goal=None), world.task.problem)


def _wrong(instruction: Instruction, state: State, problem: Problem) -> TmdError | None:
    """Return why an instruction cannot be done in ``state``; ``None`` where it can."""
    try:
        broken = first_broken(instruction, state, problem)
    except TmdError as error:
        return error
    return None if broken is None else TmdError(f"{broken.text} does not hold")
