"""Import of pybullet without its output, and detection of renderers."""

from __future__ import annotations

import ctypes
import importlib
import importlib.util
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

from tmd.diagnostics import MissingToolError, install_extra

_EGL = """
import importlib.util, pybullet as p
p.connect(p.DIRECT)
plugin = p.loadPlugin(importlib.util.find_spec("eglRenderer").origin, "_eglRendererPlugin")
assert plugin >= 0
p.getCameraImage(16, 16, renderer=p.ER_BULLET_HARDWARE_OPENGL)
"""
_WINDOW = "import pybullet as p; assert p.connect(p.GUI) >= 0"
_PATIENCE = 60.0


@cache
def pybullet() -> Any:  # noqa: ANN401 - it has no types
    """Import the module ``pybullet``.

    Raises:
        MissingToolError: It is not installed.
    """
    try:
        with quiet():
            return importlib.import_module("pybullet")
    except ImportError as error:
        raise MissingToolError("the simulator pybullet is not installed", hint=install_extra("robot")) from error


def bullet_client(mode: int) -> Any:  # noqa: ANN401 - it has no types
    """Connect to a new world. The client makes each of pybullet's functions its own once, not at every call."""
    base: Any = importlib.import_module("pybullet_utils.bullet_client").BulletClient

    def bound(self: Any, name: str) -> Any:  # noqa: ANN401 - it has no types
        return self.__dict__.setdefault(name, base.__getattr__(self, name))

    return type("Client", (base,), {"__getattr__": bound})(mode)


@contextmanager
def quiet() -> Iterator[None]:
    """Discard the output of C code: standard output is for results, standard error for the program's messages."""
    sys.stdout.flush()
    sys.stderr.flush()
    library = ctypes.CDLL(None)
    library.fflush(None)
    kept = [os.dup(stream) for stream in (1, 2)]
    sink = os.open(os.devnull, os.O_WRONLY)
    try:
        for stream in (1, 2):
            os.dup2(sink, stream)
        yield
    finally:
        library.fflush(None)  # what C still buffers would come out later
        for stream, copy in zip((1, 2), kept, strict=True):
            os.dup2(copy, stream)
            os.close(copy)
        os.close(sink)


@cache
def egl_starts() -> bool:
    """Return whether EGL can draw; tried in another process, which the plugin ends if it cannot start."""
    return importlib.util.find_spec("eglRenderer") is not None and _succeeds(_EGL)


@cache
def window_opens() -> bool:
    """Return whether pybullet can open its window; tried in another process, which may end without a display."""
    return _succeeds(_WINDOW)


def _succeeds(code: str) -> bool:
    try:
        run = subprocess.run([sys.executable, "-c", code], capture_output=True, timeout=_PATIENCE, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return run.returncode == 0
