"""Home: the map, the drive, and every app at a glance."""

from __future__ import annotations

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.apps.map import lookout
from automotive_cosim.cockpit.apps.map.scene import ego
from automotive_cosim.cockpit.apps.map.screens import map_view, next_turn, sign_view, street
from automotive_cosim.cockpit.apps.media.commands import Skip
from automotive_cosim.cockpit.apps.outside import PHENOMENA
from automotive_cosim.cockpit.apps.phone.state import Directory, Phone
from automotive_cosim.cockpit.apps.safety.state import KINDS, Alerts
from automotive_cosim.cockpit.apps.settings.state import Connections
from automotive_cosim.cockpit.commands import Set
from automotive_cosim.cockpit.drawing import text_width
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, panes, row
from automotive_cosim.cockpit.map import camera_of
from automotive_cosim.cockpit.messages import Show
from automotive_cosim.cockpit.notices import NOTICED, lit, lit_in_words
from automotive_cosim.cockpit.parts import content, distance, heading, speed, speed_unit, temperature
from automotive_cosim.cockpit.signals import CABIN, ENERGY, GLASS, HVAC, MEDIA, MOTION
from automotive_cosim.cockpit.size import Room
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.vehicle import WINDOWS
from automotive_cosim.cockpit.widgets import Bar, Button, Card, Cover, Glyph, Label, Look, Telltales, Widget
from automotive_cosim.contracts import AlertKind
from automotive_cosim.contracts.text import counted, say, say_in

METRES_PER_PIXEL = 1.6
"""Scale of the small map."""
CARDS_WIDTH, CARDS_HEIGHT = 656, 544
LAMPS_WIDTH = 3 * 31 - 3


def home(state: State) -> tuple[Widget, ...]:
    """The home screen."""
    left, right = _two(content(state))
    drive, _, first, _, second, _, media = column(right, 136, GAP, 114, GAP, 114, REST, 132)
    cells = (*first.columns(2, GAP), *second.columns(2, GAP))
    return (
        _map_card(left, state),
        drive_card(drive, state),
        _climate_card(cells[0], state),
        _outside_card(cells[1], state),
        _safety_card(cells[2], state),
        _phone_card(cells[3], state),
        media_card(media, state),
    )


def _two(rect: Rect) -> tuple[Rect, Rect]:
    """The map, and the cards beside it; where it is taller than wide, below."""
    if rect.height > rect.width:
        above, _, below = column(rect, REST, GAP, CARDS_HEIGHT)
        return above, below
    left, right = panes(rect, REST, CARDS_WIDTH)
    return left, right


def _map_card(rect: Rect, state: State) -> Widget:
    plate = rect.inset(20).bottom_part(64)
    picture, _, words, _, left, _ = row(plate.inset(14, 0), 36, 12, REST, 8, 100, 6)
    name, _, then, _ = column(words, 34, 2, 24, REST)
    camera = camera_of(state.roads, ego(state), METRES_PER_PIXEL)
    noticed = lookout.plate(plate.x, rect.inset(20).y, plate.width, state)
    sign = sign_view(plate.moved(0, -76).top(64).right_part(64), "home.sign", state)
    over = (plate, *(card.rect for card in (*noticed, *sign)))
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
            *sign,
            Card(
                rect=plate,
                look="plate",
                children=(
                    Glyph(
                        rect=picture.middle(36, 36),
                        icon=turn[0].icon if turn else Icon.MAP,
                        size=34,
                        tone="accent",
                    ),
                    Label(
                        rect=name.moved(0, 4) if turn else words,
                        key="home.street",
                        text=street(state),
                        description=say("Current road"),
                        style=Type.STRONG,
                    ),
                    *(
                        (
                            Label(
                                rect=then,
                                key="home.turn",
                                text=turn[0].ahead(distance(state.signals, turn[1])),
                                description=say("Next turn"),
                                style=Type.CAPTION,
                                tone="muted",
                            ),
                        )
                        if turn
                        else ()
                    ),
                    Label(
                        rect=left,
                        key="home.route_left",
                        text=way,
                        description=say("Distance to the destination"),
                        tone="muted",
                        align="right",
                        style=Type.LABEL,
                    ),
                ),
            ),
        ),
    )


