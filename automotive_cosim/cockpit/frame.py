"""Parts of every screen: the status bar above, the dock below."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from functools import cache, lru_cache
from typing import Any

from automotive_cosim.cockpit.apps.notifications import wanting
from automotive_cosim.cockpit.apps.phone.commands import DECLINE_CALL, TAKE_CALL
from automotive_cosim.cockpit.apps.phone.state import Phone
from automotive_cosim.cockpit.apps.settings.state import wifi
from automotive_cosim.cockpit.cards import about, heading, stepper
from automotive_cosim.cockpit.commands import Set
from automotive_cosim.cockpit.controls import CONTROLS
from automotive_cosim.cockpit.flow import Block, BlockPart, fill, grid, line
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.language import translated
from automotive_cosim.cockpit.layout import REST, row
from automotive_cosim.cockpit.make import Make
from automotive_cosim.cockpit.messages import Back, Dismiss, Show
from automotive_cosim.cockpit.notices import lit, lit_in_words
from automotive_cosim.cockpit.room import Frame
from automotive_cosim.cockpit.signals import ADAS, CALL, ENERGY, HMI, HVAC, LINK, MOTION, OUTSIDE, Signal, Signals
from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.cockpit.state import Message, State
from automotive_cosim.cockpit.telltales import Telltale
from automotive_cosim.cockpit.theme import MARGIN, Icon, Type
from automotive_cosim.cockpit.tree import entries, named, root, short
from automotive_cosim.cockpit.values import sign_figure, sign_in_words, speed, speed_unit, temperature
from automotive_cosim.cockpit.widgets import (
    Button,
    Choice,
    Glyph,
    Label,
    LimitSign,
    Look,
    Pill,
    Telltales,
    Tile,
    Widget,
)
from automotive_cosim.contracts import Severity
from automotive_cosim.contracts.text import counted, say

DOCKED: tuple[Signal[Any], ...] = (
    HVAC.DRIVER_TEMPERATURE,
    HVAC.PASSENGER_TEMPERATURE,
    HVAC.FRONT_DEFROSTER,
    HVAC.REAR_DEFROSTER,
    HMI.TEMPERATURE_UNIT,
    HMI.LANGUAGE,
)
"""Everything that the dock depends on, besides the present screen."""
SIDE_INSET = 8
"""Between the edges of a dock at a side and its entries."""
NOTICE_WIDTH = 640
"""At most; notices in a wider bar leave the rest free."""
LAMP, FEW, MANY = 31, 5, len(Telltale) - 1
"""Width of a tell-tale, how many the smallest status bar has room for, and how many can be lit: low and high beam
exclude each other."""
BEFORE, AFTER = 212, 424
"""Widths of what is always in the status bar, left and right of what comes and goes."""
_SIGNAL = (Icon.SIGNAL_0, Icon.SIGNAL_1, Icon.SIGNAL_2, Icon.SIGNAL_3, Icon.SIGNAL_3)


@cache
def _bar(frame: Frame) -> tuple[Rect, ...]:
    """The boxes of the status bar in the order of ``status_bar``, then those of the callouts and of the limit sign.

    From the left what time brings, from the right what the drive does; between them, or in a second line, what
    comes and goes."""
    size = frame.size
    lines = frame.status.rows(size.bars, 0)
    left, between, right = row(lines[0], BEFORE, REST, AFTER)
    room = lines[1].inset(MARGIN, 0) if size.bars > 1 else between
    many = FEW if size is ScreenSize.STANDARD else MANY
    _, lamps, _, notice, _ = row(room, 4, many * LAMP, 1, REST, 12)
    _, clock, _, air, _, bell = row(left, MARGIN - 4, 76, 2, 68, -2, 48)
    mobile, _, fix, _, cell, _, charge, _, gear, _, pace, _, unit, _, sign, _ = row(
        right, 28, 8, 28, 8, 28, -2, 56, 10, 36, 6, 76, 8, 52, 8, 50, MARGIN
    )
    return (
        clock,
        air,
        bell.middle(48, 48),
        lamps.middle(lamps.width, 28),
        mobile.middle(28, 28),
        fix.middle(28, 28),
        cell.middle(28, 28),
        charge,
        gear.middle(36, 36),
        pace,
        unit.moved(0, 6).within(size.whole),
        notice.left(min(notice.width, NOTICE_WIDTH)).inset(0, 6),
        sign.middle(50, 50),
    )


def status_bar(state: State) -> tuple[Widget, ...]:
    """What is there on every screen: clock, weather, bell, tell-tales, links, battery, gear and speed."""
    signals, telltales, outside = state.signals, lit(state), state.outside
    air, unit = temperature(signals, signals[OUTSIDE.TEMPERATURE], 0), speed_unit(signals)
    fix = outside is not None and outside.gps is not None and outside.gps.has_fix
    bell = Button(
        key="status.notifications",
        description=say("Notifications: {count}", count=len(wanting(state)) + len(state.notices)),
        icon=Icon.BELL_OFF if state.of(Phone).do_not_disturb else Icon.BELL,
        icon_size=24,
        look=Look.PLAIN,
        on_tap=Back() if state.screen == "notifications" else Show("notifications"),
    )
    satellites = Glyph(
        key="status.gps",
        description=say("GPS fix") if fix else say("No GPS fix"),
        icon=Icon.GPS if fix else Icon.GPS_OFF,
        size=24,
        tone="text" if fix else "muted",
    )
    gear = Label(
        key="status.gear",
        text=signals[MOTION.GEAR],
        description=say("Gear"),
        style=Type.STRONG,
        align="centre",
        plate=True,
    )
    pace = Label(
        key="status.speed",
        text=speed(signals, signals[MOTION.SPEED]),
        description=say("Speed in {unit}", unit=unit),
        style=Type.HEADLINE,
        align="right",
    )
    parts = (
        Label(key="status.clock", text=state.clock, description=say("Local time"), style=Type.TITLE),
        replace(heading(air, "status.outside_temperature"), description=say("Outside temperature")),
        bell,
        Telltales(key="status.telltales", description=lit_in_words(telltales), lit=telltales),
        _network(state),
        satellites,
        Glyph(icon=Icon.BATTERY, size=24, tone="muted"),
        Label(
            key="status.battery",
            text=f"{signals[ENERGY.LEVEL]:.0f} %",
            description=say("Battery"),
            style=Type.LABEL,
        ),
        gear,
        pace,
        about("status.speed_unit", unit, 1),
    )
    return fill(state.frame.status, Block(parts, lambda _: _bar(state.frame)))


def _network(state: State) -> Glyph:
    outside = state.outside
    online = state.signals[LINK.ONLINE] and outside is not None
    bars = outside.connectivity.signal_bars if outside is not None else 0
    words = say("Offline")
    if outside is not None and online:
        network = outside.connectivity.kind.upper()
        words = (
            say("Wi-Fi {network}", network=wifi(state))
            if wifi(state)
            else counted("{network}, {n} bar", "{network}, {n} bars", bars, network=network)
        )
    return Glyph(
        key="status.connectivity",
        description=words,
        icon=Icon.SIGNAL_OFF if not online else Icon.WIFI if wifi(state) else _SIGNAL[bars],
        size=24,
        tone="text" if online else "muted",
    )


def callouts(state: State) -> tuple[Widget, ...]:
    """What comes and goes in the status bar: a caller, a notice or a call, and the limit sign of the camera."""
    *_, room, sign = _bar(state.frame)
    return *fill(room, _callout(state)), *fill(sign, _limit_sign(state))


def _callout(state: State) -> BlockPart | None:
    ringing, partner, notice = state.signals[CALL.RINGING], state.signals[CALL.PARTNER], state.notice
    if ringing:
        return _incoming(ringing, state)
    if notice is not None:  # a tap leads to its subject, or removes it
        here = (state.screen, state.picked.get(state.screen, ""))
        return Pill(
            key="status.notice",
            text=notice.text,
            icon=notice.icon,
            severity=notice.tone,
            on_tap=Show(*notice.opens) if notice.opens and notice.opens != here else Dismiss(),
        )
    if partner:
        return Pill(
            key="call.running",
            text=say("On the phone with {who}", who=partner),
            icon=Icon.IN_CALL,
            severity=Severity.INFO,
            on_tap=Show("phone"),
        )
    return None


def _incoming(who: str, state: State) -> Block:
    """The caller, and the possible reactions, on every screen."""
    name = Label(key="call.incoming", text=who, description=say("Incoming call"), style=Type.LABEL, lines=2)
    shown = (state.screen, state.picked.get("thread")) == ("thread", who)

    def act(key: str, words: str, icon: Icon, on_tap: Message, look: Look = Look.TONAL, why: str = "") -> Button:
        return Button(key=f"call.{key}", description=words, icon=icon, look=look, on_tap=on_tap, disabled=why)

    acts = grid(
        3,
        8,
        act("answer", say("Answer the call"), Icon.PHONE, TAKE_CALL, Look.ACCENT),
        act("decline", say("Decline the call"), Icon.HANG_UP, DECLINE_CALL, Look.CRITICAL),
        act(
            "reply",
            say("Reply with a message"),
            Icon.MESSAGE,
            Show("thread", who),
            why=say("Choose a reply below") if shown else "",
        ),
    )
    return line((40, Glyph(icon=Icon.CALL_IN, size=30, tone="good")), 4, name, 8, (3 * 64, acts))


def _limit_sign(state: State) -> Widget | None:
    limit = state.signals[ADAS.LIMIT_SIGN]
    if not state.sign_camera or limit is None:
        return None
    unit = "km/h" if state.outside is None else state.outside.sign_unit
    return LimitSign(
        key="status.limit_sign",
        text=sign_figure(limit, unit),
        description=say("Limit sign {limit}", limit=sign_in_words(state.signals, limit, unit)),
        country="" if state.outside is None else state.outside.sign_country,
    )


def dock(state: State) -> tuple[Widget, ...]:
    """The apps in the middle, the temperatures and defrosters within the front seats' reach.

    It seldom changes, and is the same object as long as it does not. The driver's side is that of the traffic."""
    here = root(state.make, state.screen)
    values = tuple(state.signals[signal] for signal in DOCKED)
    return _dock(state.make, state.size, here, values, state.roads.network.left_hand)


