"""Limits in a network that was moved to another country: signs show that country's round figures.

The traffic keeps its speeds, so that the same drive can be had in two countries; a sign differs from them by what
rounding makes, a twelfth at most from 50 km/h up. What the map assumed at its own place is dropped for the law.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace

from automotive_cosim.contracts import KMH_PER_MPS, MPH_PER_MPS, DrivingState, Limit
from automotive_cosim.geo.rules import Jurisdiction

_PER_MPS = {"km/h": KMH_PER_MPS, "mph": MPH_PER_MPS}
_STEPS = {"GB": 10.0, "US": 5.0}
"""What signs are multiples of (Traffic Signs Manual, chapter 3; MUTCD 2B.13)."""
_USUAL_STEP = 10.0
_FINEST = 5.0
"""A sign that shows a multiple of it already is kept."""
_EQUAL_UP_TO = 0.1
_AMOUNT = re.compile(r"(\d+(?:\.\d+)?) (km/h|mph)")


@dataclass(frozen=True, slots=True)
class LocalSigns:
    """Reads the limits of a drive as the signs of a country."""

    unit: str
    """``"km/h"`` or ``"mph"``."""
    step: float
    """Step between the limits on signs, in that unit."""

    def on(self, driving: DrivingState) -> DrivingState:
        """The state with the signs of the country."""
        road, ahead = driving.road, driving.ahead
        here = self.shown(road.limit)
        following = None if ahead.next_limit is None else self.shown(ahead.next_limit)
        return replace(
            driving,
            road=replace(road, limit=here, limit_hours=_AMOUNT.sub(self._amount, road.limit_hours)),
            ahead=replace(ahead, next_limit=following),
        )

    def shown(self, limit: Limit) -> Limit:
        """A limit of the network as it is signed."""
        if limit.mps is None:
            return limit
        return Limit(self._rounded(limit.mps), limit.source) if limit.is_posted else Limit(None, limit.source)

    def _rounded(self, speed_mps: float) -> float:
        figure = speed_mps * _PER_MPS[self.unit]
        if abs(figure - _FINEST * round(figure / _FINEST)) < _EQUAL_UP_TO:
            return speed_mps
        return max(1, round(figure / self.step)) * self.step / _PER_MPS[self.unit]

    def _amount(self, found: re.Match[str]) -> str:
        figure = self._rounded(float(found[1]) / _PER_MPS[found[2]]) * _PER_MPS[self.unit]
        return f"{figure:.0f} {self.unit}"


def signs_of(law: Jurisdiction | None) -> LocalSigns | None:
    """The signs of a country; None where no law is known."""
    return None if law is None else LocalSigns(law.speed_unit, _STEPS.get(law.code, _USUAL_STEP))
