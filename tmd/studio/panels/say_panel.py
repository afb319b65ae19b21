"""The panel where a visitor says what is to be done, and sees what was understood, and the ranked plans."""

from __future__ import annotations

import os
import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from functools import partial
from html import escape
from typing import TYPE_CHECKING, Any

from tmd.diagnostics import RefusalKind, TmdError
from tmd.grounded import Grounded, why_refused
from tmd.pddl.model import Formula, Instruction, State
from tmd.pddl.semantics import holds
from tmd.pddl.writer import format_formula, format_plan
from tmd.readers.interface import Question, Reader
from tmd.readers.llm.client import KEY, MODEL, URL
from tmd.studio.demonstrations.clause_spans import clean
from tmd.studio.demonstrations.correction import as_corrected, steps_of
from tmd.studio.environment_view import Reel
from tmd.studio.page import PageLink
from tmd.studio.view3d.performance import RobotRun
from tmd.studio.visitor import TABS, Panel, Visitor, chosen, put
from tmd.view.candidates import candidates
from tmd.view.clauses import lit_choice, lit_sentence
from tmd.view.goals import ShownGoal, doubts, followed, in_words, outcome
from tmd.view.grounding_record import option_texts
from tmd.view.markup import style
from tmd.view.panels import changed, effort, fragment, goal_list, judgement, rejected_ways, step_list
from tmd.view.state_graph import object_rows
from tmd.view.subject import planned_steps
from tmd.world.demonstration import Demonstration

if TYPE_CHECKING:
    from viser import GuiButtonHandle

# How many plans are ranked.
TOP = 3
OWN = "(own words)"
SKILLS = "skills.yaml"
ROBOT = "the robot's run"
RULES, LLM = "rules", "language model"
_FILES = ("plan", "page")


@dataclass(frozen=True, slots=True)
class Request:
    """A text, and how it is read.

    Attributes:
        text: The text.
        reader: The reader that asks a language model; ``None`` for grammar and lexicon.
        answers: The goals that were chosen in answer to questions, by the step that the question is about.
    """

    text: str
    reader: Reader | None = None
    answers: Mapping[int, Formula] = field(default_factory=dict)

    def answer(self, question: Question) -> int | None:
        """Return the number of the option that was chosen; ``None`` where none was, or it is not offered."""
        formulas = [option.formula for option in question.options]
        formula = self.answers.get(question.step)
        return None if formula is None or formula not in formulas else formulas.index(formula)


