"""Faults act on the simulation; the monitor sees each, and nothing that failed is claimed. Runs can be repeated."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("pybullet", reason="needs the extra robot")

from experiments.execution.__main__ import CLOSING, OPENING, main
from experiments.execution.faults import InjectedFault, opportunities
from experiments.execution.judge import Judge
from experiments.execution.record import FAILED, Case, FaultRecord, Record, append, read
from experiments.execution.recorder import Frame, Recorder
from experiments.execution.report import claimed_falsely, masked, report, seen
from experiments.execution.run import corpus, holds, run, skills_of
from tmd.diagnostics import ExitCode, TmdError
from tmd.pddl.model import GroundAtom, Instruction
from tmd.robot.monitor.listeners import Title
from tmd.robot.session import SimulationSession
from tmd.robot.sim.pose import Pose
from tmd.robot.skills.results import Basis, ExecutedStep, Execution, KnownEffect, SkillStatus
from tmd.world.roots import Roots

NOOK, DEN = (str(Path(__file__).parent / f"{name}.yaml") for name in ("nook", "den"))
TAKE = ("find(ramen1)", "moveto(ramen1)", "grasp(ramen1)")


def case(*plan: str, environment: str = NOOK, fault: str = "", repairs: int = 2, **more: bool | int) -> Case:
    chosen = {"physics": False, "seed": 0, "twice": False} | more
    return Case("a plan", "kitchen", "plan", environment, plan, (), fault=fault, repairs=repairs, **chosen)


def told(record: Record) -> list[str]:
    return [fault.what for fault in record.faults]


def test_what_slips_is_seen_and_taken_again() -> None:
    record = run(case(*TAKE, fault="slip"))
    assert told(record) == ["ramen1 slipped out of the right hand"] or told(record) == [
        "ramen1 slipped out of the left hand"
    ]
    first = next(line for line in record.steps if str(line.instruction) == "grasp(ramen1)")
    assert first.failure and "slipped out" in first.failure
    assert seen(record) and not claimed_falsely(record)
    assert record.status == "recovered" or "ramen1" in record.reason
    assert record.judged > 3 and record.false == ()


def test_the_judge_tells_what_is_not_so() -> None:
    """It looks at the simulation itself, whatever the monitor says."""
    _, world = Roots().world(NOOK)
    problem = world.task.problem
    environment, folder = Roots().room(NOOK)
    instruction = Instruction("keep", ("mug1", "table1", "on"))
    claims = [GroundAtom("at", instruction.args), GroundAtom("contains", ("mug1", "water"))]
    effects = tuple(KnownEffect(claim, True, Basis.MEASURED, "") for claim in claims)
    step = ExecutedStep(instruction, False, "", "", effects, (), 0, 1, frozenset({*problem.init, *claims}))
    execution = Execution(SkillStatus.DONE, "", (step,), 0, step.state)
    with SimulationSession(environment, folder, problem, kinematic=True) as session:
        recorder, cell = Recorder(session), session.cell
        recorder.end(Title(instruction, 1, 1, False, None), step)
        upright = Judge(recorder).judge(execution)
        assert all("nothing was tipped over it" in claim for claim in upright.false) and upright.true >= 1
        body = cell.scene.bodies["mug1"]
        x, y, z = cell.sim.pose(body).position
        cell.sim.set_pose(body, Pose((x, y, z + 0.05)) * Pose.about((0.0, 1.0, 0.0), 1.5))
        cell.settle()
        recorder.end(Title(instruction, 1, 1, False, None), step)
        lying = Judge(recorder).judge(execution)
    assert any("(at mug1 table1 on)" in claim and "leans by" in claim for claim in lying.false)


def test_a_pour_counts_from_the_tilt_at_which_the_thing_spills() -> None:
    """Carried over the cup it is no pour, and what leaves beside the cup at any tilt does not come in."""
    _, world = Roots().world(NOOK)
    environment, folder = Roots().room(NOOK)
    problem, instruction = world.task.problem, Instruction("pour", ("mug1", "cup1"))
    effects = (KnownEffect(GroundAtom("contains", ("cup1", "water")), True, Basis.INFERRED, ""),)
    told = ExecutedStep(instruction, False, "", "", effects, (), 0, 1, problem.init)
    execution = Execution(SkillStatus.STOPPED, "", (told,), 0, problem.init)
    with SimulationSession(environment, folder, problem, kinematic=True) as session:
        recorder = Recorder(session)
        step, middle = recorder.look(Title(instruction, 1, 1, False, None), told), recorder.models["cup1"].opening
        rim = recorder.models["mug1"].opening
        assert middle is not None and rim is not None
        over = recorder.start.point("cup1", middle.centre) + np.array((0.0, 0.0, 0.05))

        def frame(tilt: float, beside: float) -> Frame:
            """The mug is tipped about y, the lowest point of its rim so far beside the cup's middle."""
            pose = Pose.about((0.0, 1.0, 0.0), tilt)
            x, y, z = pose.apply((rim.centre[0] + rim.radius + 0.005, rim.centre[1], rim.centre[2]))
            turn = np.array(pose.homogeneous())[:3, :3]
            places = recorder.start.places | {"mug1": (over + np.array((beside - x, -y, -z)), turn)}
            return Frame(0, places, recorder.start.joints, ("mug1",))

        def false(*frames: Frame) -> bool:
            recorder.steps[:] = [replace(step, frames=frames)]
            return bool(Judge(recorder).judge(execution).false)

        begins = rim.spills_from + 0.05
        assert false(frame(0.0, 0.0), frame(0.3, 0.0)), "upright over the cup"
        assert not false(frame(0.0, 0.2), frame(begins, 0.0), frame(1.8, 0.0), frame(0.0, 0.2))
        assert false(frame(begins, middle.radius + 0.02), frame(1.8, 0.0)), "it began to run out beside the cup"
        assert false(frame(begins, 0.0), frame(1.8, middle.radius + 0.02))


