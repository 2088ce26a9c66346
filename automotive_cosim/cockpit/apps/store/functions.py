"""The function of the store."""

from __future__ import annotations

from typing import Annotated

from automotive_cosim.cockpit.app import Where
from automotive_cosim.cockpit.apps.store.state import Installed
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.functions import CallMade, locked, offered, unknown
from automotive_cosim.cockpit.registry import apps_in
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.state import State


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


FUNCTIONS = (install_app,)
