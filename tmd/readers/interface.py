"""The boundary between reading a request and planning for it.

A :class:`Reader` turns a request into a :class:`Dialogue`: ordered steps, each with candidate goals in the state that
the steps before it lead to, and constraints on the whole plan. Inference (:mod:`tmd.inference`) sees nothing else of
the request: no words, no grammar.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Protocol

from tmd.diagnostics import Refusal as Refusal  # part of the interface
from tmd.pddl.model import Formula, Instruction
from tmd.pddl.task import Bits, Cube
from tmd.world.verb_clause import VerbClause

if TYPE_CHECKING:
    from tmd.language.clause import Parsed
    from tmd.world.world import World


@dataclass(frozen=True, slots=True)
class Step:
    """One unit of an interpretation: something to be brought about.

    Attributes:
        clause: The verb clause, with the text that it covers.
        number: The index in :attr:`Dialogue.clauses` of the clause that the step belongs to.
        main: Whether the step is that clause itself. Templates and policy propose sequences only for main steps, not
            for what the clause presupposes or is followed by: *after taking the cup out*.
        direct: The language-objects that the verb acts on.
        jointly: Whether the goal must hold together with the other goals of the same clause; that of a main step with
            those of the clause before: *close it, but leave it open* is refused.
        continued: Whether the next clause goes on with what this step acts on.
    """

    clause: VerbClause
    number: int
    main: bool = True
    direct: tuple[str, ...] = ()
    jointly: bool = False
    continued: bool = False

    @property
    def text(self) -> str:
        """The text that the step covers, on one line."""
        return " ".join(self.clause.text.split())


@dataclass(frozen=True, slots=True)
class CandidateGoal:
    """A goal that a step may have.

    Attributes:
        formula: The condition over ground atoms that must hold when the step is done.
        cubes: The formula as a disjunction of conjunctions.
        log_prior: The natural logarithm of the reader's belief in this candidate. It is a factor of the energy.
        via: Conditions that must hold on the way, in this order: *in the microwave*.
        released: Objects whose earlier goals need not be kept. What is poured leaves its vessel.
        bindings: For each noun phrase, the objects that it may mean.
        source: The kind of knowledge that it comes from: ``declared``, ``learned``, ``actions`` or ``model``.
        explanation: The lexicon row, demonstration or action that it was derived from, or the model's own words.
        notes: Parts of the text that the goal ignores.
    """

    formula: Formula
    cubes: tuple[Cube, ...]
    log_prior: float = 0.0
    via: tuple[Formula, ...] = ()
    released: tuple[str, ...] = ()
    bindings: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    source: str = ""
    explanation: str = ""
    notes: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class StepGoals:
    """The candidate goals of a step in one state.

    Attributes:
        goals: The candidates, the likeliest first; empty where nothing is to be done.
        memory: What the reader needs to know at the next step. Inference passes it on.
        note: Why nothing is to be done.
        keeps: Conditions that must hold at the end of this and every later step.
    """

    goals: tuple[CandidateGoal, ...]
    memory: object = None
    note: str = ""
    keeps: tuple[Formula, ...] = ()


@dataclass(frozen=True, slots=True)
class PlanConstraints:
    """Conditions on the whole plan.

    Attributes:
        never: Conditions that no instruction may bring about.
        kept: Conditions that must hold at the end of every step.
        untouched: Objects that no instruction may name.
    """

    never: tuple[Formula, ...] = ()
    kept: tuple[Formula, ...] = ()
    untouched: frozenset[str] = frozenset()


@dataclass(frozen=True, slots=True)
class QuestionOption:
    """An answer to a question: a candidate goal of the step that the question is about."""

    answer: str
    formula: Formula


@dataclass(frozen=True, slots=True)
class Question:
    """A question to the user: two readings of a step differ, and neither is much likelier.

    Attributes:
        step: The index of the step in :attr:`Dialogue.steps`.
        options: The answers, the likeliest first.
        taken: The index of the option that the plans are for, where nobody answered.
    """

    text: str
    step: int
    options: tuple[QuestionOption, ...]
    taken: int = 0


@dataclass(frozen=True, slots=True)
class Usage:
    """The effort of a language model for one request.

    Attributes:
        prompt_tokens: Tokens that were sent, as the server counts them.
        completion_tokens: Tokens that were received.
        seconds: Time spent waiting for the server.
        cached: The number of replies that came from the cache.
        corrections: How often a reply was sent back with an error.
        digests: The digests of the replies, in order; they name the files of the cache.
        thoughts: The model's own explanation of its reading.
    """

    model: str
    prompt_tokens: int = 0
    completion_tokens: int = 0
    seconds: float = 0.0
    cached: int = 0
    corrections: int = 0
    digests: tuple[str, ...] = ()
    thoughts: str = ""

    def plus(self, other: Usage) -> Usage:
        """Return the effort with that for further replies of the same model."""
        return replace(
            self,
            prompt_tokens=self.prompt_tokens + other.prompt_tokens,
            completion_tokens=self.completion_tokens + other.completion_tokens,
            seconds=self.seconds + other.seconds,
            cached=self.cached + other.cached,
            digests=self.digests + other.digests,
        )


@dataclass(frozen=True, slots=True)
class HandledGroup:
    """Objects that a demonstrated sequence must handle to count as an answer to a clause: one of them, or every one."""

    names: frozenset[str]
    every: bool = False


class Dialogue:
    """A request as it was read, in one environment. This class knows the clauses only, and no goals.

    Args:
        parsed: The clauses, and the pieces of text that none of them covers.

    Attributes:
        clauses: The verb clauses in the order of the text, for templates and factors.
        steps: The steps in the order of doing.
        memory: The memory before the first step.
        refusal: Why the request as a whole has no plan; ``None`` where it may have one.
        question: A question that the reader itself wants to be answered.
        notes: Warnings about the reading as a whole.
        usage: The effort of the language model; ``None`` where none was asked.
    """

    steps: Sequence[Step] = ()
    constraints: PlanConstraints = PlanConstraints()
    memory: object = None
    refusal: Refusal | None = None
    question: Question | None = None
    notes: Sequence[str] = ()
    usage: Usage | None = None

    def __init__(self, parsed: Parsed) -> None:
        self.parsed = parsed
        self.clauses: Sequence[VerbClause] = parsed.clauses

    @property
    def asks(self) -> bool:
        """Return whether something is asked for, so that a plan without instructions may be an answer."""
        return bool(self.clauses) or any(not (c.result or c.implied) for c in self.parsed.constraints)

    def goals(self, step: Step, state: Bits, memory: object) -> StepGoals | Refusal:
        """Return the candidate goals of a step that begins in ``state``."""
        return StepGoals((), memory)

    def reached(self, goal: CandidateGoal, state: Bits, memory: object) -> object:
        """Return the memory after a step that reached ``goal`` in ``state``."""
        return memory

    def handled(self, step: Step) -> Sequence[HandledGroup] | None:
        """Return what a demonstrated sequence for a step without a goal must handle; ``None`` where none would do."""
        return None


class Reader(Protocol):
    """A reader of requests."""

    def begin(self, request: str, world: World, state: Bits) -> Dialogue:
        """Read a request that is made in ``state``.

        Raises:
            TmdError: The reader cannot work: its server is not reached, or a file of the domain is wrong.
        """
        ...

    def objection(self, dialogue: Dialogue, plan: Sequence[Instruction], world: World) -> str | None:
        """Return why a plan that reaches all goals is not what was asked; ``None`` where nothing speaks against it."""
        ...

    def revise(self, dialogue: Dialogue, reason: str) -> Dialogue | None:
        """Read the request of ``dialogue`` once more, knowing why it has no plan or why its plan is not acceptable.

        Returns:
            The new reading; ``None`` where the reader has nothing else to offer.
        """
        ...
