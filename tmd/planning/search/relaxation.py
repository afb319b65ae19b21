"""The relaxation for one goal, a part of the search kernel: what matters for it, and how far from it.

See :mod:`tmd.planning.search.kernel` for how the kernel's code is written, and why.
"""

from __future__ import annotations

from typing import NamedTuple

from tmd.planning.search.flat_task import WORD, Ints, Tables
from tmd.planning.search.state_words import FAR, holds, zeros

TRUE, GOAL = 0, 1
"""The first two facts of a relaxation."""


class Relaxed(NamedTuple):
    """The part of the relaxation that matters for one goal and one bound, numbered afresh.

    ``literal`` gives the fact of the tables that each fact stands for. The relaxed operators of operator ``o``
    are ``group[group_start[o]:group_start[o + 1]]``.
    """

    facts: int
    rows: int
    literal: Ints
    action: Ints
    need_start: Ints
    need: Ints
    make_start: Ints
    make: Ints
    user_start: Ints
    user: Ints
    maker_start: Ints
    maker: Ints
    group_start: Ints
    group: Ints


def distances(t: Tables, goal: Ints) -> Ints:
    """For each fact, the least cost between using it and reaching the goal; ``FAR`` where it is of no use.

    A fact is of use for an operator's condition, for an effect's condition where the effect makes a useful fact,
    and where it keeps an effect silent that would destroy a useful fact. An operator of a cheapest plan always
    changes some fact whose distance is within what the rest of the plan costs; else the plan would do without it.
    """
    distance = zeros(t.facts)
    for fact in range(t.facts):
        distance[fact] = FAR
    queue, queued = zeros(t.facts + 1), zeros(t.facts)
    head, tail = 0, 0
    for i in range(len(goal)):
        if queued[goal[i]] == 0:
            distance[goal[i]] = 0
            queued[goal[i]] = 1
            queue[tail] = goal[i]
            tail += 1
    while head != tail:
        fact = queue[head]
        head = (head + 1) % (t.facts + 1)
        queued[fact] = 0
        for i in range(t.maker_start[fact], t.maker_start[fact + 1]):
            row = t.maker[i]
            near = distance[fact] + t.cost[t.action[row]]
            for j in range(t.need_start[row], t.need_start[row + 1]):
                tail = closer(distance, queue, queued, tail, t.need[j], near)
        if fact < 2 * t.atoms:
            for i in range(t.maker_start[fact ^ 1], t.maker_start[(fact ^ 1) + 1]):
                row = t.maker[i]
                near = distance[fact] + t.cost[t.action[row]]
                for j in range(t.guard_start[row], t.guard_start[row + 1]):
                    tail = closer(distance, queue, queued, tail, t.guard[j] ^ 1, near)
    return distance


def closer(distance: Ints, queue: Ints, queued: Ints, tail: int, fact: int, near: int) -> int:
    """Lower a distance and queue the fact; returns the new end of the queue."""
    if near >= distance[fact]:
        return tail
    distance[fact] = near
    if queued[fact] == 0:
        queued[fact] = 1
        queue[tail] = fact
        tail = (tail + 1) % len(queue)
    return tail


def nearest(t: Tables, operator: int, distance: Ints) -> int:
    """The least distance of anything an operator can change."""
    best = FAR
    for row in range(t.row_start[operator], t.row_start[operator + 1]):
        for j in range(t.make_start[row], t.make_start[row + 1]):
            best = min(best, distance[t.make[j]])
    return best


def change(t: Tables, operator: int, distance: Ints, state: Ints, at: int, child: Ints) -> int:
    """The least distance of anything an operator did change between two states."""
    best = FAR
    for row in range(t.row_start[operator], t.row_start[operator + 1]):
        for j in range(t.make_start[row], t.make_start[row + 1]):
            fact = t.make[j]
            if distance[fact] < best and holds(child, 0, fact) and not holds(state, at, fact):
                best = distance[fact]
    return best


