"""Safety centre: warn the driver, ask to slow down or stop, call for help; and earlier alerts."""

from __future__ import annotations

from dataclasses import replace

from automotive_cosim.cockpit.apps.phone.commands import CALL_EMERGENCY
from automotive_cosim.cockpit.apps.phone.state import Phone
from automotive_cosim.cockpit.apps.safety.commands import ASK_PULL_OVER, ASK_SLOW_DOWN, WarnDriver
from automotive_cosim.cockpit.apps.safety.state import KINDS, AlertDraft, AlertRecord, Alerts
from automotive_cosim.cockpit.cards import HELD_STEPS, SMALL, choices, content, heading, rows, switch
from automotive_cosim.cockpit.commands import Put
from automotive_cosim.cockpit.flow import Block, BlockItem, card, fill, grid, line, stack
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, panes
from automotive_cosim.cockpit.messages import Back, Show
from automotive_cosim.cockpit.signals import ADAS, LIGHTS, MOTION
from automotive_cosim.cockpit.state import Message, State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.values import speed, speed_unit
from automotive_cosim.cockpit.widgets import Button, Choice, Glyph, Label, Look, Row, Widget
from automotive_cosim.contracts import AlertKind, Severity
from automotive_cosim.contracts.text import say

SEVERITIES: dict[Severity, tuple[str, Icon]] = {
    Severity.INFO: (say("Info"), Icon.INFO),
    Severity.WARNING: (say("Warning"), Icon.WARNING),
    Severity.CRITICAL: (say("Critical"), Icon.CRITICAL),
}
_URGENT = {Severity.INFO: say("info"), Severity.WARNING: say("warning"), Severity.CRITICAL: say("critical")}
"""A severity within a line."""
SLOWEST_KMH, FASTEST_KMH, STEP_KMH = 10.0, 180.0, 10.0


def safety(state: State) -> tuple[Widget, ...]:
    """The safety centre."""
    left, middle, right = _three(content(state))
    return *fill(left, _kinds(state)), *fill(middle, _draft(state)), *fill(right, _help(state))


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


def _kinds(state: State) -> Block:
    draft = state.of(AlertDraft)

    def entry(index: int, kind: AlertKind) -> Choice:
        name, icon = KINDS[kind]
        return Choice(
            key=f"safety.kind.{kind}",
            text=name,
            icon=icon,
            selected=draft.kind is kind,
            look="boxed",
            stacked=True,
            on_tap=_put(replace(draft, kind=kind)),
        )

    every = rows("safety.kinds", say("Alert types"), state, tuple(KINDS), entry, columns=4, height=86, gap=10)
    return card((30, heading(say("Warn the driver about"))), 6, every, padding=SMALL)


def _draft(state: State) -> Block:
    draft = state.of(AlertDraft)
    title = say("Choose what to warn about") if draft.kind is None else KINDS[draft.kind][0]
    severities = [
        (str(severity), name, icon, draft.severity is severity, _put(replace(draft, severity=severity)))
        for severity, (name, icon) in SEVERITIES.items()
    ]
    warn = Button(
        key="safety.warn",
        text=say("Warn driver"),
        icon=Icon.WARN,
        icon_size=34,
        style=Type.TITLE,
        look=Look.ACCENT,
        on_tap=WarnDriver(),
        disabled=say("Choose what to warn about first") if draft.kind is None else "",
    )
    return card(
        (30, heading(say("Alert"))),
        4,
        (44, Label(key="safety.draft", text=title, description=say("Selected alert"), style=Type.TITLE)),
        14,
        (92, choices("safety.severity", severities, stacked=True)),
        20,
        (180, _advice(state)),
        REST,
        (88, warn),
        padding=SMALL,
    )


