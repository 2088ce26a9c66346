"""How well an agent that taps by pixel hits what it can tap: a figure to report, never a verdict."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from statistics import fmean

from automotive_cosim.contracts import ActionType, BoundingBox
from automotive_cosim.interface.trace import Step

TAPS = frozenset({ActionType.CLICK, ActionType.DOUBLE_TAP, ActionType.LONG_PRESS})


@dataclass(frozen=True, slots=True)
class PixelTaps:
    """The taps of an episode that were given as pixels, against the elements that the agent saw then."""

    count: int
    hits: int
    """Those inside a clickable element."""
    margin_px: float
    """Mean distance to the edge of the element hit, else of the nearest: positive inside, negative outside."""


def pixel_taps(steps: Sequence[Step]) -> PixelTaps | None:
    """Of an episode's steps; None without a tap by pixel."""
    margins = []
    for before, after in pairwise(steps):
        action = after.action
        if action is None or action.action_type not in TAPS or action.x is None or action.y is None:
            continue
        boxes = [element.bbox_pixels for element in before.elements if element.is_clickable]
        if boxes:
            margins.append(max(margin_px(box, action.x, action.y) for box in boxes))
    if not margins:
        return None
    return PixelTaps(len(margins), sum(margin > 0 for margin in margins), round(fmean(margins), 2))


def margin_px(box: BoundingBox, x: int, y: int) -> float:
    """Distance of a pixel's centre from the edge of a box: positive inside, negative outside."""
    beside = max(box.x_min - x - 0.5, x + 0.5 - box.x_max)
    above = max(box.y_min - y - 0.5, y + 0.5 - box.y_max)
    return -max(beside, above) if beside < 0 and above < 0 else -math.hypot(max(beside, 0.0), max(above, 0.0))
