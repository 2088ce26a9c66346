"""A prompt taken apart by its ``##`` headings, as the rule model reads it."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from dataclasses import dataclass

KM_PER_MILE = 1.609344


@dataclass(frozen=True, slots=True)
class Line:
    """One element as the prompt lists it."""

    index: int
    resource_id: str
    text: str
    description: str
    is_checked: bool
    is_enabled: bool
    is_scrollable: bool
    bounds: tuple[int, int, int, int]
    """Pixels: left, top, right, bottom; zeros where the prompt states none."""


@dataclass(frozen=True, slots=True)
class Page:
    """What a prompt says, section by section; a section that is not there is empty."""

    goal: str
    screen: tuple[Line, ...]
    car: Mapping[str, str]
    """Name to value, as they are written."""
    context: tuple[str, ...]
    """What holds here, line by line."""
    done: tuple[str, ...]
    plan: str
    result: str
    """Code of the last result."""
    gps: str
    memory: tuple[str, ...]
    before: tuple[str, ...]
    after: tuple[str, ...]
    """The screen's lines before and after the last action, where the prompt asks to look back."""

    @classmethod
    def read(cls, prompt: str) -> Page:
        """Takes a prompt apart."""
        parts = re.split(r"^## (.+)$", prompt, flags=re.MULTILINE)
        sections = {title.strip(): body.strip() for title, body in zip(parts[1::2], parts[2::2], strict=True)}

        def lines(title: str) -> tuple[str, ...]:
            return tuple(line for line in sections.get(title, "").split("\n") if line)

        return cls(
            goal=sections.get("What the driver said", ""),
            screen=tuple(line for line in map(_line, lines("The screen")) if line is not None),
            car=dict(text.split(": ", 1) for text in lines("The car") if ": " in text),
            context=lines("What holds here"),
            done=lines("Done so far"),
            plan=sections.get("Your plan", ""),
            result=sections.get("Last result", "").partition(":")[0],
            gps=sections.get("Where the car is", ""),
            memory=lines("What worked here before"),
            before=lines("The screen before"),
            after=lines("The screen after"),
        )

    @property
    def looks_back(self) -> bool:
        """Whether it asks what came of the last action."""
        return bool(self.before or self.after)

    def find(self, resource_id: str) -> Line | None:
        """The element with that id, or, after ``=``, with that text."""
        if resource_id.startswith("="):
            wanted = resource_id[1:].casefold()
            return next((line for line in self.screen if line.text.casefold() == wanted), None)
        return next((line for line in self.screen if line.resource_id == resource_id), None)

    def number(self, name: str) -> float | None:
        """The number at the start of one of the car's lines."""
        match = re.match(r"-?\d+(\.\d+)?", self.car.get(name, ""))
        return float(match.group()) if match else None

    def is_on(self, name: str) -> bool:
        """Whether one of the car's lines says True."""
        return self.car.get(name) == "True"

    def says(self, pattern: str) -> re.Match[str] | None:
        """The first line of what holds here that matches from its start."""
        return next((found for line in self.context if (found := re.match(pattern, line))), None)

    def limit_kmh(self) -> float | None:
        """The speed limit that the context states, whatever its unit; None without one."""
        found = self.says(r"Speed limit here: (\d+(?:\.\d+)?) (km/h|mph)")
        return float(found[1]) * (KM_PER_MILE if found[2] == "mph" else 1.0) if found else None


def _line(text: str) -> Line | None:
    try:
        entry = json.loads(text)
        return Line(
            index=int(entry["index"]),
            resource_id=str(entry.get("id", "")),
            text=str(entry.get("text", "")),
            description=str(entry.get("description", "")),
            is_checked=bool(entry.get("checked")),
            is_enabled=not entry.get("disabled"),
            is_scrollable=bool(entry.get("scrollable")),
            bounds=tuple(entry.get("bounds", (0, 0, 0, 0))),
        )
    except (ValueError, LookupError, TypeError, AttributeError, RecursionError):
        return None
