"""What a watcher reads from an observation: the lines of the context, and the car's readings.

It uses nothing but the text and the numbers that every agent gets, read as any agent could read them.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache

from automotive_cosim.contracts import Action, ActionType, Observation, VehicleState

KM_PER_MILE = 1.609344
_SPEED = re.compile(r"(\d+(?:\.\d+)?) (km/h|mph)")
CHANGED = " (changed)"
_AWAY = re.compile(r"\bin (\d+) m\b")
_FALLING = ("rain", "drizzle", "snow", "thunderstorm", "hail")


@dataclass(frozen=True, slots=True)
class LawLine:
    """One line of the context that states a rule."""

    text: str
    kmh: float | None
    is_verified: bool

    @property
    def said(self) -> str:
        """The text without its source."""
        return self.text.rpartition(" (")[0]


NO_LINE = LawLine("", None, False)


@dataclass(frozen=True, slots=True)
class Border:
    """The last border that was crossed."""

    at_s: float
    is_new: bool
    """Whether this is the first time in that country."""
    before: frozenset[str]
    """What the law had said before, without its sources."""


@dataclass(slots=True)
class Gathered:
    """Everything that is known at one observation."""

    time_s: float
    vehicle: VehicleState
    road: str = ""
    limit_kmh: float | None = None
    """The sign's limit, else the law's where one line states it."""
    is_posted: bool = False
    likely_kmh: float | None = None
    """``limit_kmh``, else the lowest of the law's lines, verified or not."""
    hours_kmh: float | None = None
    """The limit that is posted here for certain hours."""
    reduced: tuple[LawLine, ...] = ()
    law: Mapping[str, LawLine] = field(default_factory=dict)
    """Lines of other topics, by their label."""
    sun_deg: float | None = None
    weather: str = ""
    visibility_m: float = 20_000.0
    rain_mm_h: float = 0.0
    place: str = ""
    border: Border | None = None
    noticed: Mapping[str, str] = field(default_factory=dict)
    """The words of each of the car's readings, by its name."""
    changed: frozenset[str] = frozenset()
    """Names of the readings that are marked as changed."""

    @property
    def speed_kmh(self) -> float:
        return self.vehicle.speed_kmh

    @property
    def mps(self) -> float:
        """Speed of the car."""
        return self.vehicle.speed_kmh / 3.6

    @property
    def in_tunnel(self) -> bool:
        """Whether the road is one."""
        return self.road.endswith("tunnel") or ", tunnel" in self.road

    @property
    def phenomena(self) -> frozenset[str]:
        """The weather in the words of traffic law."""
        found = {word for word in ("fog", "rain", "snow") if word in self.weather}
        if any(word in self.weather for word in _FALLING):
            found.add("precipitation")
        elif self.visibility_m < 1000 and "dust" not in self.weather:
            found.add("fog")
        if "rain" in found and ("heavy" in self.weather or self.rain_mm_h >= 7.6):
            found.add("heavy rain")
        if "snow" in found and "heavy" in self.weather:
            found.add("heavy snow")
        return frozenset(found)

    @property
    def grip(self) -> float:
        """Grip of the road, 1 where it is dry."""
        found = re.match(r"\d\.\d\d", self.words("grip"))
        return 1.0 if found is None else float(found[0])

    def words(self, name: str) -> str:
        """The words of a reading; empty without any."""
        return self.noticed.get(name, "")

    def away_m(self, name: str) -> float | None:
        """Distance to what a reading speaks of; None without one."""
        words = self.words(name)
        found = _AWAY.search(words) if words else None
        return None if found is None else float(found[1])

    @property
    def left_km(self) -> float | None:
        """Distance to the destination."""
        found = re.search(r"(\d+\.\d) km to go", self.words("range"))
        return None if found is None else float(found[1])


