"""From when on a rule is broken for certain: margins and times that kinds of events and the watcher share."""

from __future__ import annotations

HOLDS_S = ((1.3, 3.0), (1.2, 4.0), (1.1, 5.0), (1.0, 6.0))
"""(ratio of speed to limit, seconds) after which the tone of the same annex sounds."""
BORDER_S = 60.0
"""How long after a border it is news; our choice."""
LAMP_S = 2.0
"""How long an automatic switch may take to light the dipped beam (UN R48, 6.2.7)."""


def margin_kmh(limit_kmh: float) -> float:
    """By how much a limit is exceeded for certain: 3 km/h up to 100, 3 % above, the error limit of type-approved
    speed meters (OIML R 91)."""
    return max(3.0, 0.03 * limit_kmh)


def hold_s(ratio: float) -> float:
    """Seconds for which a ratio of speed to limit must last."""
    return next((seconds for least, seconds in HOLDS_S if ratio >= least), HOLDS_S[-1][1])


def gaze_s(kmh: float) -> float:
    """How long a driver may look away at a speed (Regulation (EU) 2023/2590)."""
    return 3.5 if kmh > 50.0 else 6.0
