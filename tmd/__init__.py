"""Turn requests in English into plans that PDDL proves right.

The main path is :func:`tmd.ground.ground`; the semantics of every instruction is PDDL (:mod:`tmd.pddl`).
For programs there is :mod:`tmd.api`, whose names are found here as well: ``tmd.load_domain("kitchen")``. They are
imported when they are first used, so ``import tmd`` costs nothing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tmd.api import *  # noqa: F403

__version__ = "0.1.0"


def __getattr__(name: str) -> Any:  # noqa: ANN401 - whatever stands in the module
    """A name of :mod:`tmd.api`, imported now."""
    from importlib import import_module

    api = import_module("tmd.api")
    if name == "__all__" or name in api.__all__:
        return getattr(api, name)
    # Python suggests the nearest name of the module
    raise AttributeError(f"module 'tmd' has no attribute '{name}'", name=name, obj=import_module("tmd"))


def __dir__() -> list[str]:
    """Return the public names, those imported on demand as well."""
    return sorted({*globals(), *__getattr__("__all__")})
