"""The search kernel: depth-first search under rising cost bounds, with landmark cuts as the lower bound.

Every function here is written in the common subset of plain Python over lists and of numba over arrays:
:mod:`tmd.planning.compiled` compiles the very same code, so both give the same answers step by step.

**What is computed.** The cheapest plan from a state to any cube of the goal, and among the cheapest the one whose
sequence of operator numbers comes first in lexicographic order. This is the plan a breadth-first search in parent
order, then operator order, would find; it does not depend on the lower bound, on caches or on hashing.

**How.** Bounds rise from the landmark-cut value of the start (Helmert and Domshlak, ICAPS 2009; conditional effects
share the cost of their action). Under one bound the search takes operators in order and skips

* operators that cannot be on any optimal plan within the bound, because no chain of needs leads from what they
  change to the goal in time (:func:`distances`);
* operators outside every cut, where the bound leaves no slack;
* states already refuted with as much budget (a table of lower bounds, as in IDA* with a transposition table).

All three keep every optimal plan. Work is capped by the number of generated states, never by time.
"""

from __future__ import annotations

from typing import NamedTuple

from tmd.planning.tables import WORD, Ints, Tables

FAR = 1 << 60
"""More than any cost."""

FOUND, DEAD_END, CAPPED = 0, 1, 2
"""Status of a search."""

TRUE, GOAL = 0, 1
"""The first two facts of a relaxed query."""


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
    for cube in range(cubes):
        if satisfies(state, at, positive, negative, cube * words, words):
            return True
    return False


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


def relaxed(t: Tables, allowed: Ints, goal_start: Ints, goal: Ints, distance: Ints) -> Relaxed:
    """The relaxation for a goal (a disjunction of fact lists), with the allowed operators only.

    Facts whose ``distance`` is below ``FAR`` are included even where no relaxed plan asks for them.
    """
    number, literal = zeros(t.facts), zeros(t.facts + 2)
    used = zeros(len(t.action))
    cubes, facts, rows, needs, makes = len(goal_start) - 1, 2, 0, 0, 0
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
            if used[row] == 0 and allowed[t.action[row]] != 0:
                used[row] = 1
                rows += 1
                needs += t.need_start[row + 1] - t.need_start[row] + 1
                first = always(t, row)
                makes += t.make_start[row + 1] - t.make_start[row]
                makes += t.make_start[first + 1] - t.make_start[first] if first >= 0 else 0
                for j in range(t.need_start[row], t.need_start[row + 1]):
                    if number[t.need[j]] == 0:
                        number[t.need[j]] = facts
                        literal[facts] = t.need[j]
                        facts += 1
    rows += cubes
    action, need_start, make_start = zeros(rows), zeros(rows + 1), zeros(rows + 1)
    need, make = zeros(needs + len(goal) + cubes), zeros(makes + cubes)
    at, n, m = 0, 0, 0
    for row in range(len(t.action)):
        if used[row] == 0:
            continue
        first = always(t, row)
        action[at] = t.action[row] if first < 0 else t.operators + 1 + t.action[row]
        for j in range(t.need_start[row], t.need_start[row + 1]):
            need[n] = number[t.need[j]]
            n += 1
        if n == need_start[at]:
            need[n] = TRUE
            n += 1
        for j in range(t.make_start[row], t.make_start[row + 1]):
            if number[t.make[j]] != 0:
                make[m] = number[t.make[j]]
                m += 1
        for j in range(t.make_start[first], t.make_start[first + 1] if first >= 0 else 0):
            if number[t.make[j]] != 0:
                make[m] = number[t.make[j]]
                m += 1
        at += 1
        need_start[at], make_start[at] = n, m
    for cube in range(cubes):
        action[at] = t.operators
        for j in range(goal_start[cube], goal_start[cube + 1]):
            need[n] = number[goal[j]]
            n += 1
        if n == need_start[at]:
            need[n] = TRUE
            n += 1
        make[m] = GOAL
        m += 1
        at += 1
        need_start[at], make_start[at] = n, m
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
            if (
                s.waiting[row] == 0
                and (s.reach[row] == FAR or s.support[row] == fact)
                and supported(r, s, row)
            ):
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


class Table(NamedTuple):
    """What is known about the states of one bound. ``size`` holds the number of states in its only entry.

    ``word`` holds the states, ``bound`` the proven lower bound to the goal, ``first`` its value when it was new.
    ``slot`` is an open hash table of state numbers plus one.
    """

    size: Ints
    word: Ints
    bound: Ints
    first: Ints
    slot: Ints


def new_table(words: int, size: int) -> Table:
    """An empty table with room for ``size`` states."""
    return Table(zeros(1), zeros(words * size), zeros(size), zeros(size), zeros(4 * size))


