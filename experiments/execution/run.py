"""One run: a plan is executed in a new simulation, and what came of it is written down."""

from __future__ import annotations

import re
import time
import traceback
from collections.abc import Sequence
from functools import cache

from experiments.execution.record import FAILED, Case, Record, TimedStep
from experiments.execution.trace import Trace
from tmd.pddl.model import GroundAtom, State
from tmd.pddl.plan_file import parse_instruction
from tmd.records.run import FaultRecord, RanStep
from tmd.robot.monitor.faults import InjectedFault
from tmd.robot.monitor.listeners import Order, Title
from tmd.robot.run_plan import run_plan
from tmd.robot.session import SimulationSession
from tmd.robot.sim.simulator import STEPS_PER_SECOND
from tmd.robot.skills.results import ExecutedStep
from tmd.robot.skills.skill_file import Skills, load_skills
from tmd.veil.corpus import Corpus
from tmd.world.environment import load_environment
from tmd.world.folder import find_domain, find_root


def run(case: Case) -> Record:
    """Do what ``case`` asks for; a fault of the program becomes a record with the status ``error``."""
    first = _guarded(case)
    if not case.twice or first.status == FAILED:
        return first
    return first.model_copy(update={"repeated": _guarded(case).trajectory == first.trajectory})


@cache
def corpus(domain: str) -> Corpus:
    """The domain's problems; read once in a process."""
    return Corpus(find_domain(domain), find_root("problems") / domain)


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
    found = corpus(case.domain)
    problem = found.world(case.environment).task.problem
    environment = load_environment(found.directory / "environments" / f"{case.environment}.yaml")
    orders = [Order(parse_instruction(text)) for text in case.plan]
    fault = InjectedFault(case.fault) if case.fault else None
    trace = Trace()
    notes = _Notes(skills_of(case.domain))
    started = (begin, 0)

    def prepare(session: SimulationSession) -> tuple[_Notes]:
        nonlocal started
        if case.twice:
            session.sim.add_watcher(trace)
        started = (time.perf_counter(), session.sim.steps)
        notes.restart()
        return (notes,)

    run = run_plan(
        environment, found.folder, problem, orders, prepare=prepare, repairs=case.repairs, fault=fault,
        kinematic=not case.physics, seed=case.seed,
    )  # fmt: skip
    ready, steps = started
    return _record(
        case,
        status=run.execution.status.value,
        reason=run.execution.reason,
        repairs=run.execution.repairs,
        steps=tuple(notes.steps),
        faults=tuple(FaultRecord(what=fault.text, tick=fault.tick) for fault in run.faults),
        goal=tuple(literal for literal in case.end_state if not holds(literal, run.execution.state)),
        setup=round(ready - begin, 3),
        seconds=round(time.perf_counter() - ready, 3),
        simulated=round((run.sim_steps - steps) / STEPS_PER_SECOND, 3),
        trajectory=trace.digest() if case.twice else "",
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
    nothing = {"repairs": 0, "steps": (), "faults": (), "goal": (), "setup": 0.0, "simulated": 0.0}
    asked = {"name": name, "task": case.task, "environment": case.environment, "mode": mode, "fault": fault}
    return Record.model_validate({**asked, "seed": seed, **nothing, "trajectory": "", "repeated": None, **told})


def holds(literal: str, state: State) -> bool:
    """Whether ``(at mug1 table1 on)`` or ``(not (hot mug1))`` holds."""
    words = re.findall(r"[^\s()]+", literal)
    denied = words[0] == "not"
    atom = GroundAtom(words[denied], tuple(words[denied + 1 :]))
    return (atom in state) is not denied
