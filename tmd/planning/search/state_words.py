"""States as words: the part of the search kernel that says when operators apply and what they do.

See :mod:`tmd.planning.search.kernel` for how the kernel's code is written, and why.
"""

from __future__ import annotations

from tmd.planning.search.flat_task import WORD, Ints, Tables

FAR = 1 << 60
"""More than any cost."""


def zeros(size: int) -> Ints:
    """An array of zeros (a list here, a numpy array when compiled)."""
    return [0] * size


def grown(old: Ints, size: int) -> Ints:
    """``old`` with room for ``size`` entries."""
    return old + [0] * (size - len(old))


def holds(state: Ints, at: int, fact: int) -> bool:
    """Whether the literal ``fact`` is true in the state whose words begin at ``at``."""
    atom = fact >> 1
    return (state[at + atom // WORD] >> (atom % WORD)) & 1 != fact & 1


def satisfies(state: Ints, at: int, positive: Ints, negative: Ints, first: int, words: int) -> bool:
    """Whether a state satisfies the cube whose words begin at ``first``."""
    for w in range(words):
        word = state[at + w]
        if word & positive[first + w] != positive[first + w] or word & negative[first + w] != 0:
            return False
    return True


def reached_goal(state: Ints, at: int, positive: Ints, negative: Ints, cubes: int, words: int) -> bool:
    """Whether a state satisfies any cube of the goal."""
    found = False
    for cube in range(cubes):
        found = found or satisfies(state, at, positive, negative, cube * words, words)
    return found


def applicable(t: Tables, operator: int, state: Ints, at: int) -> bool:
    """Whether an operator applies: :meth:`tmd.pddl.task.Operator.applicable`."""
    if not satisfies(state, at, t.positive, t.negative, operator * t.words, t.words):
        return False
    for i in range(t.forbidden_start[operator], t.forbidden_start[operator + 1]):
        if satisfies(state, at, t.forbidden_positive, t.forbidden_negative, i * t.words, t.words):
            return False
    return True


def successor(t: Tables, operator: int, state: Ints, at: int, mask: Ints, child: Ints, gone: Ints) -> None:
    """Write the successor into ``child``: :meth:`tmd.pddl.task.Operator.apply`, then only the atoms of ``mask``."""
    words, first = t.words, operator * t.words
    for w in range(words):
        child[w] = t.add[first + w]
        gone[w] = t.delete[first + w]
    for i in range(t.when_start[operator], t.when_start[operator + 1]):
        if satisfies(state, at, t.when_positive, t.when_negative, i * words, words):
            for w in range(words):
                child[w] |= t.when_add[i * words + w]
                gone[w] |= t.when_delete[i * words + w]
    for w in range(words):
        child[w] = (child[w] | (state[at + w] & ~gone[w])) & mask[w]
