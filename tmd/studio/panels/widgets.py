"""Helpers for the page's inputs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tmd.diagnostics import TmdError

if TYPE_CHECKING:
    from viser import GuiButtonGroupHandle, GuiDropdownHandle

# Set by its name: the inputs' own types say that a program cannot set it.
_VALUE = "value"


def put(handle: object, value: object) -> None:
    """Let an input have a value. Its callbacks are called as if the visitor had changed it, unless it has it."""
    if getattr(handle, _VALUE) != value:
        setattr(handle, _VALUE, value)


def chosen(handle: GuiDropdownHandle[str] | GuiButtonGroupHandle) -> str:
    """Return the chosen option of an input.

    Raises:
        TmdError: The page is out of date, or did not send the value.
    """
    value = handle.value
    if value not in handle.options:
        raise TmdError("that cannot be chosen any more", hint="choose again")
    return str(value)
