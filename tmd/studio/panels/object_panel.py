"""The panel of the object that was pointed at: its parts and states, what it is to others, and what controls what."""

from __future__ import annotations

from tmd.studio.object_info import about
from tmd.studio.panels.context import PanelContext
from tmd.studio.panels.html import changed, fragment, object_facts
from tmd.studio.panels.widgets import chosen, put
from tmd.view.markup import style
from tmd.view.object_graph import GraphChanges, object_graph

NOTHING = "(nothing)"


class ObjectPanel:
    """Shows one object of the state that is seen.

    Args:
        visitor: Whose panel it is.
    """

    def __init__(self, visitor: PanelContext) -> None:
        self._visitor = visitor
        gui = visitor.client.gui
        self._which = gui.add_dropdown("Object", (NOTHING, *self._names()))
        self._which.on_update(visitor.guarded(self._chosen))
        self._facts = gui.add_html("")
        self.refresh()

    def _names(self) -> list[str]:
        return self._visitor.setting.names()

    def _chosen(self) -> None:
        name = None if self._which.value == NOTHING else chosen(self._which)
        if name != self._visitor.selected:
            self._visitor.select(name)

    def entered(self) -> None:
        """Another environment."""
        self._which.options = (NOTHING, *self._names())
        put(self._which, NOTHING)
        self.refresh()

    def refresh(self) -> None:
        """Show the state that is seen now."""
        visitor = self._visitor
        name = visitor.selected
        if name is None:
            self._facts.content = fragment("<p>Click on an object, or choose one: its parts and states are shown.</p>")
            return
        if self._which.value != name:
            put(self._which, name)
        reel, step = visitor.reel, visitor.cursor
        world = visitor.setting.world
        now = reel.facts(step)
        before = reel.facts(step - 1) if step else now
        said = visitor.studio.offers(visitor.setting.name).wording.fact
        came, went = (sorted(a for a in more if name in a.args) for more in (now - before, before - now))
        gains = changed(came, went, said)
        lines = "".join(f"<li>{line}</li>" for line in gains)
        news = f"<h4>Changed by the last step</h4><ul>{lines}</ul>" if lines else ""
        graph = object_graph(world, now, name, GraphChanges(now - before, before - now))
        names = (name, *(part for _, part in world.profiles.parts.get(name, ())))
        facts = "".join(object_facts(about(each, world, reel.states[step]), said) for each in names)
        self._facts.content = fragment(f"<style>{style()}</style>{news}{graph}{facts}")