class Reader:
    """Reads the observations of one drive, and remembers what they said."""

    def __init__(self) -> None:
        self._last: Gathered | None = None
        self._countries: list[str] = []
        self._border: Border | None = None
        self._asked: tuple[str, str] | None = None
        self._answers: dict[tuple[str, str], LawLine] = {}

    def read(self, seen: Observation) -> Gathered | None:
        """What an observation says; None for an agent without the car's readings or the context."""
        if seen.vehicle is None or seen.context is None:
            return None
        last = self._last
        if self._asked is not None:
            self._answers[self._asked] = _answer(seen.feedback.text, self._asked[1])
            self._asked = None
        known = self._last = _read(seen, seen.vehicle, seen.context)
        known.noticed, known.changed = _noticed(seen.vehicle.noticed or "")
        self._cross(known, last)
        told = {label: line for (place, label), line in self._answers.items() if place == known.place}
        known.law = {**told, **known.law}
        return known

    def _cross(self, known: Gathered, last: Gathered | None) -> None:
        country = known.words("place").partition(",")[0]
        if country and self._countries[-1:] != [country]:
            if self._countries:
                before = () if last is None else last.law.values()
                texts = frozenset(line.said for line in before)
                self._border = Border(known.time_s, country not in self._countries, texts)
            self._countries.append(country)
        known.border = self._border

    def can_ask(self, known: Gathered, label: str) -> bool:
        """Whether a rule is neither shown nor was asked for at this place, and the context offers it."""
        return label not in known.law and label.casefold() in known.law.get("Further rules, by query", NO_LINE).text

    def ask(self, known: Gathered, label: str) -> Action:
        """The question for a rule."""
        self._asked = known.place, label
        return Action(ActionType.QUERY, text=label)


def _noticed(text: str) -> tuple[dict[str, str], frozenset[str]]:
    """Each line's words by its name, without those of what has ended, and the names that are marked as changed."""
    lines = [line.partition(": ") for line in text.splitlines()]
    changed = frozenset(name.removesuffix(CHANGED) for name, _, _ in lines if name.endswith(CHANGED))
    noticed = {name.removesuffix(CHANGED): words for name, _, words in lines if not words.startswith("ended")}
    return noticed, changed


def _answer(text: str, label: str) -> LawLine:
    """The line of an answer that states a rule."""
    lines = (line.partition(f"{label}: ")[2] for line in text.splitlines() if line.startswith(f"{label}: "))
    return _law(next(lines, ""))


def _read(seen: Observation, vehicle: VehicleState, context: str) -> Gathered:
    known = Gathered(seen.time_s, vehicle)
    defaults, reduced, law = [], [], {}
    for line in context.splitlines():
        label, text, stated = _stated(line)
        match label:
            case "Place":
                known.place = text
            case "Road":
                known.road = text
            case "Speed limit here" if "posted on" in text:
                known.limit_kmh, known.is_posted = _kmh(text), True
            case "Speed limit here" if text == "none":
                known.is_posted = True
            case "Posted for certain hours":
                known.hours_kmh = _kmh(text)
            case "Default limit":
                defaults.append(stated)
            case "Reduced limit":
                reduced.append(stated)
            case "Time":
                known.sun_deg = _sun_deg(text)
            case "Weather":
                _read_weather(known, text)
            case _:
                law[label] = stated
    if not known.is_posted and len(defaults) == 1 and defaults[0].is_verified:
        known.limit_kmh = defaults[0].kmh
    towed_kmh = [each.kmh for each in defaults if "with a trailer" in each.text and each.is_verified and each.kmh]
    if known.is_posted and towed_kmh:  # the law's for such a car also lowers a sign
        known.limit_kmh = min(filter(None, (known.limit_kmh, *towed_kmh)))
    kmhs = [line.kmh for line in defaults if line.kmh is not None]
    known.likely_kmh = known.limit_kmh if known.is_posted else min(kmhs, default=None)
    known.reduced, known.law = tuple(reduced), law
    return known


@lru_cache(maxsize=4096)
def _stated(line: str) -> tuple[str, str, LawLine]:
    """A line's label, its text, and what that says if it states a rule. Cached, as most lines are the same from
    second to second."""
    label, _, text = line.partition(": ")
    return label, text, _law(text)


def _law(text: str) -> LawLine:
    start = _SPEED.match(text)
    return LawLine(text, None if start is None else _kmh(start[0]), ", verified " in text)


def _kmh(text: str) -> float | None:
    found = _SPEED.search(text)
    if found is None:
        return None
    return float(found[1]) * (KM_PER_MILE if found[2] == "mph" else 1.0)


def _sun_deg(text: str) -> float | None:
    found = re.search(r"sun (\d+)° (above|below)", text)
    return None if found is None else float(found[1]) * (1 if found[2] == "above" else -1)


def _read_weather(known: Gathered, text: str) -> None:
    known.weather = text.partition(",")[0]
    if (seen := re.search(r"visibility (\d+) m", text)) is not None:
        known.visibility_m = float(seen[1])
    if (rain := re.search(r"(\d+\.\d) mm/h", text)) is not None:
        known.rain_mm_h = float(rain[1])
