from __future__ import annotations

import socket
import sys

import pytest

pytest.importorskip("viser", reason="needs the extra studio")

from tmd.cli.program import run as main
from tmd.diagnostics import ExitCode


def test_a_port_in_use_is_told_before_anything_is_learned(capsys: pytest.CaptureFixture[str]) -> None:
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = taken.getsockname()[1]
        assert main(["studio", "--port", str(port)]) == ExitCode.BAD_INPUT
    said = capsys.readouterr().err
    assert f"port {port} is in use" in said and "--port" in said and "Looking" not in said


@pytest.mark.parametrize(
    ("words", "code", "message"),
    [
        (["--domain", "nosuch"], ExitCode.BAD_INPUT, "there is no domain 'nosuch'"),
        (["--environment", "nosuch"], ExitCode.BAD_INPUT, "there is no environment 'nosuch'"),
        (["--environment", "missing.yaml"], ExitCode.BAD_INPUT, "missing.yaml"),
        (["--host", "192.0.2.1"], ExitCode.BAD_INPUT, "cannot be listened at"),
        (["--host", "no such host"], ExitCode.BAD_INPUT, "cannot be listened at"),
        (["--port", "70000"], ExitCode.USAGE, "70000"),
        (["--learned"], ExitCode.USAGE, "--learned"),
    ],
)
def test_bad_input(words: list[str], code: ExitCode, message: str, capsys: pytest.CaptureFixture[str]) -> None:
    port = [] if "--port" in words else ["--port", "0"]
    assert main(["studio", *port, *words]) == code
    said = capsys.readouterr().err
    assert message in said and "Traceback" not in said


def test_without_viser(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setitem(sys.modules, "viser", None)
    assert main(["studio", "--port", "0"]) == ExitCode.MISSING_TOOL
    assert "pip install 'tell-me-dave[studio]'" in capsys.readouterr().err
