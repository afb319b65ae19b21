"""The targets that the README names: listed, with their options, and clear about an interpreter that is too old."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.cli.conftest import ROOT

pytestmark = pytest.mark.skipif(shutil.which("make") is None, reason="there is no make here")
MAKEFILE = ROOT / "Makefile"


def make(directory: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run make on a copy of the Makefile, where there is no .venv/."""
    for name in ("Makefile", "pyproject.toml"):
        shutil.copy(ROOT / name, directory)
    # neither what the calling make passes on nor its variables, such as ARGS
    kept = {name: os.environ[name] for name in ("PATH", "HOME", "LANG", "TMPDIR") if name in os.environ}
    return subprocess.run(
        ["make", *arguments], cwd=directory, env=kept, capture_output=True, text=True, timeout=60, check=False
    )


def test_make_alone_lists_every_target(tmp_path: Path) -> None:
    listed = re.findall(r"^  make ([\w-]+) +\w", make(tmp_path).stdout, re.MULTILINE)
    phony = re.search(r"^\.PHONY: (help .*)$", MAKEFILE.read_text(), re.MULTILINE)
    assert phony
    assert set(phony[1].split()) <= set(listed)


def test_options_are_passed_on(tmp_path: Path) -> None:
    """``-n`` prints the commands; the set-up it prints first is that of an empty directory."""
    options = ["TASK=all", "DATA=veil500", "VEIL500=/a b", "MODELS=empty,nearest", "JOBS=3", "SEED=7", "OUT=o"]
    options.append("ROBOT=off")
    shown = " ".join(make(tmp_path, "-n", "experiment", *options).stdout.replace("\\\n", " ").split())
    assert shown.endswith(
        "tmd experiment --task 'all' --data 'veil500' --out 'o' --veil500 '/a b' --models 'empty,nearest'"
        " --jobs '3' --seed '7' --robot 'off'"
    )


def test_options_that_are_not_given_are_not_passed_on(tmp_path: Path) -> None:
    shown = " ".join(make(tmp_path, "-n", "experiment", "TASK=ramen").stdout.replace("\\\n", " ").split())
    assert shown.endswith(
        "tmd experiment --task 'ramen' --data 'bundled' --out 'runs/ramen-bundled' --robot 'kinematic'"
    )


def test_an_old_interpreter_is_refused_in_one_line(tmp_path: Path) -> None:
    old = tmp_path / "python2"
    old.write_text("#!/bin/sh\nexit 1\n")
    old.chmod(0o755)
    ended = make(tmp_path, "setup", f"PYTHON={old}")
    assert ended.returncode != 0
    assert f"error: tmd needs Python 3.11 or newer, and {old} is older; name another" in ended.stderr
    assert not (tmp_path / ".venv").exists()


def test_a_missing_interpreter_is_refused_in_one_line(tmp_path: Path) -> None:
    ended = make(tmp_path, "setup", "PYTHON=python-nowhere")
    assert "error: there is no python-nowhere; name an interpreter" in ended.stderr


def test_a_complete_venv_is_left_alone(tmp_path: Path) -> None:
    """No network is needed where .venv/ was made from the same pyproject.toml, whatever the dates say."""
    interpreter = tmp_path / ".venv" / "bin" / "python"
    interpreter.parent.mkdir(parents=True)
    interpreter.write_text('#!/bin/sh\n[ "$1" = -c ]\n')
    interpreter.chmod(0o755)
    shutil.copy(ROOT / "pyproject.toml", tmp_path / ".venv" / ".made-from-pyproject.toml")
    os.utime(tmp_path / ".venv" / ".made-from-pyproject.toml", (0, 0))
    assert make(tmp_path, "setup", "PYTHON=python-nowhere").returncode == 0


def test_real_data_want_a_directory(tmp_path: Path) -> None:
    shown = make(tmp_path, "-n", "test-data", "VEIL500=/a b").stdout
    assert "VEIL500_DIR='/a b'" in shown and "tests/datasets" in shown
