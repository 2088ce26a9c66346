"""A prompt taken apart by its ``##`` headings, as the rule model reads it."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import inf

KM_PER_MILE = 1.609344
HEAVY_RAIN_MMH = 7.6
"""Heavy rain by the AMS Glossary of Meteorology (over 0.30 inch per hour)."""


@dataclass(frozen=True, slots=True)
class ListedElement:
    """One element as the prompt lists it."""

    index: int
    text: str
    description: str
    is_checked: bool
    is_enabled: bool
    is_scrollable: bool
    bounds: tuple[int, int, int, int]
    """Pixels: left, top, right, bottom; zeros where the prompt states none."""

    def is_called(self, label: str) -> bool:
        """Whether it has that text or description; a text may go on after a colon, with the level."""
        texts = (self.text, self.text.partition(": ")[0], self.description)
        return label.casefold() in (text.casefold() for text in texts)


@dataclass(frozen=True, slots=True)
class Page:
    """The content of a prompt by section; a missing section is empty."""

    goal: str
    screen: tuple[ListedElement, ...]
    car: Mapping[str, str]
    """The car's readings, from name to value, as texts."""
    context: tuple[str, ...]
    """The geo-context, line by line."""
    done: tuple[str, ...]
    plan: str
    result: str
    """Code of the last result."""
    told: str
    """Text of the last result."""
    gps: str
    memory: tuple[str, ...]
    changes: tuple[str, ...] = ()
    """What changed on the screen, if the prompt asks to look back."""
    calls_alone: bool = False
    """Whether functions can be called, and the screen not touched."""

    @classmethod
    def read(cls, prompt: str) -> Page:
        parts = re.split(r"^## (.+)$", prompt, flags=re.MULTILINE)
        sections = {title.strip(): body.strip() for title, body in zip(parts[1::2], parts[2::2], strict=True)}

        def lines(title: str) -> tuple[str, ...]:
            return tuple(line for line in sections.get(title, "").split("\n") if line)

        return cls(
            goal=sections.get("What the driver said", "").partition("\n")[0],
            screen=tuple(found for line in lines("The screen") for found in _elements(line)),
            car=dict(text.split(": ", 1) for text in (*lines("The car"), *lines("The car now")) if ": " in text),
            context=lines("What applies here"),
            done=lines("Done so far"),
            plan=sections.get("Your plan", ""),
            result=sections.get("Last result", "").partition(":")[0],
            told=sections.get("Last result", "").partition(": ")[2],
            gps=sections.get("Where the car is", ""),
            memory=lines("What worked here before"),
            changes=lines("What changed on the screen"),
            calls_alone=bool(re.search(r"^Functions for the action", prompt, re.MULTILINE))
            and not re.search(r"\bclick\b", sections.get("Actions", "")),
        )

    @property
    def looks_back(self) -> bool:
        """Whether it asks about the result of the last action."""
        return bool(self.changes)

    def find(self, label: str) -> ListedElement | None:
        """The first element with that text or description; ``label#2`` is the second."""
        name, _, number = label.partition("#")
        found = [line for line in self.screen if line.is_called(name)]
        at = int(number or 1) - 1
        return found[at] if at < len(found) else None

    def number(self, name: str) -> float | None:
        """The number at the start of one of the car's lines."""
        match = re.match(r"-?\d+(\.\d+)?", self.car.get(name, ""))
        return float(match.group()) if match else None

    def is_on(self, name: str) -> bool:
        """Whether one of the car's lines says True."""
        return self.car.get(name) == "True"

    def says(self, pattern: str) -> re.Match[str] | None:
        """The first line of the geo-context that matches from its start."""
        return next((found for line in self.context if (found := re.match(pattern, line))), None)

    def limit_kmh(self) -> float | None:
        """The speed limit that applies by the context: the posted one, else the first default, reduced if this
        weather requires it. None without one."""
        amount = r"(\d+(?:\.\d+)?) (km/h|mph)\b(.*)"
        first = self.says(f"Speed limit here: {amount}") or self.says(f"Default limit: (?:none\\b|{amount})")
        stated = [first] if first and first[1] else []
        reduced = [found for line in self.context if (found := re.match(f"Reduced limit: {amount}", line))]
        stated += [found for found in reduced if self._weather_is(found[3], unless_named=False)]
        return min(
            (float(found[1]) * (KM_PER_MILE if found[2] == "mph" else 1.0) for found in stated), default=None
        )

    def visibility_m(self) -> float:
        """The visibility in the weather line; far without one."""
        found = self.says(r"Weather: .*visibility (\d+) m")
        return float(found[1]) if found else inf

    def sky(self) -> frozenset[str]:
        """Precipitation or fog, in the words that rules use."""
        found = self.says(r"Weather: ([^,]+)(?:.* (\d+\.\d) mm/h)?")
        if found is None:
            return frozenset()
        words, amount_mmh = found[1], float(found[2] or 0.0)
        kinds = {kind for kind in ("fog", "snow", "rain", "drizzle", "dust") if kind in words}
        kinds |= {"rain"} if "drizzle" in kinds else set()
        kinds |= {"precipitation"} if kinds & {"rain", "snow"} else set()
        heavy = "heavy" in words or amount_mmh >= HEAVY_RAIN_MMH
        kinds |= {f"heavy {kind}" for kind in kinds} if heavy else set()
        kinds |= {"hazardous weather"} if heavy or "fog" in kinds else set()
        return frozenset(kinds)

    def allows_now(self, lamps: str) -> bool | None:
        """Whether the rule of that name, e.g. ``Rear fog lamp``, allows or requires it in this weather; None if
        there is no such rule."""
        rule = self.says(f"{lamps}: ([^;(]*)")
        if rule is None:
            return None
        return self._weather_is(re.split(r", (?:not|instead)\b", rule[1])[0], unless_named=True)

    def forbids_high_beam(self) -> bool:
        """Whether the high-beam rule forbids it on this road under this sky; False without such a rule."""
        rule = self.says(r"High beam: ([^(]*)")
        road = self.says(r"Road: (.*)")
        if rule is None or road is None:
            return False
        told = {part.strip() for part in road[1].split(",")}
        is_lit = "lit" in told and re.search(r"\blit\b|unlit|lighting", rule[1]) is not None
        is_town = "built-up" in told and "built-up" in rule[1]
        return is_lit or is_town or any(kind in rule[1] for kind in self.sky() & {"fog", "snow", "heavy rain"})

    def _weather_is(self, rule: str, *, unless_named: bool) -> bool:
        """Whether the weather is one that a rule names; ``unless_named`` if it names none."""
        named = re.search(r"(?:visibility|generally) under (\d+) m", rule)
        if named and self.visibility_m() >= float(named[1]):
            return False
        kinds = set(re.findall(r"heavy (?:rain|snow|precipitation)|hazardous weather|fog|snow|rain|dust", rule))
        kinds |= {"precipitation"} if "other precipitation" in rule else set()
        if not kinds:
            return bool(named) or unless_named
        return bool(kinds & self.sky())


_TEXT = r"(\"(?:[^\"\\]|\\.)*\"|[^\",\[\]]+?)"
BRIEF = re.compile(rf"(?:(?:^\w+: |, )(\d+) {_TEXT}(?: - {_TEXT})?(?: \[([^\]]*)\])?)(?=, |$)")
"""An element of the prompt: its index, label, description and state."""
ACROSS = re.compile(r"x (\d+) to (\d+), y (\d+)")


def _plain(text: str) -> str:
    return str(json.loads(text)) if text.startswith('"') else text


def _elements(line: str) -> Iterator[ListedElement]:
    for found in BRIEF.finditer(line):
        state = found[4] or ""
        across = ACROSS.search(state)
        left, right, y = map(int, across.groups()) if across else (0, 0, 0)
        yield ListedElement(
            index=int(found[1]),
            text=_plain(found[2]),
            description=_plain(found[3] or ""),
            is_checked="on" in state.split(", ") or "chosen" in state,
            is_enabled="disabled" not in state,
            is_scrollable="scrolls" in state,
            bounds=(left, y, right, y),
        )
