"""Commands of the safety centre: to warn the driver, to ask for a lower speed or a stop."""

from __future__ import annotations

from dataclasses import dataclass

from automotive_cosim.cockpit.apps.safety.state import ADVICE, KINDS, AlertDraft, AlertRecord, Alerts
from automotive_cosim.cockpit.commands import SimpleCommand
from automotive_cosim.cockpit.restrictions import STRING_LIMIT
from automotive_cosim.cockpit.road import Ask
from automotive_cosim.cockpit.signals import ADAS
from automotive_cosim.cockpit.state import Command, State
from automotive_cosim.contracts import Alert, AlertKind, Feedback, FeedbackCode, PullOver, SlowDown
from automotive_cosim.contracts.text import say


@dataclass(frozen=True, slots=True)
class WarnDriver(Command):
    """Give an alert; without one, the prepared alert."""

    alert: Alert | None = None

    def aims(self, state: State) -> frozenset[str]:
        return frozenset({"alerts"})

    def perform(self, state: State) -> Feedback:
        """The alert, on screen and by voice, and its passing to the road."""
        if self.alert is not None:
            return _give(state, self.alert)
        draft = state.of(AlertDraft)
        if draft.kind is None:
            return Feedback(FeedbackCode.DISABLED, say("choose what to warn about first"))
        state.keep(AlertDraft())
        return _give(state, Alert(draft.kind, draft.severity, "", draft.speed_kmh))


def _ask_slow_down(state: State) -> Feedback:
    """Ask the driver to go no faster than the advised speed, or the limit sign."""
    wanted = state.of(AlertDraft).speed_kmh or state.signals[ADAS.LIMIT_SIGN]
    if wanted is None:
        return state.refused(say("No limit sign is known: set an advised speed first"))
    return Ask(SlowDown(wanted)).perform(state)


ASK_SLOW_DOWN = SimpleCommand(_ask_slow_down, ("requests",))


def _ask_pull_over(state: State) -> Feedback:
    """Ask the driver to stop at the side."""
    return Ask(PullOver()).perform(state)


ASK_PULL_OVER = SimpleCommand(_ask_pull_over, ("requests",))


def _give(state: State, alert: Alert) -> Feedback:
    name, icon = KINDS[alert.kind]
    if alert.speed_kmh is not None and not 0 < alert.speed_kmh <= 400:
        return Feedback(
            FeedbackCode.REFUSED, say("{speed} km/h is not a valid speed to advise", speed=f"{alert.speed_kmh:g}")
        )
    text = " ".join(alert.text.split())[:STRING_LIMIT] or ADVICE[alert.kind]
    if alert.speed_kmh is not None and not alert.text:
        kmh = f"{alert.speed_kmh:.0f}"
        text = (
            say("Slow down to {speed} km/h", speed=kmh)
            if alert.kind is AlertKind.SPEED
            else say("{name}: {value}", name=text, value=f"{kmh} km/h")
        )
    state.keep(Alerts((*state.of(Alerts).given, AlertRecord(state.clock, alert))))
    state.pending += (alert,)
    state.notify(text, icon, alert.severity)
    return Feedback(FeedbackCode.OK, say("{kind} alert given to the driver: {text}", kind=name, text=text))
