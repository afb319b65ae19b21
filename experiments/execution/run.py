"""One run: a plan is executed in a new simulation, and what came of it is written down."""

from __future__ import annotations

import time
import traceback
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from functools import cache

import numpy as np

from experiments.execution.faults import FaultyPerformer, InjectedFault
from experiments.execution.judge import Judge, summary
from experiments.execution.record import FAILED, Case, FaultRecord, Record, TimedStep
from experiments.execution.recorder import Recorder
from experiments.execution.trace import Trace
from tmd.diagnostics import TmdError
from tmd.pddl import semantics
from tmd.pddl.model import And, GroundAtom, Problem, State
from tmd.pddl.plan_file import parse_instruction
from tmd.pddl.reading.reader import with_goal
from tmd.pddl.writer import format_formula
from tmd.planning.backends import solve
from tmd.planning.result import Solved
from tmd.records.run import RanStep
from tmd.robot.monitor.listeners import Order, Title
from tmd.robot.session import SimulationSession
from tmd.robot.sim.simulator import STEPS_PER_SECOND
from tmd.robot.skills.performer import RobotPerformer
from tmd.robot.skills.results import ExecutedStep
from tmd.robot.skills.skill_file import Skills, load_skills
from tmd.world.corpus import Corpus
from tmd.world.folder import find_domain, find_roots
from tmd.world.roots import Roots


def run(case: Case) -> Record:
    """Do what ``case`` asks for; a fault of the program becomes a record with the status ``error``."""
    first = _guarded(case)
    if not case.twice or first.status == FAILED:
        return first
    return first.model_copy(update={"repeated": _guarded(case).trajectory == first.trajectory})


@cache
def corpus(domain: str) -> Corpus:
    """The domain's problems; read once in a process."""
    return Corpus(find_domain(domain), find_roots("problems")[0] / domain)


def planned(case: Case) -> Case:
    """The case with a plan for its goal, if it has one.

    Raises:
        TmdError: There is no such environment, or no plan.
    """
    if not case.goal:
        return case
    _, world = Roots().world(case.environment)
    problem = with_goal(world.task.problem, case.goal)
    answer = solve(problem, "in-process")
    if not isinstance(answer, Solved):
        raise TmdError(f"{case.name}: no plan for {case.goal}")
    literals = problem.goal.parts if isinstance(problem.goal, And) else (problem.goal,)
    return replace(case, plan=tuple(map(str, answer.plan)), end_state=tuple(map(format_formula, literals)))


@cache
def skills_of(domain: str) -> Skills:
    """The domain's ``skills.yaml``."""
    return load_skills(corpus(domain).folder)


def _guarded(case: Case) -> Record:
    begin = time.perf_counter()
    try:
        return _run(case)
    except Exception as error:  # one run that breaks must not end the others; the record says what broke
        place = traceback.extract_tb(error.__traceback__, limit=-1)[0]
        said = f"{type(error).__name__} in {place.filename.rpartition('/')[2]}:{place.lineno}: {error}"
        return _record(case, status=FAILED, reason=said, seconds=time.perf_counter() - begin)


def _run(case: Case) -> Record:
    begin = time.perf_counter()
    roots = Roots()
    _, world = roots.world(case.environment)
    environment, folder = roots.room(case.environment)
    problem = world.task.problem
    case = planned(case)
    orders = [Order(parse_instruction(text)) for text in case.plan]
    faulty: list[FaultyPerformer] = []

    def disturbed(robot: RobotPerformer) -> FaultyPerformer:
        plan = [order.instruction for order in orders]
        faulty.append(FaultyPerformer(robot, InjectedFault(case.fault), np.random.default_rng([case.seed, 1]), plan))
        return faulty[0]

    trace = Trace()
    notes = _Notes(load_skills(folder))
    with SimulationSession(environment, folder, problem, kinematic=not case.physics, seed=case.seed) as session:
        if case.twice:
            session.sim.add_watcher(trace)
        recorder = Recorder(session)
        ready, cpu, steps = time.perf_counter(), time.process_time(), session.sim.steps
        notes.restart()
        execution = session.execute(
            orders, (notes, recorder), repairs=case.repairs, wrap=disturbed if case.fault else None
        )
        seconds, used, after = time.perf_counter() - ready, time.process_time() - cpu, session.sim.steps
        digest = trace.digest() if case.twice else ""
        verdict = Judge(recorder).judge(execution)
    effects = Counter(effect.basis.value for step in execution.steps for effect in step.effects)
    return _record(
        case,
        status=execution.status.value,
        reason=execution.reason,
        repairs=execution.repairs,
        steps=tuple(notes.steps),
        faults=tuple(FaultRecord(what=fault.text, tick=fault.tick) for each in faulty for fault in each.log),
        fault_missing=faulty[0].missing() if faulty else "",
        lasting=tuple(map(str, execution.lasting)),
        goal=tuple(literal for literal in case.end_state if not holds(literal, execution.state, problem)),
        setup=round(ready - begin, 3),
        seconds=round(seconds, 3),
        cpu=round(used, 3),
        simulated=round((after - steps) / STEPS_PER_SECOND, 3),
        trajectory=digest,
        known=dict(sorted(effects.items())),
        judged=verdict.true,
        unjudged=verdict.unjudged,
        false=tuple(verdict.false),
        worst=summary(recorder),
    )


class _Notes:
    """Writes down each step, and how long it took."""

    def __init__(self, skills: Skills) -> None:
        self.skills = skills
        self.steps: list[TimedStep] = []
        self._last = time.perf_counter()

    def restart(self) -> None:
        """The first instruction begins now."""
        self._last = time.perf_counter()

    def begin(self, title: Title, expected: Sequence[GroundAtom]) -> None:
        """An instruction begins."""

    def end(self, title: Title, step: ExecutedStep) -> None:
        """It is over."""
        now = time.perf_counter()
        self.steps.append(
            TimedStep(
                **RanStep.of(title, step).given(),
                skill=self.skills.task(step.instruction).skill,
                took=round(now - self._last, 3),
            )
        )
        self._last = now


def _record(case: Case, **told: object) -> Record:
    """The record of a case; what is not told is as where nothing was done."""
    name, mode, fault, seed = case.key
    nothing = {
        "repairs": 0, "steps": (), "faults": (), "fault_missing": "", "lasting": (), "goal": (), "setup": 0.0,
        "cpu": 0.0, "simulated": 0.0, "known": {}, "judged": 0, "unjudged": 0, "false": (), "worst": (),
    }  # fmt: skip
    asked = {"name": name, "task": case.task, "environment": case.environment, "mode": mode, "fault": fault}
    return Record.model_validate({**asked, "seed": seed, **nothing, "trajectory": "", "repeated": None, **told})


def holds(condition: str, state: State, problem: Problem) -> bool:
    """Whether a PDDL condition, such as ``(not (hot mug1))``, holds."""
    return semantics.holds(with_goal(problem, condition).goal, state, problem)
