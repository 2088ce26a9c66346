"""Events of weather: glass that fogs, rain on the windshield, a slippery road."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import ClassVar

from automotive_cosim.cockpit.notices import NOTICED
from automotive_cosim.cockpit.signals import BODY, DRIVE, GLASS, HVAC
from automotive_cosim.contracts import AlertKind, PullOver, SlowDown
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.events.base import EventKind, Measured, Sighting, Wanted, off, on
from automotive_cosim.drives.events.law import SLOW_KMH, TREND_S, grows, speed_kmh
from automotive_cosim.traffic.road_weather import ICY

ICY_FROM_KMH = 40.0
"""Faster than this, stopping on packed snow (0.25) takes over 30 m."""
DRY = 0.9
"""Friction from which a road is dry."""
GROWTH = 0.01
"""Share of the glass by which a film or fog on it grows within ten seconds, at least, on its way to an event."""
LOSS = 0.015
"""Friction that a road loses within ten seconds, at least, on its way to snow or ice."""
COLD_C = 4.0
"""Cars warn of possible ice from this temperature."""


SEEN = 0.03
"""Share of fogged or wet glass that one sees."""


class GlassFogs(EventKind):
    """The windshield fogs."""

    told_by = ("glass",)
    name = "glass_fog"
    about = "the windshield fogs inside while the car moves"
    lookalike = "a breath of mist on the glass, that no screen speaks of"
    source = "a fifth of the light is lost, as the screens say; deadline: 20 s, what a defroster takes"
    neutral = "any more, while it grows"
    grace_s = 20.0
    alerts = frozenset({AlertKind.VISIBILITY})
    writes: ClassVar[Mapping[str, Wanted]] = {
        HVAC.FRONT_DEFROSTER.path: on,
        HVAC.MAX_DEFROST.path: on,
        HVAC.AIR_CONDITIONING.path: on,
        HVAC.RECIRCULATION.path: off,
        HVAC.AIR_DISTRIBUTION.path: lambda value: value == "UP",
        HVAC.FAN_SPEED.path: lambda value: isinstance(value, float) and value >= 50,
    }

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Sights fog on the glass from a twentieth of the light lost."""
        now = drive[-1]
        fog = float(now.signals[GLASS.WINDSHIELD_FOG.path])
        if fog < NOTICED / 4 or speed_kmh(now) < 1.0:
            return
        words = f"windshield fogged by {fog:.0%}"
        if fog >= NOTICED:
            yield Sighting(words, due=True, hold_s=3.0, severity=fog / NOTICED)
        else:
            yield Sighting(words, lookalike=not grows(drive, GLASS.WINDSHIELD_FOG.path, GROWTH))

    def against(self, drive: Sequence[Moment]) -> str | None:
        """Glass that is clear, or a mist on it that does not grow."""
        fog = float(drive[-1].signals[GLASS.WINDSHIELD_FOG.path])
        if fog >= NOTICED or grows(drive, GLASS.WINDSHIELD_FOG.path, GROWTH):
            return None
        words = f"the windshield is fogged by {fog:.0%}, and no more than before"
        return Measured(words) if fog > SEEN else words


class Wipers(EventKind):
    """Rain on the windshield that nobody wipes."""

    told_by = ("rain",)
    name = "wipers"
    about = "rain covers the windshield and the wipers are off"
    lookalike = "a few drops that cover less than a fifth of the glass"
    source = "a fifth of the light is lost; deadline: 10 s"
    neutral = "any more, while it grows"
    alerts = frozenset({AlertKind.VISIBILITY, AlertKind.WEATHER})
    writes: ClassVar[Mapping[str, Wanted]] = {BODY.FRONT_WIPER.path: lambda value: value != "OFF"}

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """While the wipers are off; also after the rain, until the glass has dried."""
        now = drive[-1]
        film = float(now.signals[GLASS.WINDSHIELD_FILM.path])
        if now.signals[BODY.FRONT_WIPER.path] != "OFF" or speed_kmh(now) < 1.0:
            return
        words = f"windshield covered by {film:.0%}, wipers off"
        if film >= NOTICED:
            yield Sighting(words, due=True, hold_s=3.0, severity=film / NOTICED)
        elif float(now.signals[BODY.RAIN_INTENSITY.path]) > 0:
            yield Sighting(words, lookalike=not grows(drive, GLASS.WINDSHIELD_FILM.path, GROWTH))

    def against(self, drive: Sequence[Moment]) -> str | None:
        """Wipers that wipe, or glass that is dry enough and becomes no wetter."""
        signals = drive[-1].signals
        film, wipers = float(signals[GLASS.WINDSHIELD_FILM.path]), signals[BODY.FRONT_WIPER.path]
        if wipers != "OFF":
            return f"the wipers are on: {str(wipers).lower().replace('_', ' ')}"
        if film >= NOTICED or grows(drive, GLASS.WINDSHIELD_FILM.path, GROWTH):
            return None
        words = f"the windshield is covered by {film:.0%}, and no more than before"
        return Measured(words) if film > SEEN else words


class Slippery(EventKind):
    """Snow or ice on the road, at speed."""

    told_by = ("grip", "weather", "speed")
    name = "slippery"
    about = "the road loses grip: due when it has that of snow or ice and the car is fast, not while it is only wet"
    lookalike = "cold, but a dry road"
    source = "friction: VTI meddelande 911A; deadline: 20 s, 450 m at 80 km/h"
    neutral = "a wet road, above all one that loses its grip; snow or ice below 40 km/h"
    weight = 1.5
    grace_s = 20.0
    alerts = frozenset({AlertKind.SLIPPERY, AlertKind.WEATHER})
    requests = (SlowDown, PullOver)
    writes: ClassVar[Mapping[str, Wanted]] = {DRIVE.MODE.path: lambda value: value == "SNOW"}

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Reads the friction of the lane under the car."""
        now = drive[-1]
        friction, kmh = now.driving.road.friction, speed_kmh(now)
        if kmh < SLOW_KMH or now.driving.road.in_tunnel:
            return
        if friction < ICY:
            words = f"{kmh:.0f} km/h on a road with friction {friction:.2f}"
            yield Sighting(words, due=kmh > ICY_FROM_KMH, hold_s=5.0, severity=ICY / friction)
        elif friction < DRY:  # one that goes on losing its grip is on its way to ice
            yield Sighting(f"a wet road, friction {friction:.2f}", "" if _loses_grip(drive) else "wet")
        elif now.weather.temperature_2m <= COLD_C:
            yield Sighting(f"{now.weather.temperature_2m:.0f} degrees and dry", lookalike=True)

    def against(self, drive: Sequence[Moment]) -> str | None:
        """A dry road."""
        now = drive[-1]
        if now.driving.road.friction < DRY and not now.driving.road.in_tunnel:
            return None
        if now.weather.precipitation > 0 and not now.driving.road.in_tunnel:
            return None
        return f"the road is dry, at {now.weather.temperature_2m:.0f} degrees"


def _loses_grip(drive: Sequence[Moment]) -> bool:
    """Whether the road has lost some of its grip within ten seconds."""
    from_s = drive[-1].time_s - TREND_S
    then = next((moment for moment in reversed(drive) if moment.time_s <= from_s), drive[0])
    return drive[-1].driving.road.friction <= then.driving.road.friction - LOSS
