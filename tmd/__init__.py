"""What a person says, turned into plans that a robot may safely execute.

The main path is :func:`tmd.ground.ground`; the semantics of every instruction is PDDL (:mod:`tmd.pddl`).
For programs there is :mod:`tmd.api`, whose names are found here as well: ``tmd.load_domain("kitchen")``. They are
imported when they are first used, so ``import tmd`` costs nothing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tmd.api import DomainKit as DomainKit
    from tmd.api import Grounded as Grounded
    from tmd.api import Instruction as Instruction
    from tmd.api import NoPlanError as NoPlanError
    from tmd.api import Problem as Problem
    from tmd.api import TmdError as TmdError
    from tmd.api import Verdict as Verdict
    from tmd.api import export_plan as export_plan
    from tmd.api import find_plan as find_plan
    from tmd.api import from_unified_planning as from_unified_planning
    from tmd.api import load_domain as load_domain
    from tmd.api import load_problem as load_problem
    from tmd.api import plan_from_unified_planning as plan_from_unified_planning
    from tmd.api import plan_to_unified_planning as plan_to_unified_planning
    from tmd.api import read_plan as read_plan
    from tmd.api import to_unified_planning as to_unified_planning
    from tmd.api import validate as validate
    from tmd.api import with_goal as with_goal

__version__ = "0.1.0"
__all__ = [  # as in tmd.api; a test compares them
    "DomainKit",
    "Grounded",
    "Instruction",
    "NoPlanError",
    "Problem",
    "TmdError",
    "Verdict",
    "export_plan",
    "find_plan",
    "from_unified_planning",
    "load_domain",
    "load_problem",
    "plan_from_unified_planning",
    "plan_to_unified_planning",
    "read_plan",
    "to_unified_planning",
    "validate",
    "with_goal",
]


def __getattr__(name: str) -> Any:  # noqa: ANN401 - whatever stands in the module
    """A name of :mod:`tmd.api`, imported now."""
    if name in __all__:
        from tmd import api

        return getattr(api, name)
    raise AttributeError(f"module 'tmd' has no attribute '{name}'")


def __dir__() -> list[str]:
    """What is here, with what is imported on demand."""
    return sorted({*globals(), *__all__})
