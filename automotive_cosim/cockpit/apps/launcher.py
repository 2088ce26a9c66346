"""The launcher: every app, to be opened."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.store import Installed
from automotive_cosim.cockpit.cards import content, rows
from automotive_cosim.cockpit.flow import fill
from automotive_cosim.cockpit.messages import Show
from automotive_cosim.cockpit.registry import apps, apps_in
from automotive_cosim.cockpit.room import Room
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.widgets import Button, Widget
from automotive_cosim.contracts.text import say


def launcher(state: State) -> tuple[Widget, ...]:
    """All installed apps, then those of the car, and those of the dock last."""
    offered = (
        *(apps()[name] for name in state.of(Installed).apps),
        *apps_in(Where.LAUNCHER),
        *apps_in(Where.STATUS),
        *(app for app in apps_in(Where.DOCK) if app.name not in ("home", "apps")),
    )
    offered = tuple(app for app in offered if app.name not in state.make.placed)

    def entry(index: int, app: App) -> Button:
        return Button(
            key=f"apps.{app.name}",
            text=app.title,
            icon=app.icon,
            icon_size=44,
            stacked=True,
            style=Type.STRONG,
            on_tap=Show(app.name),
        )

    return fill(content(state), rows("apps.all", say("Apps"), state, offered, entry, columns=6, height=170, gap=16))


APP = App(
    name="apps",
    title=say("Apps"),
    icon=Icon.APPS,
    order=9,
    where=Where.DOCK,
    pages={"apps": AppPage(launcher, Room.ONE)},
)
