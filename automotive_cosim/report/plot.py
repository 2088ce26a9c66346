"""Speed against the limit over time, as the numbers an SVG template needs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

from automotive_cosim.geo.text import KM_PER_MILE
from automotive_cosim.run.timeline import Sample, TimelineEntry, is_over

MOST_LINES = 7
STEPS = (10, 20, 40, 80)


@dataclass(frozen=True, slots=True)
class SpeedAxis:
    """From zero to above everything that the drive and its limits reach."""

    unit: str
    """``"km/h"`` or ``"mph"``, as where the drive ends."""
    top_kmh: float
    lines: tuple[tuple[int, float], ...]
    """Grid lines: the figure in the unit, and the speed in km/h."""

    @classmethod
    def of(cls, path: Sequence[Sample]) -> SpeedAxis:
        """The axis for a drive of at least one sample."""
        unit = path[-1].speed_unit
        kmh_per_unit = KM_PER_MILE if unit == "mph" else 1.0
        most = max(max(sample.speed_kmh, sample.limit_kmh or 0.0) for sample in path) / kmh_per_unit
        tens = 20 if unit == "km/h" else 10
        top = tens * (int(most // tens) + 1)
        step = next((step for step in STEPS if step >= tens and top / step < MOST_LINES), STEPS[-1])
        figures = range(0, top + 1, step)
        return cls(unit, top * kmh_per_unit, tuple((figure, figure * kmh_per_unit) for figure in figures))


LEFT, RIGHT, TOP, BOTTOM = 44, 14, 34, 40
MARKED = {"alert": "alert", "limit": "at the limit", "declared": "declared"}
"""Events of the timeline that get a line in the plot; the hand-over has its own."""


class Plot:
    """One size of the plot. Coordinates are pixels of its view box."""

    def __init__(self, path: Sequence[Sample], timeline: Sequence[TimelineEntry], width: int, height: int) -> None:
        """Draws a drive of at least one sample."""
        self.width, self.height = width, height
        self.left, self.right = LEFT, width - RIGHT
        self.top, self.bottom = TOP, height - BOTTOM
        self._path = path
        self._timeline = timeline
        self._begin = self._path[0].at_s
        self._end = max(self._path[-1].at_s, self._begin + 1)
        self.speeds = SpeedAxis.of(self._path)

    def x(self, at_s: float) -> float:
        return round(self.left + (at_s - self._begin) / (self._end - self._begin) * (self.right - self.left), 1)

    def y(self, speed_kmh: float) -> float:
        return round(self.bottom - speed_kmh / self.speeds.top_kmh * (self.bottom - self.top), 1)

    @property
    def times(self) -> tuple[int, ...]:
        """Times with a label, in seconds since the hand-over."""
        room = (self.right - self.left) / 60
        shown_s = self._end - self._begin
        every = next(step for step in (5, 10, 20, 30, 60, 120, 300, 3600) if shown_s / step <= room)
        first = int(-(-self._begin // every)) * every
        return tuple(range(first, int(self._end) + 1, every))

    @property
    def speed(self) -> str:
        """The speed as a path."""
        return self._line([(sample.at_s, sample.speed_kmh) for sample in self._path])

    @property
    def over(self) -> tuple[str, ...]:
        """The areas between limit and speed where the speed is above the limit, as closed paths."""
        areas = []
        for over, group in groupby(self._path, key=lambda s: is_over(s.speed_kmh, s.limit_kmh)):
            samples = list(group)
            if over and len(samples) > 1:
                above = [(sample.at_s, sample.speed_kmh) for sample in samples]
                below = [(each.at_s, each.limit_kmh) for each in reversed(samples) if each.limit_kmh is not None]
                areas.append(self._line(above + below) + "Z")
        return tuple(areas)

    @property
    def limits(self) -> tuple[str, ...]:
        """The limit as steps, one path per stretch with a limit."""
        lines = []
        ends = [*(sample.at_s for sample in self._path[1:]), self._end]
        rows = zip(self._path, ends, strict=True)
        for _, group in groupby(rows, key=lambda row: row[0].limit_kmh is not None):
            steps = [
                (at_s, sample.limit_kmh)
                for sample, end in group
                for at_s in (sample.at_s, end)
                if sample.limit_kmh is not None
            ]
            if steps:
                lines.append(self._line(steps))
        return tuple(lines)

    @property
    def marks(self) -> tuple[tuple[float, str, str], ...]:
        """The first event of each kind with a line: x, kind, label."""
        first: dict[str, TimelineEntry] = {}
        for entry in self._timeline:
            if entry.kind in MARKED:
                first.setdefault(entry.kind, entry)
        return tuple((self.x(entry.at_s), kind, MARKED[kind]) for kind, entry in first.items())

    def _line(self, points: Sequence[tuple[float, float]]) -> str:
        return "M" + "L".join(f"{self.x(at_s):g} {self.y(speed):g}" for at_s, speed in points)
