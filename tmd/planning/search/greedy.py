"""The search for any plan, a part of the search kernel: where the cheapest one takes too long to find.

Greedy best-first search, then weighted A*, as LAMA does it (Richter and Westphal, JAIR 2010): a state is looked at
when its turn comes, and waits in line under the landmark-cut value of the state before it. There are two lines. One
holds every successor, the other only those by operators of a cut, which are preferred: each time a state nearer to
the goal than all before is found, the second line goes first for a while.

See :mod:`tmd.planning.search.kernel` for how the kernel's code is written, and why. Plans are valid, not cheapest. No
state that can lead to the goal is left out, so a search that runs dry proves that there is no plan.
"""

from __future__ import annotations

from typing import NamedTuple

from tmd.planning.search.flat_task import Ints, Tables
from tmd.planning.search.heuristics import (
    FAR,
    Goal,
    Scratch,
    applicable,
    grown,
    landmark_cut,
    reached_goal,
    scratch,
    successor,
    zeros,
)
from tmd.planning.search.kernel import CAPPED, DEAD_END, FOUND, Table, enlarged, find, insert, new_table

BOOST = 1_000
"""For how many turns the preferred operators go first after progress."""
ENTRY = 3
"""A place in a line: the value and order of arrival, the state, the operator."""
HEAVIEST = 4
"""The weight of the lower bound where a better plan is looked for; then less and less."""
MORE = 5_000
"""Number of further states generated for better plans."""
ORDERS = 1 << 32
"""More than ever stand in a line; a value times this is below the greatest integer of compiled code."""


class Line(NamedTuple):
    """A binary heap of operators that wait, each with its state.

    ``number`` has how many are in it, and how many were put so far.
    """

    entry: Ints
    number: Ints


