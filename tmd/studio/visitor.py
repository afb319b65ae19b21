"""One browser at the studio: what it looks at, its messages, its playing, and the robot that it runs."""

from __future__ import annotations

import sys
import threading
import time
import traceback
from collections.abc import Callable, Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING, Any, ClassVar, Literal

import numpy as np

from tmd.diagnostics import TmdError, install_extra
from tmd.goals.wording import shortened
from tmd.inference.ranking import RankedPlan
from tmd.pddl.model import Instruction
from tmd.pddl.task import Bits
from tmd.robot.sim.pose import Vector
from tmd.studio.demonstrations.session import DemonstratedStep
from tmd.studio.environment_view import Reel
from tmd.studio.page import Event, PageLink, Window
from tmd.studio.studio import Studio
from tmd.studio.view3d.performance import RobotRun
from tmd.studio.view3d.scenery import Scenery
from tmd.view.markup import style
from tmd.view.panels import fragment, notice
from tmd.view.state_graph import StateGraph
from tmd.world.demonstration import Demonstration

if TYPE_CHECKING:
    import viser

# Pixels of the panel beside the 3D view: two fifths of the window, between these.
WIDTH, LEAST_WIDTH = 430, 330
WELCOME = (
    "Welcome. Say: type what is to be done, or take an example, and press Enter. Demonstrate: show how it is done, and "
    "the next sentence uses it. Correct: change a plan that was made."
)
LEARNING = "Learning from what was saved. Go on meanwhile; plans may still change at its end."
VIEWS = ("the whole room", "behind the robot", "the object of the step", "the robot's eyes")
ROOM, BEHIND, OBJECT, EYES = VIEWS
# Of messages and of faults, as on the page.
BLUE, ORANGE = (0, 114, 178), (213, 94, 0)
# Seconds that a message over the view stays.
ALOUD = 8.0
# Seconds within which a click in the picture is the one that an object was pointed at with.
_CLICK = 1.5
_NOWHERE = (0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
TABS = ("Say", "Demonstrate", "Correct", "Object")
# Under this name a browser keeps which visitors its windows are.
KEY = "tmd-visitor"
# After all other parts of the page.
_LAST = 1e12
# Set by its name: the inputs' own types say that a program cannot set it.
_VALUE = "value"

Act = Callable[[], Any]
Colour = Literal["gray", "blue", "red"]


class Panel:
    """Panel of a visitor's page; its methods are called for what is done elsewhere."""

    name: ClassVar[str] = ""

    def __init__(self, visitor: Visitor) -> None:
        self._visitor = visitor
        visitor.panels.append(self)

    def entered(self) -> None:
        """Show another environment."""

    def come_back(self, link: PageLink) -> None:
        """Go on where the window was when it was loaded again."""

    def address(self) -> Mapping[str, Any]:
        """Return the fields of :class:`PageLink` that name what is shown here."""
        return {}

    def goto(self, step: int) -> None:
        """Look at the state after so many steps of this panel."""

    def seen(self) -> None:
        """Show the state that is looked at now."""

    def pointed(self) -> None:
        """Show the object that was pointed at."""

    def correct(self, text: str, plan: Sequence[DemonstratedStep]) -> None:
        """Correct a plan for a text."""

    def saved(self, demonstration: Demonstration) -> None:
        """Plan the text of a saved demonstration again, and report whether the plan uses it."""

    def learned(self) -> None:
        """Report that everything is learned."""

    def moved(self, run: RobotRun) -> None:
        """Show the moment of a run that is followed."""

    def ran(self, run: RobotRun) -> None:
        """Show where the robot is, and how its run ended."""


class Visitor:
    """One connected browser.

    ``identity`` is the visitor's name, under which drafts are kept.

    Attributes:
        panels: The panels of the page; see :func:`tmd.studio.panels.furnish`.
        cursor: The number of steps before the state that is seen.
        owner: The panel whose steps are looked at, if any.
        instructions: The steps of that panel.
        moment: The moment of the run that is seen, where a run is looked at.
        live: Whether the robot is followed in its run.
        view: The folder of what there is to choose about the view.
        lock: One thing at a time happens to what is looked at.
    """

    def __init__(self, studio: Studio, client: viser.ClientHandle, identity: str) -> None:
        self.studio, self.client, self.identity = studio, client, identity
        self.panels: list[Panel] = []
        self.cursor = self.moment = self._scenes = 0
        self.live = False
        self.owner: Panel | None = None
        self.instructions: tuple[Instruction, ...] = ()
        self.selected: str | None = None
        self.run: RobotRun | None = None
        self.lock = threading.RLock()
        self._playing: threading.Event | None = None
        self.at_fault = False
        """Whether the last message says that something was not done."""
        self._voice = threading.Lock()
        self._aloud: viser.NotificationHandle | None = None
        self._pointed_at = -_CLICK
        self._aimed: tuple[float, Vector, Vector] = _NOWHERE
        self.scenery: Scenery | None = None
        self._graph: tuple[tuple[Bits, ...], StateGraph] | None = None
        self.setting = studio.setting(studio.start)
        self.reel = Reel(self.setting)
        self._tab = TABS[0]
        with self.lock:  # who is quick waits until everything is there
            self._furnish()

    def _furnish(self) -> None:
        """Make what is above the panels, the choice of the view, and the view."""
        gui = self.client.gui
        gui.set_panel_label("tmd studio")
        self.window = Window(self.client, lambda event: self.guarded(lambda: self._happened(event))(None))
        self._theme(dark=self.window.dark)
        gui.main_panel.dock_right()
        gui.main_panel.set_width(min(WIDTH, max(LEAST_WIDTH, self.client.camera.image_width * 2 // 5)))
        self._drawn = gui.add_html("")
        self._message = gui.add_html(
            notice(WELCOME, "Click on a thing in the picture to see what it is. Ctrl-K lists commands and their keys.")
        )
        self._learning = gui.add_html(fragment(f"<p>{LEARNING}</p>"), visible=False)
        self._blind = gui.add_html("")
        self._where = self.dropdown("Environment", self.studio.environments())
        put(self._where, self.studio.start)
        self._where.on_update(self.guarded(self._go))
        self.view = gui.add_folder("View", expand_by_default=False, order=_LAST)
        with self.view:
            self._view = self.dropdown("View (V)", VIEWS, self._camera)
            self._names = gui.add_checkbox("Names (L)", False)
            self._names.on_update(self.guarded(self._name))
        self.command("Show or hide the names", "L", lambda: put(self._names, not self._names.value))
        self.command("Point at no object", "O", lambda: self.select(None))
        self.command("Next view", "V", self._turn)
        self._build()
        self.client.camera.on_update(self.guarded(self._resized))

    def come_back(self) -> None:
        """Show the view of the window's address: that before it was loaded again, or one that was sent."""
        link = self.window.link
        if link.environment in self.studio.environments() and link.environment != self.setting.name:
            self.enter(link.environment)
        if link.tab in TABS:
            self._tab = link.tab
            self.window.show_tab(link.tab)
        for panel in self.panels:
            panel.come_back(link)

    def _theme(self, *, dark: bool) -> None:
        self._dark = dark
        self.client.gui.configure_theme(show_logo=False, show_share_button=False, dark_mode=dark)

    def _happened(self, event: Event) -> None:
        """Handle an event that the page's own script sends."""
        if event.dark is not None:
            self._theme(dark=event.dark)
            self._build()
            self.draw()
        elif event.tab in TABS:
            self._tab = event.tab
            self.keep_link()
        elif event.step is not None:
            for panel in self.panels:
                if panel.name and panel.name == event.list:
                    self.stop()
                    panel.goto(event.step)
        elif event.object:
            self.select(event.object)
        elif event.clicked and time.monotonic() - self._pointed_at > _CLICK:  # a click on an object has come before
            self.select(None)

    def keep_link(self) -> None:
        """Let the window's address say what is looked at."""
        shown = {key: value for panel in self.panels for key, value in panel.address().items()}
        tab = self._tab if self._tab != TABS[0] else ""
        self.window.keep(PageLink(environment=self.setting.name, tab=tab, **shown))

    def show_tab(self, name: str) -> None:
        """Open a tab."""
        self._tab = name
        self.window.show_tab(name)
        self.keep_link()

    # what is looked at

    def _go(self) -> None:
        if self._where.value != self.setting.name:
            try:
                self.enter(self._where.value)
            finally:  # it may be wrong, or too large
                put(self._where, self.setting.name)

    def enter(self, name: str) -> None:
        """Go to another environment."""
        self.stop()
        self.tell(f"Opening {name} …")
        self.setting = self.studio.setting(name)
        names = tuple(self.studio.environments())
        if self._where.options != names:
            self._where.options = names
        self.reel = Reel(self.setting)
        self.cursor, self.selected = 0, None
        put(self._where, name)
        self._build()
        for panel in self.panels:
            panel.entered()
        self.tell(f"This is {name}. Say what is to be done, or show it.")
        self.keep_link()

    def _build(self) -> None:
        self.client.scene.reset()
        look = self.setting.look
        self.scenery = None
        self._view.visible = self._names.visible = look is not None
        self._blind.content = "" if look is not None else fragment(f"<p class='quiet'>{escape(self.setting.blind)}</p>")
        self._drawn.content, self._graph, self._aimed = "", None, _NOWHERE
        if look is None:
            self._draw_graph()
            return
        with self.client.atomic():
            self._scenes += 1
            self.scenery = Scenery(
                self.client.scene, look, self.studio.figure(), self._pointed, dark=self._dark, number=self._scenes
            )
        self._camera()
        self._name()
        if self.studio.figure() is None:
            self.tell("The PR2 is not shown: its model is not installed.", install_extra("robot"))

    def watch(self, reel: Reel, step: int, by: Panel | None = None, instructions: Sequence[Instruction] = ()) -> None:
        """Look at a state of some states; ``by`` is the panel whose instructions lead through them."""
        self.reel, self.cursor, self.owner, self.instructions = reel, step, by, tuple(instructions)
        if isinstance(reel, RobotRun):
            self.moment = len(reel.moments) - 1 if self.live and not reel.over else reel.after(step)
        self.draw()
        for panel in self.panels:
            panel.seen()

    def draw(self) -> None:
        """Draw what is looked at: a moment of a run, or a state."""
        reel, scenery = self.reel, self.scenery
        if scenery is None:
            self._draw_graph()
            return
        with self.client.atomic():  # half of the robot must not go before the rest
            if isinstance(reel, RobotRun) and reel.moments:
                scenery.replay(reel.moments[self.moment])
            elif (picture := reel.picture(0 if isinstance(reel, RobotRun) else self.cursor)) is not None:
                scenery.draw(picture)
        if self._view.value != ROOM:
            self._camera()
        if self._names.value:
            self._name()

    def _draw_graph(self) -> None:
        """Draw the state that is looked at as a graph, where there is no scene; the page puts it into the view."""
        reel, problem = self.reel, self.setting.world.task.problem
        if self._graph is None or self._graph[0] != reel.states:
            states = [reel.facts(step) for step in range(len(reel.states))]
            names = [name for instruction in self.instructions for name in instruction.args]
            self._graph = reel.states, StateGraph(problem, states, names)
        before = reel.facts(self.cursor - 1) if self.cursor else None
        svg = self._graph[1].svg(reel.facts(self.cursor), before, self.selected, f"{self.setting.name} as a graph")
        self._drawn.content = f'<style>{style()}</style><div class="tmd-state" hidden>{svg}</div>'

    def select(self, name: str | None) -> None:
        """Point at an object."""
        if name is not None and name not in self.setting.names():
            raise TmdError(f"there is no object '{name}' here")
        self.selected = name
        if self.scenery is not None:
            self.scenery.mark(name)
        else:
            self._draw_graph()
        for panel in self.panels:
            panel.pointed()

    def point(self, handle: viser.GuiDropdownHandle[str]) -> None:
        """Point at the object that is chosen in a list, whose first entry is none."""
        name = chosen(handle) if handle.value != handle.options[0] else None
        if name != self.selected:
            self.select(name)

    def _name(self) -> None:
        """Show the names, or hide them."""
        if self.scenery is not None:
            self.scenery.names(self.client.camera if self._names.value else None)

    def _pointed(self, name: str) -> None:
        self._pointed_at = time.monotonic()
        self.guarded(lambda: self.select(name))(None)

    # the camera

    def _camera(self) -> None:
        """Look from where the view says."""
        scenery, camera = self.scenery, self.client.camera
        if scenery is None:
            return
        aim = {BEHIND: scenery.behind, OBJECT: lambda: scenery.near(self._touched()), EYES: scenery.eyes}
        eye, target = aim.get(self._view.value, lambda: None)() or scenery.overview(camera.fov, camera.aspect)
        if (camera.aspect, eye, target) == self._aimed:
            return
        self._aimed = camera.aspect, eye, target
        with self.client.atomic():
            camera.up_direction = (0.0, 0.0, 1.0)
            camera.position = eye
            camera.look_at = target

    def _touched(self) -> list[str]:
        """Return the objects of the step that is looked at, or of what the robot does now; parts as their wholes."""
        done, step = self.instructions, self.cursor
        now = self.run.now if self.run is not None and self.live and self.reel is self.run else None
        found = now.instruction if now else done[step - 1] if 0 < step <= len(done) else None
        wholes = self.setting.world.profiles.wholes
        return [wholes.get(name, name) for name in found.args] if found else []

    def _resized(self) -> None:
        """Look at the whole room again in a view of another form, unless the visitor moved the camera; move names."""
        camera = self.client.camera
        aspect, eye, _ = self._aimed
        if self._view.value == ROOM and aspect != camera.aspect and np.allclose(camera.position, eye, atol=0.01):
            self._camera()
        if self._names.value:
            self._name()

    def _turn(self) -> None:
        """Take the next view."""
        put(self._view, VIEWS[(VIEWS.index(self._view.value) + 1) % len(VIEWS)])

    # the robot

    def execute(self, plan: RankedPlan) -> RobotRun:
        """Let the simulated robot carry a plan out, in the background."""
        if self.scenery is None:
            raise TmdError(f"the robot cannot do it here. {self.setting.blind}")
        if self.studio.figure() is None:
            raise TmdError("the PR2's model is not installed", hint=install_extra("robot"))
        self.halt()

        def moved() -> None:
            with self.lock:
                if self.live and self.reel is run:
                    self.moment = len(run.moments) - 1
                    self.draw()
                    for panel in self.panels:
                        panel.moved(run)

        def advanced() -> None:
            with self.lock:
                if self.run is run:
                    for panel in self.panels:
                        panel.ran(run)

        self.run = run = self.studio.runs[self.identity] = RobotRun(self.setting, plan, moved, advanced)
        self.live = True
        self.tell("The simulation is being set up …", aloud=True)
        self.behind(lambda: run.carry_out(self.studio.corpus.folder))
        return run

    def halt(self) -> None:
        """Stop the robot."""
        if self.run is not None:
            self.run.ended.set()

    # widgets

    def button(self, label: str, act: Act, *, color: Colour = "gray", **options: Any) -> viser.GuiButtonHandle:  # noqa: ANN401
        """Add a button: blue is the main one of its panel, red throws something away, any other one is grey."""
        handle = self.client.gui.add_button(label, color=color, **options)
        handle.on_click(self.guarded(act))
        return handle

    def buttons(
        self, label: str, names: Sequence[str], act: Act, *, visible: bool = True
    ) -> viser.GuiButtonGroupHandle:
        """Add a row of buttons."""
        handle = self.client.gui.add_button_group(label, names, visible=visible)
        handle.on_click(self.guarded(act))
        return handle

    def dropdown(
        self, label: str, options: Sequence[str], act: Act | None = None, *, visible: bool = True
    ) -> viser.GuiDropdownHandle[str]:
        """Add a list to choose from."""
        handle: viser.GuiDropdownHandle[str] = self.client.gui.add_dropdown(label, options, visible=visible)
        if act is not None:
            handle.on_update(self.guarded(act))
        return handle

    # one action at a time

    def guarded(self, act: Act) -> Callable[[object], None]:
        """Return a callback that holds the lock, and reports errors to the visitor, never by a traceback."""

        def called(_: object) -> None:
            with self.lock:
                self._report(act)

        return called

    def behind(self, act: Act) -> None:
        """Do something in the background, without the lock, and report errors to the visitor."""
        threading.Thread(target=self._report, args=(act,), daemon=True).start()

    def _report(self, act: Act) -> None:
        try:
            act()
        except TmdError as error:
            place = f"{error.location}: " if error.location else ""
            self.tell(place + error.message, error.hint, fault=True)
        except Exception:
            traceback.print_exc(file=sys.stderr)
            self.tell("that is a fault of tmd itself; what was saved is safe.", "See the terminal.", fault=True)

    def command(self, label: str, key: str, act: Act) -> None:
        """Add a hot key: W, A, S, D, Q, E and the arrows move the camera, and space presses the focused button."""
        self.client.gui.add_command(label, hotkey=key).on_trigger(self.guarded(act))  # type: ignore[arg-type]

    # messages

    def tell(self, message: str, hint: str | None = None, *, fault: bool = False, aloud: bool = False) -> None:
        """Show a message at the top of the panel.

        With ``aloud`` it is shown over the view as well, as faults always are, for a while or until the next message:
        the panel may be scrolled down.
        """
        self._message.content = notice(message, hint, fault=fault)
        self.at_fault = fault
        title, colour = ("Not done", ORANGE) if fault else ("tmd studio", BLUE)
        said = shortened(" – ".join(filter(None, (message, hint))))
        with self._voice:
            if self._aloud is not None:
                self._aloud.remove()
                self._aloud = None
            if fault or aloud:
                self._aloud = self.client.add_notification(title, said, auto_close_seconds=ALOUD, color=colour)

    def ask(self, title: str, question: str, yes: str, act: Act) -> None:
        """Do something if the visitor agrees."""
        box = self.client.gui.add_modal(title)

        def agreed() -> None:
            box.close()
            act()

        with box:
            self.client.gui.add_html(fragment(f"<p>{escape(question)}</p>"))
            self.button(yes, agreed, color="red")
            self.button("Cancel", box.close)

    # playing

    def play(self, frames: Callable[[threading.Event], None]) -> None:
        """Run something that shows one thing after the other, in the background, until :meth:`stop`."""
        self.stop()
        ended = self._playing = threading.Event()
        self.behind(lambda: frames(ended))

    def is_playing(self) -> bool:
        """Return whether something is being played."""
        return self._playing is not None and not self._playing.is_set()

    def stop(self) -> None:
        """Stop playing."""
        if self._playing is not None:
            self._playing.set()

    def learning(self, on: bool, failed: Exception | None = None) -> None:
        """Show that something is being learned, that it is done, or that it failed."""
        self._learning.visible = on
        if failed is not None:
            self.tell(f"Learning failed: {failed}", "Plans are made with what was learned before.", fault=True)
        for panel in () if on or failed else self.panels:
            self.guarded(panel.learned)(None)


def put(handle: object, value: object) -> None:
    """Let an input have a value. Its callbacks are called as if the visitor had changed it, unless it has it."""
    if getattr(handle, _VALUE) != value:
        setattr(handle, _VALUE, value)


def chosen(handle: viser.GuiDropdownHandle[str] | viser.GuiButtonGroupHandle) -> str:
    """Return the chosen option of an input.

    Raises:
        TmdError: The page is out of date, or did not send the value.
    """
    value = handle.value
    if value not in handle.options:
        raise TmdError("that cannot be chosen any more", hint="choose again")
    return str(value)
