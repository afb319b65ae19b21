"""The panel where a visitor shows how a thing is done, instruction by instruction."""

from __future__ import annotations

from collections import Counter
from functools import partial
from typing import TYPE_CHECKING, ClassVar, Generic, TypeVar

from tmd.diagnostics import TmdError
from tmd.pddl.model import Instruction
from tmd.studio.demonstrations.correction import Correction, what_it_needs
from tmd.studio.demonstrations.demo_store import SHOWN
from tmd.studio.demonstrations.drafts import CorrectionDraft, Draft
from tmd.studio.demonstrations.session import EditedSteps, Session
from tmd.studio.environment_view import Reel
from tmd.studio.page import PageLink
from tmd.studio.visitor import Panel, Visitor, chosen, put
from tmd.view.panels import changed, step_list
from tmd.view.subject import PlannedStep

if TYPE_CHECKING:
    from viser import GuiButtonHandle

NONE = "(no object)"
NOTHING = "(nothing)"
GOAL_HINT = "A PDDL condition such as (contains cup1 water), or nothing; it is saved with what was shown."
# Maximum number of instructions of an action with a button each.
_FEW = 4


_Work = TypeVar("_Work", Session, Correction)
_Draft = TypeVar("_Draft", Draft, CorrectionDraft)


class DraftPanel(Panel, Generic[_Work, _Draft]):
    """Panel of something that is kept as a draft until it is saved.

    Attributes:
        form: The form of the draft.
        idle: An error where nothing is under way: the message, and the remedy.
    """

    form: type[_Draft]
    idle: ClassVar[tuple[str, str]]

    def __init__(self, visitor: Visitor, resume: str) -> None:
        super().__init__(visitor)
        self._work: _Work | None = None
        self._reel = Reel(visitor.setting)
        self._resume = visitor.button(resume, self._go_on, visible=False)
        visitor.guarded(self._look_for_draft)(None)

    def _draft(self) -> _Draft | None:
        return self._visitor.studio.drafts.of(self._visitor.identity, self.form)

    def _look_for_draft(self) -> None:
        self._resume.visible = self._draft() is not None

    def _go_on(self) -> None:
        """Go on with what was not saved."""
        visitor, draft = self._visitor, self._draft()
        if draft is None:
            raise TmdError("there is nothing that was not saved")
        if draft.environment != visitor.setting.name:
            visitor.enter(draft.environment)
        self._take_up(draft)

    def _take_up(self, draft: _Draft) -> None:
        """Show a draft."""
        raise NotImplementedError

    def come_back(self, link: PageLink) -> None:
        """Go on with what was not saved after the page was loaded again, if there is something."""
        if link.tab == self.name.capitalize() and self._work is None and self._draft() is not None:
            self._go_on()

    def _going(self) -> _Work:
        if self._work is None:
            raise TmdError(self.idle[0], hint=self.idle[1])
        return self._work

    def _go_back(self, forward: bool) -> None:
        work = self._going()
        if not (work.redo() if forward else work.undo()):
            raise TmdError("nothing was taken back" if forward else "there is nothing to take back")
        self.refresh()

    def refresh(self) -> None:
        """Show what is under way as it is now, and keep it."""

    def _store(self, session: EditedSteps, task: str, goal: str) -> None:
        """Save a demonstration, and learn from it."""
        visitor = self._visitor
        saved = visitor.studio.save(session, task, goal.strip() or None)
        visitor.studio.drafts.discard(visitor.identity, self.form)
        self._close()
        for panel in visitor.panels:
            panel.saved(saved)

    def entered(self) -> None:
        """Close what is under way in another environment; it is kept."""
        self._close()

    def _close(self) -> None:
        self._work = None
        self._look_for_draft()


