"""An agent's acts on a drive, from what the car carried out, by whatever way it was asked."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from automotive_cosim.cockpit.apps.safety.commands import WarnDriver
from automotive_cosim.cockpit.commands import Set, SetAll
from automotive_cosim.cockpit.state import CommandRecord
from automotive_cosim.contracts import Action, ActionType, Alert, DrivingState, SlowDown
from automotive_cosim.drives.events.base import DriveAct
from automotive_cosim.traffic.ego import takes_back

BOOKKEEPING = frozenset({"alerts", "requests"})
"""Commands that only say that something was asked for."""


def acts_of(given: Sequence[CommandRecord], driving: DrivingState) -> Iterator[DriveAct]:
    """The acts in what was commanded, in order; preparations such as a typed text are none, nor is what the road
    refused.

    Args:
        driving: how the car drove when they were given.
    """
    for record in given:
        if not record.aims or refusal(record):
            continue
        message = record.command
        asked = tuple(request for request, _ in record.answers)
        alert = next((request for request in asked if isinstance(request, Alert)), None)
        if isinstance(message, WarnDriver):
            alert = alert or message.alert
        if alert is not None:
            yield DriveAct(record.time_s, alert.kind, alert.severity, alert.speed_kmh, text=alert.text)
            continue
        releases = any(isinstance(each, SlowDown) and takes_back(each.speed_kmh, driving) for each in asked)
        yield DriveAct(record.time_s, requests=asked, writes=tuple(_writes(record)), releases=releases)


def refusal(record: CommandRecord) -> str:
    """Why the road refuses what was asked of it; empty if it does not."""
    return next((answer.reason for _, answer in record.answers if not answer.accepted), "")


def _writes(record: CommandRecord) -> Iterator[tuple[str, Any]]:
    message = record.command
    if isinstance(message, Set):
        yield message.signal.path, message.value
    elif isinstance(message, SetAll):
        yield from ((signal.path, value) for signal, value in message.values)
    else:
        yield from ((path, None) for path in sorted(record.aims - BOOKKEEPING))


def spoken(action: Action, time_s: float) -> DriveAct | None:
    """What an action says to the driver besides alerts: an answer, or a question."""
    speaks = action.action_type in (ActionType.ANSWER, ActionType.ASK_DRIVER)
    return DriveAct(time_s, said=action.text or "") if speaks else None
