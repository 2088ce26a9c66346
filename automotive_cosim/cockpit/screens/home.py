"""Home: the map, the drive, and every app at a glance."""

from __future__ import annotations

from automotive_cosim.cockpit.drawing import text_width
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.map import camera_of
from automotive_cosim.cockpit.mapscene import ego
from automotive_cosim.cockpit.messages import Set, Show, Skip
from automotive_cosim.cockpit.screens import lookout
from automotive_cosim.cockpit.screens.map import map_view, next_turn, street
from automotive_cosim.cockpit.screens.notices import NOTICED
from automotive_cosim.cockpit.screens.outside import PHENOMENA
from automotive_cosim.cockpit.screens.parts import (
    CONTENT,
    distance,
    heading,
    speed,
    speed_unit,
    temperature,
)
from automotive_cosim.cockpit.signals import ENERGY, GLASS, HVAC, MEDIA, MOTION
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.widgets import Bar, Button, Card, Glyph, Label, Look, Widget

METRES_PER_PIXEL = 1.6
"""Scale of the small map."""


def home(state: State) -> tuple[Widget, ...]:
    """The home screen."""
    left = CONTENT.left(560)
    right = CONTENT.right_part(CONTENT.width - 560 - GAP)
    drive, first, second, media = (
        right.top(136),
        Rect(right.x, right.y + 136 + GAP, right.width, 114),
        Rect(right.x, right.y + 266 + GAP, right.width, 114),
        right.bottom_part(132),
    )
    cells = (*first.columns(2, GAP), *second.columns(2, GAP))
    return (
        _map_card(left, state),
        _drive_card(drive, state),
        _climate_card(cells[0], state),
        _outside_card(cells[1], state),
        _safety_card(cells[2], state),
        _phone_card(cells[3], state),
        _media_card(media, state),
    )


def _map_card(rect: Rect, state: State) -> Widget:
    plate = Rect(rect.x + 20, rect.bottom - 84, rect.width - 40, 64)
    words = Rect(plate.x + 62, plate.y, plate.width - 190, plate.height)
    camera = camera_of(state.roads, ego(state), METRES_PER_PIXEL)
    noticed = lookout.plate(rect.x + 20, rect.y + 20, rect.width - 40, state)
    over = (plate, *(card.rect for card in noticed))
    view = map_view(rect, "home.map", state, camera, over, Show("map"))
    ahead = None if state.outside is None else state.outside.driving.ahead
    way = "" if ahead is None else distance(state.signals, ahead.route_left_m)
    turn = next_turn(state)
    return Card(
        rect=rect,
        look="none",
        children=(
            view,
            *noticed,
            Card(
                rect=plate,
                look="plate",
                children=(
                    Glyph(
                        rect=Rect(plate.x + 14, plate.y + 14, 36, 36),
                        icon=turn[0].icon if turn else Icon.MAP,
                        size=34,
                        tone="accent",
                    ),
                    Label(
                        rect=Rect(
                            plate.x + 62, plate.y + (4 if turn else 0), plate.width - 190, 34 if turn else 64
                        ),
                        key="home.street",
                        text=street(state),
                        description="Current road",
                        style=Type.STRONG,
                    ),
                    *(
                        (
                            Label(
                                rect=Rect(words.x, words.y + 36, words.width, 24),
                                key="home.turn",
                                text=f"{turn[0].words} in {distance(state.signals, turn[1])}",
                                description="Next turn",
                                style=Type.CAPTION,
                                tone="muted",
                            ),
                        )
                        if turn
                        else ()
                    ),
                    Label(
                        rect=Rect(plate.right - 120, plate.y, 100, plate.height),
                        key="home.route_left",
                        text=way,
                        description="Distance to the destination",
                        tone="muted",
                        align="right",
                        style=Type.LABEL,
                    ),
                ),
            ),
        ),
    )


def _drive_card(rect: Rect, state: State) -> Widget:
    signals = state.signals
    level = signals[ENERGY.LEVEL]
    inner = rect.inset(24, 14)
    right = inner.right_part(220)
    shown = speed(signals, signals[MOTION.SPEED])
    wide = round(text_width(shown, Type.HUGE)) + 4
    return Card(
        rect=rect,
        children=(
            Label(
                rect=inner.left(wide),
                key="home.speed",
                text=shown,
                description=f"Speed in {speed_unit(signals)}",
                style=Type.HUGE,
            ),
            Label(
                rect=Rect(inner.x + wide + 12, inner.bottom - 44, 60, 30),
                key="home.speed_unit",
                text=speed_unit(signals),
                tone="muted",
                style=Type.LABEL,
            ),
            heading(right.top(28), "Range"),
            Label(
                rect=Rect(right.x, right.y + 30, 130, 40),
                key="home.range",
                text=distance(signals, signals[ENERGY.RANGE]),
                description="Range",
                style=Type.TITLE,
            ),
            Label(
                rect=Rect(right.x + 130, right.y + 30, 90, 40),
                key="home.battery",
                text=f"{level:.0f} %",
                description="Battery",
                align="right",
                tone="muted",
            ),
            Bar(
                rect=Rect(right.x, right.y + 84, right.width, 12),
                share=round(level / 100, 2),
                tone="good" if level > 15 else "warning",
            ),
        ),
    )


def _live(rect: Rect, key: str, name: str, icon: Icon, screen: str, value: Label, note: Label) -> Widget:
    """A card that shows an app's state and opens it."""
    inner = rect.inset(20, 12)
    return Card(
        rect=rect,
        key=key,
        description=name,
        on_tap=Show(screen),
        children=(
            Glyph(rect=Rect(inner.right - 30, inner.y, 30, 30), icon=icon, size=26, tone="accent"),
            value,
            note,
        ),
    )


