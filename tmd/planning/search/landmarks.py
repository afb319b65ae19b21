"""Landmark cuts, a part of the search kernel: a lower bound on the cost to the goal (Helmert and Domshlak 2009).

See :mod:`tmd.planning.search.kernel` for how the kernel's code is written, and why.
"""

from __future__ import annotations

from typing import NamedTuple

from tmd.planning.search.flat_task import Ints, Tables
from tmd.planning.search.relaxation import GOAL, TRUE, Relaxed
from tmd.planning.search.state_words import FAR, holds, zeros


class Scratch(NamedTuple):
    """Working memory of the lower bound. ``value`` is hmax of a fact, ``reach`` that of a row's needs."""

    value: Ints
    mark: Ints
    queue: Ints
    queued: Ints
    true: Ints
    waiting: Ints
    reach: Ints
    support: Ints
    cost: Ints
    in_cut: Ints
    cut: Ints
    part: Ints


def scratch(t: Tables, r: Relaxed) -> Scratch:
    """Working memory for ``r``."""
    f, rows = r.facts, r.rows
    return Scratch(
        zeros(f), zeros(f), zeros(f + 1), zeros(f), zeros(f + 1), zeros(rows), zeros(rows), zeros(rows),
        zeros(len(t.cost)), zeros(len(t.cost)), zeros(len(t.cost) + 1), zeros(f),
    )  # fmt: skip


def lowered(r: Relaxed, s: Scratch, row: int, tail: int) -> int:
    """Pass a row's value on to what it makes; returns the new end of the queue."""
    value = s.reach[row] + s.cost[r.action[row]]
    for j in range(r.make_start[row], r.make_start[row + 1]):
        fact = r.make[j]
        if value < s.value[fact]:
            s.value[fact] = value
            if s.queued[fact] == 0:
                s.queued[fact] = 1
                s.queue[tail] = fact
                tail = (tail + 1) % len(s.queue)
    return tail


def supported(r: Relaxed, s: Scratch, row: int) -> bool:
    """Find the need of a row with the highest value; whether the row became cheaper."""
    best, worst = r.need[r.need_start[row]], -1
    for j in range(r.need_start[row], r.need_start[row + 1]):
        if s.value[r.need[j]] > worst:
            best, worst = r.need[j], s.value[r.need[j]]
    s.support[row] = best
    if worst < s.reach[row]:
        s.reach[row] = worst
        return True
    return False


def settle(r: Relaxed, s: Scratch, head: int, tail: int) -> None:
    """Work the queue off until every value is hmax."""
    while head != tail:
        fact = s.queue[head]
        head = (head + 1) % len(s.queue)
        s.queued[fact] = 0
        for i in range(r.user_start[fact], r.user_start[fact + 1]):
            row = r.user[i]
            if s.mark[fact] == 0:
                s.waiting[row] -= 1
            if s.waiting[row] == 0 and (s.reach[row] == FAR or s.support[row] == fact) and supported(r, s, row):
                tail = lowered(r, s, row, tail)
        s.mark[fact] = 1


def hmax(t: Tables, r: Relaxed, s: Scratch, state: Ints, at: int) -> int:
    """The hmax value of the goal (Bonet and Geffner 2001); fills ``value``, ``reach``, ``support`` and ``true``."""
    for fact in range(r.facts):
        s.value[fact] = FAR
        s.mark[fact] = 0
    for row in range(r.rows):
        s.waiting[row] = r.need_start[row + 1] - r.need_start[row]
        s.reach[row] = FAR
    for action in range(len(t.cost)):
        s.cost[action] = t.cost[action]
        s.in_cut[action] = 0
    count = 0
    for fact in range(r.facts):
        known = fact != GOAL and r.literal[fact] < 2 * t.atoms
        if fact == TRUE or (known and holds(state, at, r.literal[fact])):
            s.value[fact] = 0
            s.queue[count] = fact
            s.queued[fact] = 1
            s.true[count] = fact
            count += 1
    s.true[r.facts] = count
    settle(r, s, 0, count)
    return s.value[GOAL]