def _advice(state: State) -> Block:
    """Advised speed: the posted limit, or a number."""
    signals, draft = state.signals, state.of(AlertDraft)
    advised = draft.speed_kmh
    start = signals[ADAS.LIMIT_SIGN] or signals[MOTION.SPEED]
    start = min(FASTEST_KMH, max(SLOWEST_KMH, start // STEP_KMH * STEP_KMH))

    def step(key: str, words: str, icon: Icon, by: int, end_kmh: float, why: str) -> Button:
        def moved(steps: int) -> Put:
            new = start if advised is None else min(FASTEST_KMH, max(SLOWEST_KMH, advised + steps * STEP_KMH))
            return _put(replace(draft, speed_kmh=new))

        return Button(
            key=f"safety.speed.{key}",
            description=words,
            icon=icon,
            on_tap=moved(by),
            on_hold=moved(by * HELD_STEPS),
            disabled=why if advised == end_kmh else "",
        )

    name = say("Advised speed")
    less, more = say("{name} lower", name=name), say("{name} higher", name=name)
    shown = say("Posted limit") if advised is None else f"{speed(signals, advised)} {speed_unit(signals)}"
    number = Label(key="safety.speed.value", text=shown, description=name, style=Type.STRONG, align="centre")
    posted = Choice(
        key="safety.speed.posted",
        text=say("Use posted limit"),
        selected=advised is None,
        look="boxed",
        on_tap=_put(replace(draft, speed_kmh=None)),
    )
    steps = line(
        (64, step("decrease", less, Icon.MINUS, -1, SLOWEST_KMH, say("It is at its lowest"))),
        number,
        (64, step("increase", more, Icon.PLUS, 1, FASTEST_KMH, say("It is at its highest"))),
    )
    return stack(heading(name), 12, (64, steps), 12, (52, posted))


def _help(state: State) -> Block:
    def button(key: str, text: str, icon: Icon, on_tap: Message, look: Look = Look.TONAL) -> Button:
        return Button(key=f"safety.{key}", text=text, icon=icon, stacked=True, look=look, on_tap=on_tap)

    buttons = grid(
        2,
        12,
        switch(LIGHTS.HAZARD, state, key="safety.hazard_lights"),
        button("slow_down", say("Slow down"), Icon.SLOWER, ASK_SLOW_DOWN),
        button("pull_over", say("Pull over"), Icon.PULL_OVER, ASK_PULL_OVER),
        button("emergency_call", say("SOS call"), Icon.PHONE_ALERT, Show("emergency"), Look.CRITICAL),
    )
    return stack((204, buttons), GAP, (REST, _history(state)))


def _history(state: State) -> Block:
    given = state.of(Alerts).given[::-1]

    def entry(index: int, each: AlertRecord) -> Row:
        name, icon = KINDS[each.alert.kind]
        return Row(
            key=f"safety.history.{index}",
            text=say("{first}, {second}", first=name, second=_URGENT[each.alert.severity]),
            detail=f"{each.clock} {each.answer}".strip(),
            icon=icon,
        )

    listed = rows("safety.history", say("Alerts given"), state, given, entry, height=84, gap=6)
    empty = Label(key="safety.history.empty", text=say("No alerts yet"), tone="muted", style=Type.LABEL)
    body: BlockItem = (REST, listed if given else stack((40, empty), REST))
    return card(heading(say("History")), 6, body, padding=(16, 14))


def emergency(state: State) -> tuple[Widget, ...]:
    """Asks for confirmation before it calls."""
    made = "emergency" in state.of(Phone).called
    question = Label(
        key="emergency.title", text=say("Call the emergency services?"), style=Type.TITLE, align="centre"
    )
    told = Label(
        key="emergency.about",
        text=say("Emergency call placed. They have the car's position.")
        if made
        else say("They will receive the car's position. A call can't be undone."),
        tone="muted",
        align="centre",
        lines=2,
    )
    cancel = Button(key="emergency.cancel", text=say("Back"), style=Type.STRONG, on_tap=Back())
    call = Button(
        key="emergency.call",
        text=say("Call now"),
        icon=Icon.PHONE,
        look=Look.CRITICAL,
        style=Type.STRONG,
        on_tap=CALL_EMERGENCY,
    )
    whole = card(
        (72, Glyph(icon=Icon.PHONE_ALERT, size=64, tone="accent")),
        16,
        (48, question),
        6,
        (72, told),
        REST,
        (88, grid(2, GAP, cancel, call)),
        padding=(40, 36),
    )
    return fill(content(state).middle(640, 400), whole)
