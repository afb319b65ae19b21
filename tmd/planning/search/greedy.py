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

    With the weight 0 the lower bound is all that counts, and no state is looked at twice. Rounds count from 1.
    """

    number: int
    weight: int
    below: int
    cap: int


class Visited(NamedTuple):
    """The states of all rounds, with what does not depend on the round.

    ``table.first`` has the lower bound of each state, ``table.bound`` the number of the last round that came to it.
    ``begin`` has for each state one more than the place of its successors in ``pool``, 0 where they are not known yet:
    their number, then for each the operator, doubled, and one more where it is preferred. ``used`` has the used length
    of ``pool`` in its only entry.
    """

    table: Table
    begin: Ints
    pool: Ints
    used: Ints


def new_visited(words: int) -> Visited:
    """Return no states."""
    return Visited(new_table(words, 64), zeros(64), zeros(1024), zeros(1))


def with_successors(t: Tables, s: Scratch, usable: Ints, visited: Visited, node: int) -> Visited:
    """Keep the operators that apply in a state whose cuts ``s`` has; returns the states, which may have more room."""
    first = visited.used[0]
    if first + len(usable) + 1 > len(visited.pool):
        visited = Visited(
            visited.table, visited.begin, grown(visited.pool, 2 * len(visited.pool) + len(usable)), visited.used
        )
    pool, at = visited.pool, first + 1
    for i in range(len(usable)):
        operator = usable[i]
        if applicable(t, operator, visited.table.word, node * t.words):
            preferred = s.in_cut[operator] | s.in_cut[t.operators + 1 + operator]
            pool[at] = 2 * operator + (1 if preferred != 0 else 0)
            at += 1
    pool[first] = at - first - 1
    visited.used[0] = at
    visited.begin[node] = first + 1
    return visited


def put_successors(visited: Visited, node: int, key: int, every: Line, preferred: Line) -> tuple[Line, Line]:
    """Add the operators that apply in a state to both lines, those of a cut to the preferred one; returns the lines."""
    first = visited.begin[node]
    for at in range(first, first + visited.pool[first - 1]):
        entry = visited.pool[at]
        every = put(every, key, node, entry // 2)
        if entry % 2 != 0:
            preferred = put(preferred, key, node, entry // 2)
    return every, preferred


def weighed(rule: Round, cost: int, value: int) -> int:
    """Return the place in a line of the successors of a state with a cost so far and a lower bound."""
    return cost + rule.weight * value if rule.weight > 0 else value


class Looked(NamedTuple):
    """The end of a round: its status, the cost of the plan, its operators, and all states visited so far."""

    status: int
    cost: int
    plan: Ints
    visited: Visited


def look(
    t: Tables, g: Goal, s: Scratch, usable: Ints, start: Ints, rule: Round, counter: Ints, visited: Visited
) -> Looked:
    """Search for a plan that costs less than ``rule.below``.

    ``counter`` counts generated states. ``DEAD_END`` proves that there is no plan that is so cheap.
    """
    words, cubes = t.words, len(g.fact_start) - 1
    child, gone = grown(start, words), zeros(words)
    room = len(visited.table.bound)
    parent, via, spent = zeros(room), zeros(room), zeros(room)
    every, preferred = Line(zeros(64 * ENTRY), zeros(2)), Line(zeros(64 * ENTRY), zeros(2))
    lead, best, cost = 0, FAR, 0
    before, operator = -1, -1
    while True:
        at = find(visited.table, words, child)
        new = visited.table.slot[at] == 0
        if new:
            if visited.table.size[0] == len(visited.table.bound):
                table = enlarged(visited.table, words)
                room = len(table.bound)
                visited = Visited(table, grown(visited.begin, room), visited.pool, visited.used)
                parent, via, spent = grown(parent, room), grown(via, room), grown(spent, room)
                at = find(visited.table, words, child)
            visited.table.first[insert(visited.table, words, at, child)] = landmark_cut(t, g.tight, s, child, 0)
        node = visited.table.slot[at] - 1
        value = visited.table.first[node]
        fresh = visited.table.bound[node] != rule.number
        visited.table.bound[node] = rule.number
        again = rule.weight > 0 and cost < spent[node]
        if (fresh or again) and cost + value < rule.below:
            parent[node], via[node], spent[node] = before, operator, cost
            if reached_goal(child, 0, g.positive, g.negative, cubes, words):
                return Looked(FOUND, cost, traced(parent, via, node), visited)
            if visited.begin[node] == 0:
                if not new:
                    landmark_cut(t, g.tight, s, child, 0)
                visited = with_successors(t, s, usable, visited, node)
            if value < best:
                best, lead = value, lead + BOOST
            every, preferred = put_successors(visited, node, weighed(rule, cost, value), every, preferred)
        elif fresh:
            spent[node] = cost
        if every.number[0] == 0:
            return Looked(DEAD_END, FAR, zeros(0), visited)
        counter[0] += 1
        if counter[0] > rule.cap:
            return Looked(CAPPED, best, zeros(0), visited)
        before, operator, lead = take_next(every, preferred, lead, counter[0])
        cost = spent[before] + t.cost[operator]
        successor(t, operator, visited.table.word, before * words, g.mask, child, gone)


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
    usable, s, number = usable[:width], scratch(t, g.tight), 1
    last = look(t, g, s, usable, begin, Round(number, 0, FAR, cap), counter, new_visited(t.words))
    if last.status != FOUND:
        return last.status, last.cost, counter[0], last.plan
    cost, plan = last.cost, last.plan
    most = 2 * counter[0] + MORE
    weight = HEAVIEST
    while weight > 0 and counter[0] < most:
        number += 1
        last = look(t, g, s, usable, begin, Round(number, weight, cost, most), counter, last.visited)
        if last.status == FOUND:
            cost, plan = last.cost, last.plan
        else:
            weight -= 1
    return FOUND, cost, counter[0], plan
