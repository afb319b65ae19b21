"""The panel where a visitor shows how a thing is done, instruction by instruction."""

from __future__ import annotations

from collections import Counter
from functools import partial
from typing import TYPE_CHECKING

from tmd.diagnostics import TmdError
from tmd.pddl.model import Instruction
from tmd.planning.backends import IN_PROCESS, make
from tmd.studio.demonstrations.correction import what_it_needs
from tmd.studio.demonstrations.demo_store import SHOWN
from tmd.studio.demonstrations.drafts import Draft
from tmd.studio.demonstrations.session import Session
from tmd.studio.environment_view import Reel
from tmd.studio.page import PageLink
from tmd.studio.visitor import Panel, Visitor, chosen, put
from tmd.view.panels import StepLine, changed, step_list

if TYPE_CHECKING:
    from viser import GuiButtonHandle

NONE = "(no object)"
NOTHING = "(nothing)"
GOAL_HINT = "A PDDL condition such as (contains cup1 water), or nothing; it is saved with what was shown."
# Maximum number of instructions of an action with a button each.
_FEW = 4


class DemonstratePanel(Panel):
    """Panel that demonstrates: it carries out, marks, undoes and saves."""

    name = "demonstrate"

    def __init__(self, visitor: Visitor) -> None:
        super().__init__(visitor)
        self._session: Session | None = None
        self._reel = Reel(visitor.setting)
        self._offered: list[GuiButtonHandle] = []
        self._more: dict[str, Instruction] = {}
        gui = visitor.client.gui
        self._text = gui.add_text("Task text", "", multiline=True, hint="What you are going to show.")
        self._begin = visitor.button("Begin", self._start, color="blue")
        self._resume = visitor.button("Go on with what was not saved", self.resume, visible=False)
        self._steps = gui.add_html("")
        self._clause = visitor.dropdown("It serves", ("1",), self._mark, visible=False)
        self._undo = visitor.button("Undo", self._take_back, visible=False)
        self._redo = visitor.button("Redo", self._make_again, visible=False)
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
            self._save = visitor.button("Save (K)", self._store, color="blue")
            visitor.button("Throw away", self._discard, color="red")
        for words, key, act in (
            ("Undo", "U", self._take_back),
            ("Redo", "R", self._make_again),
            ("Keep the demonstration: save it", "K", self._store),
        ):
            visitor.command(words, key, act)
        visitor.guarded(self._look_for_draft)(None)

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
        self._session = session
        put(self._goal, "")
        self._reel = Reel(self._visitor.setting)
        for handle in (self._undo, self._redo, self._do, self._keep):
            handle.visible = True
        self._begin.label, self._begin.color = "Start over", "gray"
        self._resume.visible = False
        self.refresh()

    def _close(self) -> None:
        self._session = None
        for handle in (self._undo, self._redo, self._do, self._keep, self._clause):
            handle.visible = False
        self._begin.label, self._begin.color = "Begin", "blue"
        self._steps.content = ""
        self._look_for_draft()

    def _store(self) -> None:
        """Save the demonstration, and learn from it."""
        visitor = self._visitor
        session = self._going()
        goal = self._goal.value.strip() or None
        saved = visitor.studio.save(session, self._task.value, goal)
        visitor.studio.drafts.discard(visitor.identity, Draft)
        self._close()
        for panel in visitor.panels:
            panel.saved(saved)

    def _discard(self) -> None:
        visitor = self._visitor
        self._going()
        visitor.studio.drafts.discard(visitor.identity, Draft)
        self._close()
        visitor.tell("Thrown away.", aloud=True)

    def _going(self) -> Session:
        if self._session is None:
            raise TmdError("no demonstration is under way", hint="type a task, and press Begin")
        return self._session

    # drafts

    def _draft(self) -> Draft | None:
        return self._visitor.studio.drafts.of(self._visitor.identity, Draft)

    def _look_for_draft(self) -> None:
        self._resume.visible = self._draft() is not None

    def resume(self) -> None:
        """Go on with what was not saved."""
        visitor = self._visitor
        draft = self._draft()
        if draft is None:
            raise TmdError("there is no demonstration that was not saved")
        if draft.environment != visitor.setting.name:
            visitor.enter(draft.environment)
        session = draft.resume(visitor.setting.world, visitor.studio.corpus.lexicon, visitor.studio.teacher.habits)
        put(self._text, session.text)
        put(self._task, draft.task)
        self._open(session)
        visitor.tell(f"Here is what was not saved: {len(session.steps)} steps.")

    def come_back(self, link: PageLink) -> None:
        """Resume the unsaved demonstration after the page was loaded again, if there is one."""
        if link.tab == "Demonstrate" and self._session is None and self._draft() is not None:
            self.resume()

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
        needed = what_it_needs(instruction, session.state, world, make(IN_PROCESS, world.task))
        for each in (*needed, instruction):
            session.do(each)
        self.refresh()
        visitor.tell(f"Done, with {len(needed)} step{'' if len(needed) == 1 else 's'} before it.")

    def _able(self) -> None:
        self._other.disabled = self._others.value == NOTHING

    def _take_back(self) -> None:
        if not self._going().undo():
            raise TmdError("there is nothing to take back")
        self.refresh()

    def _make_again(self) -> None:
        if not self._going().redo():
            raise TmdError("nothing was taken back")
        self.refresh()

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
        session = self._session
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
                StepLine(step.instruction, f"clause {step.clause + 1}" + (", marked" if step.marked else ""))
                for step in session.steps
            ]
            self._steps.content = step_list(lines, cursor, gains, in_words=wording.instruction, of="demonstrate")
            self._clause.visible, self._save.disabled = bool(session.steps), not session.steps
            self._undo.disabled, self._redo.disabled = not session.history.before, not session.history.after
            if session.steps:
                self._clause.options = tuple(titles)
                put(self._clause, titles[session.steps[cursor - 1].clause if cursor else 0])
            self.pointed()

    def pointed(self) -> None:
        """Offer what can be done with the object that was pointed at, now or after what it needs."""
        session, visitor = self._session, self._visitor
        if session is None:
            return
        put(self._object, visitor.selected or NONE)
        operators = visitor.setting.offers(visitor.selected)
        possible = [operator.instruction for operator in operators if operator.applicable(session.state)]
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
