"""Networks and devices that the car is linked to, and the drivers' profiles, one of which is chosen."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from automotive_cosim.cockpit.apps.vehicle.state import REMEMBERED, CarMemory
from automotive_cosim.cockpit.commands import set_all
from automotive_cosim.cockpit.signals import HMI, HVAC, LINK, Signal
from automotive_cosim.cockpit.state import AppData, Command, State
from automotive_cosim.contracts import Feedback, FeedbackCode
from automotive_cosim.contracts.text import say

PROFILES = (say("Driver 1"), say("Driver 2"), say("Guest"))
NETWORKS = ("Home-5G", "CityFree", "Garage", "Coffee-Guest")
PHONES = (say("Driver's phone"), say("Second phone"))
"""Of these one is paired, for calls and messages."""
TABLET = say("Tablet")
"""It is paired beside the phone, for its music."""


@dataclass(frozen=True, slots=True)
class UserProfile:
    """A driver's preferences: values of signals."""

    name: str
    values: tuple[tuple[Signal[Any], Any], ...]


@dataclass(frozen=True, slots=True)
class Connections(AppData):
    """What is connected and paired."""

    network: str = ""
    """The Wi-Fi network, while Wi-Fi is on."""
    phone: str = PHONES[0]
    """The paired phone."""
    tablet: bool = False
    """Whether the tablet is paired too."""

    def commands(self) -> dict[str, Any]:
        return {"wifi.network": self.network, "bluetooth.devices": [self.phone, *([TABLET] if self.tablet else [])]}


@dataclass(frozen=True, slots=True)
class Profiles(AppData):
    """The drivers, and who of them drives."""

    known: tuple[UserProfile, ...]
    driver: str = PROFILES[0]

    def commands(self) -> dict[str, Any]:
        return {"driver.profile": self.driver}


def wifi(state: State) -> str:
    """Name of the Wi-Fi network that the car is on; empty without."""
    return state.of(Connections).network if state.signals[LINK.WIFI] else ""


def profiles(car: CarMemory) -> Profiles:
    """A profile for each seat that the car remembers."""
    return Profiles(tuple(_profile(name, seat) for name, seat in zip(PROFILES, car.memory, strict=True)))


def _profile(name: str, seat: tuple[float, ...]) -> UserProfile:
    warmth = {"Driver 1": 21.0, "Driver 2": 22.5, "Guest": 20.0}[name]
    return UserProfile(
        name,
        (
            *zip(REMEMBERED, seat, strict=True),
            (HVAC.DRIVER_TEMPERATURE, warmth),
            (HMI.BRIGHTNESS, 80.0 if name == "Driver 2" else 70.0),
        ),
    )


@dataclass(frozen=True, slots=True)
class SwitchProfile(Command):
    """Switch to a driver's profile."""

    profile: str

    def aims(self, state: State) -> frozenset[str]:
        return frozenset({"driver.profile"})

    def perform(self, state: State) -> Feedback:
        """The profile's seat, mirrors, temperature and brightness."""
        name, profiles = self.profile, state.of(Profiles)
        values = next(profile.values for profile in profiles.known if profile.name == name)
        feedback = set_all(state, values, say("{name} is now the driver", name=name))
        if feedback.code is FeedbackCode.REFUSED:
            return feedback
        state.keep(replace(profiles, driver=name))
        return Feedback(FeedbackCode.OK, say("{name} is now the driver", name=name))
