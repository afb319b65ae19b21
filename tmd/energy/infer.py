"""Inference: the forward pass of Algorithm 1 over the clauses, and the best plans it leads to.

α_j maps each environment that clause j can end in to the cheapest ways of getting there. For every template of
the clause's verb, and every trimming of it, the constraints of what is left go to the planner, which finds the
instructions that the person left unsaid. A verb without templates, or with none that can be executed, leaves the
environment as it is: α_j = α_{j-1}.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

from tmd.energy.constraints import get_constraints
from tmd.energy.energy import Energy
from tmd.energy.factors import delta_stated
from tmd.energy.plans import Choice, RankedPlan, Refusal, Step, why_lost
from tmd.language.clause import Clause
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits, Cube, Operator
from tmd.planning.eliminate import eliminate
from tmd.planning.result import Filled, GaveUp, Planner, Unreachable
from tmd.veil.instantiate import Instantiation, instantiate
from tmd.veil.library import Library
from tmd.veil.stated import stated
from tmd.veil.world import World

Sequence_ = tuple[Instruction, ...]
GENERATED = "policy"
"""The source of a sequence that was made from no demonstration."""
FEW = 20.0
"""The usual ``few`` of :class:`Inference`."""
_MOST_GOALS = 64
"""So many ways of fulfilling what a clause states are looked at."""
STATED = "planner"
"""The source of a sequence that the planner made for what the clause states."""


@dataclass(frozen=True, slots=True)
class Path:
    """A way through the clauses so far: its cost, where it ends, and the choices that make it."""

    energy: float
    state: Bits
    choices: tuple[Choice, ...] = ()


class Policy(Protocol):
    """A learned distribution over instruction sequences given the words of a clause: not in the paper."""

    def knows(self, verb: str) -> bool:
        """Whether it was learned from demonstrations with that verb."""
        ...

    def best(
        self, clause: Clause, earlier: Sequence[Clause], done: Sequence[Instruction], count: int
    ) -> Sequence[tuple[float, Sequence_]]:
        """The ``count`` likeliest sequences for a clause, each after its score, likeliest first."""
        ...

    def surprise(
        self,
        clause: Clause,
        earlier: Sequence[Clause],
        done: Sequence[Instruction],
        instructions: Sequence[Instruction],
    ) -> float:
        """The mean of -ln P over a sequence and its end, never negative."""
        ...


@dataclass(frozen=True, slots=True)
class _Candidate:
    """A trimmed instantiation: what it costs before the planner is asked, and the objects its clause speaks of.

    With a ``goal`` it has no instructions of its own: they are what the planner finds for it.
    """

    source: str
    instructions: Sequence_
    raw: dict[str, float]
    energy: float
    names: tuple[str, ...]
    goal: tuple[Cube, ...] = ()


@dataclass(frozen=True, slots=True)
class Inferred:
    """The outcome: plans, cheapest first, and the candidates that could not be executed."""

    plans: tuple[RankedPlan, ...]
    refusals: tuple[Refusal, ...]


class Inference:
    """Inference in one environment with one library.

    Args:
        world: The environment.
        library: The templates.
        energy: The factors, weighed.
        filler: The planner that finds what was left unsaid.
        beam: How many environments each α keeps; ``None`` keeps all, which is exact.
        trim: How many leading instructions may be trimmed; ``None`` is any number.
        top: How many plans are wanted; each α keeps as many ways to each environment.
        pair_nouns: The extension of :mod:`tmd.veil.instantiate`; without it the rules are the paper's own.
        knowledge: Whether the robot knows what its instructions need and do. Without it (*No Domain Knowledge*) every
            candidate counts as executable, nothing is added to it, and the environment stays as it was.
        policy: Proposes sequences of its own beside the templates, and judges all (Δ_words). It is not asked about a
            clause whose templates all have verbs that it does not know: then it is older than the library.
        generated: How many sequences of the policy are looked at for each clause and environment.
        plan_stated: Whether the planner proposes, beside the templates, the shortest way to what the clause states
            (:mod:`tmd.veil.stated`).
        few: Below how many templates in all the policy is trusted less than half: with n its word counts
            n / (n + ``few``), and its proposals are charged (n + ``few``) / n. What few demonstrations taught is
            better done as it was shown. 0 trusts it always.
        guess: Whether anything is proposed for a verb that has no templates.
        goal_filler: The planner for that way; ``filler`` where none is given.
        last_resort: Makes the planner that is asked for that way where that one gave up and nothing else leads there.
    """

    def __init__(
        self,
        world: World,
        library: Library,
        energy: Energy,
        filler: Planner,
        *,
        beam: int | None = 5,
        trim: int | None = None,
        top: int = 1,
        pair_nouns: bool = True,
        knowledge: bool = True,
        policy: Policy | None = None,
        generated: int = 5,
        plan_stated: bool = False,
        few: float = 0.0,
        guess: bool = True,
        goal_filler: Planner | None = None,
        last_resort: Callable[[], Planner] | None = None,
    ) -> None:
        self.world = world
        self.library = library
        self.energy = energy
        self.filler = filler
        self.beam = beam
        self.trim = trim
        self.top = top
        self.pair_nouns = pair_nouns
        self.knowledge = knowledge
        self.policy = policy
        self.generated = generated
        self.plan_stated = plan_stated
        self.few = few
        self.guess = guess
        self.goal_filler = goal_filler or filler
        self.last_resort = last_resort
        self._constraints: dict[Sequence_, tuple[Cube, ...]] = {}
        self._statements: dict[tuple[int, Bits], list[tuple[Cube, ...]]] = {}
        self._gave_up: set[int] = set()
        self._refused: dict[tuple[int, str, str], Refusal] = {}

    def infer(self, clauses: Sequence[Clause], state: Bits) -> Inferred:
        """The best plans for ``clauses`` from ``state``."""
        self._refused.clear()
        self._statements.clear()
        self._gave_up.clear()
        self._clauses = tuple(clauses)
        alpha = {state: [Path(0.0, state)]}
        for number, clause in enumerate(clauses):
            alpha = self._forward(number, clause, alpha)
        paths = sorted((path for ways in alpha.values() for path in ways), key=_order)
        plans = _distinct(paths, self.top)
        ranked = [plans[0], *(_explained(plan, plans[0]) for plan in plans[1:])] if plans else []
        return Inferred(tuple(ranked), tuple(self._refused.values()))

    def _forward(self, number: int, clause: Clause, alpha: dict[Bits, list[Path]]) -> dict[Bits, list[Path]]:
        """One step of Algorithm 1."""
        found: dict[Bits, list[Path]] = {}
        for bound, state, candidate in self._queue(number, clause, alpha):
            if self._settled(found, bound):
                break
            done = _instructions(alpha[state][0])
            reached = self._reach(number, clause, candidate, state, done)
            if reached is not None:
                _extend(found, alpha[state], *reached)
        self._resort(number, clause, alpha, found)
        if not found:
            nothing = Choice(None, (), {}, {})
            return {s: [Path(p.energy, s, (*p.choices, nothing)) for p in ways] for s, ways in alpha.items()}
        kept = {end: _cheapest(paths, self.top) for end, paths in found.items()}
        ends = sorted(kept, key=lambda end: _order(kept[end][0]))[: self.beam]
        return {end: kept[end] for end in ends}

    def _queue(
        self, number: int, clause: Clause, alpha: dict[Bits, list[Path]]
    ) -> list[tuple[float, Bits, _Candidate]]:
        """Every candidate in every state, by what it costs at least; the planner can only add to that."""
        queue = [
            (ways[0].energy + candidate.energy, state, candidate)
            for state, ways in alpha.items()
            for candidate in self._candidates(number, clause, state, _instructions(ways[0]))
        ]
        return sorted(queue, key=lambda item: item[0])

    def _settled(self, found: dict[Bits, list[Path]], bound: float) -> bool:
        """Whether no candidate that costs ``bound`` or more can enter the beam or the best plans any more.

        Without a beam every candidate counts; so it does where weights are negative, since then
        ``bound`` is none.
        """
        if self.beam is None:
            return False
        least = bound + self.energy.least_more()
        cheaper = [sum(path.energy < least for path in paths) for paths in found.values()]
        return sum(map(bool, cheaper)) >= self.beam and sum(cheaper) >= self.top

    def _reach(
        self, number: int, clause: Clause, candidate: _Candidate, state: Bits, done: Sequence_
    ) -> tuple[Choice, Bits] | None:
        """Ask the planner for what the candidate needs; ``None`` where it cannot be executed."""
        if not self.knowledge:
            steps = tuple(Step(i, number, latent=False) for i in candidate.instructions)
            return Choice(candidate.source, steps, self.energy.weigh(candidate.raw), candidate.raw), state
        operators = [self.world.task.by_instruction[i] for i in candidate.instructions]
        if candidate.goal:
            answer = self.goal_filler.fill(state, candidate.goal)
        else:
            answer = self.filler.fill(state, self._needs(candidate.instructions, operators))
        match answer:
            case Filled() if candidate.goal:
                return self._choice(number, clause, self._made(candidate, answer.plan), answer, state, done)
            case Filled():
                return self._choice(number, clause, candidate, answer, state, done)
            case Unreachable(reason):
                self._refuse(number, candidate.source, reason)
            case GaveUp(limit):
                if candidate.goal:
                    self._gave_up.add(number)
                self._refuse(number, candidate.source, f"the planner gave up at {limit}")
        return None

    def _made(self, candidate: _Candidate, plan: Sequence_) -> _Candidate:
        """A candidate with a goal, with what the planner found for it."""
        raw = {**candidate.raw, **self.energy.of_sequence(plan, len(plan), candidate.names)}
        return replace(candidate, instructions=plan, raw=raw)

    def _choice(
        self, number: int, clause: Clause, candidate: _Candidate, filled: Filled, state: Bits, done: Sequence_
    ) -> tuple[Choice, Bits]:
        latent, end = ((), state) if candidate.goal else (filled.plan, filled.state)
        for instruction in candidate.instructions:
            end = self.world.task.by_instruction[instruction].apply(end)
        steps = tuple(Step(i, number, latent=True) for i in latent)
        steps += tuple(Step(i, number, latent=False) for i in candidate.instructions)
        verb = self.library.lexicon.canonical_verb(clause.verb)
        raw = {
            **candidate.raw,
            **self.energy.of_end(verb, candidate.names, end),
            **self.energy.of_latent(latent, filled.state),
        }
        if self.plan_stated:
            raw["stated"] = delta_stated(self._stated(number, clause, state), end)
        if self.policy is not None and self._heard(clause):
            whole = (*latent, *candidate.instructions)
            surprise = self.policy.surprise(clause, self._clauses[:number], done, whole)
            raw["words"] = surprise * self._trust()
        return Choice(candidate.source, steps, self.energy.weigh(raw), raw), end

    def _resort(
        self, number: int, clause: Clause, alpha: dict[Bits, list[Path]], found: dict[Bits, list[Path]]
    ) -> None:
        """Ask the planner of last resort, once, for what the clause states, if no path leads there."""
        state, ways = min(alpha.items(), key=lambda item: _order(item[1][0]))
        if self.last_resort is None or number not in self._gave_up or self._is_stated(found):
            return
        for candidate in self._planned(number, clause, state):
            answer = self.last_resort().fill(state, candidate.goal)
            if not isinstance(answer, Filled):
                continue
            made = self._made(candidate, eliminate(answer.plan, self.world.task, state, candidate.goal))
            _extend(found, ways, *self._choice(number, clause, made, answer, state, _instructions(ways[0])))

    def _is_stated(self, found: dict[Bits, list[Path]]) -> bool:
        """Whether some path has done what its last clause states."""
        return any(not path.choices[-1].raw.get("stated") for ways in found.values() for path in ways)

    def _stated(self, number: int, clause: Clause, state: Bits) -> list[tuple[Cube, ...]]:
        """What the clause states, where the planner may propose for it."""
        if not self.plan_stated:
            return []
        key = number, state
        if key not in self._statements:
            self._statements[key] = stated(clause, self.world, state)
        return self._statements[key]

    def _planned(self, number: int, clause: Clause, state: Bits) -> list[_Candidate]:
        """For what the clause states whatever leads to it, all of it at once."""
        statements = self._stated(number, clause, state)
        if not statements:
            return []
        goal = tuple(
            Cube(either.positive | cube.positive, either.negative | cube.negative)
            for either in statements[0]
            for cube in (statements[1] if len(statements) > 1 else (Cube(),))
        )[:_MOST_GOALS]
        names = self.world.mentions.meant(clause, (), state)
        raw = {"generated": 1.0}
        return [_Candidate(STATED, (), raw, sum(self.energy.weigh(raw).values()), names, goal)]

    def _candidates(self, number: int, clause: Clause, state: Bits, done: Sequence_) -> list[_Candidate]:
        """The clause's templates, each distinct trimmed instantiation at its cheapest, and what others propose."""
        if not self.guess and not self.library.propose(clause):
            return []
        best: dict[tuple[Sequence_, tuple[str, ...]], _Candidate] = {}
        for template in self.library.propose(clause):
            instantiation = instantiate(template, clause, self.world, state, pair_nouns=self.pair_nouns)
            if instantiation is None:
                self._refuse(number, template.source, "there is no object for one of its variables")
                continue
            first = self._first_possible(number, template.source, instantiation.instructions) if self.knowledge else 0
            for candidate in self._trimmings(instantiation, clause, state, first):
                key = candidate.instructions, candidate.names
                if key not in best or candidate.energy < best[key].energy:
                    best[key] = candidate
        return [*best.values(), *self._generated(number, clause, state, done), *self._planned(number, clause, state)]

    def _generated(self, number: int, clause: Clause, state: Bits, done: Sequence_) -> list[_Candidate]:
        """The sequences that the policy proposes, without what can never be done here."""
        if self.policy is None or not self._heard(clause):
            return []
        found: dict[Sequence_, _Candidate] = {}
        charge = 1.0 / self._trust()
        for _, proposed in self.policy.best(clause, self._clauses[:number], done, self.generated):
            kept = tuple(i for i in proposed if i in self.world.task.by_instruction)
            names = self.world.mentions.meant(clause, [a for i in kept for a in i.args], state)
            raw = {"generated": charge, **self.energy.of_sequence(kept, len(kept), names)}
            energy = sum(self.energy.weigh(raw).values())
            found.setdefault(kept, _Candidate(GENERATED, kept, raw, energy, names))
        return list(found.values())

    def _heard(self, clause: Clause) -> bool:
        """Whether the policy knows the verb of one of the clause's templates, or the clause has none."""
        templates = self.library.propose(clause)
        verbs = dict.fromkeys(template.clause.verb for template in templates)
        return not verbs or any(self.policy is not None and self.policy.knows(verb) for verb in verbs)

    def _trust(self) -> float:
        """How far the policy is trusted, above 0 and up to 1."""
        known = max(len(self.library), 1)
        return known / (known + self.few)

    def _first_possible(self, number: int, source: str, instructions: Sequence_) -> int:
        """The first t for which nothing in I[t..] is impossible in this environment."""
        for t in range(len(instructions) - 1, -1, -1):
            if instructions[t] not in self.world.task.by_instruction:
                self._refuse(number, source, f"{instructions[t]} can never be done here")
                return t + 1
        return 0

    def _trimmings(self, instantiation: Instantiation, clause: Clause, state: Bits, first: int) -> list[_Candidate]:
        """I[t..] for every t from ``first`` on that is allowed, with its factors weighed."""
        whole = instantiation.instructions
        fixed = self.energy.of_template(instantiation, clause)
        names = self.world.mentions.meant(clause, instantiation.grounding.values(), state)
        most = len(whole) if self.trim is None else min(self.trim, len(whole))
        found = []
        for t in range(first, most + 1):
            raw = {**fixed, **self.energy.of_sequence(whole[t:], len(whole), names)}
            energy = sum(self.energy.weigh(raw).values())
            found.append(_Candidate(instantiation.template.source, whole[t:], raw, energy, names))
        return found

    def _needs(self, instructions: Sequence_, operators: Sequence[Operator]) -> tuple[Cube, ...]:
        """The constraints of a sequence; those of its tails are kept as well, since tails are asked for next."""
        if instructions not in self._constraints:
            for t, cubes in enumerate(get_constraints(operators)):
                self._constraints[instructions[t:]] = cubes
        return self._constraints[instructions]

    def _refuse(self, number: int, source: str, reason: str) -> None:
        self._refused.setdefault((number, source, reason), Refusal(number, source, reason))


