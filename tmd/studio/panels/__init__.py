"""The panels of the studio's page: say, demonstrate, correct, the object that was pointed at, and the player above.

Begin with :class:`tmd.studio.visitor.Panel`, their base.
"""

from __future__ import annotations

from tmd.studio.panels.correct_panel import CorrectPanel
from tmd.studio.panels.demonstrate_panel import DemonstratePanel
from tmd.studio.panels.object_panel import ObjectPanel
from tmd.studio.panels.player_panel import PlayerPanel
from tmd.studio.panels.say_panel import SayPanel
from tmd.studio.visitor import TABS, Visitor


def furnish(visitor: Visitor) -> None:
    """Put the panels onto the page of a visitor."""
    with visitor.lock:
        PlayerPanel(visitor)
        tabs = visitor.client.gui.add_tab_group()
        for name, panel in zip(TABS, (SayPanel, DemonstratePanel, CorrectPanel, ObjectPanel), strict=True):
            with tabs.add_tab(name):
                panel(visitor)
