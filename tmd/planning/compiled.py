"""The search kernel compiled by numba: the same code as :mod:`tmd.planning.kernel`, over arrays.

numba is optional (the extra ``fast``). Compiling takes some seconds once per machine; the result is cached on
disk beside the source.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from types import FunctionType
from typing import Any

from tmd.planning import kernel
from tmd.planning.tables import Ints, Tables

Search = Callable[[Tables, Ints, Ints, Ints, Ints, Ints, int], tuple[int, int, int, Ints]]
"""The type of :func:`tmd.planning.kernel.search`."""


@cache
def compiled_search() -> Search:
    """:func:`tmd.planning.kernel.search`, compiled.

    Raises:
        ImportError: numba is not installed.
    """
    import numba
    import numpy as np

    namespace = dict(vars(kernel))

    def zeros(size: int) -> Any:
        return np.zeros(size, np.int64)

    def grown(old: Any, size: int) -> Any:
        new = np.zeros(size, np.int64)
        new[: len(old)] = old
        return new

    def jit(function: Any) -> Any:
        try:
            return numba.njit(cache=True, nogil=True)(function)
        except RuntimeError:  # no directory to keep the cache in
            return numba.njit(nogil=True)(function)

    namespace["zeros"], namespace["grown"] = jit(zeros), jit(grown)
    for name, member in vars(kernel).items():
        if isinstance(member, FunctionType) and member.__module__ == kernel.__name__ and name not in replaced:
            twin = FunctionType(member.__code__, namespace, name, member.__defaults__)
            twin.__module__ = kernel.__name__
            namespace[name] = jit(twin)
    search: Search = namespace["search"]
    return search


replaced = frozenset({"zeros", "grown"})
"""Functions of the kernel that differ between lists and arrays."""


def arrays(tables: Tables) -> Tables:
    """``tables`` with numpy arrays in the place of lists."""
    return Tables(*(array(part) if isinstance(part, list) else part for part in tables))


def array(values: Ints) -> Any:
    """A list as the kernel's kind of array."""
    import numpy as np

    return np.array(values, dtype=np.int64)
