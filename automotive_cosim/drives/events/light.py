"""Events of lamps: lamps that law or darkness requires, high beam at others, fog lamps where they dazzle."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import ClassVar

from automotive_cosim.cockpit.signals import LIGHTS
from automotive_cosim.contracts import STANDING_BELOW_MPS, AlertKind
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.events.base import DriveAct, EventKind, Measured, Sighting, Wanted, off, on
from automotive_cosim.drives.events.law import may_say, says
from automotive_cosim.drives.margins import LAMP_S
from automotive_cosim.geo.context import GeoContext

DARK_DEG = -6.0
"""The end of civil twilight."""
LOW_SUN_DEG = 6.0
CLEAR_AIR_M = 1000.0
"""Sight below which there is fog (WMO No. 8)."""
PRECEDING_M = 100.0
"""An automatic high beam must notice a vehicle ahead at least this far (UN R48, 6.1.9.3.1.2)."""
CLEAR_M = 150.0
"""Reach of the forward radar: nobody is seen ahead beyond."""


class LampsMissing(EventKind):
    """No dipped beam where law or darkness requires it."""

    told_by = ("lamps", "light", "weather")
    name = "lamps"
    about = "the dipped beam is off in the dark, in a tunnel, or where the law requires it"
    lookalike = "a low sun, in which the law requires no lamps"
    source = "UN R48, 6.2.7: 2 s; deadline: 10 s"
    neutral = "twilight, rain, fog, or a rule that is not verified; while the car stands"
    alerts = frozenset({AlertKind.VISIBILITY, AlertKind.TUNNEL, AlertKind.WEATHER})
    writes: ClassVar[Mapping[str, Wanted]] = {
        LIGHTS.LOW_BEAM.path: on,
        LIGHTS.SWITCH.path: lambda value: value in ("BEAM", "AUTO"),
    }

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """While moving without dipped or high beam."""
        now = drive[-1]
        signals = now.signals
        lit = signals[LIGHTS.LOW_BEAM.path] or signals[LIGHTS.HIGH_BEAM.path]
        if lit or now.driving.speed_mps < STANDING_BELOW_MPS:
            return
        sun = now.context.sun
        dark = now.driving.road.in_tunnel or (sun is not None and sun.elevation_deg < DARK_DEG)
        if dark or says(now.context, "dipped_beam", "required"):
            why = "in a tunnel" if now.driving.road.in_tunnel else "in the dark" if dark else "where the law asks"
            yield Sighting(f"no dipped beam {why}", due=True, hold_s=LAMP_S, value=1.0 if dark else 0.0)
        elif sun is not None and 0 <= sun.elevation_deg < LOW_SUN_DEG and self.against(drive):
            yield Sighting("no dipped beam by a low sun", lookalike=True, value=0.0)

    def against(self, drive: Sequence[Moment]) -> str | None:
        """Lamps that are on, or daylight in clear air with no rule that asks for them."""
        now = drive[-1]
        if now.signals[LIGHTS.LOW_BEAM.path] or now.signals[LIGHTS.HIGH_BEAM.path]:
            return "the dipped beam is on" if now.signals[LIGHTS.LOW_BEAM.path] else "the high beam is on"
        sun, weather = now.context.sun, now.weather
        is_clear = weather.precipitation <= 0 and weather.visibility >= CLEAR_AIR_M
        is_day = sun is not None and sun.elevation_deg >= 0 and not now.driving.road.in_tunnel
        if sun is None or not is_day or not is_clear or may_say(now.context, "dipped_beam", "required"):
            return None
        return f"the sun is {sun.elevation_deg:.0f} degrees up, and the air is clear"

    def settles(self, act: DriveAct, value: float | None) -> bool:
        """By day an automatic switch lights nothing."""
        by_day_auto = value == 0.0 and (LIGHTS.SWITCH.path, "AUTO") in act.writes
        return super().settles(act, value) and not by_day_auto


class HighBeam(EventKind):
    """High beam at somebody ahead, or where the law forbids it."""

    told_by = ("lamps", "vehicle ahead")
    name = "high_beam"
    about = "the high beam dazzles a driver ahead, or is on where the law forbids it"
    lookalike = "high beam on an empty road where it is allowed"
    source = "UN R48, 6.1.9.3: 100 m to a vehicle ahead, 2 s; deadline: 6 s, one more vehicle met"
    neutral = "a vehicle ahead within the radar's 150 m, or a rule that is not verified"
    grace_s = 6.0
    alerts = frozenset({AlertKind.VISIBILITY, AlertKind.DISTRACTION})
    writes: ClassVar[Mapping[str, Wanted]] = {LIGHTS.HIGH_BEAM.path: off}

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """While the high beam is on."""
        now = drive[-1]
        if not now.signals[LIGHTS.HIGH_BEAM.path]:
            return
        leader = now.driving.around.leader
        gap_m = CLEAR_M if leader is None else leader.gap_m
        if gap_m <= PRECEDING_M:
            yield Sighting(f"high beam at a car {gap_m:.0f} m ahead", due=True, hold_s=LAMP_S)
        elif says(now.context, "high_beam", "forbidden"):
            # no sensor of the car tells of oncoming traffic: what only that forbids is not due
            due = says(_with_nobody_coming(now.context), "high_beam", "forbidden")
            yield Sighting("high beam where the law forbids it", due=due, hold_s=LAMP_S)
        elif gap_m >= CLEAR_M:
            yield Sighting("high beam on an empty road", lookalike=True)

    def against(self, drive: Sequence[Moment]) -> str | None:
        """High beam that is off, or that shines on an empty road without a rule against it."""
        now = drive[-1]
        if not now.signals[LIGHTS.HIGH_BEAM.path]:
            return "the high beam is off"
        leader = now.driving.around.leader
        is_alone = leader is None or leader.gap_m > CLEAR_M
        forbidden = may_say(now.context, "high_beam", "forbidden")
        return (
            "nobody within 150 m ahead, and no rule against the high beam" if is_alone and not forbidden else None
        )


def _with_nobody_coming(context: GeoContext) -> GeoContext:
    around = replace(context.driving.around, oncoming=None)
    return replace(context, driving=replace(context.driving, around=around))


class FogLamps(EventKind):
    """Fog lamps where the law forbids them."""

    told_by = ("lamps", "weather")
    name = "fog_lamps"
    about = "a fog lamp is on where the law forbids it, so that it dazzles"
    lookalike = "fog lamps in fog"
    source = "the law of the place; UN R48, 6.2.7: 2 s; deadline: 10 s"
    neutral = "clear air, or a rule that is not verified"
    weight = 0.5
    alerts = frozenset({AlertKind.VISIBILITY})
    writes: ClassVar[Mapping[str, Wanted]] = {LIGHTS.FRONT_FOG.path: off, LIGHTS.REAR_FOG.path: off}

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """While a fog lamp is on and the car moves."""
        now = drive[-1]
        if now.driving.speed_mps < STANDING_BELOW_MPS:
            return
        lit = _fog_lamps(now)
        if any(says(now.context, topic, "forbidden") for topic in lit):
            yield Sighting("a fog lamp where the law forbids it", due=True, hold_s=LAMP_S)
        elif lit:
            yield Sighting("a fog lamp where it is allowed", lookalike=True)

    def against(self, drive: Sequence[Moment]) -> str | None:
        """No fog lamp that is on, or one in fog without a rule against it."""
        now = drive[-1]
        lit = _fog_lamps(now)
        if not lit:
            return "no fog lamp is on"
        if now.weather.visibility >= CLEAR_AIR_M or any(may_say(now.context, topic, "forbidden") for topic in lit):
            return None
        return Measured(f"a fog lamp where one sees {now.weather.visibility:.0f} m")


def _fog_lamps(now: Moment) -> set[str]:
    """The topics of law of the fog lamps that are on."""
    lamps = (("front_fog", LIGHTS.FRONT_FOG), ("rear_fog", LIGHTS.REAR_FOG))
    return {topic for topic, lamp in lamps if now.signals[lamp.path]}
