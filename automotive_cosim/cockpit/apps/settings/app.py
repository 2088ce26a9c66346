"""Settings: display and units, sound, connections, language and time, privacy, profiles."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.settings.screens import (
    connections,
    language,
    privacy,
    profile_list,
    settings,
    sound,
)
from automotive_cosim.cockpit.apps.settings.state import (
    NETWORKS,
    PHONES,
    PROFILES,
    TABLET,
    Connections,
    SwitchProfile,
    profiles,
)
from automotive_cosim.cockpit.apps.vehicle.state import CarMemory
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.functions import CallMade, disabled, locked, offered
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.signals import LINK
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say, say_in
from automotive_cosim.formats.annotations import OneOf


@offered
def switch_profile(state: State, profile: Annotated[str, OneOf(PROFILES), "The profile."]) -> CallMade:
    """Switch to a driver's profile, with its seat, mirrors, temperature and brightness. Only while parked."""
    return locked(state, Restriction.NO_SETUP) or SwitchProfile(profile)


@offered
def connect_wifi(state: State, network: Annotated[str, OneOf(NETWORKS), "Name of the network."]) -> CallMade:
    """Connect to a Wi-Fi network, with Wi-Fi on. Only while parked."""
    if refusal := locked(state, Restriction.NO_SETUP):
        return refusal
    if not state.signals[LINK.WIFI]:
        return disabled(say("Wi-Fi is off"))
    return Put(replace(state.of(Connections), network=network), "")


@offered
def pair_device(
    state: State,
    device: Annotated[str, OneOf((*PHONES, TABLET)), "The device. A phone takes the other phone's place."],
    on: Annotated[bool, "False unpairs the tablet; a phone stays paired until another one is."] = True,
) -> CallMade:
    """Pair a phone or the tablet by Bluetooth. Only while parked."""
    if refusal := locked(state, Restriction.NO_SETUP):
        return refusal
    if not state.signals[LINK.BLUETOOTH]:
        return disabled(say("Bluetooth is off"))
    now = state.of(Connections)
    if device == TABLET:
        return Put(replace(now, tablet=on), "")
    return Put(replace(now, phone=device), "") if on else disabled("a phone stays paired until another one is")


FUNCTIONS = (switch_profile, connect_wifi, pair_device)


APP = App(
    name="settings",
    title=say("Settings"),
    short=say_in("dock", "Settings"),
    icon=Icon.SETTINGS,
    order=10,
    where=Where.DOCK,
    functions=FUNCTIONS,
    pages={
        "settings": AppPage(settings),
        "sound": AppPage(sound),
        "connections": AppPage(connections),
        "language": AppPage(language),
        "privacy": AppPage(privacy),
        "profiles": AppPage(profile_list),
    },
    aliases={"system": ""},
    starts=lambda state, rng: (Connections(), profiles(state.of(CarMemory))),
    turn=6,
)