class SayPanel(Panel):
    """Panel that plans a text, and shows the plans."""

    name = "say"

    def __init__(self, visitor: Visitor) -> None:
        super().__init__(visitor)
        self._grounded: Grounded | None = None
        self._request: Request | None = None
        self._waiting: PageLink | None = None
        self._reels: list[Reel] = []
        self._corrected = False
        self._run: RobotRun | None = None
        self._ran = 0
        self._asked: list[ShownGoal] = []
        self._step = 0
        self._saved: Demonstration | None = None
        gui = visitor.client.gui
        self._text = gui.add_text("Text", "", multiline=True, hint="What is to be done, in English.")
        self._button = visitor.button("Plan it", self.plan, color="blue")
        self._question = gui.add_folder("Which one is meant?", visible=False)
        with self._question:
            self._asked_for = gui.add_html("")
        self._options: list[GuiButtonHandle] = []
        self._understood = gui.add_html("")
        self._judged = gui.add_html("")
        self._which = visitor.dropdown("Plan", ("1",), self._choose, visible=False)
        self._steps = gui.add_html("")
        self._robot = visitor.button("Let the robot do it", self._execute, visible=False)
        self._stop = visitor.button("Stop", visitor.halt, color="red", visible=False)
        self._repair = visitor.button("Correct this plan", self._correct, visible=False)
        self._vain = gui.add_html("", visible=False)
        self._reached = gui.add_folder("Goals", visible=False)
        with self._reached:
            self._goals = gui.add_html("")
        self._rows = gui.add_folder("Objects and steps", expand_by_default=False, visible=False)
        with self._rows:
            self._chart = gui.add_html("")
        self._more = gui.add_folder("Energies, and why the others lost", expand_by_default=False, visible=False)
        with self._more:
            self._energies = gui.add_html("")
        self._files = visitor.buttons("Download", _FILES, self._download, visible=False)
        self._examples = visitor.dropdown("Examples", (OWN, *self._texts()), self._take_example)
        with gui.add_folder("Reader settings", expand_by_default=False):
            self._add_settings()

    def _add_settings(self) -> None:
        """Add the settings of the reader. The key is not among them: the page never has it."""
        gui = self._visitor.client.gui
        model, url = os.environ.get(MODEL, ""), os.environ.get(URL, "")
        self._reader = self._visitor.dropdown("Reader", (RULES, LLM), self._choose_reader)
        self._model = gui.add_text("Model", model, hint=f"Its name; ${MODEL} if empty.", visible=False)
        self._url = gui.add_text("Server address", url, hint=_URL_HINT, visible=False)
        self._verify = gui.add_checkbox("Check the plan with the model", False, visible=False)

    def _texts(self) -> list[str]:
        return self._visitor.studio.examples(self._visitor.setting.name)

    def _take_example(self) -> None:
        if chosen(self._examples) != OWN:
            put(self._text, self._examples.value)

    def entered(self) -> None:
        """Show the examples of another environment, and no plan."""
        self._examples.options = (OWN, *self._texts())
        put(self._examples, OWN)
        self._clear()

    def _clear(self) -> None:
        """Remove all plans; the picture shows the beginning."""
        self._grounded, self._request, self._waiting, self._reels = None, None, None, []
        self._button.disabled = False
        self._understood.content = self._judged.content = self._steps.content = ""
        self._goals.content = self._chart.content = ""
        self._question.visible = self._more.visible = False
        self._found(found=False)
        self._visitor.watch(Reel(self._visitor.setting), 0)

    def _found(self, *, found: bool) -> None:
        """Show what a plan has, or hide it; a robot that does another plan is stopped."""
        self._visitor.halt()
        self._run = None
        self._robot.disabled, self._stop.disabled, self._vain.visible = False, True, False
        for handle in (self._which, self._repair, self._reached, self._rows, self._files):
            handle.visible = found
        folder, look = self._visitor.studio.corpus.folder, self._visitor.setting.look
        robot = found and look is not None and (folder.path / SKILLS).is_file()
        self._robot.visible = self._stop.visible = robot

    # planning

    def plan(self) -> None:
        """Ground the text, and show the best plan."""
        if self._button.disabled:
            return  # it was pressed twice
        self._visitor.stop()
        self._clear()  # what is refused must not leave another sentence's plan below it
        text = clean(self._text.value)
        self._plan(Request(text, self._chosen_reader()))

    def _plan(self, request: Request, link: PageLink | None = None) -> None:
        """Ground a request in the background, and show the plan that ``link`` names, the best one by default."""
        visitor = self._visitor
        self._waiting = asked = link or PageLink(environment=visitor.setting.name, say=request.text)
        self._button.disabled = request.reader is not None
        if request.reader is None:
            visitor.tell("Planning …")
        else:
            visitor.tell("Asking the language model …", "To wait no longer, choose the reader 'rules'.")
        visitor.behind(lambda: self._plan_behind(asked, request))

    def _plan_behind(self, link: PageLink, request: Request) -> None:
        """Ground a request, while the visitor may do something else; nothing is shown if that is another request."""
        visitor = self._visitor
        begun = time.perf_counter()
        try:
            world, teacher = visitor.setting.world, visitor.studio.teacher
            grounded = teacher.ground(request.text, world, top=TOP, reader=request.reader, ask=request.answer)
        except TmdError:
            if self._waiting is not link:
                return
            raise
        finally:
            with visitor.lock:
                if self._waiting is link:
                    self._button.disabled = False
        took = time.perf_counter() - begun
        with visitor.lock:
            if self._waiting is not link:
                return  # another text was planned meanwhile
            free = visitor.owner in (None, self)
            place = link.plan - 1 if link.plan <= len(grounded.plans) else 0
            self._show(grounded, place, link.step, watch=free, request=request)
            if free or request.reader is not None:
                self._tell(self._grounded or grounded, took)
        visitor.keep_link()

    def _chosen_reader(self) -> Reader | None:
        """Return the reader that asks a language model; ``None`` for grammar and lexicon.

        Raises:
            TmdError: It cannot be asked with these settings.
        """
        if chosen(self._reader) == RULES:
            return None
        model, url = self._model.value.strip(), self._url.value.strip()
        return self._visitor.studio.teacher.model_reader(model, url, verify=self._verify.value)

    def _choose_reader(self) -> None:
        """Show the settings of the reader, and wait no longer for one that is asked."""
        model = chosen(self._reader) == LLM
        for handle in (self._model, self._url, self._verify):
            handle.visible = model
        if self._button.disabled and not model:
            self._waiting, self._button.disabled = None, False
            self._visitor.tell("The language model is not waited for any longer.")

    def _answer(self, grounded: Grounded, request: Request) -> None:
        """Ground again what a question was asked about, knowing the answer."""
        if self._grounded is not grounded:
            return  # it was pressed twice, or another text was planned
        self._visitor.stop()
        self._clear()
        self._plan(request)

    def come_back(self, link: PageLink) -> None:
        """Plan what the address of the window says, in the background."""
        if link.say:
            put(self._text, link.say)
            self._plan(Request(clean(link.say)), link)

    def address(self) -> Mapping[str, Any]:
        """Return the number of the plan that is shown, the step, and the sentence."""
        if self._waiting is not None:
            return self._waiting.model_dump(include={"plan", "step", "say"})
        if self._grounded is None:
            return {}
        return {"plan": self._number() + 1 if self._reels else 1, "step": self._step, "say": self._grounded.parsed.text}

    def saved(self, demonstration: Demonstration) -> None:
        """Plan the text of what was saved again, show that, and say whether it is what was shown."""
        visitor = self._visitor
        learning = visitor.studio.teacher.learning
        self._saved = demonstration
        grounded = self._again(demonstration)
        put(self._text, demonstration.text)
        self._show(grounded)
        used = self._whether_used(demonstration, grounded)
        if demonstration.proposed is not None:  # nothing is left to correct; what was saved is here
            visitor.show_tab(TABS[0])
        visitor.tell(f"Saved as {demonstration.id}. {used}", _LATER if learning else None, aloud=True)

    def learned(self) -> None:
        """Plan the text that was saved last again, and report whether the plan is the one that was shown."""
        visitor = self._visitor
        saved, self._saved = self._saved, None
        if saved is None:
            if not visitor.at_fault:  # what was not done is still to be read
                visitor.tell("Everything that was saved is learned.")
            return
        grounded = self._again(saved)
        # what a language model read, or what was chosen in answer to a question, stays
        same = self._request == Request(saved.text) and not self._corrected
        if same and self._run is None and not visitor.is_playing() and _plans(self._grounded) != _plans(grounded):
            self._show(grounded)
        used = self._whether_used(saved, grounded)
        said = " ".join(saved.text.split())
        visitor.tell(f'Saved as {saved.id}, and everything is learned. "{said}": {used}', aloud=True)

    def _whether_used(self, saved: Demonstration, grounded: Grounded) -> str:
        if self._corrected and saved.proposed is not None:
            return "This sentence now gives it here, as it was corrected."
        return whether_used(saved.instructions, grounded, self._visitor.setting.wording.instruction)

    def _again(self, saved: Demonstration) -> Grounded:
        """Return the text of a demonstration, planned where it was shown; a language model is not asked."""
        studio = self._visitor.studio
        return studio.teacher.ground(saved.text, studio.setting(saved.environment).world, top=TOP)

    def _tell(self, grounded: Grounded, took: float) -> None:
        """Report the number of plans, or the reason why there is none."""
        visitor, parsed = self._visitor, grounded.parsed
        if grounded.plans:
            back = f"{self._run.over or _STOPPING} {_BACK}" if self._run else None
            more = _ASKED if grounded.question is not None else back
            count = f"{len(grounded.plans)} plan{'' if len(grounded.plans) == 1 else 's'}"
            so = "" if grounded.plans[0].steps else f" {_IDLE if parsed.clauses else _FORBIDDEN}"
            visitor.tell(f"Planned in {took:.1f} s: {count}.{so}", more)
            return
        example = get_close_matches(parsed.text, visitor.studio.examples(visitor.setting.name), n=1, cutoff=0)
        tried = f"try: {' '.join(example[0].split())}" if example else None
        why, hint, unseen = grounded.reason, None, bool(grounded.unseen)
        if grounded.refused is not None:
            clause, refused = grounded.refused
            why, hint = why_refused(clause, refused.message.removesuffix("."), None), refused.hint
            unseen = refused.kind is RefusalKind.UNKNOWN_VERB
        elif not parsed.clauses and parsed.text.rstrip().endswith("?"):
            why = f"this is a question; {why}"
        shown = "show it under Demonstrate" if unseen else None
        visitor.tell(f"No plan: {why}.", "; or ".join(filter(None, (hint, shown, tried))), fault=True)

    def _show(
        self, grounded: Grounded, place: int = 0, step: int = 0, *, watch: bool = True, request: Request | None = None
    ) -> None:
        """Show what a text was grounded to: the plan at ``place``, after ``step`` steps, and its picture if wanted."""
        self._waiting = None
        self._request = request or Request(grounded.parsed.text)
        self._grounded = grounded = self._with_correction(grounded, self._request)
        self._button.disabled = False
        self._put_question(grounded, self._request)
        self._reels = [Reel(self._visitor.setting, plan.instructions) for plan in grounded.plans]
        found = bool(grounded.plans)
        self._found(found=found)
        self._more.visible = found or bool(grounded.rejected) or grounded.usage is not None
        lines = [verdict.reason if not verdict.valid else "" for verdict in grounded.verdicts]
        energies = candidates(grounded.plans, lines, grounded.rejected, narrow=True, corrected=self._corrected)
        self._energies.content = fragment(energies + effort(grounded.usage))
        if not found:
            unseen = () if grounded.refused is not None else grounded.unseen
            self._understood.content = _styled(lit_sentence(grounded.parsed, unseen=unseen))
            self._judged.content = self._steps.content = ""
            if watch:
                self._visitor.watch(Reel(self._visitor.setting), 0)
            return
        self._offer(grounded)
        self._step = step
        put(self._which, self._which.options[place])
        self._choose(watch=watch)

    def _with_correction(self, grounded: Grounded, request: Request) -> Grounded:
        """Return what a text was grounded to, with the plan to which somebody corrected it first."""
        corrected = self._visitor.studio.corrected(grounded.parsed.text, self._visitor.setting.name)
        found = None
        if corrected is not None and request == Request(grounded.parsed.text):
            found = as_corrected(grounded, corrected)
        self._corrected = found is not None
        return found or grounded

    def _offer(self, grounded: Grounded) -> None:
        """Offer the plans to look at, and what the robot did."""
        self._which.options = tuple(
            f"{number} of {len(grounded.plans)}: {len(plan.steps)} step{'' if len(plan.steps) == 1 else 's'}"
            + (", as it was corrected" if self._corrected and number == 1 else "")
            for number, plan in enumerate(grounded.plans, start=1)
        )
        run = self._visitor.studio.runs.get(self._visitor.identity)  # from before the connection was lost
        same = (n for n, plan in enumerate(grounded.plans) if run is not None and plan.instructions == run.planned)
        self._ran = next(same, -1)
        if run is not None and run.setting is self._visitor.setting and self._ran >= 0:
            self._run = run
            self._which.options = (*self._which.options, ROBOT)

    def _put_question(self, grounded: Grounded, request: Request) -> None:
        """Show the question that was not answered, with a button for each option; nothing where there is none."""
        visitor, question = self._visitor, grounded.question
        with visitor.client.atomic(), self._question:
            for button in self._options:
                button.remove()
            self._options = []
            self._question.visible = question is not None
            if question is None:
                return
            self._asked_for.content = fragment(f"<p>{escape(question.text)}</p>")
            texts = option_texts(question, grounded.world.task.problem)
            for option, text in zip(question.options, texts, strict=True):
                answered = replace(request, answers={**request.answers, question.step: option.formula})
                answer = partial(self._answer, grounded, answered)
                self._options.append(visitor.button(text, answer, hint=format_formula(option.formula)))

    def _number(self) -> int:
        """Return the number of the plan that is looked at, or that the robot does, from 0."""
        return self._ran if self._running() is not None else list(self._which.options).index(chosen(self._which))

    def _running(self) -> RobotRun | None:
        """Return the run of the robot, if it is looked at."""
        return self._run if self._which.value == ROBOT else None

    def _choose(self, *, watch: bool = True) -> None:
        if self._grounded is None or self._number() >= len(self._grounded.plans):
            return
        grounded, plan, world = self._grounded, self._grounded.plans[self._number()], self._visitor.setting.world
        self._understood.content = _styled(lit_choice(grounded.parsed, plan, world))
        self._asked = in_words(plan.goals, world.task.problem)
        if self._running() is None:
            reached = followed(plan.goals, world.task.problem, plan.instructions)
            verdict = grounded.verdicts[self._number()]
            told = [*(grounded.warnings if not self._number() else ()), *doubts(grounded.parsed, plan, world)]
            good = outcome(verdict, reached) + (f": {verdict.reason}" if verdict.reason else "")
            self._judged.content = judgement(good, told)
        going = self._run is not None and not self._run.over
        self._robot.disabled = going or not plan.steps
        self._step = min(self._step, self._last())
        self._look(watch=watch)

    # stepping

    def goto(self, step: int) -> None:
        """Look at the state after so many steps."""
        if self._reels:
            self._step = min(max(step, 0), self._last())
            self._visitor.live = self._run is not None and self._step == self._last()
            self._look()

    def ran(self, run: RobotRun) -> None:
        """Show where the robot is, if it is followed, and how its run ended."""
        if run is not self._run:
            return
        over = run.ended.is_set() and bool(run.over)
        self._robot.disabled, self._stop.disabled = not over, over
        if over:
            self._vain.visible = bool(run.rejected)
            self._vain.content = _styled(rejected_ways(run.rejected))
            self._visitor.tell(run.over, _BACK if run.done else None, fault=run.failed, aloud=True)
        elif run.now is not None:
            said = self._visitor.setting.wording.instruction(run.now.instruction)
            self._visitor.tell(f"The robot, step {run.now.number} of {run.now.of}: {said}")
        if self._running() is not None:
            if self._visitor.live:
                self._step = self._last()
            if self._visitor.owner is self:
                self._look()

    def _reel(self) -> Reel:
        return self._running() or self._reels[self._number()]

    def _last(self) -> int:
        return len(self._reel().states) - 1 if self._reels else 0

    def _look(self, *, watch: bool = True) -> None:
        """Show the step that is looked at: in the picture, in the list, what it changed, and the goals that hold."""
        if self._grounded is None or not self._reels:
            return
        visitor, run, reel = self._visitor, self._running(), self._reel()
        lines = run.lines if run else planned_steps(self._grounded.plans[self._number()])
        instructions = [line.instruction for line in lines]
        if watch:
            visitor.watch(reel, self._step, self, instructions)
        wording, problem = visitor.setting.wording, visitor.setting.world.task.problem
        facts, of = reel.facts(self._step), sum(goal.asked for goal in self._asked)
        self._reached.label = f"Goals: {self._true(facts)} of {of} hold now"
        if run is not None:
            reached = self._true(reel.facts(self._last())) == of
            self._judged.content = judgement(run_outcome(over=bool(run.over), failed=run.failed, reached=reached), ())
        self._goals.content = goal_list(self._asked, facts, problem)
        doing = run is not None and run.now is not None and visitor.live
        gains = () if doing else changed(*reel.changes(self._step), wording.fact)
        faults, current = run.faults if run else None, self._step + doing
        self._steps.content = step_list(lines, current, gains, faults, in_words=wording.instruction, of="say")
        self._chart.content = _styled(object_rows(instructions, problem, current, wording))
        visitor.keep_link()

    def _true(self, facts: State) -> int:
        """Return how many goals hold in a state."""
        problem = self._visitor.setting.world.task.problem
        asked = (goal.goal.formula for goal in self._asked if goal.asked)
        return sum(holds(formula, facts, problem) for formula in asked if formula is not None)

    # what next

    def _planned(self) -> Grounded:
        if self._grounded is None or not self._grounded.plans:
            raise TmdError("there is no plan", hint="plan something first")
        return self._grounded

    def _correct(self) -> None:
        grounded = self._planned()
        parsed, plan = grounded.parsed, grounded.plans[self._number()]
        steps = steps_of(plan, parsed.clauses, parsed.text, self._visitor.studio.corpus.lexicon)
        for panel in self._visitor.panels:
            panel.correct(parsed.text, steps)

    def _download(self) -> None:
        """Send the plan, or the page of `tmd view`, as a file."""
        grounded = self._planned()
        number, kind = self._number(), chosen(self._files)
        plans = (grounded.plans[number], *(p for n, p in enumerate(grounded.plans) if n != number))
        verdicts = (grounded.verdicts[number], *(v for n, v in enumerate(grounded.verdicts) if n != number))
        looked_at = replace(grounded, plans=plans, verdicts=verdicts)
        name = self._visitor.setting.name
        if kind == "plan":
            file, content = f"{name}.plan", format_plan(plans[0].instructions)
        else:
            from tmd.view.page import render
            from tmd.view.subject import text_subject

            file, content = f"{name}.html", render(text_subject(looked_at)).html
        self._visitor.client.send_file_download(file, content.encode(), save_immediately=True)

    def _execute(self) -> None:
        grounded = self._planned()
        visitor, number = self._visitor, self._number()
        visitor.stop()
        self._run, self._ran, self._step = visitor.execute(grounded.plans[number]), number, 0
        self._robot.disabled, self._stop.disabled = True, False
        plans = tuple(each for each in self._which.options if each != ROBOT)
        self._which.options = (*plans, ROBOT)
        put(self._which, ROBOT)
        self._look()


