"""Requests to the driver and the router, and their replies."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from automotive_cosim.cockpit.pois import Gazetteer
from automotive_cosim.cockpit.signals import ADAS
from automotive_cosim.cockpit.state import Command, CommandRecord, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.contracts import (
    Alert,
    Answer,
    Cruise,
    Feedback,
    FeedbackCode,
    Hazards,
    PullOver,
    Reroute,
    RoadRequest,
    Severity,
    SlowDown,
)
from automotive_cosim.contracts.text import say

UNKNOWN = Answer(True, "")
"""The reply to a request that was not made at the other cockpit."""
ICONS: Mapping[type, Icon] = {
    SlowDown: Icon.SLOWER,
    PullOver: Icon.PULL_OVER,
    Reroute: Icon.ROUTE,
    Cruise: Icon.CRUISE,
}
"""By request; alerts have icons of their own, and hazard lights speak for themselves."""


@dataclass(frozen=True, slots=True)
class Ask(Command):
    """Make a request to the driver or the router, as a safety call does."""

    request: SlowDown | PullOver | Reroute

    def aims(self, state: State) -> frozenset[str]:
        """The destination, or the request as such."""
        if isinstance(self.request, Reroute) and self.request.destination:
            return frozenset({"navigation.destination"})
        return frozenset({"requests"})

    def perform(self, state: State) -> Feedback:
        """The request, which cannot be taken back."""
        request = self.request
        match request:
            case SlowDown(speed_kmh):
                if not 0 <= speed_kmh <= 400:
                    return Feedback(
                        FeedbackCode.REFUSED,
                        say("{speed} km/h is not a valid speed to slow down to", speed=f"{speed_kmh:g}"),
                    )
                words = say("Asked to slow down to {speed} km/h", speed=f"{speed_kmh:.0f}")
            case PullOver():
                words = say("Asked to pull over")
            case Reroute(destination):
                name = state.of(Gazetteer).named(destination)
                words = (
                    say("Looking for a route to {place}", place=name) if name else say("Looking for a faster route")
                )
        state.asked += (request,)
        state.pending += (request,)
        return state.said(words, ICONS[type(request)])


def answered(state: State, request: RoadRequest, answer: Answer) -> None:
    """Takes the road's reply and shows it."""
    if isinstance(request, Cruise) and not answer.accepted:
        state.signals[ADAS.CRUISE_ACTIVE] = False
        state.signals[ADAS.LIMITER_ACTIVE] = False
    for data in state.apps:
        data.answered(state, request, answer)
    if not answer.accepted:
        state.notify(answer.reason, Icon.WARNING, Severity.WARNING)
    elif answer.reason and not isinstance(request, Alert | Hazards | Reroute):
        state.notify(answer.reason, ICONS[type(request)])


def note_answer(state: State, request: RoadRequest, answer: Answer) -> None:
    """Records the road's reply to the last command."""
    if state.given:
        *before, last = state.given
        state.given = (*before, replace(last, answers=(*last.answers, (request, answer))))


def repeat(state: State, record: CommandRecord, keys: frozenset[str]) -> None:
    """Gives once more a command that was given elsewhere, as far as it aims at these keys of ``State.commands``.

    What it asks of the road is answered as it was then."""
    record.command.repeat(state, record, keys)
    pending, state.pending = state.pending, ()
    for request in pending:
        reply = next((answer for asked, answer in record.answers if asked == request), UNKNOWN)
        answered(state, request, reply)