def _lines(rect: Rect) -> tuple[Rect, Rect]:
    """Boxes of a live card's value and its note."""
    inner = rect.inset(20, 12)
    return Rect(inner.x, inner.y, inner.width - 40, 50), inner.bottom_part(32)


def _climate_card(rect: Rect, state: State) -> Widget:
    signals = state.signals
    value, note = _lines(rect)
    is_fogged = signals[GLASS.WINDSHIELD_FOG] >= NOTICED
    words = f"Humidity {signals[HVAC.CABIN_HUMIDITY]:.0f} %"
    if is_fogged:
        words = "Windows fogging"
    elif signals[MOTION.GEAR] == "P":
        words = f"If you leave: {temperature(signals, signals[HVAC.FORECAST], 0)}"
    return _live(
        rect,
        "home.climate",
        "Climate",
        Icon.CLIMATE,
        "climate",
        Label(
            rect=value,
            key="home.cabin_temperature",
            text=temperature(signals, signals[HVAC.CABIN_TEMPERATURE]),
            description="Cabin temperature",
            style=Type.HEADLINE,
        ),
        Label(rect=note, key="home.cabin_note", text=words, style=Type.LABEL, tone="muted"),
    )


def _outside_card(rect: Rect, state: State) -> Widget:
    """The worst of the phenomena outside."""
    value, note = _lines(rect)
    readings = {known: known.read(state) for known in PHENOMENA.values()}
    worst = max(readings, key=lambda known: readings[known].share)
    calm = readings[worst].share < NOTICED
    return _live(
        rect,
        "home.outside",
        "Outside",
        Icon.OUTSIDE if calm else worst.icon,
        "outside",
        Label(
            rect=value,
            key="home.outside.value",
            text="All clear" if calm else readings[worst].word,
            description="Outside",
            style=Type.TITLE,
        ),
        Label(
            rect=note,
            key="home.outside.note",
            text="No hazards outside" if calm else f"{worst.title}: {readings[worst].value}",
            style=Type.LABEL,
            tone="muted",
        ),
    )


def _safety_card(rect: Rect, state: State) -> Widget:
    value, note = _lines(rect)
    last = state.alerts[-1] if state.alerts else None
    title = "Warn driver" if last is None else f"{_words(last.alert.kind)} alert"
    words = "No alerts given" if last is None else f"Given at {last.clock}"
    return _live(
        rect,
        "home.safety",
        "Safety centre",
        Icon.SAFETY,
        "safety",
        Label(rect=value, key="home.last_alert", text=title, style=Type.TITLE),
        Label(rect=note, key="home.alert_note", text=words, style=Type.LABEL, tone="muted"),
    )


def _words(kind: str) -> str:
    return kind.replace("_", " ").capitalize()


def _phone_card(rect: Rect, state: State) -> Widget:
    value, note = _lines(rect)
    icon, words, about = _phone_line(state)
    return _live(
        rect,
        "home.phone",
        "Phone",
        icon,
        "phone",
        Label(rect=value, key="home.phone.value", text=words, style=Type.TITLE),
        Label(rect=note, key="home.phone.note", text=about, style=Type.LABEL, tone="muted"),
    )


def _phone_line(state: State) -> tuple[Icon, str, str]:
    """The state of the phone: icon, text and its subject."""
    phone, count = state.phone, len(state.directory.unread(state.phone))
    if phone.ringing is not None:
        return Icon.CALL_IN, phone.ringing.who, "Is calling"
    if phone.on_call is not None:
        return Icon.IN_CALL, phone.on_call.who, "On the phone"
    new = f"{count} new message{'s' if count != 1 else ''}" if count else "No new messages"
    return Icon.PHONE, new, "Do not disturb" if phone.do_not_disturb else state.desk.device


def _media_card(rect: Rect, state: State) -> Widget:
    signals = state.signals
    playing = signals[MEDIA.ACTION] == "PLAY"
    inner = rect.inset(16, 16)
    art = inner.left(inner.height)
    buttons = inner.right_part(3 * 72).columns(3, 8)
    words = Rect(art.right + 20, inner.y, buttons[0].x - art.right - 36, inner.height)
    return Card(
        rect=rect,
        key="home.media",
        description="Media",
        on_tap=Show("media"),
        children=(
            Card(
                rect=art,
                look="raised",
                children=(Glyph(rect=art.middle(48, 48), icon=Icon.NOTE, size=48, tone="accent"),),
            ),
            Label(
                rect=Rect(words.x, words.y + 10, words.width, 48),
                key="home.media.title",
                text=signals[MEDIA.TRACK],
                description="Playing" if playing else "Paused",
                style=Type.STRONG,
                lines=2,
            ),
            Label(
                rect=Rect(words.x, words.y + 60, words.width, 28),
                key="home.media.artist",
                text=signals[MEDIA.ARTIST],
                style=Type.LABEL,
                tone="muted",
            ),
            Button(
                rect=buttons[0].inset(0, 16),
                key="home.media.previous",
                description="Previous",
                icon=Icon.PREVIOUS,
                look=Look.PLAIN,
                on_tap=Skip(-1),
            ),
            Button(
                rect=buttons[1].inset(0, 16),
                key="home.media.play",
                description="Pause" if playing else "Play",
                icon=Icon.PAUSE if playing else Icon.PLAY,
                on_tap=Set(MEDIA.ACTION, "STOP" if playing else "PLAY"),
            ),
            Button(
                rect=buttons[2].inset(0, 16),
                key="home.media.next",
                description="Next",
                icon=Icon.NEXT,
                look=Look.PLAIN,
                on_tap=Skip(1),
            ),
        ),
    )