def useful_atoms(t: Tables, distance: Ints) -> Ints:
    """The atoms that matter for the goal, as words."""
    mask = zeros(t.words)
    for atom in range(t.atoms):
        if distance[2 * atom] < FAR or distance[2 * atom + 1] < FAR:
            mask[atom // WORD] |= 1 << (atom % WORD)
    return mask


def transposed(start: Ints, entries: Ints, lists: int, size: int) -> tuple[Ints, Ints]:
    """For each of ``size`` entries the lists that hold it."""
    begin = zeros(size + 1)
    for i in range(start[lists]):
        begin[entries[i] + 1] += 1
    for i in range(size):
        begin[i + 1] += begin[i]
    fill, found = zeros(size), zeros(start[lists])
    for one in range(lists):
        for i in range(start[one], start[one + 1]):
            entry = entries[i]
            found[begin[entry] + fill[entry]] = one
            fill[entry] += 1
    return begin, found


def always(t: Tables, row: int) -> int:
    """The row of what an operator does in any case, for a row of what it does under a condition; else -1."""
    first = t.row_start[t.action[row]]
    conditional = t.guard_start[row] < t.guard_start[row + 1]
    return first if conditional and t.guard_start[first] == t.guard_start[first + 1] else -1


def relevant(t: Tables, allowed: Ints, goal: Ints, distance: Ints, number: Ints, place: Ints) -> tuple[Ints, Ints]:
    """The facts and rows of a relaxation, in the order in which they are found backwards from the goal.

    Writes one more than the position of each row into ``place`` and the new number of each fact into ``number``.
    """
    literal, order = zeros(t.facts + 2), zeros(len(t.action))
    facts, rows = 2, 0
    for i in range(len(goal)):
        if number[goal[i]] == 0:
            number[goal[i]] = facts
            literal[facts] = goal[i]
            facts += 1
    for fact in range(len(distance)):
        if distance[fact] < FAR and number[fact] == 0:
            number[fact] = facts
            literal[facts] = fact
            facts += 1
    done = 2
    while done < facts:
        fact = literal[done]
        done += 1
        for i in range(t.maker_start[fact], t.maker_start[fact + 1]):
            row = t.maker[i]
            if place[row] != 0 or allowed[t.action[row]] == 0:
                continue
            order[rows] = row
            rows += 1
            place[row] = rows
            for j in range(t.need_start[row], t.need_start[row + 1]):
                if number[t.need[j]] == 0:
                    number[t.need[j]] = facts
                    literal[facts] = t.need[j]
                    facts += 1
    return literal[:facts], order[:rows]


def products(t: Tables, literal: Ints, order: Ints, place: Ints) -> tuple[Ints, Ints]:
    """What each row makes: its own facts, and those that its operator makes in any case."""
    rows = len(order)
    own = zeros(rows)
    for fact in range(2, len(literal)):
        for i in range(t.maker_start[literal[fact]], t.maker_start[literal[fact] + 1]):
            if place[t.maker[i]] != 0:
                own[place[t.maker[i]] - 1] += 1
    start, filled = zeros(rows + 1), zeros(rows)
    for at in range(rows):
        first = always(t, order[at])
        more = own[place[first] - 1] if first >= 0 and place[first] != 0 else 0
        start[at + 1] = start[at] + own[at] + more
    make = zeros(start[rows])
    for fact in range(2, len(literal)):
        for i in range(t.maker_start[literal[fact]], t.maker_start[literal[fact] + 1]):
            at = place[t.maker[i]] - 1
            if at >= 0:
                make[start[at] + filled[at]] = fact
                filled[at] += 1
    for at in range(rows):
        first = always(t, order[at])
        source = place[first] - 1 if first >= 0 else -1
        for j in range(own[source] if source >= 0 else 0):
            make[start[at] + own[at] + j] = make[start[source] + j]
    return start, make


def relaxed(t: Tables, allowed: Ints, goal_start: Ints, goal: Ints, distance: Ints) -> Relaxed:
    """The relaxation for a goal (a disjunction of fact lists), with the allowed operators only.

    Facts whose ``distance`` is below ``FAR`` are included even where no relaxed plan asks for them.
    """
    number, place = zeros(t.facts), zeros(len(t.action))
    literal, order = relevant(t, allowed, goal, distance, number, place)
    begin, made = products(t, literal, order, place)
    plain, cubes, facts = len(order), len(goal_start) - 1, len(literal)
    rows = plain + cubes
    size = len(goal) + cubes
    for at in range(plain):
        size += t.need_start[order[at] + 1] - t.need_start[order[at]] + 1
    action, need_start, make_start = zeros(rows), zeros(rows + 1), zeros(rows + 1)
    need, make = zeros(size), zeros(begin[plain] + cubes)
    n = 0
    for at in range(rows):
        if at < plain:
            row = order[at]
            action[at] = t.action[row] if always(t, row) < 0 else t.operators + 1 + t.action[row]
            make_start[at + 1] = begin[at + 1]
            for j in range(t.need_start[row], t.need_start[row + 1]):
                need[n] = number[t.need[j]]
                n += 1
        else:
            action[at] = t.operators
            make[make_start[at]] = GOAL
            make_start[at + 1] = make_start[at] + 1
            for j in range(goal_start[at - plain], goal_start[at - plain + 1]):
                need[n] = number[goal[j]]
                n += 1
        if n == need_start[at]:
            need[n] = TRUE
            n += 1
        need_start[at + 1] = n
    for j in range(begin[plain]):
        make[j] = made[j]
    user_start, user = transposed(need_start, need, rows, facts)
    maker_start, maker = transposed(make_start, make, rows, facts)
    one = zeros(rows + 1)
    for row in range(rows):
        one[row + 1] = row + 1
    group_start, group = transposed(one, action, rows, len(t.cost))
    return Relaxed(
        facts, rows, literal, action, need_start, need, make_start, make,
        user_start, user, maker_start, maker, group_start, group,
    )  # fmt: skip


class Goal(NamedTuple):
    """A goal and what follows from it for every start: worth keeping, since goals come again and again.

    The goal is there twice: as words (``positive``, ``negative``) and as facts (``fact_start``, ``fact``).
    ``near`` is the least distance of anything an operator can change. ``wide`` is the relaxation of all that
    matters, ``tight`` that of all that relaxed plans need.
    """

    positive: Ints
    negative: Ints
    fact_start: Ints
    fact: Ints
    distance: Ints
    mask: Ints
    near: Ints
    wide: Relaxed
    tight: Relaxed


def prepared(t: Tables, positive: Ints, negative: Ints, fact_start: Ints, fact: Ints) -> Goal:
    """Everything about a goal that does not depend on the start."""
    distance = distances(t, fact)
    near, allowed = zeros(t.operators), zeros(t.operators + 1)
    for operator in range(t.operators):
        near[operator] = nearest(t, operator, distance)
        allowed[operator] = 1 if near[operator] < FAR else 0
    allowed[t.operators] = 1
    wide = relaxed(t, allowed, fact_start, fact, distance)
    tight = relaxed(t, allowed, fact_start, fact, zeros(0))
    mask = useful_atoms(t, distance)
    return Goal(positive, negative, fact_start, fact, distance, mask, near, wide, tight)
