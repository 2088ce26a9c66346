"""What a search may use in all, with earlier starts of it: points, hours or money, whichever is spent first."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import UserError
from automotive_cosim.run.budget import MeterHandle, Spent

LAID = 1024
"""Points that are laid out if their number is not limited."""
MOST_POINTS = 1_000_000
_PART = re.compile(r"\s*(?P<dollar>\$?)(?P<number>\d+(?:\.\d+)?)\s*(?P<unit>h|min|usd|)\s*")
EXAMPLES = "64, 2h, 90min, 5usd, or several as in 64,2h"


@dataclass(frozen=True, slots=True)
class SearchBudget:
    """What a search may use; None means no limit."""

    points: int | None = None
    """Points to sample. Repeats and reductions come in addition."""
    hours: float | None = None
    """Wall time; no trial is begun after it."""
    usd: float | None = None
    """For the agent's model."""

    @classmethod
    def read(cls, text: str) -> SearchBudget:
        """Reads ``64``, ``2h``, ``90min``, ``5usd`` or several of them with commas.

        Raises UserError: it is none of these, or one is given twice."""
        given: dict[str, float] = {}
        for part in text.lower().split(","):
            found = _PART.fullmatch(part)
            unit = "" if found is None else "usd" if found["dollar"] else found["unit"]
            if found is None or (found["dollar"] and found["unit"] not in ("", "usd")):
                raise UserError(f"{part.strip()!r} is no budget; give {EXAMPLES}")
            name = {"": "points", "h": "hours", "min": "hours", "usd": "usd"}[unit]
            value = float(found["number"]) / (60 if unit == "min" else 1)
            if name in given:
                raise UserError(f"the budget {text!r} has {name} twice; give {EXAMPLES}")
            if not 0 < value <= MOST_POINTS or (name == "points" and value != int(value)):
                raise UserError(f"{part.strip()!r} is no budget: more than 0, combinations whole; give {EXAMPLES}")
            given[name] = value
        points = given.get("points")
        return cls(None if points is None else int(points), given.get("hours"), given.get("usd"))

    @property
    def most_points(self) -> int:
        return MOST_POINTS if self.points is None else self.points


def progress_in_words(budget: SearchBudget, points: int, used_s: float, each_s: float) -> str:
    """How far a search is, by each limit of its budget, and the time left by the one that is reached first.

    Args:
        used_s: wall time so far, with earlier starts.
        each_s: wall time of a run; 0 while unknown.
    """
    told = [
        counted(points, "combination")
        if budget.points is None
        else f"{points} of {counted(budget.points, 'combination')}"
    ]
    left_s = []
    if budget.points is not None and each_s:
        left_s.append(each_s * (budget.points - points))
    if budget.hours is not None:
        minutes = 60 * budget.hours
        told.append(f"{min(minutes, used_s / 60):.0f} of {counted(round(minutes), 'minute')}")
        left_s.append(60 * minutes - used_s)
    if left_s and min(left_s) >= 60:
        what = " for the combinations" if budget.hours is None else " at most"
        told.append(f"about {counted(round(min(left_s) / 60), 'minute')} left{what}")
    return ", ".join(told)


@dataclass(frozen=True, slots=True)
class SearchLimit:
    """Says when a budget is spent; a ``MeterHandle`` for ``run.batch``, which asks it before each trial."""

    budget: SearchBudget
    meter: MeterHandle
    used_s: Callable[[], float]
    """Wall time so far, with earlier starts."""

    def refusal(self) -> str:
        """Why nothing more may be begun; empty while it may."""
        hours, used_s = self.budget.hours, self.used_s()
        if hours is not None and used_s >= 3600 * hours:
            return f"the budget is spent: {used_s / 3600:.2g} of {hours:.2g} hours"
        return self.meter.refusal()

    def spent(self) -> Spent:
        """What the models have cost."""
        return self.meter.spent()

    def wait_s(self, model: str, per_minute: float) -> float:
        return self.meter.wait_s(model, per_minute)

    def spend(self, tokens: int, usd: float) -> None:
        self.meter.spend(tokens, usd)
