"""A domain as programs use it: texts grounded, plans carried out, demonstrations learned from, sentences tested."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import cache, cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from tmd.diagnostics import OptionError, TmdError
from tmd.ground import Ask
from tmd.ground import ground as ground_text
from tmd.grounded import Grounded
from tmd.inference.config import DEFAULT, preset
from tmd.inference.energy import FIXED, NAMES, Weights, named_weights, parse_weights, read_weights, title
from tmd.knowledge import Knowledge, known
from tmd.language.lexicon.lexicon import Lexicon
from tmd.pddl.model import Instruction, Problem
from tmd.pddl.reading.reader import with_goal
from tmd.pddl.reading.syntax import nearest
from tmd.pddl.validator import validate
from tmd.planning.backends import IN_PROCESS
from tmd.readers.interface import Reader
from tmd.world.corpus import Corpus, is_environment_file
from tmd.world.folder import DomainFolder
from tmd.world.world import World

if TYPE_CHECKING:
    from tmd.evaluation.sentence_tests import SentenceResult
    from tmd.readers.llm.client import ModelError, ModelSettings
    from tmd.records.run import RecordedRun
    from tmd.robot.monitor.listeners import Order
    from tmd.robot.skills.reachability_report import SceneSurvey
    from tmd.studio.server import Server
    from tmd.world.sentence_file import SentenceTest

# The readers by name.
RULES, LLM = READERS = ("rules", "llm")
# The weights that :meth:`DomainKit.learn` saved.
LEARNED = "learned"
# The name of a bundled environment, an environment file (YAML) or PDDL problem, or what was made of one before.
Place: TypeAlias = str | Path | World


class DomainKit:
    """A domain folder with its environments, and with what its demonstrations teach.

    Make it with :func:`load_domain`.
    """

    def __init__(self, corpus: Corpus, learned: Path | None = None) -> None:
        self._corpus = corpus
        self._learned = learned
        self._readers: dict[tuple[ModelSettings, bool], Reader] = {}

    def __repr__(self) -> str:
        return f"<DomainKit {self.name}>"

    @property
    def name(self) -> str:
        """The name of the domain."""
        return self._corpus.folder.name

    def environments(self) -> list[str]:
        """Return the names of its bundled environments, sorted."""
        return self._corpus.environments()

    @property
    def lexicon(self) -> Lexicon:
        """The built-in words with those of the domain, for ``tmd.parse(text, kit.lexicon)``."""
        return self._corpus.lexicon

    def problem(self, environment: Place, goal: str | None = None) -> Problem:
        """Return an environment as a PDDL problem.

        Args:
            environment: Its name or file.
            goal: A condition, such as ``(contains cup1 water)``; without it the goal is empty.

        Raises:
            TmdError: There is no such environment, or it or the goal is wrong.
        """
        problem = self._world(environment).task.problem
        return problem if goal is None else with_goal(problem, goal, "goal")

    def ground(
        self,
        text: str,
        environment: Place,
        *,
        top: int = 1,
        planner: str = IN_PROCESS,
        model: str = DEFAULT,
        guess: bool = False,
        weights: str | Path | Mapping[str, float] | None = None,
        beam: int | None = None,
        trim: int | None = None,
        reader: Reader | str = RULES,
        llm: ModelSettings | None = None,
        verify: bool = False,
        ask: Ask | None = None,
    ) -> Grounded:
        """Ground a text in an environment, as ``tmd ground`` does.

        Args:
            text: What the person said.
            environment: Its name or file.
            top: How many distinct plans are wanted.
            planner: Which planner fills in what was left unsaid.
            model: What is minimised; the models are those of ``tmd ground --model``.
            guess: Whether a plan may be made where what was said is not understood or cannot be done.
            weights: The factors' weights, by name or file, or ``learned``; the model's own by default, or with other
                numbers for some factors: ``{"description length": 2.0}``.
            beam: How many states to follow from clause to clause, 0 for all; what the model says by default.
            trim: How many leading instructions of a template may be dropped; what the model says by default.
            reader: ``rules``, the offline reader of grammar and lexicon; ``llm``, a language model; or a reader of
                your own.
            llm: How the language model is reached; by default as the environment variables say.
            verify: Whether the language model is asked once more whether the plan does what was asked.
            ask: Asks the user where two readings differ; without it the likeliest is taken.

        Returns:
            The clauses that were understood, the plans (cheapest first), what the validator says of each, and what of
            the text could not be used.

        Raises:
            OptionError: The request is not a text, or a number is too small.
            TmdError: There is no such environment, planner, model or weights, or a file of the domain is wrong.
        """
        if not isinstance(text, str):
            raise OptionError(
                f"the request is {text!r}, not a text", hint='write kit.ground("Take the cup.", environment)'
            )
        for name, number, least in (("top", top, 1), ("beam", beam, 0), ("trim", trim, 0)):
            if number is not None and number < least:
                raise OptionError(f"{name} is {number}", hint=f"it is at least {least}")
        config = replace(preset(model), guess=guess)
        if beam is not None:
            config = replace(config, beam=beam or None)
        if trim is not None:
            config = replace(config, trim=trim)
        return ground_text(
            text,
            self._world(environment),
            self._knowledge.library,
            None if weights is None else self._weights(weights, config.weights),
            reward=self._knowledge.reward,
            goals=self._knowledge.goals,
            config=config,
            planner=planner,
            top=top,
            reader=self.reader(reader, llm, verify=verify) if isinstance(reader, str) else reader,
            ask=ask,
        )

    def reader(self, name: str, llm: ModelSettings | None = None, *, verify: bool = False) -> Reader | None:
        """Return the reader of a name; ``None`` for the offline reader, which :meth:`ground` makes for each request.

        Args:
            name: ``rules`` or ``llm``.
            llm: How the language model is reached; by default as the environment variables say.
            verify: Whether the language model is asked once more whether a plan does what was asked.

        Raises:
            TmdError: There is no such reader; or there is no model, or no key for a server that needs one.
        """
        if name not in READERS:
            raise TmdError(f"there is no reader '{name}'", hint=nearest(name, READERS, what="readers"))
        if name == RULES:
            if llm is not None or verify:
                raise OptionError("llm and verify are for the reader 'llm'", hint="give reader='llm'")
            return None
        from tmd.readers.llm.client import ModelSettings
        from tmd.readers.llm.reader import llm_reader

        key = llm or ModelSettings(), verify
        if key not in self._readers:
            self._readers[key] = llm_reader(self._corpus, key[0], verify=verify)
        return self._readers[key]

    def run_plan(
        self,
        plan: Grounded | Iterable[Instruction],
        environment: str | Path,
        *,
        kinematic: bool = False,
        seed: int = 0,
        planner: str = IN_PROCESS,
        repairs: int = 6,
        video: str | Path | None = None,
        strip: str | Path | None = None,
        trajectory: str | Path | None = None,
        explain: str | Path | None = None,
        rate: float = 10.0,
        robot: str = "pr2",
        urdf: str | Path | None = None,
        gui: bool = False,
    ) -> RecordedRun:
        """Let a simulated PR2 carry out a plan, each effect checked, as ``tmd run`` does.

        Args:
            plan: The instructions, or a text that was grounded, of which the best plan is taken.
            environment: The name of a bundled environment, or an environment file (YAML).
            kinematic: Set joints along their paths instead of driving motors: faster, less realistic.
            seed: Random seed; 0 leaves all things exactly where they are said to be.
            planner: Replans where the state that was observed is not the predicted one.
            repairs: Maximum number of replannings.
            video: Where a film goes, an MP4 or GIF file.
            strip: Where a sheet with one picture for each instruction goes, a PNG file.
            trajectory: Where joints, base and things are recorded: a .jsonl or .mcap (ROS 2) file.
            explain: Where a page with pictures of what failed and why goes, an HTML file.
            rate: Samples of that a second of simulated time.
            robot: ``pr2`` or ``tiago_pro``.
            urdf: Another PR2 or TIAGo Pro than the packaged one.
            gui: Open a window, and go no faster than real time.

        Returns:
            How it ended, with every step, and the record that ``tmd run --json`` prints.

        Raises:
            MissingToolError: What simulates or films is not installed.
            OutputError: Film or sheet cannot be written.
            TmdError: The plan does not work, or the domain has no skills or no shapes.
        """
        from tmd.records.run import RecordedRun, RunRecord
        from tmd.robot.monitor.listeners import Order
        from tmd.robot_trials.plan_runner import PlanRunner, StepRecorder
        from tmd.world.environment import load_room

        file = self._corpus.file(environment)
        room, problem = load_room(file), self.problem(environment)
        text = plan.parsed.text if isinstance(plan, Grounded) else ""
        orders = orders_of(plan) if isinstance(plan, Grounded) else list(map(Order, plan))
        verdict = validate(problem, [order.instruction for order in orders])
        if not verdict.valid:
            raise TmdError(f"the plan does not work: {verdict.reason}")
        recorder = StepRecorder()
        with PlanRunner(
            room,
            self._corpus.folder,
            problem,
            kinematic=kinematic,
            seed=seed,
            planner=planner,
            repairs=repairs,
            video=_path(video),
            strip=_path(strip),
            trajectory=_path(trajectory),
            explain=_path(explain),
            rate=rate,
            robot=None if urdf else robot,
            urdf=_path(urdf),
            gui=gui,
        ) as runner:
            run = runner.run(orders, lambda _: (recorder,), room.name, text)
        given = str(file) if is_environment_file(environment) else None
        asked = runner.request(orders, text or None, environment_file=given, grounding=None)
        return RecordedRun(run.execution, RunRecord.of(asked, recorder.steps, run.execution, run.sim_steps))

    def survey_scene(
        self,
        environment: str | Path,
        *,
        reach: bool = False,
        seed: int = 0,
        robot: str = "pr2",
        urdf: str | Path | None = None,
        picture: str | Path | None = None,
    ) -> SceneSurvey:
        """Build the robot's room of an environment and say what stands where, as ``tmd scene`` does.

        See :func:`tmd.robot.skills.reachability_report.survey_scene` for arguments and errors.
        """
        from tmd.robot.pr2.urdf import packaged_robot
        from tmd.robot.skills.reachability_report import survey_scene
        from tmd.world.environment import load_room

        return survey_scene(
            load_room(self._corpus.file(environment)),
            self._corpus.folder,
            reach=reach,
            seed=seed,
            urdf=_path(urdf) or packaged_robot(robot),
            picture=_path(picture),
        )

    def learn(self, out: str | Path | None = None, *, weights: bool = True, seed: int = 0) -> Path:
        """Learn from the demonstrations, and save it where texts are grounded with it, as ``tmd learn`` does.

        Args:
            out: Save in its directory of the domain's name; where this kit looks by default.
            weights: Learn weights of the factors as well, which takes by far the longest.
            seed: Random seed of the weights.

        Returns:
            Where it was saved.

        Raises:
            TmdError: There are no demonstrations, one is wrong, or it cannot be saved.
        """
        from tmd.evaluation.learn import learn_domain

        found = learn_domain(self._corpus, _path(out) or self._learned, weights=weights, seed=seed)
        self.__dict__["_knowledge"] = found.knowledge
        return found.directory

    def run_sentence_tests(
        self,
        tests: Iterable[SentenceTest] | None = None,
        *,
        model: str = DEFAULT,
        guess: bool = False,
        reader: Reader | str = RULES,
        llm: ModelSettings | None = None,
        verify: bool = False,
        jobs: int = 1,
    ) -> list[SentenceResult]:
        """Run sentence tests, as ``tmd test`` does.

        Args:
            tests: What :func:`read_sentences` read; those of the domain by default.
            model: As for :meth:`ground`.
            guess: As for :meth:`ground`.
            reader: As for :meth:`ground`; with more than one job, its name.
            llm: As for :meth:`ground`.
            verify: As for :meth:`ground`.
            jobs: The number of processes.

        Returns:
            What became of each; ``.outcome.passed`` says whether that is right.

        Raises:
            TmdError: There are no tests, or one names what is not there; with its place.
            ModelError: The language model cannot be asked. Where that may pass, all other tests are run first.
        """
        from tmd.evaluation.runs.backends import in_processes
        from tmd.readers.llm.client import ModelError
        from tmd.world.sentence_file import domain_sentences

        chosen = list(domain_sentences(self._corpus.directory) if tests is None else tests)
        options = {"model": model, "guess": guess, "reader": reader, "llm": llm, "verify": verify}
        if jobs == 1:
            results = [self._judged(test, options) for test in chosen]
        else:
            place = self._corpus.folder, self._corpus.directory, self._learned
            tasks = [(place, number, test, options) for number, test in enumerate(chosen)]
            found = dict(in_processes(_judged_elsewhere, tasks, jobs))
            results = [found[number] for number in range(len(chosen))]
        unread = [result for result in results if isinstance(result, TmdError)]
        if unread:
            message = f"{len(unread)} of {len(chosen)} requests were not read: {unread[0].message}"
            raise ModelError(message, hint="run the command again: replies that came are kept", passing=True)
        return [result for result in results if not isinstance(result, TmdError)]

    def _judged(self, test: SentenceTest, options: Mapping[str, Any]) -> SentenceResult | ModelError:
        """Run a sentence test; a failure of the language model that may pass does not end the others."""
        from tmd.evaluation.sentence_tests import judge
        from tmd.readers.llm.client import ModelError

        try:
            problem = self.problem(test.environment)
        except TmdError as error:
            raise TmdError(f"'{test.id}': {error.message}", location=test.location, hint=error.hint) from None
        try:
            grounded = self.ground(test.text, test.environment, **options)
        except ModelError as error:
            if error.passing:
                return error
            raise
        return judge(test, grounded, problem)

    def open_studio(
        self, environment: str | Path | None = None, *, host: str = "127.0.0.1", port: int = 8080
    ) -> Server:
        """Open a studio, as ``tmd studio`` does: ``.url`` is where, ``.serve()`` waits, ``.close()`` ends it.

        Args:
            environment: Where visitors come to first; the first one by default.
            host: Where to listen. Whoever reaches it can see the studio, and save demonstrations.
            port: 0 takes a free one.

        Raises:
            MissingToolError: viser is not installed.
            TmdError: The port is in use, or the environment or a demonstration is wrong.
        """
        from tmd.studio.server import Server
        from tmd.studio.studio import Studio
        from tmd.studio.teaching import Teacher

        path = None if environment is None else self._corpus.file(environment)
        return Server(Studio(self._corpus, Teacher(self._corpus, self._learned), path), host, port)

    @cached_property
    def _knowledge(self) -> Knowledge:
        """The knowledge of the demonstrations."""
        return known(self._corpus, self._learned)

    def _weights(self, given: str | Path | Mapping[str, float], own: str) -> Weights:
        if isinstance(given, Mapping):
            names = {title(name): name for name in (*NAMES, *FIXED)}
            lines = "\n".join(f"{names.get(name, name).replace(' ', '_')} {value}" for name, value in given.items())
            return Weights({**named_weights(own).values, **parse_weights(lines, "weights").values})
        if given != LEARNED:
            path = Path(given)
            return read_weights(path) if path.suffix or path.is_file() else named_weights(str(given))
        if self._knowledge.weights is None:
            raise TmdError(
                f"there are no learned weights of '{self.name}' that its demonstrations still bear out",
                hint=f"run tmd learn {self.name}",
            )
        return self._knowledge.weights

    def _world(self, environment: Place) -> World:
        return environment if isinstance(environment, World) else self._corpus.world(environment)


@cache
def _kit_at(folder: DomainFolder, directory: Path, learned: Path | None) -> DomainKit:
    return DomainKit(Corpus(folder, directory), learned)


def _judged_elsewhere(
    place: tuple[DomainFolder, Path, Path | None], number: int, test: SentenceTest, options: Mapping[str, Any]
) -> tuple[int, SentenceResult | ModelError]:
    """Run a sentence test in a process of its own; the kit is made once for each process."""
    return number, _kit_at(*place)._judged(test, options)


def _path(given: str | Path | None) -> Path | None:
    return Path(given) if given else None


def orders_of(grounded: Grounded) -> list[Order]:
    """Return the best plan of a text as what the robot is to do, each instruction with the words that it serves.

    Raises:
        TmdError: The text has no plan that works.
    """
    from tmd.robot.monitor.listeners import Order

    if grounded.reason:
        raise TmdError(f"there is no plan: {grounded.reason}")
    clauses = [" ".join(clause.text.split()) for clause in grounded.parsed.clauses]
    return [Order(s.instruction, s.clause, s.latent, clauses[s.clause]) for s in grounded.plans[0].steps]
