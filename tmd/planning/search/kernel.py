"""The search kernel: depth-first search under rising cost bounds, with landmark cuts as the lower bound.

Every function here, in :mod:`~tmd.planning.search.heuristics` and in :mod:`~tmd.planning.search.greedy` is written in
the common subset of plain Python over lists and of numba over arrays: :mod:`tmd.planning.search.numba_build` compiles
the same code, so both give the same answers step by step.

**What is computed.** The cheapest plan from a state to any cube of the goal; among the cheapest, the plans with the
fewest steps; and among these the one whose sequence of operator numbers comes first in lexicographic order. With unit
costs this is the plan that a breadth-first search in parent order, then operator order, would find. It does not
depend on the lower bound, on caches or on hashing.

**How.** Bounds rise from the landmark-cut value of the start (Helmert and Domshlak, ICAPS 2009; conditional effects
share the cost of their action). Under one bound the search takes operators in order and skips

* operators that cannot be on any optimal plan within the bound, because no chain of needs leads from what they
  change to the goal in time (:func:`~tmd.planning.search.heuristics.distances`);
* operators outside every cut, where the bound leaves no slack;
* states already refuted with as much budget (a table of lower bounds, as in IDA* with a transposition table).

All three keep every optimal plan. Where operators differ in cost, a step counts for a small fraction of the smallest
cost; bounds then rise by whole costs, and by steps only once the cost is settled.

Work is capped by the number of generated states, never by time.
"""

from __future__ import annotations

from typing import NamedTuple

from tmd.planning.search.flat_task import Ints, Tables
from tmd.planning.search.heuristics import (
    FAR,
    Goal,
    Relaxed,
    Scratch,
    applicable,
    change,
    earliest,
    grown,
    hmax,
    landmark_cut,
    reached_goal,
    relaxed,
    scratch,
    successor,
    zeros,
)

FOUND, DEAD_END, CAPPED = 0, 1, 2
"""Status of a search."""

GENERATED, LIMITED = 0, 1
"""Entries of the counter: how many states were generated, and whether the bound limited the search."""


class Table(NamedTuple):
    """The known states of one bound. ``size`` holds their number in its only entry.

    ``word`` holds the states, ``bound`` the proven lower bound to the goal, ``first`` its value when it was new.
    ``slot`` is an open hash table of state numbers plus one.
    """

    size: Ints
    word: Ints
    bound: Ints
    first: Ints
    slot: Ints


def new_table(words: int, size: int) -> Table:
    """Return an empty table with room for ``size`` states."""
    return Table(zeros(1), zeros(words * size), zeros(size), zeros(size), zeros(4 * size))


def find(table: Table, words: int, state: Ints) -> int:
    """Return the slot of a state, or the empty slot where it belongs."""
    mixed = 0
    for w in range(words):
        folded = (mixed ^ state[w]) & ((1 << 40) - 1)
        mixed = (folded * 2654435 + (state[w] >> 40) * 40503) & ((1 << 61) - 1)
        mixed ^= mixed >> 29
    slots = len(table.slot)
    at = mixed % slots
    while table.slot[at] != 0:
        node = table.slot[at] - 1
        same = True
        for w in range(words):
            same = same and table.word[node * words + w] == state[w]
        if same:
            return at
        at = (at + 1) % slots
    return at


def insert(table: Table, words: int, at: int, state: Ints) -> int:
    """Add a state at an empty slot; returns its number."""
    node = table.size[0]
    table.size[0] = node + 1
    table.slot[at] = node + 1
    for w in range(words):
        table.word[node * words + w] = state[w]
    return node


def enlarged(table: Table, words: int) -> Table:
    """Return the same table with four times the room."""
    old, child = table.size[0], zeros(words)
    wide = new_table(words, 4 * len(table.bound))
    for node in range(old):
        for w in range(words):
            child[w] = table.word[node * words + w]
        insert(wide, words, find(wide, words, child), child)
        wide.bound[node] = table.bound[node]
        wide.first[node] = table.first[node]
    return wide


class SearchQuery(NamedTuple):
    """One bound of one search. ``usable`` lists the operators worth trying, ``near`` what each may change."""

    t: Tables
    r: Relaxed
    s: Scratch
    positive: Ints
    negative: Ints
    cubes: int
    distance: Ints
    mask: Ints
    usable: Ints
    near: Ints


def needed(q: SearchQuery, operator: int) -> int:
    """Return whether an operator is in a cut, with or without effects under conditions."""
    return q.s.in_cut[operator] | q.s.in_cut[q.t.operators + 1 + operator]