def earliest(t: Tables, r: Relaxed, s: Scratch) -> Ints:
    """For each operator, the hmax value of the cheapest of its rows; ``FAR`` where it is out of reach."""
    early = zeros(t.operators + 1)
    for operator in range(t.operators + 1):
        early[operator] = FAR
    for row in range(r.rows):
        operator = r.action[row] % (t.operators + 1)
        early[operator] = min(early[operator], s.reach[row])
    return early


def zone(r: Relaxed, s: Scratch, target: int) -> None:
    """Mark (2) the facts from which ``target`` follows for nothing."""
    for fact in range(r.facts):
        s.mark[fact] = 0
    s.mark[target] = 2
    s.queue[0] = target
    count = 1
    while count > 0:
        count -= 1
        fact = s.queue[count]
        for i in range(r.maker_start[fact], r.maker_start[fact + 1]):
            row = r.maker[i]
            if s.cost[r.action[row]] == 0 and s.reach[row] != FAR and s.mark[s.support[row]] == 0:
                s.mark[s.support[row]] = 2
                s.queue[count] = s.support[row]
                count += 1


def cut(r: Relaxed, s: Scratch) -> int:
    """Collect the operators that lead from what holds into the goal zone; returns how many."""
    size, count = 0, s.true[r.facts]
    for i in range(count):
        s.queue[i] = s.true[i]
        s.mark[s.true[i]] = 1
    while count > 0:
        count -= 1
        fact = s.queue[count]
        for i in range(r.user_start[fact], r.user_start[fact + 1]):
            row = r.user[i]
            if s.support[row] != fact or s.reach[row] == FAR:
                continue
            crosses = False
            for j in range(r.make_start[row], r.make_start[row + 1]):
                crosses = crosses or s.mark[r.make[j]] == 2
            if crosses:
                s.cut[size] = r.action[row]
                size += 1 if s.in_cut[r.action[row]] < 2 else 0
                s.in_cut[r.action[row]] = 2
                continue
            for j in range(r.make_start[row], r.make_start[row + 1]):
                if s.mark[r.make[j]] == 0:
                    s.mark[r.make[j]] = 1
                    s.queue[count] = r.make[j]
                    count += 1
    return size


def cut_off(r: Relaxed, s: Scratch, target: int) -> int:
    """Cut until ``target`` is free; returns the cost of all cuts."""
    total = 0
    while s.value[target] > 0:
        zone(r, s, target)
        size = cut(r, s)
        least = FAR
        for i in range(size):
            least = min(least, s.cost[s.cut[i]])
        total += least
        for fact in range(r.facts):
            s.mark[fact] = 1
        tail = 0
        for i in range(size):
            action = s.cut[i]
            s.cost[action] -= least
            s.in_cut[action] = 1
            for j in range(r.group_start[action], r.group_start[action + 1]):
                if s.reach[r.group[j]] != FAR:
                    tail = lowered(r, s, r.group[j], tail)
        settle(r, s, 0, tail)
    return total


def choices(r: Relaxed, fact: int) -> int:
    """In how many ways a fact can be made true."""
    return r.maker_start[fact + 1] - r.maker_start[fact]


def landmark_cut(t: Tables, r: Relaxed, s: Scratch, state: Ints, at: int) -> int:
    """A lower bound on the cost to the goal; ``in_cut`` then marks the operators of all cuts.

    An application of an operator either has effects under conditions that matter or not, and the rows of each kind
    share one cost, which keeps the bound admissible under conditional effects. The parts of the goal are cut off
    one by one, those with the fewest makers first: what they need for certain is then not spent on the
    alternatives of the others.
    """
    if hmax(t, r, s, state, at) == FAR:
        return FAR
    total = 0
    if r.maker_start[GOAL + 1] - r.maker_start[GOAL] == 1:
        row = r.maker[r.maker_start[GOAL]]
        first, last = r.need_start[row], r.need_start[row + 1]
        for i in range(first, last):
            s.part[i - first] = r.need[i]
            j = i - first
            while j > 0 and choices(r, s.part[j]) < choices(r, s.part[j - 1]):
                s.part[j], s.part[j - 1] = s.part[j - 1], s.part[j]
                j -= 1
        for i in range(last - first):
            total += cut_off(r, s, s.part[i])
    return total + cut_off(r, s, GOAL)