def drive_card(rect: Rect, state: State) -> Widget:
    """Speed, range and battery."""
    signals, telltales = state.signals, lit(state)
    level = signals[ENERGY.LEVEL]
    inner = rect.inset(24, 14)
    head, _, reach, _, bar, _ = column(inner.right_part(220), 28, 2, 40, 14, 12, REST)
    far, charge = row(reach, 130, 90)
    shown = speed(signals, signals[MOTION.SPEED])
    figure, _, unit, _, lamps = row(inner, round(text_width(shown, Type.HUGE)) + 4, 12, 60, 8, REST)
    return Card(
        rect=rect,
        children=(
            Label(
                rect=figure,
                key="home.speed",
                text=shown,
                description=say("Speed in {unit}", unit=speed_unit(signals)),
                style=Type.HUGE,
            ),
            Label(
                rect=unit.bottom_part(44).top(30),
                key="home.speed_unit",
                text=speed_unit(signals),
                tone="muted",
                style=Type.LABEL,
            ),
            Telltales(
                rect=lamps.left(LAMPS_WIDTH).middle(LAMPS_WIDTH, LAMPS_WIDTH),
                key="home.telltales",
                description=lit_in_words(telltales),
                lit=telltales,
            ),
            heading(head, say("Range")),
            Label(
                rect=far,
                key="home.range",
                text=distance(signals, signals[ENERGY.RANGE]),
                description=say("Range"),
                style=Type.TITLE,
            ),
            Label(
                rect=charge,
                key="home.battery",
                text=f"{level:.0f} %",
                description=say("Battery"),
                align="right",
                tone="muted",
            ),
            Bar(
                rect=bar,
                share=round(level / 100, 2),
                tone="good" if level > 15 else "warning",
            ),
        ),
    )


def _live(rect: Rect, key: str, name: str, icon: Icon, screen: str, value: Label, note: Label) -> Widget:
    """A card that shows an app's state and opens it."""
    picture = rect.inset(20, 12).top(30).right_part(30)
    return Card(
        rect=rect,
        key=key,
        description=name,
        on_tap=Show(screen),
        children=(
            Glyph(rect=picture, icon=icon, size=26, tone="accent"),
            value,
            note,
        ),
    )


def _lines(rect: Rect) -> tuple[Rect, Rect]:
    """Boxes of a live card's value and its note."""
    value, _, note = column(rect.inset(20, 12), 50, REST, 32)
    return row(value, REST, 40)[0], note


def _climate_card(rect: Rect, state: State) -> Widget:
    signals = state.signals
    value, note = _lines(rect)
    is_fogged = signals[GLASS.WINDSHIELD_FOG] >= NOTICED
    words = say("Humidity {humidity} %", humidity=f"{signals[HVAC.CABIN_HUMIDITY]:.0f}")
    if is_fogged:
        words = say("Windows fogging")
    elif signals[MOTION.GEAR] == "P":
        words = say("If you leave: {temperature}", temperature=temperature(signals, signals[HVAC.FORECAST], 0))
    elif any(signals[pane] > 0 for pane in (*WINDOWS, CABIN.SUNROOF)):
        words = say("Windows open")
    return _live(
        rect,
        "home.climate",
        say("Climate"),
        Icon.CLIMATE,
        "climate",
        Label(
            rect=value,
            key="home.cabin_temperature",
            text=temperature(signals, signals[HVAC.CABIN_TEMPERATURE]),
            description=say("Cabin temperature"),
            style=Type.HEADLINE,
        ),
        Label(rect=note, key="home.cabin_note", text=words, style=Type.LABEL, tone="muted"),
    )


def _outside_card(rect: Rect, state: State) -> Widget:
    """The worst of the phenomena outside."""
    value, note = _lines(rect)
    readings = [(known, known.read(state)) for known in PHENOMENA.values()]
    worst, reading = max(readings, key=lambda pair: pair[1].share)
    calm = reading.share < NOTICED
    return _live(
        rect,
        "home.outside",
        say("Outside"),
        Icon.OUTSIDE if calm else worst.icon,
        "outside",
        Label(
            rect=value,
            key="home.outside.value",
            text=say("No weather hazards") if calm else reading.word,
            description=say("Outside"),
            style=Type.TITLE,
        ),
        Label(
            rect=note,
            key="home.outside.note",
            text=say("Monitoring rain, fog, ice, dust, wind")
            if calm
            else say("{name}: {value}", name=worst.title, value=reading.value),
            style=Type.LABEL,
            tone="muted",
        ),
    )


