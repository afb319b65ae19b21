"""The search kernel compiled by numba: the same code as :mod:`tmd.planning.search.kernel`, over arrays.

numba is optional (the extra ``fast``). Compiling takes half a minute once per machine; the result is cached on
disk beside the source. ``python -m tmd.planning`` does it, and so does the first search; then standard error says so.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable
from functools import cache
from hashlib import sha256
from pathlib import Path
from threading import Lock
from types import FunctionType
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias, cast

from tmd.planning.search import greedy, heuristics, kernel
from tmd.planning.search.flat_task import Ints, Tables
from tmd.planning.search.heuristics import Goal

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


SearchFunction: TypeAlias = Callable[[Tables, Goal, Ints, int], tuple[int, int, int, Ints]]
"""Status, bound, generated states and plan, for tables, goal, start and the greatest number of generated states."""


PrepareFunction: TypeAlias = Callable[[Tables, Ints, Ints, Ints, Ints], Goal]
"""The prepared goal, for tables, the goal as words and as facts."""


class Functions(NamedTuple):
    """The entry points of the kernel."""

    prepared: PrepareFunction
    search: SearchFunction
    search_any: SearchFunction


MODULES = (heuristics, kernel, greedy)
"""The modules that make up the kernel, each before those that use it."""

REPLACED = frozenset({"zeros", "grown"})
"""Functions of the kernel that differ between lists and arrays."""


# Two threads that import numba at the same time see it half initialised.
_IMPORTING = Lock()


def compiled() -> Functions:
    """Return the kernel, compiled; threads may ask for it at the same time.

    Raises:
        ImportError: numba is not installed.
    """
    with _IMPORTING:
        return _compiled()


def loaded() -> bool:
    """Return whether this process has loaded the compiled kernel already."""
    return _compiled.cache_info().currsize > 0


@cache
def _compiled() -> Functions:
    import numpy as np

    def zeros(size: int) -> NDArray[np.int64]:
        return np.zeros(size, np.int64)

    def grown(old: NDArray[np.int64], size: int) -> NDArray[np.int64]:
        new = np.zeros(size, np.int64)
        new[: len(old)] = old
        return new

    _announce_compiling()
    namespace: dict[str, Any] = {}
    for module in MODULES:
        namespace.update(vars(module))
    namespace["zeros"], namespace["grown"] = jit(zeros), jit(grown)
    version, functions = digest(), _functions()
    plain = _plain(functions)
    for name, member in functions.items():
        if name not in REPLACED:
            twin = FunctionType(member.__code__, namespace, name)
            twin.__module__, twin.__qualname__ = member.__module__, f"{name}_{version}"
            namespace[name] = jit(twin, counted=name not in plain)
    return Functions(namespace["prepared"], namespace["search"], namespace["search_any"])


def _functions() -> dict[str, FunctionType]:
    """Return the functions of the kernel by name."""
    return {
        name: member
        for module in MODULES
        for name, member in vars(module).items()
        if isinstance(member, FunctionType) and member.__module__ == module.__name__
    }


def _plain(functions: dict[str, FunctionType]) -> set[str]:
    """Return the functions that make and return no array, nor does any that they call.

    They need not count references to arrays, which takes longer than all that they compute.
    """
    plain = {name for name, function in functions.items() if _SCALARS.fullmatch(function.__annotations__["return"])}
    while more := {n for n in plain if (functions.keys() - plain).intersection(functions[n].__code__.co_names)}:
        plain -= more
    return plain


_SCALARS = re.compile(r"int|bool|None|tuple\[int(, int)*\]")


class _Announcement:
    """A message, printed once, that numba compiles the kernel; loading compiled code is not an event."""

    printed = False

    def notify(self, event: Any) -> None:  # noqa: ANN401 - numba has no types
        """Handle an event of numba."""
        function = event.data["dispatcher"].py_func
        if event.is_start and not self.printed and function.__module__.startswith("tmd.planning."):
            self.printed = True
            print("compiling the search for this machine, once; this takes about half a minute …", file=sys.stderr)


def _announce_compiling() -> None:
    from numba.core import event

    event.Listener.register(_Announcement)
    event.register("numba:compile", _Announcement())  # type: ignore[no-untyped-call]


def digest() -> str:
    """Return a name for the present text of the kernel: what is cached of one module has others compiled into it."""
    files = (*(module.__file__ or "" for module in MODULES), __file__)
    text = "".join(Path(file).read_text(encoding="utf-8") for file in files)
    return sha256(text.encode()).hexdigest()[:12]


def jit(function: Callable[..., object], *, counted: bool = True) -> Callable[..., object]:
    """Return ``function`` compiled, with the result kept on disk where there is a place for it.

    ``counted`` says whether references to arrays are counted.
    """
    import numba

    options: dict[str, Any] = {"nogil": True, "_nrt": counted}  # NRT is what numba calls its counting
    try:
        kept: Callable[..., object] = numba.njit(cache=True, **options)(function)
    except RuntimeError:  # no directory that numba may write to
        kept = numba.njit(**options)(function)
    return kept


def arrays(tables: Tables) -> Tables:
    """Return ``tables`` with numpy arrays in the place of lists."""
    return Tables(*[array(part) if isinstance(part, list) else part for part in tables])  # type: ignore[arg-type]


def array(values: Ints) -> Ints:
    """Return a list as the compiled kernel's kind of list, a numpy array."""
    import numpy as np

    return cast(Ints, np.array(values, dtype=np.int64))
