"""What of a drive can be set otherwise than its script has it; what is right is found on the drive itself."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from datetime import datetime, timedelta
from math import inf
from typing import Annotated

from annotated_types import Ge, Gt, Le, Lt

from automotive_cosim.cockpit.occupants import Kind, Occupant, Seat
from automotive_cosim.contracts import Weather
from automotive_cosim.drives.errands import with_errands
from automotive_cosim.drives.family import timeline
from automotive_cosim.drives.script import DriveScript, Staged
from automotive_cosim.drives.sky import fog
from automotive_cosim.drives.staging import ON_REQUEST, Causes, Setting
from automotive_cosim.formats.annotations import OneOf
from automotive_cosim.geo.weather import FOG_BELOW_M, HEAVY_RAIN_FROM_MM_PER_H
from automotive_cosim.tasking.draws import Draws, Purpose
from automotive_cosim.traffic.profiles import PROFILES

NOTHING, NOBODY = "nothing", "nobody"
"""Words for no staging, and for an empty car."""
STAGE_S = 60.0
"""When something is staged unless said otherwise: the car is on its way, as in ``family.FIRST_S``."""


@dataclass(frozen=True, slots=True, order=True)
class DriveSettings:
    """What is set otherwise than the script has it; None leaves it as it is."""

    hour: Annotated[float, Ge(0), Lt(24)] | None = None
    """Local time at departure."""
    visibility_m: Annotated[float, Ge(10), Le(100_000)] | None = None
    """The farthest that one can see at any time; below a kilometre it is fog, unless something falls."""
    rain_mm_h: Annotated[float, Ge(0), Le(100)] | None = None
    """The least that falls at any time, as snow in the cold."""
    temperature_c: Annotated[float, Ge(-40), Le(55)] | None = None
    """Temperature of the air all the time."""
    density: Annotated[float, Gt(0), Le(5)] | None = None
    """Factor on the traffic of the place."""
    driver: Annotated[str, OneOf(tuple(PROFILES), "driver")] | None = None
    """Name of a driver profile."""
    driven_min: Annotated[float, Ge(0), Le(1440)] | None = None
    """How long the driver had been driving without a break before departure."""
    minutes: Annotated[float, Gt(0), Le(60)] | None = None
    """When it is over and judged, if the script ends later: to try a model that costs money or time. Its score is
    not that of a whole drive, which has more events."""

    errands: bool | None = None
    """Whether people aboard also ask for things on the way, near what is staged (``drives.errands``)."""
    stage: Annotated[str, OneOf((NOTHING, *ON_REQUEST), "staging")] | None = None
    """What is staged, once and as an event, instead of all that the script stages; ``nothing`` stages nothing.
    Calls and messages stay."""
    stage_s: Annotated[float, Ge(0), Le(1800)] | None = None
    """When that is staged, in seconds after departure; a minute without it."""
    ahead_m: Annotated[float, Gt(0), Le(5000)] | None = None
    """How far ahead of the car what is staged stands, drives or moves over, or how far behind an ambulance
    appears."""
    aboard: Annotated[str, OneOf((NOBODY, *Kind), "occupant")] | None = None
    """Who rides on the rear seat, behind the passenger's, besides the driver and nobody else."""
    trailer: bool | None = None
    """Whether the car tows a trailer, for which the law may have other limits; it drives as if without one."""
    cars: Annotated[int, Ge(1), Le(512)] | None = None
    """How many cars drive in one traffic, each with a cockpit, an agent, a driver and a judge of its own: a fleet.
    Car ``k`` drives what the seed ``k`` further on says, and enters as soon as there is a gap."""
    coarse: bool | None = None
    """Whether SUMO runs in steps of a second, which takes a fraction of the time; the traffic is another then, and
    drivers act only once a second."""

    @property
    def tags(self) -> tuple[str, ...]:
        """Whatever is set, for ids."""
        return tuple(f"{name}{_told(value)}" for name, value in self._set())

    @property
    def words(self) -> str:
        """Whatever is set: ``hour 22, density 0.5``."""
        return ", ".join(f"{name} {_told(value)}" for name, value in self._set())

    def applied(self, script: DriveScript) -> DriveScript:
        made = script
        if self.hour is not None:
            day = datetime.fromisoformat(script.start).replace(hour=0, minute=0, second=0)
            made = replace(made, start=(day + timedelta(minutes=round(self.hour * 60))).isoformat()[:19])
        if self.aboard is not None:
            made = replace(made, aboard=self._aboard())
        if self.stage is not None:
            made = self._staged(made)
        if self.errands:
            made = with_errands(made)
        weather = tuple(replace(each, weather=self._weather(each.weather)) for each in made.weather)
        return replace(
            made,
            weather=weather,
            driver=script.driver if self.driver is None else self.driver,
            driven_s=made.driven_s if self.driven_min is None else self.driven_min * 60,
            density=script.density if self.density is None else self.density,
            coarse=script.coarse if self.coarse is None else self.coarse,
            trailer=script.trailer if self.trailer is None else self.trailer,
            duration_s=min(script.duration_s, inf if self.minutes is None else self.minutes * 60),
        )

    def _aboard(self) -> tuple[Occupant, ...]:
        if self.aboard == NOBODY:
            return ()
        kind = Kind(str(self.aboard))
        return (Occupant(Seat.REAR_RIGHT, kind, belted=kind is not Kind.OBJECT),)

    def _staged(self, script: DriveScript) -> DriveScript:
        """The script with one staging instead of its own."""
        at_s = STAGE_S if self.stage_s is None else self.stage_s
        usual = script.weather[0].weather
        causes = Causes()
        staged: tuple[Staged, ...] = ()
        if self.stage != NOTHING:
            rng = Draws(script.family, script.seed).rng(Purpose.DRIVE)
            driver = script.driver if self.driver is None else self.driver
            kind = str(self.stage)
            causes = ON_REQUEST[kind](Setting(at_s, False, driver, usual, rng, script.aboard, self.ahead_m))
            staged = (Staged(kind, at_s, False),)
        return replace(
            script,
            weather=timeline(usual, causes.weather),
            moods=causes.moods,
            halts=causes.halts,
            changes=causes.changes,
            incidents=causes.incidents,
            driven_s=causes.driven_s,
            staged=staged,
            quiet_s=(0.0, at_s),
        )

    def _weather(self, before: Weather) -> Weather:
        made = before
        if self.temperature_c is not None:
            made = replace(made, temperature_2m=self.temperature_c)
        if self.rain_mm_h is not None and self.rain_mm_h > made.precipitation:
            heavy = self.rain_mm_h >= HEAVY_RAIN_FROM_MM_PER_H
            codes = (71, 75) if made.temperature_2m <= 0 else (61, 65)
            made = replace(
                made,
                precipitation=self.rain_mm_h,
                weather_code=codes[heavy],
                cloud_cover=100.0,
                relative_humidity_2m=max(made.relative_humidity_2m, 92.0),
            )
        if self.visibility_m is not None and self.visibility_m < made.visibility:
            is_fog = self.visibility_m < FOG_BELOW_M and made.precipitation == 0
            made = fog(made, self.visibility_m) if is_fog else replace(made, visibility=self.visibility_m)
        return made

    def _set(self) -> Iterator[tuple[str, float | str]]:
        values = ((entry.name, getattr(self, entry.name)) for entry in fields(self))
        return ((name, value) for name, value in values if value is not None)


AS_SCRIPTED = DriveSettings()
"""Nothing is set."""


def _told(value: float | str) -> str:
    if isinstance(value, bool):
        return "on" if value else "off"
    return value if isinstance(value, str) else f"{value:g}"
