"""Commands of the timer."""

from __future__ import annotations

from dataclasses import dataclass, replace

from automotive_cosim.cockpit.apps.timer.state import Countdown
from automotive_cosim.cockpit.state import Command, State
from automotive_cosim.contracts import Feedback
from automotive_cosim.contracts.text import say


@dataclass(frozen=True, slots=True)
class StartTimer(Command):
    """Count down from the length that is set."""

    def aims(self, state: State) -> frozenset[str]:
        return frozenset({"timer.running"})

    def perform(self, state: State) -> Feedback:
        """The countdown, from now on."""
        now = state.of(Countdown)
        return state.change(
            replace(now, begun_s=state.time_s), say("the timer runs for {minutes} minutes", minutes=now.minutes)
        )


@dataclass(frozen=True, slots=True)
class StopTimer(Command):
    """Stop the countdown."""

    def aims(self, state: State) -> frozenset[str]:
        return frozenset({"timer.running"})

    def perform(self, state: State) -> Feedback:
        return state.change(replace(state.of(Countdown), begun_s=None), say("The timer is stopped"))