def _extend(found: dict[Bits, list[Path]], ways: Sequence[Path], choice: Choice, end: Bits) -> None:
    """Take up a choice behind each of ``ways``."""
    found.setdefault(end, []).extend(Path(p.energy + choice.energy, end, (*p.choices, choice)) for p in ways)


def _order(path: Path) -> tuple[float, tuple[Instruction, ...]]:
    """Cheapest first; ties in the order of the instructions, so that the ranking is the same everywhere."""
    return path.energy, _instructions(path)


def _instructions(path: Path) -> tuple[Instruction, ...]:
    return tuple(step.instruction for choice in path.choices for step in choice.steps)


def _cheapest(paths: Sequence[Path], count: int) -> list[Path]:
    """The ``count`` cheapest paths that differ in what is done."""
    seen: set[tuple[Instruction, ...]] = set()
    kept: list[Path] = []
    for path in sorted(paths, key=_order):
        done = _instructions(path)
        if done not in seen:
            seen.add(done)
            kept.append(path)
        if len(kept) == count:
            break
    return kept


def _distinct(paths: Sequence[Path], count: int) -> list[RankedPlan]:
    return [RankedPlan(path.choices, path.state) for path in _cheapest(paths, count)]


def _explained(plan: RankedPlan, best: RankedPlan) -> RankedPlan:
    return RankedPlan(plan.choices, plan.state, why_lost(plan, best))
