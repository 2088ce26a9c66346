"""Alerts: those given, and the one that is being prepared."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, ClassVar

from automotive_cosim.cockpit.state import AppData, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import Alert, AlertKind, Answer, RoadRequest, Severity
from automotive_cosim.contracts.text import say, say_in

KINDS: dict[AlertKind, tuple[str, Icon]] = {
    AlertKind.SPEED: (say("Speed"), Icon.SPEED),
    AlertKind.DISTANCE: (say_in("alert", "Distance"), Icon.DISTANCE),
    AlertKind.COLLISION: (say("Collision"), Icon.COLLISION),
    AlertKind.LANE: (say("Lane"), Icon.LANE),
    AlertKind.FATIGUE: (say("Fatigue"), Icon.FATIGUE),
    AlertKind.DISTRACTION: (say("Distraction"), Icon.DISTRACTION),
    AlertKind.SEAT_BELT: (say("Seat belt"), Icon.SEAT_BELT),
    AlertKind.VISIBILITY: (say("Visibility"), Icon.REAR_FOG),
    AlertKind.SLIPPERY: (say("Slippery road"), Icon.SLIPPERY),
    AlertKind.WEATHER: (say("Weather"), Icon.WEATHER),
    AlertKind.TRAFFIC: (say("Traffic"), Icon.TRAFFIC),
    AlertKind.CORRIDOR: (say("Rescue lane"), Icon.CORRIDOR),
    AlertKind.YIELD: (say("Give way"), Icon.AMBULANCE),
    AlertKind.MOVE_OVER: (say("Move over"), Icon.MOVE_OVER),
    AlertKind.SCHOOL: (say("School"), Icon.SCHOOL),
    AlertKind.TUNNEL: (say("Tunnel"), Icon.TUNNEL),
    AlertKind.VEHICLE: (say("Vehicle"), Icon.VEHICLE_FAULT),
}
"""Name on screen and icon of every kind of alert."""
ADVICE: dict[AlertKind, str] = {
    AlertKind.SPEED: say("Slow down"),
    AlertKind.DISTANCE: say("Increase your distance"),
    AlertKind.COLLISION: say("Collision risk: brake"),
    AlertKind.LANE: say("Stay in your lane"),
    AlertKind.FATIGUE: say("Time for a break"),
    AlertKind.DISTRACTION: say("Eyes on the road"),
    AlertKind.SEAT_BELT: say("Fasten seat belts"),
    AlertKind.VISIBILITY: say("Poor visibility"),
    AlertKind.SLIPPERY: say("Slippery road"),
    AlertKind.WEATHER: say("Dangerous weather"),
    AlertKind.TRAFFIC: say("Traffic ahead"),
    AlertKind.CORRIDOR: say("Form a rescue lane"),
    AlertKind.YIELD: say("Give way to an emergency vehicle"),
    AlertKind.MOVE_OVER: say("Move over: stopped vehicle ahead"),
    AlertKind.SCHOOL: say("School zone"),
    AlertKind.TUNNEL: say("Tunnel ahead"),
    AlertKind.VEHICLE: say("Check the vehicle"),
}
"""Texts of alerts without a text of their own."""


@dataclass(frozen=True, slots=True)
class AlertDraft(AppData):
    """The alert being prepared in the safety centre."""

    prepares: ClassVar[bool] = True

    kind: AlertKind | None = None
    severity: Severity = Severity.WARNING
    speed_kmh: float | None = None
    """Advised speed; None means the posted limit."""


@dataclass(frozen=True, slots=True)
class AlertRecord:
    """One line of the history."""

    clock: str
    alert: Alert
    answer: str = ""
    """The road's reply."""


@dataclass(frozen=True, slots=True)
class Alerts(AppData):
    """The alerts given so far."""

    given: tuple[AlertRecord, ...] = ()

    def commands(self) -> dict[str, Any]:
        """The alerts, which cannot be taken back."""
        return {
            "alerts": [
                {
                    "kind": str(given.alert.kind),
                    "severity": str(given.alert.severity),
                    "text": given.alert.text,
                    "speed_kmh": given.alert.speed_kmh,
                }
                for given in self.given
            ]
        }

    def answered(self, state: State, request: RoadRequest, answer: Answer) -> None:
        """The reply to the last alert."""
        if isinstance(request, Alert) and self.given:
            *before, last = self.given
            state.keep(Alerts((*before, replace(last, answer=answer.reason))))
