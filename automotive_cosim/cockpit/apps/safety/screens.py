"""Safety centre: warn the driver, ask to slow down or stop, call for help; and earlier alerts."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.apps.phone.commands import CallEmergency
from automotive_cosim.cockpit.apps.phone.state import Phone
from automotive_cosim.cockpit.apps.safety.commands import AskPullOver, AskSlowDown, WarnDriver
from automotive_cosim.cockpit.apps.safety.state import KINDS, AlertDraft, Alerts
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, panes, row
from automotive_cosim.cockpit.messages import Back, Show
from automotive_cosim.cockpit.parts import HELD_STEPS, choices, content, heading, rows, speed, speed_unit, switch
from automotive_cosim.cockpit.signals import ADAS, LIGHTS, MOTION
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.widgets import Button, Card, Choice, Glyph, Label, Look, Row, Widget
from automotive_cosim.contracts import Severity
from automotive_cosim.contracts.text import say

SEVERITIES: dict[Severity, tuple[str, Icon]] = {
    Severity.INFO: (say("Info"), Icon.INFO),
    Severity.WARNING: (say("Warning"), Icon.WARNING),
    Severity.CRITICAL: (say("Critical"), Icon.CRITICAL),
}
_URGENT = {
    Severity.INFO: say("info"),
    Severity.WARNING: say("warning"),
    Severity.CRITICAL: say("critical"),
}
"""A severity within a line."""
SLOWEST_KMH, FASTEST_KMH, STEP_KMH = 10.0, 180.0, 10.0


def safety(state: State) -> tuple[Widget, ...]:
    """The safety centre."""
    left, middle, right = _three(content(state))
    return _kinds(left, state), _draft(middle, state), *_help(right, state)


def _three(rect: Rect) -> tuple[Rect, Rect, Rect]:
    """The kinds, the alert and the help; where it is taller than wide, the kinds over the others."""
    if rect.height > rect.width:
        left, lower = panes(rect, REST, REST)
        middle, right = lower.columns(2, GAP)
        return left, middle, right
    left, middle, right = panes(rect, 556, 344, REST)
    return left, middle, right


def _put(draft: AlertDraft) -> Put:
    return Put(draft, say("The alert is not given yet"))


def _kinds(rect: Rect, state: State) -> Widget:
    head, _, body = column(rect.inset(20, 16), 30, 6, REST)
    kinds = tuple(KINDS)

    def cell(index: int, box: Rect) -> Widget:
        kind = kinds[index]
        name, icon = KINDS[kind]
        return Choice(
            rect=box,
            key=f"safety.kind.{kind}",
            text=name,
            icon=icon,
            selected=state.of(AlertDraft).kind is kind,
            look="boxed",
            stacked=True,
            on_tap=_put(replace(state.of(AlertDraft), kind=kind)),
        )

    return Card(
        rect=rect,
        children=(
            heading(head, say("Warn the driver about")),
            rows(
                body,
                "safety.kinds",
                say("Alert types"),
                state,
                len(kinds),
                cell,
                columns=4,
                height=86,
                gap=10,
            ),
        ),
    )


def _draft(rect: Rect, state: State) -> Widget:
    head, _, chosen, _, severities, _, advice, _, warn = column(
        rect.inset(20, 16), 30, 4, 44, 14, 92, 20, 180, REST, 88
    )
    draft = state.of(AlertDraft)
    title = say("Choose what to warn about") if draft.kind is None else KINDS[draft.kind][0]
    return Card(
        rect=rect,
        children=(
            heading(head, say("Alert")),
            Label(
                rect=chosen,
                key="safety.draft",
                text=title,
                description=say("Selected alert"),
                style=Type.TITLE,
            ),
            choices(
                severities,
                "safety.severity",
                [
                    (
                        str(severity),
                        name,
                        icon,
                        draft.severity is severity,
                        _put(replace(draft, severity=severity)),
                    )
                    for severity, (name, icon) in SEVERITIES.items()
                ],
                stacked=True,
            ),
            *_advice(advice, state),
            Button(
                rect=warn,
                key="safety.warn",
                text=say("Warn driver"),
                icon=Icon.WARN,
                icon_size=34,
                style=Type.TITLE,
                look=Look.ACCENT,
                on_tap=WarnDriver(),
                disabled=say("Choose what to warn about first") if draft.kind is None else "",
            ),
        ),
    )


def _advice(rect: Rect, state: State) -> tuple[Widget, ...]:
    """Advised speed: the posted limit, or a number."""
    signals, draft = state.signals, state.of(AlertDraft)
    advised = draft.speed_kmh
    start = signals[ADAS.LIMIT_SIGN] or signals[MOTION.SPEED]
    start = min(FASTEST_KMH, max(SLOWEST_KMH, start // STEP_KMH * STEP_KMH))

    def moved(steps: int) -> AlertDraft:
        new = start if advised is None else min(FASTEST_KMH, max(SLOWEST_KMH, advised + steps * STEP_KMH))
        return replace(draft, speed_kmh=new)

    shown = say("Posted limit") if advised is None else f"{speed(signals, advised)} {speed_unit(signals)}"
    head, _, line, _, posted = column(rect, 28, 12, 64, 12, 52)
    minus, number, plus = row(line, 64, REST, 64)
    return (
        heading(head, say("Advised speed")),
        Button(
            rect=minus,
            key="safety.speed.decrease",
            description=say("{name} lower", name=say("Advised speed")),
            icon=Icon.MINUS,
            on_tap=_put(moved(-1)),
            on_hold=_put(moved(-HELD_STEPS)),
            disabled=say("It is at its lowest") if advised == SLOWEST_KMH else "",
        ),
        Label(
            rect=number,
            key="safety.speed.value",
            text=shown,
            description=say("Advised speed"),
            style=Type.STRONG,
            align="centre",
        ),
        Button(
            rect=plus,
            key="safety.speed.increase",
            description=say("{name} higher", name=say("Advised speed")),
            icon=Icon.PLUS,
            on_tap=_put(moved(1)),
            on_hold=_put(moved(HELD_STEPS)),
            disabled=say("It is at its highest") if advised == FASTEST_KMH else "",
        ),
        Choice(
            rect=posted,
            key="safety.speed.posted",
            text=say("Use posted limit"),
            selected=advised is None,
            look="boxed",
            on_tap=_put(replace(draft, speed_kmh=None)),
        ),
    )


def _help(rect: Rect, state: State) -> tuple[Widget, ...]:
    first, _, earlier = column(rect, 204, GAP, REST)
    upper, lower = first.rows(2, 12)
    hazard, slow = upper.columns(2, 12)
    stop, call = lower.columns(2, 12)
    return (
        switch(hazard, "safety.hazard_lights", say("Hazards"), Icon.HAZARD, LIGHTS.HAZARD, state.signals),
        Button(
            rect=slow,
            key="safety.slow_down",
            text=say("Slow down"),
            icon=Icon.SLOWER,
            stacked=True,
            on_tap=AskSlowDown(),
        ),
        Button(
            rect=stop,
            key="safety.pull_over",
            text=say("Pull over"),
            icon=Icon.PULL_OVER,
            stacked=True,
            on_tap=AskPullOver(),
        ),
        Button(
            rect=call,
            key="safety.emergency_call",
            text=say("SOS call"),
            icon=Icon.PHONE_ALERT,
            stacked=True,
            look=Look.CRITICAL,
            on_tap=Show("emergency"),
        ),
        _history(earlier, state),
    )


def _history(rect: Rect, state: State) -> Widget:
    head, _, body = column(rect.inset(16, 14), 28, 6, REST)
    given = tuple(reversed(state.of(Alerts).given))

    def line(index: int, box: Rect) -> Widget:
        entry = given[index]
        name, icon = KINDS[entry.alert.kind]
        return Row(
            rect=box,
            key=f"safety.history.{index}",
            text=say("{first}, {second}", first=name, second=_URGENT[entry.alert.severity]),
            detail=f"{entry.clock} {entry.answer}".strip(),
            icon=icon,
        )

    empty = Label(
        rect=body.top(40), key="safety.history.empty", text=say("No alerts yet"), tone="muted", style=Type.LABEL
    )
    listed = rows(body, "safety.history", say("Alerts given"), state, len(given), line, height=84, gap=6)
    return Card(rect=rect, children=(heading(head, say("History")), listed if given else empty))


def emergency(state: State) -> tuple[Widget, ...]:
    """Asks for confirmation before it calls."""
    card = content(state).middle(640, 400)
    picture, _, question, _, about, _, answers = column(card.inset(40, 36), 72, 16, 48, 6, 72, REST, 88)
    cancel, call = answers.columns(2, GAP)
    made = "emergency" in state.of(Phone).called
    return (
        Card(
            rect=card,
            children=(
                Glyph(rect=picture, icon=Icon.PHONE_ALERT, size=64, tone="accent"),
                Label(
                    rect=question,
                    key="emergency.title",
                    text=say("Call the emergency services?"),
                    style=Type.TITLE,
                    align="centre",
                ),
                Label(
                    rect=about,
                    key="emergency.about",
                    text=say("Emergency call placed. They have the car's position.")
                    if made
                    else say("They will receive the car's position. A call can't be undone."),
                    tone="muted",
                    align="centre",
                    lines=2,
                ),
                Button(
                    rect=cancel,
                    key="emergency.cancel",
                    text=say("Back"),
                    look=Look.TONAL,
                    style=Type.STRONG,
                    on_tap=Back(),
                ),
                Button(
                    rect=call,
                    key="emergency.call",
                    text=say("Call now"),
                    icon=Icon.PHONE,
                    look=Look.CRITICAL,
                    style=Type.STRONG,
                    on_tap=CallEmergency(),
                ),
            ),
        ),
    )