class DemonstratePanel(DraftPanel[Session, Draft]):
    """Panel that demonstrates: it carries out, marks, undoes and saves."""

    name = "demonstrate"
    form = Draft
    idle = "no demonstration is under way", "type a task, and press Begin"

    def __init__(self, visitor: Visitor) -> None:
        gui = visitor.client.gui
        self._text = gui.add_text("Task text", "", multiline=True, hint="What you are going to show.")
        self._begin = visitor.button("Begin", self._start, color="blue")
        super().__init__(visitor, "Go on with what was not saved")
        self._offered: list[GuiButtonHandle] = []
        self._more: dict[str, Instruction] = {}
        self._steps = gui.add_html("")
        self._clause = visitor.dropdown("It serves", ("1",), self._mark, visible=False)
        self._undo = visitor.button("Undo", partial(self._go_back, False), visible=False)
        self._redo = visitor.button("Redo", partial(self._go_back, True), visible=False)
        self._do = gui.add_folder("Do", visible=False)
        with self._do:
            self._object = visitor.dropdown(
                "With", (NONE, *visitor.setting.names()), lambda: visitor.point(self._object)
            )
            self._buttons = gui.add_folder("Possible now")
            self._others = visitor.dropdown("More", (NOTHING,), self._able)
            self._other = visitor.button("Do that, and first what it needs", self._do_other, disabled=True)
        self._keep = gui.add_folder("Save", visible=False)
        with self._keep:
            self._task = gui.add_text("Task name", SHOWN, hint="Small letters, digits, _ : a folder of this name.")
            self._goal = gui.add_text("Goal (optional)", "", hint=GOAL_HINT)
            self._save = visitor.button("Save (K)", self._save_it, color="blue")
            visitor.button("Throw away", self._discard, color="red")
        visitor.command("Undo", "U", partial(self._go_back, False))
        visitor.command("Redo", "R", partial(self._go_back, True))
        visitor.command("Keep the demonstration: save it", "K", self._save_it)

    def entered(self) -> None:
        """Show the objects of another environment."""
        self._object.options = (NONE, *self._visitor.setting.names())
        self._close()

    # beginning and ending

    def _start(self) -> None:
        """Begin a new demonstration of the text; one that was not saved is asked for."""
        visitor, draft = self._visitor, self._draft()

        def go() -> None:
            self._open(visitor.studio.session(visitor.setting, self._text.value))
            visitor.tell("Point at an object, in the picture or under 'With', and choose what to do.")

        if draft is None or not draft.instructions:
            go()
            return
        count, said = len(draft.instructions), " ".join(draft.text.split())
        steps = f"{count} step{'' if count == 1 else 's'}"
        question = f'"{said}" was shown with {steps} in {draft.environment} and is not saved.'
        visitor.ask("Begin anew?", question, "Throw it away, and begin", go)

    def _open(self, session: Session) -> None:
        self._visitor.stop()
        self._work = session
        put(self._goal, "")
        self._reel = Reel(self._visitor.setting)
        for handle in (self._undo, self._redo, self._do, self._keep):
            handle.visible = True
        self._begin.label, self._begin.color = "Start over", "gray"
        self._resume.visible = False
        self.refresh()

    def _close(self) -> None:
        for handle in (self._undo, self._redo, self._do, self._keep, self._clause):
            handle.visible = False
        self._begin.label, self._begin.color = "Begin", "blue"
        self._steps.content = ""
        super()._close()

    def _save_it(self) -> None:
        self._store(self._going(), self._task.value, self._goal.value)

    def _discard(self) -> None:
        visitor = self._visitor
        self._going()
        visitor.studio.drafts.discard(visitor.identity, Draft)
        self._close()
        visitor.tell("Thrown away.", aloud=True)

    def _take_up(self, draft: Draft) -> None:
        visitor = self._visitor
        session = draft.resume(visitor.setting.world, visitor.studio.corpus.lexicon, visitor.studio.teacher.habits)
        put(self._text, session.text)
        put(self._task, draft.task)
        self._open(session)
        visitor.tell(f"Here is what was not saved: {len(session.steps)} steps.")

    # doing

    def _carry_out(self, instruction: Instruction) -> None:
        self._going().do(instruction)
        self.refresh()

    def _do_other(self) -> None:
        """Carry out an instruction after what the planner finds that it needs."""
        visitor = self._visitor
        session, world = self._going(), visitor.setting.world
        instruction = self._more.get(self._others.value)
        if instruction is None:
            raise TmdError("choose an instruction first", hint="point at an object")
        needed = what_it_needs(instruction, session.state, world)
        for each in (*needed, instruction):
            session.do(each)
        self.refresh()
        visitor.tell(f"Done, with {len(needed)} step{'' if len(needed) == 1 else 's'} before it.")

    def _able(self) -> None:
        self._other.disabled = self._others.value == NOTHING

    def goto(self, step: int) -> None:
        """Look at the state after so many steps; nothing is undone."""
        self._going().goto(step)
        self.refresh()

    def _mark(self) -> None:
        session = self._going()
        clause = list(self._clause.options).index(chosen(self._clause))
        if session.cursor and session.steps[session.cursor - 1].clause != clause:
            session.mark(session.cursor, clause)
            self.refresh()

    # showing

    def refresh(self) -> None:
        """Show the demonstration as it is now, and keep it."""
        session = self._work
        if session is None:
            return
        visitor = self._visitor
        visitor.studio.drafts.keep(visitor.identity, Draft.of(session, self._task.value))
        # All at once: who presses a button as soon as the new list shows must not press one of the old state.
        with visitor.client.atomic():
            self._reel.become(session.states)
            cursor = session.cursor
            visitor.watch(self._reel, cursor, self, [step.instruction for step in session.steps])
            titles = [f"{number}: {piece.text}" for number, piece in enumerate(session.clauses, start=1)]
            wording = visitor.setting.wording
            gains = changed(*self._reel.changes(cursor), wording.fact)
            lines = [
                PlannedStep(step.instruction, f"clause {step.clause + 1}" + (", marked" if step.marked else ""))
                for step in session.steps
            ]
            self._steps.content = step_list(lines, cursor, gains, in_words=wording.instruction, of="demonstrate")
            self._clause.visible, self._save.disabled = bool(session.steps), not session.steps
            self._undo.disabled, self._redo.disabled = not session.undoable, not session.redoable
            if session.steps:
                self._clause.options = tuple(titles)
                put(self._clause, titles[session.steps[cursor - 1].clause if cursor else 0])
            self.pointed()

    def pointed(self) -> None:
        """Offer what can be done with the object that was pointed at, now or after what it needs."""
        session, visitor = self._work, self._visitor
        if session is None:
            return
        put(self._object, visitor.selected or NONE)
        operators = visitor.setting.offers(visitor.selected)
        state = session.state
        possible = [operator.instruction for operator in operators if operator.applicable(state)]
        alike = Counter[str]()
        few = []
        for instruction in possible:
            alike[instruction.name] += 1
            if alike[instruction.name] <= _FEW:
                few.append(instruction)
        with visitor.client.atomic(), self._buttons:
            for handle in self._offered:
                handle.remove()
            self._offered = [
                visitor.button(words, partial(self._carry_out, instruction), hint=str(instruction))
                for words, instruction in visitor.setting.wording.by_words(few).items()
            ]
        rest = [operator.instruction for operator in operators if operator.instruction not in few]
        self._more = visitor.setting.wording.by_words(rest)
        options = (NOTHING, *self._more)
        if self._others.options != options:
            self._others.options = options
        self._able()