def test_what_is_stuck_is_seen_and_tried_again() -> None:
    record = run(case("find(microwave1)", "moveto(microwave1)", "open(microwave1_door)", fault="stuck"))
    assert told(record) == ["a joint is stuck: microwave1_door is 0 % open"]
    first, *others = [line for line in record.steps if str(line.instruction) == "open(microwave1_door)"]
    assert first.failure
    assert record.status == "recovered" and not any(line.failure for line in others[-1:])


def test_a_button_that_shifts_is_missed_and_pressed_again() -> None:
    record = run(case("find(fridge1)", "moveto(fridge1)", "press(fridge1_button)", fault="missed"))
    assert len(record.faults) == 1 and told(record)[0].startswith("fridge1 was shifted by ")
    first = next(line for line in record.steps if str(line.instruction) == "press(fridge1_button)")
    assert first.failure
    assert str(record.steps[-1].instruction) == "press(fridge1_button)" and "went down" in record.steps[-1].evidence
    assert record.status == "recovered", record.reason


def test_what_is_moved_is_seen_and_fetched_from_there() -> None:
    record = run(case("find(mug1)", *TAKE, fault="moved"))
    assert len(record.faults) == 1 and told(record)[0].startswith("ramen1 was moved from ")
    there = told(record)[0].split()[-1]
    assert any(f"not (at ramen1 {there} on) was expected" in str(m) for line in record.steps for m in line.mismatches)
    assert seen(record) and not claimed_falsely(record)
    assert record.status == "recovered", record.reason


def test_a_button_of_what_is_in_the_other_hand_goes_down_under_physics() -> None:
    plan = [f"{name}(remote1)" for name in ("find", "moveto", "grasp")]
    blank = case(*plan, "press(remote1_power_button)", environment=DEN, physics=True, twice=True)
    record = run(replace(blank, domain="living_room"))
    assert record.status == "done", record.reason
    assert "went down" in record.steps[-1].evidence and record.false == ()
    assert record.repeated is True, "the same seed gives the same trajectory to the byte"


