"""Data of the smaller apps: memos, parking tickets, set times, remembered seats, and the manual."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from automotive_cosim.cockpit.places import Gazetteer, PlaceKind
from automotive_cosim.cockpit.signals import HMI, HVAC, MIRROR, SEAT, Signal, Signals
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts.text import say

TOOLS: Mapping[str, tuple[str, Icon, str]] = {
    "charging": (say("Charging"), Icon.CHARGING, say("Charge limit, times and stations nearby")),
    "parking": (say("Parking"), Icon.TICKET, say("Pay for a parking space from the car")),
    "manual": (say("Manual"), Icon.MANUAL, say("The owner's handbook, to search in")),
    "memo": (say("Memos"), Icon.MEMO, say("Spoken notes")),
    "trip": (say("Trip"), Icon.TRIP, say("Distance, time and consumption")),
    "calendar": (say("Calendar"), Icon.CALENDAR, say("Today's appointments and how to get there")),
}
"""Apps that can be installed: title, icon and description."""
PREINSTALLED = ("charging", "parking", "manual", "memo", "trip")
REMEMBERED: tuple[Signal[float], ...] = (
    SEAT.DRIVER_POSITION,
    SEAT.DRIVER_HEIGHT,
    SEAT.DRIVER_RECLINE,
    SEAT.DRIVER_LUMBAR,
    MIRROR.DRIVER_PAN,
    MIRROR.DRIVER_TILT,
    MIRROR.PASSENGER_PAN,
    MIRROR.PASSENGER_TILT,
)
"""Signals stored in a seat memory."""
PROFILES = (say("Driver 1"), say("Driver 2"), say("Guest"))
NETWORKS = ("Home-5G", "CityFree", "Garage", "Coffee-Guest")
PHONES = (say("Driver's phone"), say("Second phone"))
"""Of these one is paired, for calls and messages."""
TABLET = say("Tablet")
"""It is paired beside the phone, for its music."""
MANUAL: tuple[tuple[str, Icon, str], ...] = (
    (
        say("Windows are fogged"),
        Icon.DEFROST_FRONT,
        say(
            "Fog inside: blow dry air at the windshield with the front defroster, and switch recirculation off. "
            "Fog outside: use the wipers. The rear window has a heater of its own."
        ),
    ),
    (
        say("Fog lamps"),
        Icon.REAR_FOG,
        say(
            "Front fog lamps work with position lamps or low beam, the rear one with low beam or front fog lamps. "
            "When they may be lit is a matter of local law: the rear fog lamp dazzles those behind."
        ),
    ),
    (
        say("Tyre pressures"),
        Icon.TYRE,
        say(
            "Check them cold. The pressure falls by about a tenth of a bar for every ten degrees that it gets "
            "colder. Add air when a tyre is a fifth below the value on the door frame."
        ),
    ),
    (
        say("Cruise control"),
        Icon.CRUISE,
        say(
            "It holds the set speed and, when adaptive, the chosen gap to the car in front. The limiter lets you "
            "accelerate up to its speed but not beyond. Only one of them is active at a time."
        ),
    ),
    (
        say("Saving range"),
        Icon.BATTERY,
        say("Drive slower, use economy mode, and warm the seats rather than the air: a seat takes a tenth of it."),
    ),
    (
        say("Driving on ice"),
        Icon.SLIPPERY,
        say(
            "Snow mode softens the throttle. Keep stability control on, leave a gap several times as long as "
            "usual, and brake early and gently."
        ),
    ),
    (
        say("Child safety"),
        Icon.CHILD,
        say(
            "Child locks keep the rear doors from being opened from inside; the window lock blocks the rear "
            "switches."
        ),
    ),
    (
        say("After a crash"),
        Icon.PHONE_ALERT,
        say(
            "Switch the hazard lights on, call for help from the safety centre, which sends the position, and wait "
            "beyond the barrier."
        ),
    ),
    (
        say("Charging"),
        Icon.CHARGING,
        say("For daily driving charge to 80 %. Above that the battery takes power ever more slowly."),
    ),
    (
        say("Mirrors and seats"),
        Icon.SEAT,
        say("Set the seat first, then the mirrors. Up to three positions can be stored and recalled while parked."),
    ),
)
"""Topic, icon and text."""
FILM_S = 40.0
"""Length of a topic's video."""
APPOINTMENTS = 4
_OCCASIONS = (
    (say("Check-up"), PlaceKind.HOSPITAL),
    (say("Team meeting"), PlaceKind.WORK),
    (say("A meal with Nora"), PlaceKind.RESTAURANT),
    (say("Parents' evening"), PlaceKind.SCHOOL),
    (say("Training"), PlaceKind.GYM),
    (say("Groceries"), PlaceKind.SHOP),
    (say("Meet the visitors"), PlaceKind.STATION),
)
ZONES = (say("Zone A"), say("Zone B"), say("Zone C"))
PRICES = {"Zone A": 4.0, "Zone B": 2.5, "Zone C": 1.2}
"""Price per hour."""


@dataclass(frozen=True, slots=True)
class Ticket:
    """A paid parking space; payments cannot be undone."""

    zone: str
    minutes: int
    price: float
    until: str


@dataclass(frozen=True, slots=True)
class Timer:
    """A time of day at which something happens."""

    on: bool = False
    minute: int = 7 * 60
    """Minute of the day."""

    @property
    def shown(self) -> str:
        """The time as hours and minutes."""
        return f"{self.minute // 60:02d}:{self.minute % 60:02d}"

    def moved(self, minutes: int) -> Timer:
        """A copy with another time of day."""
        return replace(self, minute=(self.minute + minutes) % 1440)


