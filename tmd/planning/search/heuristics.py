"""Relaxed distances and landmark cuts: the heuristics of the search kernel, and the states as words they read.

What matters for one goal and how far it is from it; a lower bound on the cost to the goal (Helmert and Domshlak,
ICAPS 2009); when operators apply in a state and what they do. See :mod:`tmd.planning.search.kernel` for how this code
is written, and why.
"""

from __future__ import annotations

from typing import NamedTuple

from tmd.planning.search.flat_task import WORD, Ints, Tables

FAR = 1 << 60
"""More than any cost."""


def zeros(size: int) -> Ints:
    """Return an array of zeros (a list here, a numpy array when compiled)."""
    return [0] * size


def grown(old: Ints, size: int) -> Ints:
    """Return ``old`` with room for ``size`` entries."""
    return old + [0] * (size - len(old))


def holds(state: Ints, at: int, fact: int) -> bool:
    """Return whether the literal ``fact`` is true in the state whose words begin at ``at``."""
    atom = fact >> 1
    return (state[at + atom // WORD] >> (atom % WORD)) & 1 != fact & 1


def satisfies(state: Ints, at: int, positive: Ints, negative: Ints, first: int, words: int) -> bool:
    """Return whether a state satisfies the cube whose words begin at ``first``."""
    for w in range(words):
        word = state[at + w]
        if word & positive[first + w] != positive[first + w] or word & negative[first + w] != 0:
            return False
    return True


def reached_goal(state: Ints, at: int, positive: Ints, negative: Ints, cubes: int, words: int) -> bool:
    """Return whether a state satisfies any cube of the goal."""
    found = False
    for cube in range(cubes):
        found = found or satisfies(state, at, positive, negative, cube * words, words)
    return found


def applicable(t: Tables, operator: int, state: Ints, at: int) -> bool:
    """Return whether an operator applies: :meth:`tmd.pddl.task.Operator.applicable`."""
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


TRUE, GOAL = 0, 1
"""The first two facts of a relaxation."""


class Relaxed(NamedTuple):
    """The part of the relaxation that matters for one goal and one bound, numbered afresh.

    ``literal`` gives the fact of the tables that each fact is. The relaxed operators of operator ``o``
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
    """Return for each fact the least cost between using it and reaching the goal; ``FAR`` for useless ones.

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
    """Return the least distance of anything an operator can change."""
    best = FAR
    for row in range(t.row_start[operator], t.row_start[operator + 1]):
        for j in range(t.make_start[row], t.make_start[row + 1]):
            best = min(best, distance[t.make[j]])
    return best


def change(t: Tables, operator: int, distance: Ints, state: Ints, at: int, child: Ints) -> int:
    """Return the least distance of anything an operator did change between two states."""
    best = FAR
    for row in range(t.row_start[operator], t.row_start[operator + 1]):
        for j in range(t.make_start[row], t.make_start[row + 1]):
            fact = t.make[j]
            if distance[fact] < best and holds(child, 0, fact) and not holds(state, at, fact):
                best = distance[fact]
    return best


def useful_atoms(t: Tables, distance: Ints) -> Ints:
    """Return the atoms that matter for the goal, as words."""
    mask = zeros(t.words)
    for atom in range(t.atoms):
        if distance[2 * atom] < FAR or distance[2 * atom + 1] < FAR:
            mask[atom // WORD] |= 1 << (atom % WORD)
    return mask


def transposed(start: Ints, entries: Ints, lists: int, size: int) -> tuple[Ints, Ints]:
    """Return for each of ``size`` entries the lists that hold it."""
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
    """Return the row of what an operator does in any case, for a row of what it does under a condition; else -1."""
    first = t.row_start[t.action[row]]
    conditional = t.guard_start[row] < t.guard_start[row + 1]
    return first if conditional and t.guard_start[first] == t.guard_start[first + 1] else -1


def relevant(t: Tables, allowed: Ints, goal: Ints, distance: Ints, number: Ints, place: Ints) -> tuple[Ints, Ints]:
    """Return the facts and rows of a relaxation, in the order in which they are found backwards from the goal.

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
    """Return the facts that each row makes: its own, and those that its operator makes in any case."""
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
    """Return the relaxation for a goal (a disjunction of fact lists), with the allowed operators only.

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
    """Compute everything about a goal that does not depend on the start."""
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


class Scratch(NamedTuple):
    """Working memory of the lower bound. ``value`` is hmax of a fact, ``reach`` that of a row's needs.

    ``crosses`` marks the rows that make a fact of the zone before a cut, and ``crossing`` lists them.
    """

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
    crosses: Ints
    crossing: Ints


def scratch(t: Tables, r: Relaxed) -> Scratch:
    """Return working memory for ``r``."""
    f, rows = r.facts, r.rows
    return Scratch(
        zeros(f), zeros(f), zeros(f + 1), zeros(f), zeros(f + 1), zeros(rows), zeros(rows), zeros(rows),
        zeros(len(t.cost)), zeros(len(t.cost)), zeros(len(t.cost) + 1), zeros(f),
        zeros(rows), zeros(rows),
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
                tail = tail + 1 if tail + 1 < len(s.queue) else 0
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
        head = head + 1 if head + 1 < len(s.queue) else 0
        s.queued[fact] = 0
        for i in range(r.user_start[fact], r.user_start[fact + 1]):
            row = r.user[i]
            if s.mark[fact] == 0:
                s.waiting[row] -= 1
            if s.waiting[row] == 0 and (s.reach[row] == FAR or s.support[row] == fact) and supported(r, s, row):
                tail = lowered(r, s, row, tail)
        s.mark[fact] = 1


def hmax(t: Tables, r: Relaxed, s: Scratch, state: Ints, at: int) -> int:
    """Return hmax of the goal (Bonet and Geffner 2001); fills ``value``, ``reach``, ``support`` and ``true``."""
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
    """Return for each operator hmax of the cheapest of its rows; ``FAR`` where it is out of reach."""
    early = zeros(t.operators + 1)
    for operator in range(t.operators + 1):
        early[operator] = FAR
    for row in range(r.rows):
        operator = r.action[row] % (t.operators + 1)
        early[operator] = min(early[operator], s.reach[row])
    return early


def zone(r: Relaxed, s: Scratch, target: int) -> int:
    """Mark (2) the facts from which ``target`` follows for nothing, and the rows that make one of them.

    Returns how many of these rows are within reach.
    """
    for fact in range(r.facts):
        s.mark[fact] = 0
    for row in range(r.rows):
        s.crosses[row] = 0
    s.mark[target] = 2
    s.queue[0] = target
    count, rows = 1, 0
    while count > 0:
        count -= 1
        fact = s.queue[count]
        for i in range(r.maker_start[fact], r.maker_start[fact + 1]):
            row = r.maker[i]
            if s.crosses[row] != 0 or s.reach[row] == FAR:
                continue
            s.crosses[row] = 1
            s.crossing[rows] = row
            rows += 1
            if s.cost[r.action[row]] == 0 and s.mark[s.support[row]] == 0:
                s.mark[s.support[row]] = 2
                s.queue[count] = s.support[row]
                count += 1
    return rows


def cut(r: Relaxed, s: Scratch, target: int, rows: int) -> int:
    """Collect the operators that lead from what holds into the zone of ``target``; returns how many.

    ``rows`` is the number of rows that lead into the zone. Nothing in the zone is cheaper than the target. So what is
    cheaper comes about without the zone, and only what is not has to be looked into.
    """
    size, price = 0, s.value[target]
    for i in range(rows):
        row = s.crossing[i]
        fact, action = s.support[row], r.action[row]
        if s.reach[row] < price or s.mark[fact] == 1 or (s.mark[fact] == 0 and outside(r, s, fact, price)):
            s.cut[size] = action
            size += 1 if s.in_cut[action] < 2 else 0
            s.in_cut[action] = 2
    return size


def outside(r: Relaxed, s: Scratch, fact: int, price: int) -> bool:
    """Return whether a fact comes about without the zone: from anything cheaper than ``price``.

    Marks the fact (1) if so; if not, marks it and all that it might come from (3).
    """
    s.queue[0] = fact
    s.mark[fact] = 3
    head, tail, found = 0, 1, False
    while head < tail and not found:
        made = s.queue[head]
        head += 1
        for i in range(r.maker_start[made], r.maker_start[made + 1]):
            row = r.maker[i]
            if s.reach[row] == FAR or s.crosses[row] != 0:
                continue
            support = s.support[row]
            if s.reach[row] < price or s.mark[support] == 1:
                found = True
            elif s.mark[support] == 0:
                s.mark[support] = 3
                s.queue[tail] = support
                tail += 1
    if found:
        for i in range(tail):
            s.mark[s.queue[i]] = 0
        s.mark[fact] = 1
    return found


def cut_off(r: Relaxed, s: Scratch, target: int) -> int:
    """Cut until ``target`` is free; returns the cost of all cuts."""
    total = 0
    while s.value[target] > 0:
        size = cut(r, s, target, zone(r, s, target))
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
    """Return the number of ways in which a fact can be made true."""
    return r.maker_start[fact + 1] - r.maker_start[fact]


def landmark_cut(t: Tables, r: Relaxed, s: Scratch, state: Ints, at: int) -> int:
    """Return a lower bound on the cost to the goal; ``in_cut`` then marks the operators of all cuts.

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
