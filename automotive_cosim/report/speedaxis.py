"""The speed axis of a drive's plots, in the unit of the place's signs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from automotive_cosim.geo.text import KM_PER_MILE
from automotive_cosim.run.timeline import Sample

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
