"""VEIL-500, the data set behind the paper's follow-up: reading, simulating and checking it.

The data are not part of this project; give the directory of your copy to :func:`load`. Begin with
:mod:`tmd.datasets.veil500.data`; all about the set is in ``docs/veil500.md``.
"""

from tmd.datasets.veil500.compile import absent_types, compile_environment
from tmd.datasets.veil500.data import Point, VeilData, VeilGroup, load
from tmd.datasets.veil500.environment import VeilEnvironment, VeilObject
from tmd.datasets.veil500.forms import from_veil, mentioned, to_veil, veil_domain
from tmd.pddl.forced_execution import ForcedExecution, Rollout, rollout

__all__ = [
    "ForcedExecution",
    "Point",
    "Rollout",
    "VeilData",
    "VeilEnvironment",
    "VeilGroup",
    "VeilObject",
    "absent_types",
    "compile_environment",
    "from_veil",
    "load",
    "mentioned",
    "rollout",
    "to_veil",
    "veil_domain",
]
