"""Files are written whole or not at all."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from tmd.diagnostics import OutputError
from tmd.files import draft_of, make_directory, write_bytes, write_text


def names(directory: Path) -> list[str]:
    return sorted(path.name for path in directory.iterdir())


def test_new_file_and_again(tmp_path: Path) -> None:
    path = tmp_path / "out.txt"
    write_text(path, "één\n")
    write_text(path, "two\n")
    assert path.read_bytes() == b"two\n"
    assert names(tmp_path) == ["out.txt"]


def test_new_file_has_the_usual_mode(tmp_path: Path) -> None:
    usual = tmp_path / "usual"
    usual.touch()
    write_text(tmp_path / "ours", "x")
    assert (tmp_path / "ours").stat().st_mode == usual.stat().st_mode


def test_mode_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "script"
    path.write_text("a")
    path.chmod(0o750)
    write_text(path, "b")
    assert stat.S_IMODE(path.stat().st_mode) == 0o750


def test_a_link_stays_a_link(tmp_path: Path) -> None:
    target, link = tmp_path / "target", tmp_path / "link"
    target.write_text("a")
    link.symlink_to(target)
    write_text(link, "b")
    assert link.is_symlink()
    assert target.read_text() == "b"


def test_a_device_stays_a_device() -> None:
    write_text("/dev/null", "x")
    assert stat.S_ISCHR(Path("/dev/null").stat().st_mode)


@pytest.mark.parametrize("place", ["missing/out.txt", ".", "file/out.txt"])
def test_impossible_places_are_refused_in_one_line(tmp_path: Path, place: str) -> None:
    (tmp_path / "file").write_text("kept")
    with pytest.raises(OutputError) as caught:
        write_text(tmp_path / place, "x")
    assert "cannot be written" in caught.value.message
    assert names(tmp_path) == ["file"]
    assert (tmp_path / "file").read_text() == "kept"


@pytest.mark.parametrize("call", ["write", "fsync", "replace"])
def test_what_stood_there_survives_a_failure(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, call: str) -> None:
    path = tmp_path / "out.txt"
    path.write_text("before")

    def fail(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    if call == "write":
        monkeypatch.setattr(os, "fdopen", fail)
    else:
        monkeypatch.setattr(os if call == "fsync" else Path, call, fail)
    with pytest.raises(OutputError):
        write_bytes(path, b"after")
    monkeypatch.undo()
    assert path.read_text() == "before"
    assert names(tmp_path) == ["out.txt"]


def test_an_interrupt_leaves_no_draft(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(_: int) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(os, "fsync", interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_text(tmp_path / "out.txt", "x")
    assert names(tmp_path) == []


@pytest.mark.parametrize("other", ["host", "process"])
def test_two_writers_never_share_a_draft(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, other: str) -> None:
    """Machines that share a directory may give two writers the same process id."""
    drafts: list[str] = []

    def note(_: int) -> None:
        (draft,) = names(tmp_path)
        drafts.append(draft)

    monkeypatch.setattr(os, "fsync", note)
    for number in (1, 2):
        name = f"{'n' * 64}{number}" if other == "host" else "same"
        monkeypatch.setattr(os, "uname", lambda n=name: os.uname_result(("Linux", n, "6", "1", "x86_64")))
        monkeypatch.setattr(os, "getpid", lambda n=number: 4_194_303 if other == "host" else n)
        write_text(tmp_path / "out.txt", "x")
        (tmp_path / "out.txt").unlink()
    assert drafts[0] != drafts[1]
    assert all(draft.startswith(".out.txt.") and len(draft) < 64 for draft in drafts)


def test_directories(tmp_path: Path) -> None:
    assert make_directory(tmp_path / "a" / "b").is_dir()
    assert make_directory(tmp_path / "a" / "b").is_dir()
    (tmp_path / "file").touch()
    with pytest.raises(OutputError):
        make_directory(tmp_path / "file" / "b")


def test_what_killed_writers_left_is_removed_by_the_next(tmp_path: Path) -> None:
    target = tmp_path / "out.txt"
    dead = subprocess.Popen([sys.executable, "-c", ""])
    dead.wait()
    draft = draft_of(target)
    for process in (dead.pid, os.getppid()):
        draft.with_name(draft.name.replace(f".{os.getpid()}.", f".{process}.")).write_text("half")
    other_host = draft.with_name(f".out.txt.00000000.{dead.pid}.part")
    other_host.write_text("half")
    write_text(target, "whole")
    assert f".{dead.pid}." not in "".join(set(names(tmp_path)) - {other_host.name})
    assert len(names(tmp_path)) == 3  # what another machine, or a process that lives, writes is not ours to remove
