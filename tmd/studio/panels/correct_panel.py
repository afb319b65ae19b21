"""The panel where a visitor corrects a plan: leaves steps out, puts others in, takes other objects."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from tmd.diagnostics import TmdError
from tmd.pddl.model import Instruction
from tmd.studio.demonstrations.correction import Correction
from tmd.studio.demonstrations.demo_store import SHOWN
from tmd.studio.demonstrations.drafts import CorrectionDraft
from tmd.studio.demonstrations.session import DemonstratedStep
from tmd.studio.environment_view import Reel
from tmd.studio.panels.demonstrate_panel import GOAL_HINT, DraftPanel
from tmd.studio.visitor import Visitor, chosen, put
from tmd.view.panels import fragment, step_list
from tmd.view.subject import PlannedStep

EVERYWHERE = "in every step"
HERE = "in this step"
NOTHING = "(nothing)"
PLAN_FIRST = "<p>Plan something under Say, and press 'Correct this plan'.</p>"
NO_STEPS = "No step is left: that nothing is to be done is a correction as well."


class CorrectPanel(DraftPanel[Correction, CorrectionDraft]):
    """Panel that edits a proposed plan, and saves it."""

    name = "correct"
    form = CorrectionDraft
    idle = "nothing is corrected", "plan something under Say, and press 'Correct this plan'"

    def __init__(self, visitor: Visitor) -> None:
        gui = visitor.client.gui
        self._text = gui.add_html(fragment(PLAN_FIRST))
        super().__init__(visitor, "Go on with the correction")
        self._insertable: dict[str, Instruction] = {}
        self._at = 0
        self._all = gui.add_folder("Edit", visible=False)
        with self._all:
            self._delete = visitor.button("Delete", self._leave_out)
            self._earlier = visitor.button("Earlier", partial(self._move, -1))
            self._later = visitor.button("Later", partial(self._move, 1))
            self._undo = visitor.button("Undo", partial(self._go_back, False))
            self._redo = visitor.button("Redo", partial(self._go_back, True))
            self._repair = visitor.button("Let the planner put in what is missing", self._mend)
            self._old = visitor.dropdown("Instead of", (NOTHING,), self._able)
            self._new = visitor.dropdown("take", (NOTHING,), self._able)
            self._swaps = [visitor.button(f"Swap {where}", partial(self._swap, where)) for where in (HERE, EVERYWHERE)]
            self._with = visitor.dropdown("Insert with", (NOTHING,), self._instructions)
            self._what = visitor.dropdown("Instruction", (NOTHING,), self._able)
            self._put_in = visitor.button("Insert behind this step", self._insert)
            self._goal = gui.add_text("What must hold at the end", "", hint=GOAL_HINT)
            self._goal.on_update(visitor.guarded(self._keep))
            visitor.button("Save the correction", self._save, color="blue")

    def _close(self) -> None:
        self._all.visible = False
        self._text.content = fragment(PLAN_FIRST)
        super()._close()

    def correct(self, text: str, plan: Sequence[DemonstratedStep]) -> None:
        """Correct a plan for a text; what was corrected before and is not saved is asked for."""
        visitor = self._visitor

        def go() -> None:
            self._open(Correction(visitor.setting.world, text, plan, visitor.studio.corpus.lexicon))
            visitor.show_tab("Correct")
            visitor.tell("The plan is under Correct: click on a step, move it, delete it, or put another behind it.")

        before = self._draft()
        if before is None:
            go()
            return
        said = " ".join(before.text.split())
        question = f'The correction of "{said}" in {before.environment} is not saved.'
        visitor.ask("Correct this plan instead?", question, "Throw it away", go)

    def _open(self, correction: Correction, goal: str = "") -> None:
        visitor = self._visitor
        visitor.stop()
        self._work = correction
        self._reel, self._at = Reel(visitor.setting), 1 if correction.steps else 0
        self._new.options = self._with.options = (NOTHING, *visitor.setting.names())
        self._all.visible, self._resume.visible = True, False
        put(self._goal, goal)
        self.refresh()

    # what is not saved yet

    def _take_up(self, draft: CorrectionDraft) -> None:
        visitor = self._visitor
        self._open(draft.resume(visitor.setting.world, visitor.studio.corpus.lexicon), draft.goal)
        visitor.tell("Here is the correction that is not saved.")

    def _keep(self) -> None:
        """Keep the correction as a draft, if it changes anything."""
        visitor, correction = self._visitor, self._work
        if correction is None:
            return
        goal = self._goal.value.strip()
        if goal or correction.steps != correction.proposed:
            visitor.studio.drafts.keep(visitor.identity, CorrectionDraft.of(correction, goal))
        else:
            visitor.studio.drafts.discard(visitor.identity, CorrectionDraft)

    # edits

    def goto(self, step: int) -> None:
        """Choose a step, and look at what it leads to."""
        self._at = min(max(step, 0), len(self._going().steps))
        self.refresh()

    def _able(self) -> None:
        """Disable the buttons that would do nothing."""
        correction, at = self._going(), self._at
        self._delete.disabled = not at
        self._earlier.disabled, self._later.disabled = at < 2, not 0 < at < len(correction.steps)
        self._undo.disabled, self._redo.disabled = not correction.undoable, not correction.redoable
        self._repair.disabled = correction.broken() is None
        self._put_in.disabled = self._what.value == NOTHING
        for button in self._swaps:
            button.disabled = NOTHING in (self._old.value, self._new.value)

    def _leave_out(self) -> None:
        self._going().delete(self._at)
        self.refresh()

    def _move(self, by: int) -> None:
        self._going().move(self._at, self._at + by)
        self._at += by
        self.refresh()

    def _swap(self, where: str) -> None:
        correction, old, new = self._going(), chosen(self._old), chosen(self._new)
        if NOTHING in (old, new):
            raise TmdError("choose the two objects first")
        count = correction.swap(old, new, self._at if where == HERE else None)
        self.refresh()
        self._visitor.tell(f"{count} step{'' if count == 1 else 's'} changed.")

    def _instructions(self) -> None:
        """Offer the instructions with an object; the planner may make possible those that do not apply."""
        name = chosen(self._with)
        operators = self._visitor.setting.offers(None if name == NOTHING else name)
        self._insertable = self._visitor.setting.wording.by_words(operator.instruction for operator in operators)
        self._what.options = (NOTHING, *self._insertable)
        self._able()

    def _insert(self) -> None:
        instruction = self._insertable.get(self._what.value)
        if instruction is None:
            raise TmdError("choose an instruction first")
        self._going().insert(self._at + 1, instruction)
        self._at += 1
        self.refresh()

    def _mend(self) -> None:
        added = self._going().repair()
        self.refresh()
        said = "; ".join(map(self._visitor.setting.wording.instruction, added))
        self._visitor.tell(f"Put in: {said}." if added else "Nothing is missing.")

    def _save(self) -> None:
        """Save the corrected plan as a demonstration of the text, and learn from it."""
        self._store(self._going(), SHOWN, self._goal.value)

    # showing

    def refresh(self) -> None:
        """Show the plan as it is now, and the state after the chosen step, or the last one that is reached."""
        visitor, correction = self._visitor, self._going()
        self._keep()
        steps, broken = correction.steps, correction.broken()
        self._at = min(self._at, len(steps))
        used = sorted(set(steps[self._at - 1].instruction.args)) if self._at else []
        self._old.options = (NOTHING, *used)
        works = broken[0] - 1 if broken else len(steps)
        states = Reel(visitor.setting, [step.instruction for step in steps[:works]]).states
        self._reel.become([*states, *[states[-1]] * (len(steps) - works)])
        visitor.watch(self._reel, self._at, self, [step.instruction for step in steps])
        lines = [PlannedStep(step.instruction, f"clause {step.clause + 1}") for step in steps]
        faults = {broken[0]: [f"✗ {broken[1]}"]} if broken else {}
        state = f"Step {broken[0]} does not apply." if broken else "Every step applies." if steps else NO_STEPS
        in_words = visitor.setting.wording.instruction
        listed = step_list(lines, self._at, (), faults, in_words=in_words, of="correct")
        self._text.content = fragment(f"<p role='status'>{state}</p>") + listed
        self._able()
