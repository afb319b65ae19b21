"""Small things about the page's inputs."""

from __future__ import annotations

_VALUE = "value"
"""Set by its name: the inputs' own types say that a program cannot set it."""


def put(handle: object, value: object) -> None:
    """Let an input have a value. Its callbacks are called as if the visitor had changed it, unless it has it."""
    if getattr(handle, _VALUE) != value:
        setattr(handle, _VALUE, value)
