"""Small things about the page's inputs."""

from __future__ import annotations

from typing import Any


def put(handle: Any, value: object) -> None:
    """Let an input have a value. Its callbacks are called as if the visitor had changed it, unless it has it already.

    The inputs' own types say that this cannot be done.
    """
    if handle.value != value:
        handle.value = value
