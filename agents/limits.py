"""A speed limit information function: tells the limit wherever it is another one, and does nothing else.

One of the two reads signs alone; the other also what the law says for the road, the weather and the sight.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from automotive_cosim.contracts import Action, ActionType, AlertKind, GoalStatus, Observation
from automotive_cosim.interface.observe import Channel

KM_PER_MILE = 1.609344
_LIMIT = re.compile(r"^(Speed limit here|Default limit|Reduced limit): ([\d.]+) (km/h|mph) (.*)$", re.MULTILINE)
_SIGHT = re.compile(r"^Weather: .*?(?:([\d.]+) mm/h, )?visibility (\d+) m", re.MULTILINE)
_BELOW = re.compile(r"visibility (?:under|below) (\d+) m")


class LimitTeller:
    """Reads the geo-context, and tells the limit as a speed alert; on a task it then declares ``complete``."""

    model = "none"
    channels: frozenset[Channel] = frozenset({Channel.CONTEXT})

    def __init__(self, *, knows_law: bool) -> None:
        """One that reads signs, or also knows what the law says where there is none."""
        self.name = "limit-law" if knows_law else "limit-sign"
        self._knows_law = knows_law
        self.reset("")

    def reset(self, goal: str) -> None:
        self._told: float | None = None

    def act(self, observation: Observation) -> Action:
        """An alert with a limit that has not been told, else a wait or, on a task, the end."""
        kmh = self.limit_kmh(observation.context or "")
        if kmh is not None and kmh != self._told:
            self._told = kmh
            return Action(ActionType.SHOW_ALERT, kind=AlertKind.SPEED, speed_kmh=kmh)
        if observation.on_watch:
            return Action(ActionType.WAIT)
        return Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE)

    def limit_kmh(self, context: str) -> float | None:
        """The limit that a context states, in km/h; None if it states none that this one reads."""
        if not self._knows_law:
            return next((kmh for label, kmh in _limits(context) if label.startswith("Speed")), None)
        found = list(_limits(context))
        signed = [kmh for label, kmh in found if label.startswith("Speed")]
        usual = signed or [kmh for label, kmh in found if label.startswith("Default")]
        return min([*usual[:1], *(kmh for label, kmh in found if label.startswith("Reduced"))], default=None)


def _limits(context: str) -> Iterator[tuple[str, float]]:
    """Label and value of each limit that is stated; a reduced one only if weather or sight are as it says."""
    weather = _SIGHT.search(context)
    for label, number, unit, rest in _LIMIT.findall(context):
        if label.startswith("Reduced"):
            below = _BELOW.search(rest)
            if weather is None or not (float(weather[2]) < float(below[1]) if below else weather[1]):
                continue
        yield label, round(float(number) * (KM_PER_MILE if unit == "mph" else 1), 1)
