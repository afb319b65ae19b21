"""Files: JSON and its schema, SAS+, directories that are written whole or not at all."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.export.conftest import ROOT, planned_case
from tmd.diagnostics import OutputError, TmdError
from tmd.export import directory as directories
from tmd.export.directory import write_directory
from tmd.export.formats import FORMATS, chosen_files
from tmd.export.planned_problem import Planned, planned, with_outcome
from tmd.files import draft_of
from tmd.pddl.model import TRUE, Instruction
from tmd.pddl.plan_file import parse_plan
from tmd.pddl.reading.reader import parse_domain, parse_problem
from tmd.pddl.validator import validate


def test_adl_is_read_back(source: Planned) -> None:
    files = FORMATS["adl"](source)
    problem = parse_problem(files["problem.pddl"], parse_domain(files["domain.pddl"]))
    assert problem == source.portable
    assert parse_plan(files["plan.plan"]).instructions == source.plan
    assert f"; cost = {source.cost} " in files["plan.plan"]


def test_sas_is_what_fast_downward_searches(tmp_path: Path) -> None:
    pytest.importorskip("up_fast_downward")
    import subprocess

    from tmd.planning.fast_downward import binaries

    source = planned_case("kitchen")
    files = FORMATS["sas"](source)
    assert files["output.sas"].startswith("begin_version\n3\nend_version\n")
    (tmp_path / "output.sas").write_text(files["output.sas"])
    command = [binaries() / "downward", "--search", "lazy_greedy([ff()])", "--internal-plan-file", "sas_plan"]
    with (tmp_path / "output.sas").open() as sas:
        subprocess.run(command, stdin=sas, cwd=tmp_path, check=True, capture_output=True, timeout=60)
    assert validate(source.problem, parse_plan((tmp_path / "sas_plan").read_text()).instructions).valid


def test_a_plan_that_does_not_work_is_no_planned_problem() -> None:
    source = planned_case("blocks")
    with pytest.raises(TmdError, match="the plan does not work: step 1"):
        planned(source.problem, source.plan[1:])


def test_what_a_plan_changes_is_its_outcome() -> None:
    source = planned_case("blocks")
    aimed = with_outcome(source.problem, source.plan)
    assert validate(aimed, source.plan).valid
    assert not validate(aimed, source.plan[:-1]).valid
    assert with_outcome(source.problem, ()).goal == TRUE
    with pytest.raises(TmdError):
        with_outcome(source.problem, [Instruction("fly")])


def test_one_format_fills_the_directory_several_share_it() -> None:
    source = planned_case("blocks")
    assert list(chosen_files(source, ["ipc"]).files["ipc"]) == ["plan.plan"]
    several = chosen_files(source, ["ipc", "adl", "ipc"]).files
    assert [path for files in several.values() for path in files] == [
        "ipc/plan.plan",
        "adl/domain.pddl",
        "adl/problem.pddl",
        "adl/plan.plan",
    ]
    with pytest.raises(TmdError, match=r"there is no format 'adll' \(did you mean"):
        chosen_files(source, ["adll"])


def test_every_format_is_documented() -> None:
    page = (ROOT / "docs" / "export.md").read_text(encoding="utf-8")
    assert [name for name in FORMATS if f"| `{name}` |" not in page] == []


FILES = {"a.txt": b"a", "b/c.txt": b"c"}


def _found(directory: Path) -> dict[str, bytes]:
    return {p.relative_to(directory).as_posix(): p.read_bytes() for p in directory.rglob("*") if p.is_file()}


@pytest.mark.parametrize("place", ["new", "deep/er/new", "there"])
def test_a_directory_appears_with_everything_in_it(tmp_path: Path, place: str) -> None:
    (tmp_path / "there").mkdir()
    write_directory(tmp_path / place, FILES)
    assert _found(tmp_path / place) == FILES
    assert not list(tmp_path.rglob(".*"))


def test_a_directory_with_files_is_left_alone(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(OutputError, match="it is not empty"):
        write_directory(tmp_path, FILES)
    assert _found(tmp_path) == {"mine.txt": b"mine"}
    write_directory(tmp_path, FILES, overwrite=True)
    assert _found(tmp_path) == {"mine.txt": b"mine", **FILES}


def test_what_is_no_directory_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("mine")
    for place in (file, file / "below"):
        with pytest.raises(OutputError, match="not a directory"):
            write_directory(place, FILES)
    assert _found(tmp_path) == {"file": b"mine"}


def test_nothing_stays_of_what_could_not_be_finished(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(path: Path, data: bytes) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(directories, "write_bytes", full)
    with pytest.raises(OutputError, match="No space left"):
        write_directory(tmp_path / "deep" / "new", FILES)
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_directory_that_may_not_be_written_is_refused(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    with pytest.raises(OutputError, match="permission denied"):
        write_directory(tmp_path / "new", FILES)


def test_a_full_disk_names_the_directory_that_was_asked_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OutputError) as caught:
        write_directory(tmp_path / "out", {"a/domain.pddl": b"x"})
    told = f"{tmp_path / 'out' / 'a' / 'domain.pddl'} cannot be written: No space left on device"
    assert caught.value.message == told
    assert list(tmp_path.iterdir()) == []


def test_the_draft_of_a_killed_export_is_removed_by_the_next(tmp_path: Path) -> None:
    dead = subprocess.Popen([sys.executable, "-c", ""])
    dead.wait()
    draft = draft_of(tmp_path / "out")
    left = draft.with_name(draft.name.replace(f".{os.getpid()}.", f".{dead.pid}."))
    for folder in (left, draft):  # of another process, and of an earlier one with the number of this one
        folder.mkdir()
        (folder / "half").write_text("")
    write_directory(tmp_path / "out", {"domain.pddl": b"x"})
    assert [path.name for path in tmp_path.iterdir()] == ["out"]
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["domain.pddl"]