def descend(q: SearchQuery, start: Ints, bound: int, cap: int, counter: Ints) -> tuple[int, int, Ints]:
    """Search depth-first for a plan within ``bound``; the canonical one where none is cheaper than ``bound``.

    ``counter`` counts generated states, and notes whether the bound kept anything from being searched: if not,
    every state is known and there is no plan at all. Returns the status, the next bound (or the length of the
    plan), and the operators.
    """
    t, words, width = q.t, q.t.words, len(q.usable)
    table = new_table(words, 64)
    child, gone = zeros(words), zeros(words)
    room = 16
    node, turn, budget, excess = zeros(room), zeros(room), zeros(room), zeros(room)
    cuts = zeros(room * width)
    insert(table, words, find(table, words, start), start)
    table.first[0] = landmark_cut(t, q.r, q.s, start, 0)
    if table.first[0] > bound:
        return DEAD_END, table.first[0], zeros(0)
    table.bound[0] = bound + 1
    counter[LIMITED] = 0
    budget[0], excess[0] = bound, FAR
    for i in range(width):
        cuts[i] = needed(q, q.usable[i])
    depth = 0
    while depth >= 0:
        here, left = node[depth], budget[depth]
        if turn[depth] == width:
            table.bound[here] = max(excess[depth], left + 1)
            depth -= 1
            if depth >= 0:
                above = q.t.cost[q.usable[turn[depth] - 1]] + table.bound[here]
                excess[depth] = min(excess[depth], above)
            continue
        i = turn[depth]
        operator = q.usable[i]
        turn[depth] = i + 1
        rest = left - t.cost[operator]
        if q.near[i] > rest:
            counter[LIMITED] = 1
            excess[depth] = min(excess[depth], left - rest + q.near[i])
            continue
        if cuts[depth * width + i] == 0 and table.first[here] > rest:
            counter[LIMITED] = 1
            excess[depth] = min(excess[depth], left - rest + table.first[here])
            continue
        if not applicable(t, operator, table.word, here * words):
            continue
        successor(t, operator, table.word, here * words, q.mask, child, gone)
        near = change(t, operator, q.distance, table.word, here * words, child)
        if near > rest:
            counter[LIMITED] |= 1 if near < FAR else 0
            excess[depth] = min(excess[depth], left - rest + near)
            continue
        counter[GENERATED] += 1
        if counter[GENERATED] > cap:
            return CAPPED, bound, zeros(0)
        if reached_goal(child, 0, q.positive, q.negative, q.cubes, words):
            plan = zeros(depth + 1)
            for step in range(depth + 1):
                plan[step] = q.usable[turn[step] - 1]
            return FOUND, depth + 1, plan
        at = find(table, words, child)
        known = table.slot[at] - 1
        if known < 0:
            if table.size[0] == len(table.bound):
                table = enlarged(table, words)
                at = find(table, words, child)
            known = insert(table, words, at, child)
            table.first[known] = landmark_cut(t, q.r, q.s, child, 0)
            table.bound[known] = table.first[known]
        elif table.bound[known] <= rest:
            landmark_cut(t, q.r, q.s, child, 0)
        if table.bound[known] > rest:
            counter[LIMITED] |= 1 if rest < table.first[known] < FAR else 0
            excess[depth] = min(excess[depth], left - rest + table.bound[known])
            continue
        table.bound[known] = rest + 1
        depth += 1
        if depth == room:
            room *= 2
            node, turn = grown(node, room), grown(turn, room)
            budget, excess = grown(budget, room), grown(excess, room)
            cuts = grown(cuts, room * width)
        node[depth], turn[depth], budget[depth], excess[depth] = known, 0, rest, FAR
        for i in range(width):
            cuts[depth * width + i] = needed(q, q.usable[i])
    return DEAD_END, table.bound[0] if counter[LIMITED] else FAR, zeros(0)


def search(t: Tables, g: Goal, start: Ints, cap: int) -> tuple[int, int, int, Ints]:
    """Return the canonical cheapest plan from ``start``, which must not satisfy the goal.

    Returns the status, the cost of the plan or the bound at which the search stopped, the number of generated
    states, and the operators of the plan.
    """
    counter, nothing, begin = zeros(2), zeros(0), zeros(t.words)
    for w in range(t.words):
        begin[w] = start[w] & g.mask[w]
    s = scratch(t, g.wide)
    hmax(t, g.wide, s, begin, 0)
    early = earliest(t, g.wide, s)
    bound = landmark_cut(t, g.tight, scratch(t, g.tight), begin, 0)
    allowed = zeros(t.operators + 1)
    allowed[t.operators] = 1
    exact = t.step == 1
    while bound < FAR:
        limit = bound if exact else bound // t.step * t.step + t.step - 1
        following, width = FAR, 0
        for operator in range(t.operators):
            near = g.near[operator]
            least = early[operator] + t.cost[operator] + near if near < FAR else FAR
            allowed[operator] = 1 if least <= limit else 0
            width += allowed[operator]
            if least > limit:
                following = min(following, least)
        usable, change_near = zeros(width), zeros(width)
        width = 0
        for operator in range(t.operators):
            if allowed[operator] != 0:
                usable[width], change_near[width] = operator, g.near[operator]
                width += 1
        r = relaxed(t, allowed, g.fact_start, g.fact, nothing)
        q = SearchQuery(
            t, r, scratch(t, r), g.positive, g.negative, len(g.fact_start) - 1, g.distance, g.mask, usable, change_near
        )
        status, value, plan = descend(q, begin, limit, cap, counter)
        if status == CAPPED or (status == FOUND and exact):
            return status, bound, counter[GENERATED], plan
        if status == FOUND:
            exact = True  # the cost is settled, the number of steps is not
        else:
            bound = min(value, following)
    return DEAD_END, FAR, counter[GENERATED], nothing
