"""Events of a border: speed signs in another unit than the car shows, and another law on lamps, horn and phone."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import ClassVar, NamedTuple

from automotive_cosim.cockpit.signals import HMI
from automotive_cosim.contracts import AlertKind
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.events.base import DriveAct, EventKind, Sighting, Wanted
from automotive_cosim.drives.margins import BORDER_S
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.rules import Status

TOPICS = ("dipped_beam", "daytime_lamps", "horn", "phone")
"""What a driver must know at once in another country."""


_time_s, _country = attrgetter("time_s"), attrgetter("context.country")


@dataclass(frozen=True, slots=True)
class BorderCrossing:
    """The last border that the car crossed, not long ago."""

    before: Moment
    """The last moment in the other country."""
    is_new: bool
    """Whether the car had not been in the present country on this drive."""


def crossing(drive: Sequence[Moment]) -> BorderCrossing | None:
    """The border crossed within the last minute; None without one, or if a country is unknown."""
    now, count = drive[-1], len(drive)
    known = _KNOWN.get(id(now))
    if known is None or known.moment is not now or known.moments != count:
        before = _KNOWN.pop(id(drive[-2]), None) if count > 1 else None
        if before is not None and before.moment is drive[-2] and before.moments == count - 1 and before.is_one:
            is_one = before.moment.context.country == now.context.country
        else:
            first = max(bisect_left(drive, now.time_s - BORDER_S, key=_time_s) - 2, 0)
            is_one = len({*map(_country, drive[first:])}) == 1
        if len(_KNOWN) >= MOST_KNOWN:
            _KNOWN.clear()
        known = _KNOWN[id(now)] = _Known(now, count, is_one, None if is_one else _crossing(drive))
    return known.found


class _Known(NamedTuple):
    moment: Moment
    moments: int
    """How many there are up to this one."""
    is_one: bool
    """Whether they are all in one country, as far as it matters."""
    found: BorderCrossing | None


_KNOWN: dict[int, _Known] = {}
"""The last answer on each drive, by the id of its last moment: two kinds ask, and to look back takes long."""
MOST_KNOWN = 256


def _crossing(drive: Sequence[Moment]) -> BorderCrossing | None:
    here, now_s = drive[-1].context.country, drive[-1].time_s
    for back, moment in enumerate(reversed(drive), start=1):
        if moment.context.country != here:
            known = bool(here and moment.context.country)
            return BorderCrossing(moment, all(m.context.country != here for m in drive[:-back])) if known else None
        if now_s - moment.time_s > BORDER_S:
            return None
    return None


class LimitUnits(EventKind):
    """Signs in miles per hour, a display in kilometres, or the other way round."""

    told_by = ("place",)
    name = "limit_units"
    about = "beyond a border the signs have another unit of speed than the car shows"
    lookalike = "a border beyond which the car already shows the unit of the signs"
    source = "our choice: told within 30 s, 670 m at 80 km/h, in which a driver meets the first sign"
    neutral = "as long as the units differ"
    grace_s = 30.0
    alerts = frozenset[AlertKind]()
    says = ("mph", "miles", "km/h", "kilomet")
    writes: ClassVar[Mapping[str, Wanted]] = {HMI.DISTANCE_UNIT.path: lambda value: True}

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """Sights a border for a minute after it was crossed."""
        crossed = crossing(drive)
        if crossed is None:
            return
        now = drive[-1]
        signs, shown = now.context.speed_unit, shown_unit(now)
        words = f"signs in {signs}, the car shows {shown}"
        miles = 1.0 if signs == "mph" else 0.0
        if signs == shown:
            yield Sighting(words, now.context.country, lookalike=True)
        else:
            yield Sighting(words, now.context.country, due=True, hold_s=2.0, value=miles)

    def settles(self, act: DriveAct, value: float | None) -> bool:
        """The display in the unit of the signs, or words about it."""
        wanted = "MILES" if value else "KILOMETERS"
        return super().settles(act, value) and all(
            written == wanted for path, written in act.writes if path == HMI.DISTANCE_UNIT.path
        )

    def against(self, drive: Sequence[Moment]) -> str | None:
        """Signs in the unit of the display."""
        signs, shown = drive[-1].context.speed_unit, shown_unit(drive[-1])
        return f"signs in {signs}, and the car shows {shown}" if signs == shown else None


class RuleChange(EventKind):
    """A country with another law on lamps, horn or phone, for the first time on this drive."""

    told_by = ("place",)
    name = "rule_change"
    about = "beyond a border the law on lamps, horn or phone is another"
    lookalike = "back in a country in which the car has been on this drive"
    source = "our choice: told within 50 s of the border"
    neutral = "within a minute of the border"
    weight = 0.5
    grace_s = 48.0
    alerts = frozenset[AlertKind]()
    says = ("lamp", "light", "beam", "horn", "phone")

    def sight(self, drive: Sequence[Moment]) -> Iterator[Sighting]:
        """For a minute after the border; only verified law obliges."""
        crossed = crossing(drive)
        if crossed is None:
            return
        country = drive[-1].context.country
        if not crossed.is_new:
            yield Sighting(f"back in {country}", country, lookalike=True)
            return
        told = set(_law(crossed.before.context, verified=False))
        changed = [text for text in _law(drive[-1].context, verified=True) if text not in told]
        if changed:
            yield Sighting(f"another law in {country}: {'; '.join(changed)}", country, due=True, hold_s=2.0)

    def against(self, drive: Sequence[Moment]) -> str | None:
        """No border, or one into a country that the driver comes from."""
        crossed, country = crossing(drive), drive[-1].context.country
        if crossed is None:
            return "no border in the last minute"
        return None if crossed.is_new else f"back in {country}"


def _law(context: GeoContext, *, verified: bool) -> Iterator[str]:
    for found in context.rules:
        if found.rule.topic in TOPICS and (not verified or found.rule.status is Status.VERIFIED):
            yield found.rule.text


def shown_unit(now: Moment) -> str:
    """The unit of speed on the car's display."""
    return "mph" if now.signals[HMI.DISTANCE_UNIT.path] == "MILES" else "km/h"
