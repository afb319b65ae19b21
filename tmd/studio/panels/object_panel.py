"""The panel of the object that was pointed at: its parts and states, what it is to others, and what controls what."""

from __future__ import annotations

from collections.abc import Callable

from tmd.diagnostics import TmdError
from tmd.studio.environment_edit import EditedEnvironment, StateChange
from tmd.studio.object_info import about
from tmd.studio.panels.context import PanelContext, chosen, put
from tmd.studio.panels.html import changed, fragment, object_facts
from tmd.view.markup import style
from tmd.view.object_graph import GraphChanges, object_graph

NOTHING = "(nothing)"
# Maximum number of object graphs drawn at once.
DRAWN = 24
# Those that domains know; what one does not have is refused.
RELATIONS = ("on", "in", "next_to")


class ObjectPanel:
    """Panel of one object of the state that is shown."""

    def __init__(self, visitor: PanelContext) -> None:
        self._visitor = visitor
        gui = visitor.client.gui
        self._which = visitor.dropdown("Object", (NOTHING, *self._names()), self._chosen)
        self._facts = gui.add_html("")
        self._changes: dict[str, StateChange] = {}
        self._offered: str | None = None
        with gui.add_folder("Change the world", expand_by_default=False):
            gui.add_html(fragment("<p>A changed world is a new environment; the file of this one stays as it is.</p>"))
            self._state = visitor.dropdown("Its state", (NOTHING,))
            visitor.button("Make it so", self._change)
            self._relation = visitor.dropdown("Place", RELATIONS)
            self._place = visitor.dropdown("of", (NOTHING, *self._names()))
            visitor.button("Put the object there", self._put)
            self._kind = visitor.dropdown("A new", (NOTHING,))
            visitor.button("Add it there", self._add)
            visitor.button("Take the object away", self._remove)
            self._name = gui.add_text("Name", "", hint="Small letters, digits, _ : a file of this name.")
            visitor.button("Save as an environment", self._keep)
        self.entered()

    def _names(self) -> list[str]:
        return self._visitor.setting.names()

    def _chosen(self) -> None:
        name = None if self._which.value == NOTHING else chosen(self._which)
        if name != self._visitor.selected:
            self._visitor.select(name)

    def entered(self) -> None:
        """Show the objects and examples of another environment."""
        self._which.options = self._place.options = (NOTHING, *self._names())
        put(self._which, NOTHING)
        put(self._place, NOTHING)
        edited = self._edited()
        self._kind.options = (NOTHING, *(edited.classes() if edited else ()))
        put(self._kind, NOTHING)
        self._offer()
        self.refresh()

    # changing the world

    def _edited(self) -> EditedEnvironment | None:
        visitor = self._visitor
        if visitor.setting.path.suffix != ".yaml":
            return None
        return EditedEnvironment(visitor.setting.path, visitor.studio.corpus.folder)

    def _offer(self) -> None:
        """Offer the states that the object can be given."""
        edited, name = self._edited(), self._visitor.selected
        self._offered = name
        found = edited.changes(name) if edited is not None and name is not None else []
        self._changes = {str(change): change for change in found}
        self._state.options = (NOTHING, *self._changes)

    def _pointed(self) -> str:
        if self._visitor.selected is None:
            raise TmdError("no object is chosen", hint="click on one, or choose it")
        return self._visitor.selected

    def _there(self) -> tuple[str, str]:
        place = chosen(self._place)
        if place == NOTHING:
            raise TmdError("choose a place first")
        return chosen(self._relation), place

    def _change(self) -> None:
        name, change = self._pointed(), self._changes.get(self._state.value)
        if change is None:
            raise TmdError("choose a state first")
        self._become(lambda edited: edited.change(name, change), f"{name}: {change}", name)

    def _put(self) -> None:
        name, (relation, place) = self._pointed(), self._there()
        self._become(lambda edited: edited.put(name, relation, place), f"{name} is {relation} {place}", name)

    def _add(self) -> None:
        kind, (relation, place) = chosen(self._kind), self._there()
        if kind == NOTHING:
            raise TmdError("choose what shall be added first")
        self._become(lambda edited: edited.add(kind, relation, place), f"a {kind} is {relation} {place}", None)

    def _remove(self) -> None:
        name = self._pointed()
        self._become(lambda edited: edited.remove(name), f"{name} is gone", None)

    def _become(self, change: Callable[[EditedEnvironment], object], words: str, name: str | None) -> None:
        """Go to the environment that a change makes of this one."""
        visitor = self._visitor
        visitor.enter(visitor.studio.changed(visitor.setting, change))
        visitor.select(name)
        visitor.tell(f"Changed: {words}. Save it as an environment to demonstrate in it.")

    def _keep(self) -> None:
        visitor = self._visitor
        name = visitor.studio.keep_environment(visitor.setting, self._name.value.strip())
        visitor.enter(name)
        visitor.tell(f"Saved as the environment {name}.", aloud=True)

    def refresh(self) -> None:
        """Show the state that is seen now."""
        visitor = self._visitor
        name, reel, step, world = visitor.selected, visitor.reel, visitor.cursor, visitor.setting.world
        now = reel.facts(step)
        before = reel.facts(step - 1) if step else now
        changes = GraphChanges(now - before, before - now)
        if name is None:
            hint = "<p>Click on an object, or choose one: its parts and states are shown.</p>"
            drawn = self._names()[:DRAWN] if visitor.setting.look is None else ()  # where there is no picture
            graphs = "".join(object_graph(world, now, each, changes) for each in drawn)
            self._facts.content = fragment(f"<style>{style()}</style>{hint}{graphs}")
            return
        put(self._which, name)
        if self._offered != name:
            self._offer()
        said = visitor.wording.fact
        came, went = (sorted(a for a in more if name in a.args) for more in (now - before, before - now))
        gains = changed(came, went, said)
        lines = "".join(f"<li>{line}</li>" for line in gains)
        news = f"<h4>Changed by the last step</h4><ul>{lines}</ul>" if lines else ""
        graph = object_graph(world, now, name, changes)
        names = (name, *(part for _, part in world.profiles.parts.get(name, ())))
        facts = "".join(object_facts(about(each, world, reel.states[step]), said) for each in names)
        self._facts.content = fragment(f"<style>{style()}</style>{news}{graph}{facts}")
