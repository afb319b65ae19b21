"""The panel of the object that was pointed at: its parts and states, what it is to others, and what controls what."""

from __future__ import annotations

from tmd.studio.visitor import Panel, Visitor, put
from tmd.view.panels import changed, fragment, object_facts

NOTHING = "(nothing)"


class ObjectPanel(Panel):
    """Panel of one object of the state that is shown."""

    def __init__(self, visitor: Visitor) -> None:
        super().__init__(visitor)
        self._which = visitor.dropdown("Object", (NOTHING,), lambda: visitor.point(self._which))
        self._facts = visitor.client.gui.add_html("")
        self.entered()

    def entered(self) -> None:
        """Show the objects of another environment."""
        self._which.options = (NOTHING, *self._visitor.setting.names())
        put(self._which, NOTHING)
        self.seen()

    def pointed(self) -> None:
        """Show the object that was pointed at."""
        self.seen()

    def seen(self) -> None:
        """Show the state that is seen now."""
        visitor = self._visitor
        name, reel, step, world = visitor.selected, visitor.reel, visitor.cursor, visitor.setting.world
        said = visitor.setting.wording.fact
        if name is None:
            hint = "<p>Click on an object, or choose one: its parts and states are shown.</p>"
            self._facts.content = fragment(hint)
            return
        put(self._which, name)
        came, went = ([atom for atom in more if name in atom.args] for more in reel.changes(step))
        lines = "".join(f"<li>{line}</li>" for line in changed(came, went, said))
        news = f"<h4>Changed by the last step</h4><ul>{lines}</ul>" if lines else ""
        names = (name, *(part for _, part in world.profiles.parts.get(name, ())))
        facts = "".join(object_facts(each, world, reel.states[step], said) for each in names)
        self._facts.content = fragment(news + facts)
