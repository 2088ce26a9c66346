"""The script of a drive: everything that is drawn before it departs. It is data, and is written as JSON."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Annotated

from annotated_types import Ge, Gt, Le, MinLen

from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.changes import CarChange
from automotive_cosim.cockpit.occupants import Occupant
from automotive_cosim.contracts.errand import Errand
from automotive_cosim.formats.annotations import Form, Latitude, Longitude
from automotive_cosim.formats.checked import as_json, checked
from automotive_cosim.formats.incidents import AnyIncident
from automotive_cosim.formats.toml import dotted
from automotive_cosim.scenarios import WeatherAt
from automotive_cosim.traffic.base import DriverAt, HaltAt

SHORTEST_S = 600.0
LONGEST_S = 1800.0
"""Ten to thirty minutes: long enough for a rate per hour, short enough for a batch."""
APART_S = 45.0
"""Minimum time between two things that are staged."""
QUIET_S = 300.0
"""Minimum length of the span in which nothing is staged."""


@dataclass(frozen=True, slots=True)
class Staged:
    """One thing that the script stages. It helps readers of a script; no judge reads it, because what counts is
    found on the drive itself."""

    kind: str
    """Kind of event, such as ``belt``."""
    at_s: float
    """Seconds after departure."""
    is_lookalike: bool
    """Whether it only looks like that kind."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveScript:
    """One drive, by name and number: the same script and the same actions give the same trace. Times are simulated
    seconds after departure."""

    family: str
    """Id of the family it was drawn from."""
    seed: Annotated[int, Ge(0)]
    """Seed of the traffic, and of everything that is drawn."""
    scenario: Annotated[str, MinLen(1)]
    """A shipped scenario, a folder, a ``.sumocfg`` or a network."""
    trips: Annotated[tuple[str, ...], MinLen(1)]
    """Names of the scenario's trips, in driving order and over again."""
    duration_s: Annotated[float, Ge(SHORTEST_S), Le(LONGEST_S)]
    """When it ends."""
    start: Annotated[str, Form(r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d$", "2026-03-10T08:30:00")]
    """Local date and time at departure, in the place's own time zone."""
    weather: Annotated[tuple[WeatherAt, ...], MinLen(1)]
    """The weather, in the order of the times; the first entry's is 0."""
    origin: tuple[Longitude, Latitude] | None = None
    """Longitude and latitude that the network's middle is moved to; None leaves it where it is."""
    density: Annotated[float, Gt(0)] = 1.0
    """Factor on the scenario's traffic."""
    driver: str = "average"
    """Name of a driver profile."""
    moods: tuple[DriverAt, ...] = ()
    """Changes of the way that the driver drives."""
    at_schools: tuple[str, ...] = ()
    """Names of the driver profiles for school zones at their hours, one a zone, over and over again."""
    aboard: tuple[Occupant, ...] = ()
    """Who is in the car besides the driver."""
    trailer: bool = False
    """Whether the car tows a trailer, for which the law may have other limits."""
    signals: Mapping[str, bool | float | str] = field(default_factory=dict)
    """VSS paths and values at departure."""
    halts: tuple[HaltAt, ...] = ()
    """Where the driver parks for a while."""
    changes: tuple[CarChange, ...] = ()
    """Changes of the car that nobody commands."""
    arrivals: tuple[Arrival, ...] = ()
    """Incoming calls and messages."""
    errands: tuple[Errand, ...] = ()
    """What people aboard ask for."""
    incidents: tuple[AnyIncident, ...] = ()
    """Incidents on the road, besides the scenario's own."""
    staged: tuple[Staged, ...] = ()
    """What is staged by all of this, in the order of the times."""
    driven_s: Annotated[float, Ge(0)] = 0.0
    """How long the driver had been driving without a break before departure."""
    quiet_s: tuple[float, float] = (0.0, 0.0)
    """From when to when nothing is staged."""
    attention: bool = False
    """Whether the driver's attention can be taken, whatever the conditions say."""
    coarse: bool = False
    """Whether SUMO runs in steps of a second instead of the scenario's own."""


def script_json(script: DriveScript) -> str:
    """The script as JSON; ``read_script`` reads it."""
    values = asdict(script)
    if script.density == 1.0:
        del values["density"]  # scripts from before there was one have the same text
    for name in ("attention", "coarse", "errands", "trailer"):
        if not values[name]:
            del values[name]
    return json.dumps(json.loads(as_json(values)), indent=1)


def read_script(text: str, source: str = "the script of the drive") -> DriveScript:
    """A script from its JSON.

    Raises:
        UserError: it is not one; the message says what is wrong where.
    """
    try:
        values = json.loads(text)
    except ValueError:
        values = text
    return checked(DriveScript, values, lambda steps: (source, dotted(steps)))