@dataclass(frozen=True, slots=True)
class UserProfile:
    """A driver's preferences: values of signals."""

    name: str
    values: tuple[tuple[Signal[Any], Any], ...]


@dataclass(frozen=True, slots=True)
class Appointment:
    """An entry of the calendar."""

    at: str
    title: str
    place: str

    @property
    def name(self) -> str:
        """Tells it from others, regardless of its time."""
        return say("{first}, {second}", first=self.title, second=self.place)


@dataclass(frozen=True, slots=True)
class TripMeter:
    """What a trip meter has counted up to a reading of the odometer, from which it counts on."""

    driven_m: float = 0.0
    took_s: float = 0.0
    used_kwh: float = 0.0
    since: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Driven metres, time and battery (``errands.odometer``) from which it counts on: at departure or the reset."""
    resets: int = 0

    def at(self, reading: tuple[float, float, float], battery_kwh: float) -> tuple[float, float, float]:
        """Metres, seconds and kWh that it shows at a reading of the odometer."""
        (metres, seconds, level), (from_m, from_s, from_level) = reading, self.since
        used_kwh = max(0.0, from_level - level) / 100 * battery_kwh
        return self.driven_m + max(0.0, metres - from_m), self.took_s + seconds - from_s, self.used_kwh + used_kwh


FROM_HERE = TripMeter()
"""A trip meter that has counted nothing yet."""


@dataclass(frozen=True, slots=True)
class Desk:
    """Everything the driver has set or created in the smaller apps."""

    memory: tuple[tuple[float, ...], ...]
    """Values of ``REMEMBERED`` by memory slot."""
    profiles: tuple[UserProfile, ...]
    agenda: tuple[Appointment, ...]
    profile: str = PROFILES[0]
    installed: tuple[str, ...] = PREINSTALLED
    memos: tuple[str, ...] = ()
    recording_since_s: float | None = None
    film: tuple[int, float] | None = None
    """The topic of the manual whose video is playing, and since when."""
    zone: str = ZONES[0]
    minutes: int = 60
    tickets: tuple[Ticket, ...] = ()
    climate_at: Timer = Timer()
    charge_by: Timer = Timer()
    network: str = ""
    phone: str = PHONES[0]
    """The paired phone."""
    tablet: bool = False
    """Whether the tablet is paired too."""
    resets: int = 0
    trip_from: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Driven metres, time and battery when the trip computer was reset."""
    trip_b: TripMeter = FROM_HERE
    """The second trip meter, which is reset by itself."""

    def with_memory(self, slot: int, signals: Signals) -> Desk:
        """With the present seat position stored in a memory slot."""
        values = tuple(signals[signal] for signal in REMEMBERED)
        return replace(self, memory=(*self.memory[:slot], values, *self.memory[slot + 1 :]))

    def with_app(self, name: str, wanted: bool) -> Desk:
        """A copy with or without an app."""
        return replace(
            self, installed=tuple(app for app in TOOLS if (wanted if app == name else app in self.installed))
        )

    def commands(self) -> dict[str, Any]:
        """Everything that was set, created or paid, as app data."""
        return {
            "apps.installed": list(self.installed),
            "apps.memos": list(self.memos),
            "apps.recording": self.recording_since_s is not None,
            "apps.film": "" if self.film is None else MANUAL[self.film[0]][0],
            "parking.zone": self.zone,
            "parking.minutes": self.minutes,
            "payments": [{"zone": t.zone, "minutes": t.minutes, "price": t.price} for t in self.tickets],
            "climate.schedule": self.climate_at.shown if self.climate_at.on else "",
            "charging.schedule": self.charge_by.shown if self.charge_by.on else "",
            "seat.memory": [list(values) for values in self.memory],
            "driver.profile": self.profile,
            "wifi.network": self.network,
            "bluetooth.devices": [self.phone, *([TABLET] if self.tablet else [])],
            "trip.resets": self.resets,
            "trip.resets_b": self.trip_b.resets,
            "calendar.entries": [
                {"at": entry.at, "title": entry.title, "place": entry.place} for entry in self.agenda
            ],
        }


def desk(rng: np.random.Generator, atlas: Gazetteer) -> Desk:
    """Draws earlier stored data, and the day's appointments at places of the network."""
    memory = tuple(_seat(rng) for _ in range(3))
    hours = np.sort(rng.choice(np.arange(8, 21), APPOINTMENTS, replace=False))
    agenda = []
    for hour, at in zip(hours, rng.permutation(len(_OCCASIONS))[:APPOINTMENTS], strict=True):
        title, kind = _OCCASIONS[int(at)]
        there = atlas.of(kind)
        if there:
            place = there[int(rng.integers(len(there)))].name
            agenda.append(Appointment(f"{hour:02d}:{30 * int(rng.integers(2)):02d}", title, place))
    profiles = tuple(_profile(name, values) for name, values in zip(PROFILES, memory, strict=True))
    return Desk(memory, profiles, tuple(agenda))


def _seat(rng: np.random.Generator) -> tuple[float, ...]:
    def step(signal: Signal[float]) -> float:
        steps = int(rng.integers(round((signal.high - signal.low) / signal.step) // 2 + 1))
        return signal.low + (steps + round((signal.high - signal.low) / signal.step) // 4) * signal.step

    return tuple(step(signal) for signal in REMEMBERED)


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