def find(table: Table, words: int, state: Ints) -> int:
    """The slot of a state, or the empty slot where it belongs."""
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
    """The same table with four times the room."""
    old, child = table.size[0], zeros(words)
    wide = new_table(words, 4 * len(table.bound))
    for node in range(old):
        for w in range(words):
            child[w] = table.word[node * words + w]
        insert(wide, words, find(wide, words, child), child)
        wide.bound[node] = table.bound[node]
        wide.first[node] = table.first[node]
    return wide


class Query(NamedTuple):
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


def needed(q: Query, operator: int) -> int:
    """Whether an operator is in a cut, with or without effects under conditions."""
    return q.s.in_cut[operator] | q.s.in_cut[q.t.operators + 1 + operator]


def descend(q: Query, start: Ints, bound: int, cap: int, counter: Ints) -> tuple[int, int, Ints]:
    """Depth-first search for a plan of cost ``bound``, where it is proven that none is cheaper.

    ``counter`` counts generated states. Returns the status, the next bound (or the length of the plan), and
    the operators.
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
            excess[depth] = min(excess[depth], left - rest + q.near[i])
            continue
        if cuts[depth * width + i] == 0 and table.first[here] > rest:
            excess[depth] = min(excess[depth], left - rest + table.first[here])
            continue
        if not applicable(t, operator, table.word, here * words):
            continue
        successor(t, operator, table.word, here * words, q.mask, child, gone)
        near = change(t, operator, q.distance, table.word, here * words, child)
        if near > rest:
            excess[depth] = min(excess[depth], left - rest + near)
            continue
        counter[0] += 1
        if counter[0] > cap:
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
    return DEAD_END, table.bound[0], zeros(0)


def useful_atoms(t: Tables, distance: Ints) -> Ints:
    """The atoms that matter for the goal, as words."""
    mask = zeros(t.words)
    for atom in range(t.atoms):
        if distance[2 * atom] < FAR or distance[2 * atom + 1] < FAR:
            mask[atom // WORD] |= 1 << (atom % WORD)
    return mask


def earliest(t: Tables, r: Relaxed, s: Scratch) -> Ints:
    """For each operator, the hmax value of the cheapest of its rows; ``FAR`` where it is out of reach."""
    early = zeros(t.operators + 1)
    for operator in range(t.operators + 1):
        early[operator] = FAR
    for row in range(r.rows):
        operator = r.action[row] % (t.operators + 1)
        early[operator] = min(early[operator], s.reach[row])
    return early


def search(
    t: Tables, start: Ints, positive: Ints, negative: Ints, goal_start: Ints, goal: Ints, cap: int
) -> tuple[int, int, int, Ints]:
    """The canonical cheapest plan from ``start`` to any cube of the goal.

    The goal is given twice: as words (``positive``, ``negative``) and as facts (``goal_start``, ``goal``).
    Returns the status, the cost of the plan or the bound at which the search stopped, the number of generated
    states, and the operators of the plan. The start must not satisfy the goal.
    """
    cubes = len(goal_start) - 1
    counter, nothing = zeros(1), zeros(0)
    distance = distances(t, goal)
    mask = useful_atoms(t, distance)
    begin = zeros(t.words)
    for w in range(t.words):
        begin[w] = start[w] & mask[w]
    allowed = zeros(t.operators + 1)
    near = zeros(t.operators)
    for operator in range(t.operators):
        near[operator] = nearest(t, operator, distance)
        allowed[operator] = 1 if near[operator] < FAR else 0
    allowed[t.operators] = 1
    r = relaxed(t, allowed, goal_start, goal, distance)
    s = scratch(t, r)
    hmax(t, r, s, begin, 0)
    early = earliest(t, r, s)
    r = relaxed(t, allowed, goal_start, goal, nothing)
    s = scratch(t, r)
    bound = landmark_cut(t, r, s, begin, 0)
    while bound < FAR:
        following, width = FAR, 0
        for operator in range(t.operators):
            least = early[operator] + t.cost[operator] + near[operator] if near[operator] < FAR else FAR
            allowed[operator] = 1 if least <= bound else 0
            width += allowed[operator]
            if least > bound:
                following = min(following, least)
        usable, change_near = zeros(width), zeros(width)
        width = 0
        for operator in range(t.operators):
            if allowed[operator] != 0:
                usable[width], change_near[width] = operator, near[operator]
                width += 1
        r = relaxed(t, allowed, goal_start, goal, nothing)
        s = scratch(t, r)
        q = Query(t, r, s, positive, negative, cubes, distance, mask, usable, change_near)
        status, value, plan = descend(q, begin, bound, cap, counter)
        if status != DEAD_END:
            return status, bound, counter[0], plan
        bound = min(value, following)
    return DEAD_END, FAR, counter[0], nothing