_IDLE = "There is nothing to do: it is so already."
_FORBIDDEN = "This only forbids something, so nothing is done; say it together with what is to be done."
_BACK = "It is under Plan, to look back."
_STOPPING = "The robot is being stopped."
_ASKED = "It is for one of several meanings; the question below has the others."
_URL_HINT = f"${URL}, or else OpenAI's, if empty. The key in ${KEY} goes only to the server that ${URL} names."
_LATER = "The rest is learned in the background; the sentence is planned once more at its end."


def _plans(grounded: Grounded | None) -> list[tuple[Instruction, ...]]:
    return [] if grounded is None else [plan.instructions for plan in grounded.plans]


def run_outcome(*, over: bool, failed: bool, reached: bool) -> str:
    """Return the outcome of a robot's run in a few words.

    The robot could not go on if ``failed``; all goals hold in the state that was observed last if ``reached``.
    """
    if not over:
        return "… the robot is at work"
    if reached:
        return "✓ the robot reached the goals" + (", and then could not go on" if failed else "")
    return "✗ the robot did not reach all goals"


def whether_used(shown: Sequence[Instruction], grounded: Grounded, said: Callable[[Instruction], str] = str) -> str:
    """Return whether the plans for a text are what was shown for it; ``said`` puts an instruction into words."""
    plans = _plans(grounded)
    if not plans:
        return f"The same sentence has no plan yet: {grounded.reason}."
    for place, plan in enumerate(plans, start=1):
        rest = iter(plan)
        if not all(instruction in rest for instruction in shown):
            continue
        more = "; ".join(map(said, (Counter(plan) - Counter(shown)).elements()))
        also = f", and does more: {more}" if more else ""
        so = f"as plan {place} of {len(plans)}" if place > 1 else ""
        return f"The same sentence {'' if so else 'now '}gives what you showed{so and ' '}{so}{also}."
    return "The same sentence still gives another plan."


def _styled(content: str) -> str:
    return fragment(f"<style>{style()}</style>{content}")
