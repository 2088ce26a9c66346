"""The store: apps that can be installed and removed while parked."""

from __future__ import annotations

from automotive_cosim.cockpit.app import Where
from automotive_cosim.cockpit.apps.store.state import Installed
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.parts import content, rows, title
from automotive_cosim.cockpit.registry import apps_in
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.cockpit.widgets import Card, Row, Widget
from automotive_cosim.contracts.text import say


def store(state: State) -> tuple[Widget, ...]:
    """Apps that can be installed and removed while parked."""
    area = content(state)
    inner = area.inset(28, 20)
    locked = state.locked(Restriction.NO_SETUP)
    offered, installed = apps_in(Where.STORE), state.of(Installed)
    names = [app.name for app in offered]

    def line(index: int, cell: Rect) -> Row:
        app = offered[index]
        there = app.name in installed.apps
        return Row(
            rect=cell,
            key=f"store.{app.name}",
            raised=True,
            text=app.title,
            detail=app.about,
            trail=say("Remove") if there else say("Install"),
            icon=app.icon,
            locked=locked,
            on_tap=Put(
                installed.with_app(app.name, not there, names),
                say("{name} is removed", name=app.title) if there else say("{app} is installed", app=app.title),
            ),
        )

    return (
        Card(
            rect=area,
            children=(
                title(inner.top(40), Icon.STORE, say("Store")),
                rows(inner.below(56), "store.apps", say("Apps"), state, len(names), line, height=68, gap=8),
            ),
        ),
    )
