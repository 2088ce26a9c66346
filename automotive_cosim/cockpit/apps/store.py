"""The store: apps that can be installed and removed while parked."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Annotated, Any

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.cards import content, rows, title
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.flow import card, fill
from automotive_cosim.cockpit.functions import CallMade, locked, offered, unknown
from automotive_cosim.cockpit.registry import apps_in
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.room import Room
from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.cockpit.widgets import Row, Widget
from automotive_cosim.contracts.text import say


@dataclass(frozen=True, slots=True)
class Installed(AppData):
    """Names of the installed apps, among those that can be removed."""

    apps: tuple[str, ...]

    def with_app(self, name: str, wanted: bool, offered: Iterable[str]) -> Installed:
        """A copy with or without an app, in the order of all that are offered."""
        return Installed(tuple(app for app in offered if (wanted if app == name else app in self.apps)))

    def commands(self) -> dict[str, Any]:
        return {"apps.installed": list(self.apps)}


def store(state: State) -> tuple[Widget, ...]:
    """Apps that can be installed and removed while parked."""
    apps, installed = apps_in(Where.STORE), state.of(Installed)
    names = [app.name for app in apps]

    def entry(index: int, app: App) -> Row:
        there = app.name in installed.apps
        return Row(
            key=f"store.{app.name}",
            raised=True,
            text=app.title,
            detail=app.about,
            trail=say("Remove") if there else say("Install"),
            icon=app.icon,
            locked=state.locked(Restriction.NO_SETUP),
            on_tap=Put(
                installed.with_app(app.name, not there, names),
                say("{name} is removed", name=app.title) if there else say("{app} is installed", app=app.title),
            ),
        )

    every = rows("store.apps", say("Apps"), state, apps, entry, height=58, gap=6)
    return fill(content(state), card(title(Icon.STORE, say("Store")), 16, every, padding=(28, 20)))


@offered
def install_app(
    state: State,
    app: Annotated[str, "Name of an app of the store, as the screen store tells it."],
    on: Annotated[bool, "True installs it, false removes it."],
) -> CallMade:
    """Install an app of the store, or remove it. Only while parked."""
    there = apps_in(Where.STORE)
    names = {name.casefold(): each.name for each in there for name in (each.name, each.title)}
    found = names.get(app.casefold().strip())
    if found is None:
        return unknown("app of the store", app, (each.name for each in there))
    offers = [each.name for each in there]
    return locked(state, Restriction.NO_SETUP) or Put(state.of(Installed).with_app(found, on, offers), "")


APP = App(
    name="store",
    title=say("Store"),
    icon=Icon.STORE,
    order=18,
    functions=(install_app,),
    pages={"store": AppPage(store, Room.ONE)},
    starts=lambda state, rng: (Installed(tuple(app.name for app in apps_in(Where.STORE) if app.preinstalled)),),
)
