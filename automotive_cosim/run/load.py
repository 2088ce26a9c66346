"""The load of an episode on the driver while the car moves: a figure to report, never a verdict.

The guideline for in-car devices requires that no glance exceed 2 s and that a task take at most 12 s of glances
(NHTSA, Visual-Manual Driver Distraction Guidelines, 78 FR 24817, 2013). The agent's touches count as interaction,
because the screen changes before the driver's eyes; new texts in the status bar count as read.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

from automotive_cosim.contracts.action import BY_HAND
from automotive_cosim.interface.trace import Step

GLANCE_S, TASK_S = 2.0, 12.0
WORDS_PER_S = 238 / 60
"""Silent reading speed of adults (Brysbaert 2019, J. Mem. Lang. 109)."""
MOVING_MPS = 0.1
NOTICE = "status.notice"
"""Elements in which the screen shows texts by itself."""


@dataclass(frozen=True, slots=True)
class DriverLoad:
    """The load on the driver while the car moved."""

    interaction_s: float
    """Time taken by touches of the screen."""
    reading_s: float
    """Time to read the new texts of the status bar."""
    longest_reading_s: float
    """Time to read the longest text: the longest glance."""
    within_guideline: bool
    """Whether no text takes over 2 s, and interaction and reading at most 12 s."""


def driver_load(steps: Sequence[Step]) -> DriverLoad:
    """The load of an episode's steps; the first step is the hand-over."""
    interaction_s, readings = 0.0, list[float]()
    for before, after in pairwise(steps):
        if after.moment.driving.speed_mps <= MOVING_MPS:
            continue
        if after.action is not None and after.action.action_type in BY_HAND:
            interaction_s += after.moment.time_s - before.moment.time_s
        said = _said(after)
        if said and said != _said(before):
            readings.append(reading_s(said))
    longest_s = max(readings, default=0.0)
    return DriverLoad(
        round(interaction_s, 3),
        round(sum(readings), 3),
        round(longest_s, 3),
        longest_s <= GLANCE_S and interaction_s + sum(readings) <= TASK_S,
    )


def reading_s(text: str) -> float:
    """Time to read a text."""
    return len(text.split()) / WORDS_PER_S


def _said(step: Step) -> str:
    return next((element.text for element in step.elements if element.resource_id == NOTICE), "")