@lru_cache(maxsize=256)
def _dock(make: Make, size: ScreenSize, here: str, values: tuple[Any, ...], left_hand: bool) -> tuple[Widget, ...]:
    signals, frame = (
        Signals({signal.path: value for signal, value in zip(DOCKED, values, strict=True)}),
        make.frame(size),
    )
    if not make.has_quick:
        across = frame.dock.inset(SIDE_INSET, 8) if frame.upright else frame.dock.inset(MARGIN, 8)
        offered = entries(make)
        cells = across.rows(len(offered), 4) if frame.upright else across.columns(len(offered), 4)
        return _translated(_entries(make, here, cells), signals, make)
    first, *second = frame.dock.rows(size.bars, 0)
    wide, large = (240, 96) if second else (184, 58)
    _, left, _, front, _, middle, _, rear, _, right, _ = row(
        second[0] if second else first, MARGIN, wide, 10, large, 8, REST, 8, large, 10, wide, MARGIN
    )
    if second:
        middle = first.inset(MARGIN, 0)
    apps = _entries(make, here, middle.inset(0, 8).columns(len(entries(make)), 4))
    left, front, rear, right = (each.inset(0, 22) for each in (left, front, rear, right))

    def warmth(signal: Signal[float], who: str) -> Block:
        return stepper(signal, signals, key=f"dock.{who}_temperature", style=Type.LABEL)

    def quick(signal: Signal[bool], where: str, name: str) -> Tile:
        on = signals[signal]
        return Tile(
            key=f"dock.{where}_defroster",
            description=name,
            icon=CONTROLS[signal].icon,
            checked=on,
            on_tap=Set(signal, not on),
        )

    whole = (
        *fill(right if left_hand else left, warmth(HVAC.DRIVER_TEMPERATURE, "driver")),
        *fill(front, quick(HVAC.FRONT_DEFROSTER, "front", say("Front defroster"))),
        *apps,
        *fill(rear, quick(HVAC.REAR_DEFROSTER, "rear", say("Rear defroster"))),
        *fill(left if left_hand else right, warmth(HVAC.PASSENGER_TEMPERATURE, "passenger")),
    )
    return _translated(whole, signals, make)


def _entries(make: Make, here: str, cells: Iterable[Rect]) -> tuple[Widget, ...]:
    return tuple(
        Choice(
            rect=cell,
            key=f"dock.{name}",
            text=short(make, name),
            icon=named(make, name)[1],
            selected=name == here,
            on_tap=Show(name),
            look="quiet",
            stacked=True,
            style=Type.SMALL,
        )
        for cell, name in zip(cells, entries(make), strict=True)
    )


def _translated(widgets: Iterable[Widget], signals: Signals, make: Make) -> tuple[Widget, ...]:
    return tuple(translated(widget, signals[HMI.LANGUAGE], make) for widget in widgets)