def put(line: Line, value: int, node: int, operator: int) -> Line:
    """Add to a line; returns the line, which may have got more room."""
    at = line.number[0]
    line.number[0] = at + 1
    if ENTRY * (at + 1) > len(line.entry):
        line = Line(grown(line.entry, 2 * len(line.entry)), line.number)
    entry = line.entry
    key = value * ORDERS + line.number[1]
    line.number[1] += 1
    while at > 0 and entry[ENTRY * ((at - 1) // 2)] > key:
        above = (at - 1) // 2
        for j in range(ENTRY):
            entry[ENTRY * at + j] = entry[ENTRY * above + j]
        at = above
    entry[ENTRY * at], entry[ENTRY * at + 1], entry[ENTRY * at + 2] = key, node, operator
    return line


def take(line: Line) -> tuple[int, int]:
    """Remove the first of a line that is not empty: its state and its operator."""
    entry = line.entry
    node, operator = entry[1], entry[2]
    last = line.number[0] - 1
    line.number[0] = last
    key, at, below = entry[ENTRY * last], 0, 1
    while below < last:
        if below + 1 < last and entry[ENTRY * (below + 1)] < entry[ENTRY * below]:
            below += 1
        if entry[ENTRY * below] >= key:
            break
        for j in range(ENTRY):
            entry[ENTRY * at + j] = entry[ENTRY * below + j]
        at, below = below, 2 * below + 1
    for j in range(ENTRY):
        entry[ENTRY * at + j] = entry[ENTRY * last + j]
    return node, operator


def take_next(every: Line, preferred: Line, lead: int, turn: int) -> tuple[int, int, int]:
    """Remove the first of the line whose turn it is; returns its state, its operator and the new lead.

    The preferred line goes first for ``lead`` turns, then every other time.
    """
    if preferred.number[0] > 0 and (lead > 0 or turn % 2 == 0):
        node, operator = take(preferred)
        return node, operator, max(lead - 1, 0)
    node, operator = take(every)
    return node, operator, lead


def traced(parent: Ints, via: Ints, node: int) -> Ints:
    """Return the operators that led to a state."""
    length, at = 0, node
    while parent[at] >= 0:
        length += 1
        at = parent[at]
    plan, at = zeros(length), node
    while length > 0:
        length -= 1
        plan[length] = via[at]
        at = parent[at]
    return plan


class Round(NamedTuple):
    """One round of the search: what a unit of the lower bound counts for, and the cost that plans must stay below.

    With the weight 0 the lower bound is all that counts, and no state is looked at twice.
    """

    weight: int
    below: int
    cap: int


def put_successors(
    t: Tables, s: Scratch, usable: Ints, table: Table, node: int, key: int, every: Line, preferred: Line
) -> tuple[Line, Line]:
    """Add the operators that apply in a state to both lines, those of a cut to the preferred one; returns the lines."""
    for i in range(len(usable)):
        if applicable(t, usable[i], table.word, node * t.words):
            every = put(every, key, node, usable[i])
            if s.in_cut[usable[i]] | s.in_cut[t.operators + 1 + usable[i]] != 0:
                preferred = put(preferred, key, node, usable[i])
    return every, preferred


def weighed(rule: Round, cost: int, value: int) -> int:
    """Return the place in a line of the successors of a state with a cost so far and a lower bound."""
    return cost + rule.weight * value if rule.weight > 0 else value


def look(t: Tables, g: Goal, usable: Ints, start: Ints, rule: Round, counter: Ints) -> tuple[int, int, Ints]:
    """Search for a plan that costs less than ``rule.below``.

    ``counter`` counts generated states. Returns the status, the cost of the plan, and its operators. ``DEAD_END``
    proves that there is no plan that is so cheap.
    """
    words, cubes = t.words, len(g.fact_start) - 1
    s, table = scratch(t, g.tight), new_table(words, 64)
    child, gone = grown(start, words), zeros(words)
    parent, via, spent = zeros(64), zeros(64), zeros(64)
    every, preferred = Line(zeros(64 * ENTRY), zeros(2)), Line(zeros(64 * ENTRY), zeros(2))
    lead, best, cost = 0, FAR, 0
    node, before, operator = -1, -1, -1
    while True:
        at = find(table, words, child)
        fresh = table.slot[at] == 0
        if fresh:
            if table.size[0] == len(table.bound):
                table = enlarged(table, words)
                room = len(table.bound)
                parent, via, spent = grown(parent, room), grown(via, room), grown(spent, room)
                at = find(table, words, child)
            node = insert(table, words, at, child)
            table.first[node] = landmark_cut(t, g.tight, s, child, 0)
        else:
            node = table.slot[at] - 1
        again = rule.weight > 0 and cost < spent[node]
        if (fresh or again) and cost + table.first[node] < rule.below:
            parent[node], via[node], spent[node] = before, operator, cost
            if reached_goal(child, 0, g.positive, g.negative, cubes, words):
                return FOUND, cost, traced(parent, via, node)
            if not fresh:
                landmark_cut(t, g.tight, s, child, 0)
            value = table.first[node]
            if value < best:
                best, lead = value, lead + BOOST
            key = weighed(rule, cost, value)
            every, preferred = put_successors(t, s, usable, table, node, key, every, preferred)
        elif fresh:
            spent[node] = cost
        if every.number[0] == 0:
            return DEAD_END, FAR, zeros(0)
        counter[0] += 1
        if counter[0] > rule.cap:
            return CAPPED, best, zeros(0)
        before, operator, lead = take_next(every, preferred, lead, counter[0])
        cost = spent[before] + t.cost[operator]
        successor(t, operator, table.word, before * words, g.mask, child, gone)


def search_any(t: Tables, g: Goal, start: Ints, cap: int) -> tuple[int, int, int, Ints]:
    """Search for any plan from ``start``, which must not satisfy the goal, and for better ones soon after.

    ``cap`` limits the search for some plan; for better ones there are as many states again, and :data:`MORE`.

    Returns the status, the cost of the plan, the number of generated states, and the operators of the plan.
    """
    width, begin, counter = 0, zeros(t.words), zeros(1)
    usable = zeros(t.operators)
    for operator in range(t.operators):
        if g.near[operator] < FAR:
            usable[width] = operator
            width += 1
    for w in range(t.words):
        begin[w] = start[w] & g.mask[w]
    status, cost, plan = look(t, g, usable[:width], begin, Round(0, FAR, cap), counter)
    if status != FOUND:
        return status, cost, counter[0], plan
    most = 2 * counter[0] + MORE
    weight = HEAVIEST
    while weight > 0 and counter[0] < most:
        found, less, shorter = look(t, g, usable[:width], begin, Round(weight, cost, most), counter)
        if found == FOUND:
            cost, plan = less, shorter
        else:
            weight -= 1
    return FOUND, cost, counter[0], plan