_WORDS = {kind: name for kind, (name, _) in KINDS.items()} | {
    AlertKind.SLIPPERY: say("Slippery"),
    AlertKind.CORRIDOR: say("Rescue lane"),
    AlertKind.YIELD: say("Yield"),
}
"""Names of alerts in this card."""


def _safety_card(rect: Rect, state: State) -> Widget:
    value, note = _lines(rect)
    last = state.of(Alerts).given[-1] if state.of(Alerts).given else None
    title = say("Warn driver") if last is None else say("{kind} alert", kind=_WORDS[last.alert.kind])
    words = say("No alerts yet") if last is None else say("Given at {time}", time=last.clock)
    return _live(
        rect,
        "home.safety",
        say("Safety centre"),
        Icon.SAFETY,
        "safety",
        Label(rect=value, key="home.last_alert", text=title, style=Type.TITLE),
        Label(rect=note, key="home.alert_note", text=words, style=Type.LABEL, tone="muted"),
    )


def _phone_card(rect: Rect, state: State) -> Widget:
    value, note = _lines(rect)
    icon, words, about = _phone_line(state)
    return _live(
        rect,
        "home.phone",
        say("Phone"),
        icon,
        "phone",
        Label(rect=value, key="home.phone.value", text=words, style=Type.TITLE),
        Label(rect=note, key="home.phone.note", text=about, style=Type.LABEL, tone="muted"),
    )


def _phone_line(state: State) -> tuple[Icon, str, str]:
    """The state of the phone: icon, text and its subject."""
    phone, count = state.of(Phone), len(state.of(Directory).unread(state.of(Phone)))
    if phone.ringing is not None:
        return Icon.CALL_IN, phone.ringing.who, say("Incoming call")
    if phone.on_call is not None:
        return Icon.IN_CALL, phone.on_call.who, say("On the phone")
    new = counted("{n} new message", "{n} new messages", count) if count else say("No new messages")
    return Icon.PHONE, new, say("Do not disturb") if phone.do_not_disturb else state.of(Connections).phone


def media_card(rect: Rect, state: State) -> Widget:
    """What plays now."""
    signals = state.signals
    playing = signals[MEDIA.ACTION] == "PLAY"
    inner = rect.inset(16, 16)
    art, _, words, _, keys = row(inner, inner.height, 20, REST, 16, 3 * 72)
    _, name, _, artist = column(words, 10, 48, 2, 28)
    buttons = keys.inset(0, 16).columns(3, 8)
    return Card(
        rect=rect,
        key="home.media",
        description=say("Media"),
        on_tap=Show("media"),
        children=(
            Cover(
                rect=art,
                key="home.media.cover",
                description=say("Cover"),
                name=f"{signals[MEDIA.TRACK]}, {signals[MEDIA.ARTIST]}",
            ),
            Label(
                rect=name,
                key="home.media.title",
                text=signals[MEDIA.TRACK],
                description=say("Playing") if playing else say("Paused"),
                style=Type.STRONG,
                lines=2,
            ),
            Label(
                rect=artist,
                key="home.media.artist",
                text=signals[MEDIA.ARTIST],
                style=Type.LABEL,
                tone="muted",
            ),
            Button(
                rect=buttons[0],
                key="home.media.previous",
                description=say("Previous"),
                icon=Icon.PREVIOUS,
                look=Look.PLAIN,
                on_tap=Skip(-1),
            ),
            Button(
                rect=buttons[1],
                key="home.media.play",
                description=say("Pause") if playing else say("Play"),
                icon=Icon.PAUSE if playing else Icon.PLAY,
                on_tap=Set(MEDIA.ACTION, "STOP" if playing else "PLAY"),
            ),
            Button(
                rect=buttons[2],
                key="home.media.next",
                description=say("Next"),
                icon=Icon.NEXT,
                look=Look.PLAIN,
                on_tap=Skip(1),
            ),
        ),
    )


APP = App(
    name="home",
    title=say("Home"),
    short=say_in("dock", "Home"),
    icon=Icon.HOME,
    order=1,
    where=Where.DOCK,
    pages={"home": AppPage(home, Room.WHOLE)},
)