def test_another_seed_gives_another_trajectory() -> None:
    """So the digest is one of what moved."""
    one, other = (run(case("find(ramen1)", twice=True, seed=seed)) for seed in (1, 2))
    assert one.repeated is True and other.repeated is True
    assert one.trajectory != other.trajectory


@pytest.mark.parametrize("kind", list(InjectedFault))
def test_where_a_fault_can_come_about(kind: InjectedFault) -> None:
    skills = skills_of("kitchen")
    wanted = {InjectedFault.SLIP: {"grasp"}, InjectedFault.STUCK: {"open", "close"}, InjectedFault.MISSED: {"press"}}
    found = 0
    for demonstration in corpus("kitchen").demonstrations():
        plan = demonstration.instructions
        for index in opportunities(kind, plan, skills):
            found += 1
            if kind is InjectedFault.MOVED:
                assert any(i.name == "grasp" and i.args[0] not in plan[index].args for i in plan[index + 1 :])
            else:
                assert plan[index].name in wanted[kind]
    assert found > 100


def test_a_run_that_breaks_is_a_record_and_what_was_cut_off_is_not(tmp_path: Path) -> None:
    broken = run(case("find(ramen1)", environment="kitchen9"))
    assert broken.status == FAILED and "kitchen9" in broken.reason
    append(tmp_path, broken)
    with (tmp_path / "runs.jsonl").open("a") as file:
        file.write('{"name": "cut o')
    assert read(tmp_path) == [broken]
    append(tmp_path, broken)
    assert read(tmp_path) == [broken], "a run that was done again counts once"
    assert "kitchen#" in report([broken], markdown=True)
    with (tmp_path / "runs.jsonl").open("a") as file:
        file.write('{"name": "of another version"}\n')
    with pytest.raises(TmdError, match=r"runs\.jsonl:4:1.* not a run of this version: task: the key is missing"):
        read(tmp_path)


def test_tables_are_put_into_a_page(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    page = tmp_path / "page.md"
    page.write_text(f"before\n{OPENING}\nold\n{CLOSING}\nafter\n")
    where = ["--out", str(tmp_path), "--page", str(page)]
    assert main(where) == ExitCode.BAD_INPUT and "there are no runs" in capsys.readouterr().err
    append(tmp_path, run(case("find(ramen1)", environment="kitchen9")))
    for _ in range(2):
        assert main(where) == ExitCode.OK
        text = page.read_text()
        assert text.startswith(f"before\n{OPENING}\n\n### ") and text.endswith(f"|\n\n{CLOSING}\nafter\n")
        assert "old" not in text and text.count("| plan | 1 | 0 (0%) |") == 1
    page.write_text("no place")
    assert main(where) == ExitCode.BAD_INPUT and "no place for tables" in capsys.readouterr().err


def test_conditions_and_masks() -> None:
    problem = Roots().world("kitchen1")[1].task.problem
    state = frozenset({GroundAtom("at", ("mug1", "sink1", "in"))})
    assert holds("(at mug1 sink1 in)", state, problem) and not holds("(not (at mug1 sink1 in))", state, problem)
    assert holds("(exists (?m - mug) (at ?m sink1 in))", state, problem) and not holds("(hot mug1)", state, problem)
    assert masked("no way to -0.40 1.25: 3 ways") == "no way to #: # ways"


def test_a_claim_is_false_when_the_end_is_not_there_or_nothing_was_noticed() -> None:
    record = run(case("find(ramen1)", fault="slip"))
    assert record.faults == () and record.status == "done", "nothing is taken, so nothing can slip"
    assert record.fault_missing == "'slip' cannot come about in this plan: nothing is taken"
    assert not claimed_falsely(record)
    assert claimed_falsely(record.model_copy(update={"goal": ("(hot mug1)",)}))
    assert claimed_falsely(record.model_copy(update={"faults": (FaultRecord(what="the mug is gone", tick=1),)}))
    assert not claimed_falsely(record.model_copy(update={"status": "stopped", "goal": ("(hot mug1)",)}))
