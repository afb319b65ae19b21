"""The language model as a reader.

The model proposes steps with PDDL goals. Every formula is checked (:mod:`tmd.readers.llm.checking`). Faults go back to
the model, and so do goals that are proven unreachable, at most :data:`MOST_CORRECTIONS` times. After that the request
is refused.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from tmd.diagnostics import Refusal, RefusalKind, TmdError
from tmd.language.clause import Parsed
from tmd.language.lexicon.lexicon import Lexicon
from tmd.pddl.model import Formula, Instruction
from tmd.pddl.semantics import holds
from tmd.pddl.task import Bits
from tmd.readers.interface import Dialogue, Step, StepGoals, Usage
from tmd.readers.llm.checking import ModelReading, ModelStep, ReplyChecker
from tmd.readers.llm.client import ModelClient, ModelSettings
from tmd.readers.llm.prompt import Prompt, changes, filled, one_line, prompt_for
from tmd.readers.llm.reply import Judgement, Reply, parse_reply, schema_of
from tmd.world.corpus import Corpus
from tmd.world.sentence_file import SUFFIX, SentenceTest, read_sentences
from tmd.world.world import World

# How often a model may correct its reading of a request.
MOST_CORRECTIONS = 2
# Maximum number of faults that are sent back at a time.
_MOST_FAULTS = 8


def llm_reader(corpus: Corpus, settings: ModelSettings, *, verify: bool = False) -> LLMReader:
    """Return a reader for a domain, with its sentence tests as examples.

    Raises:
        ModelError: There is no model, or no key for a server that needs one.
        TmdError: A file of sentence tests is wrong.
    """
    tests = [t for path in sorted(corpus.directory.glob(f"*{SUFFIX}")) for t in read_sentences(path)]
    return LLMReader(ModelClient(settings), corpus.lexicon, tests, verify=verify)


class LLMReader:
    """A reader that asks a language model.

    ``examples`` are requests of the domain with their goals. With ``verify`` the model is asked once more whether a
    plan does what was asked.
    """

    def __init__(
        self, client: ModelClient, lexicon: Lexicon, examples: Sequence[SentenceTest] = (), *, verify: bool = False
    ) -> None:
        self._client = client
        self._lexicon = lexicon
        self._examples = tuple(examples)
        self._verify = verify

    def begin(self, request: str, world: World, state: Bits) -> LLMDialogue:
        """Read a request that is made in ``state``.

        Raises:
            ModelError: The model cannot be asked, or gives no answer.
            MissingToolError: The package ``openai`` is not installed.
        """
        prompt = self.prompt(request, world, state)
        messages = ({"role": "system", "content": prompt.system}, _user(prompt.user))
        return self._read(request, world, prompt, messages, Usage(self._client.model))

    def prompt(self, request: str, world: World, state: Bits) -> Prompt:
        """Return the prompt for a request that is made in ``state``."""
        return prompt_for(request, world, state, self._lexicon, self._examples)

    def objection(self, dialogue: Dialogue, plan: Sequence[Instruction], world: World) -> str | None:
        """Return why the model thinks that a plan is not what was asked; ``None`` where it agrees or is not asked.

        Raises:
            ModelError: As :meth:`begin`.
        """
        if not self._verify or not isinstance(dialogue, LLMDialogue):
            return None
        added, deleted = changes(world, plan)
        text = filled(
            "verify",
            domain_text=dialogue.prompt.domain,
            environment_text=dialogue.prompt.environment,
            plan=" ".join(instruction.pddl() for instruction in plan) or "no action",
            added=added,
            deleted=deleted,
            request=one_line(dialogue.parsed.text),
        )
        answer, usage = self._client.complete([_user(text)], "judgement", schema_of(Judgement))
        dialogue.usage = dialogue.usage.plus(usage)
        try:
            judgement = parse_reply(Judgement, answer)
        except TmdError as error:
            dialogue.rejected = True
            return f"the plan could not be verified: {error.message}"
        dialogue.rejected = not judgement.correct
        return (one_line(judgement.reason)[:300] or "no reason was given") if dialogue.rejected else None

    def revise(self, dialogue: Dialogue, reason: str) -> LLMDialogue | None:
        """Ask the model for another reading, with the reason why the last one has no acceptable plan.

        Raises:
            ModelError: As :meth:`begin`.
        """
        assert isinstance(dialogue, LLMDialogue)
        if dialogue.usage.corrections >= MOST_CORRECTIONS:
            return None
        section = "objection" if dialogue.rejected else "unreachable"
        messages = (*dialogue.messages, _user(filled(section, reason=one_line(reason))))
        usage = replace(dialogue.usage, corrections=dialogue.usage.corrections + 1)
        return self._read(dialogue.parsed.text, dialogue.world, dialogue.prompt, messages, usage)

    def _read(
        self, request: str, world: World, prompt: Prompt, messages: tuple[Mapping[str, str], ...], usage: Usage
    ) -> LLMDialogue:
        """Ask, and send faults back until there are none or no more corrections are left."""
        checker = ReplyChecker(request, world)
        while True:
            answer, effort = self._client.complete(messages, "reading", schema_of(Reply))
            usage = usage.plus(effort)
            try:
                found = checker.read(parse_reply(Reply, answer))
            except TmdError as error:
                found = [error.message, *([error.hint] if error.hint else [])]
                answer = answer[:2000]
            messages = (*messages, {"role": "assistant", "content": answer})
            if isinstance(found, ModelReading):
                return LLMDialogue(found, world, prompt, messages, replace(usage, thoughts=found.thoughts))
            if usage.corrections >= MOST_CORRECTIONS:
                message = f"the model's reading cannot be used: {found[0]}"
                refusal = Refusal(RefusalKind.NOT_UNDERSTOOD, message, "say it in other words, or use another model")
                reading = ModelReading(Parsed(request, ()), refusal=refusal)
                return LLMDialogue(reading, world, prompt, messages, usage)
            faults = "\n".join(f"- {one_line(fault)}" for fault in found[:_MOST_FAULTS])
            messages = (*messages, _user(filled("correction", faults=faults)))
            usage = replace(usage, corrections=usage.corrections + 1)


@dataclass(frozen=True, slots=True)
class _Guard:
    """The last guard, and whether it held.

    Attributes:
        of: The guard of the step before, after whether that was an *otherwise*; ``None`` where it had none.
        held: Whether it held when it was evaluated.
    """

    of: tuple[bool, Formula] | None = None
    held: bool = False


class LLMDialogue(Dialogue):
    """A request as a language model read it."""

    asks = True  # a request that asks for nothing is refused

    def __init__(
        self,
        reading: ModelReading,
        world: World,
        prompt: Prompt,
        messages: tuple[Mapping[str, str], ...],
        usage: Usage,
    ) -> None:
        super().__init__(reading.parsed)
        self.steps, self.constraints = reading.steps, reading.constraints
        self.refusal, self.question, self.notes = reading.refusal, reading.question, prompt.notes
        self.memory = _Guard()
        self.usage: Usage = usage
        self.world = world
        self.prompt = prompt
        self.messages = messages
        self.rejected = False  # whether the model rejects the plan for this reading

    def goals(self, step: Step, state: Bits, memory: object) -> StepGoals | Refusal:
        """Return the candidate goals of a step, if its guard holds in ``state``."""
        assert isinstance(step, ModelStep) and isinstance(memory, _Guard)
        if step.when is None and not step.otherwise:
            return StepGoals(step.candidates, _Guard())
        own = None if step.when is None else (step.otherwise, step.when)
        shared = own is not None and own == memory.of  # steps that share a guard share its evaluation
        if step.otherwise and not shared and memory.held:
            return StepGoals((), memory, "the condition before it held")
        if own is not None and not shared:
            memory = _Guard(own, holds(own[1], self.world.task.decode(state), self.world.objects))
        if own is not None and not memory.held:
            return StepGoals((), memory, "the condition does not hold")
        return StepGoals(step.candidates, memory)


def _user(text: str) -> Mapping[str, str]:
    return {"role": "user", "content": text}
