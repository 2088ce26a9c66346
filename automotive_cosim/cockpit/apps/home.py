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
from automotive_cosim.cockpit.cards import content, heading
from automotive_cosim.cockpit.commands import Set
from automotive_cosim.cockpit.drawing import text_width
from automotive_cosim.cockpit.flow import Block, at, fill, framed, grid, line, stack
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.layout import REST, column, panes
from automotive_cosim.cockpit.map import camera_of
from automotive_cosim.cockpit.messages import Show
from automotive_cosim.cockpit.notices import NOTICED, lit, lit_in_words
from automotive_cosim.cockpit.room import Room
from automotive_cosim.cockpit.signals import CABIN, ENERGY, GLASS, HVAC, MEDIA, MOTION
from automotive_cosim.cockpit.state import Message, State
from automotive_cosim.cockpit.theme import GAP, Icon, Type
from automotive_cosim.cockpit.values import distance, speed, speed_unit, temperature
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
    upper = grid(2, GAP, _climate_card(state), _outside_card(state))
    lower = grid(2, GAP, _safety_card(state), _phone_card(state))
    cards = stack((136, drive_card(state)), GAP, (114, upper), GAP, (114, lower), REST, (132, media_card(state)))
    return _map_card(left, state), *fill(right, cards)


def _two(rect: Rect) -> tuple[Rect, Rect]:
    """The map, and the cards beside it; where it is taller than wide, below."""
    if rect.height > rect.width:
        above, _, below = column(rect, REST, GAP, CARDS_HEIGHT)
        return above, below
    left, right = panes(rect, REST, CARDS_WIDTH)
    return left, right


def _map_card(rect: Rect, state: State) -> Widget:
    plate = rect.inset(20).bottom_part(64)
    camera = camera_of(state.roads, ego(state), METRES_PER_PIXEL)
    noticed = lookout.plate(plate.x, rect.inset(20).y, plate.width, state)
    sign = sign_view(plate.moved(0, -76).top(64).right_part(64), "home.sign", state)
    over = (plate, *(card.rect for card in (*noticed, *sign)))
    view = map_view(rect, "home.map", state, camera, over, Show("map"))
    return Card(
        rect=rect, look="none", children=(view, *noticed, *sign, *fill(plate, framed(_way(state), look="plate")))
    )


def _way(state: State) -> Block:
    """The present road, the next turn, and how far it is to go."""
    turn = next_turn(state)
    ahead = None if state.outside is None else state.outside.driving.ahead
    left = Label(
        key="home.route_left",
        text="" if ahead is None else distance(state.signals, ahead.route_left_m),
        description=say("Distance to the destination"),
        tone="muted",
        align="right",
        style=Type.LABEL,
    )
    words: Label | Block = Label(
        key="home.street", text=street(state), description=say("Current road"), style=Type.STRONG
    )
    if turn:
        then = Label(
            key="home.turn",
            text=turn[0].ahead(distance(state.signals, turn[1])),
            description=say("Next turn"),
            style=Type.CAPTION,
            tone="muted",
        )
        words = Block((words, then), lambda box: (box.top(34).moved(0, 4), box.below(36).top(24)))
    picture = Glyph(icon=turn[0].icon if turn else Icon.MAP, size=34, tone="accent")
    return line(14, (36, at(lambda box: box.middle(36, 36), picture)), 12, words, 8, (100, left), 20)


def drive_card(state: State) -> Block:
    """Speed, range and battery."""
    signals, telltales = state.signals, lit(state)
    level, shown = signals[ENERGY.LEVEL], speed(signals, signals[MOTION.SPEED])
    figure = Label(
        key="home.speed", text=shown, description=say("Speed in {unit}", unit=speed_unit(signals)), style=Type.HUGE
    )
    unit = Label(key="home.speed_unit", text=speed_unit(signals), tone="muted", style=Type.LABEL)
    lamps = Telltales(key="home.telltales", description=lit_in_words(telltales), lit=telltales)
    far = Label(
        key="home.range", text=distance(signals, signals[ENERGY.RANGE]), description=say("Range"), style=Type.TITLE
    )
    charge = Label(
        key="home.battery", text=f"{level:.0f} %", description=say("Battery"), align="right", tone="muted"
    )
    pace = line(
        (round(text_width(shown, Type.HUGE)) + 4, figure),
        12,
        (60, at(lambda box: box.bottom_part(44).top(30), unit)),
        8,
        at(lambda box: box.left(LAMPS_WIDTH).middle(LAMPS_WIDTH, LAMPS_WIDTH), lamps),
    )
    bar = Bar(share=round(level / 100, 2), tone="good" if level > 15 else "warning")
    reach = stack(heading(say("Range")), 2, (40, line((130, far), (90, charge))), 14, (12, bar), REST)
    over = Block((pace, reach), lambda box: (box, box.right_part(220)))
    return framed(over, (24, 14))


def _live(key: str, name: str, icon: Icon, screen: str, value: Label, note: Label) -> Block:
    """A card that shows an app's state and opens it."""
    picture = Glyph(icon=icon, size=26, tone="accent")
    parts = Block(
        (picture, stack((50, line(value, 40)), REST, (32, note))), lambda box: (box.top(30).right_part(30), box)
    )
    return framed(parts, (20, 12), key=key, description=name, on_tap=Show(screen))


def _climate_card(state: State) -> Block:
    signals = state.signals
    words = say("Humidity {humidity} %", humidity=f"{signals[HVAC.CABIN_HUMIDITY]:.0f}")
    if signals[GLASS.WINDSHIELD_FOG] >= NOTICED:
        words = say("Windows fogging")
    elif signals[MOTION.GEAR] == "P":
        words = say("If you leave: {temperature}", temperature=temperature(signals, signals[HVAC.FORECAST], 0))
    elif any(signals[pane] > 0 for pane in (*WINDOWS, CABIN.SUNROOF)):
        words = say("Windows open")
    value = Label(
        key="home.cabin_temperature",
        text=temperature(signals, signals[HVAC.CABIN_TEMPERATURE]),
        description=say("Cabin temperature"),
        style=Type.HEADLINE,
    )
    return _live("home.climate", say("Climate"), Icon.CLIMATE, "climate", value, heading(words, "home.cabin_note"))


def _outside_card(state: State) -> Block:
    """The worst of the phenomena outside."""
    readings = [(known, known.read(state)) for known in PHENOMENA.values()]
    worst, reading = max(readings, key=lambda pair: pair[1].share)
    calm = reading.share < NOTICED
    word = say("No weather hazards") if calm else reading.word
    value = Label(key="home.outside.value", text=word, description=say("Outside"), style=Type.TITLE)
    about = say("{name}: {value}", name=worst.title, value=reading.value)
    note = heading(say("Monitoring rain, fog, ice, dust, wind") if calm else about, "home.outside.note")
    return _live("home.outside", say("Outside"), Icon.OUTSIDE if calm else worst.icon, "outside", value, note)


_WORDS = {kind: name for kind, (name, _) in KINDS.items()} | {
    AlertKind.SLIPPERY: say("Slippery"),
    AlertKind.CORRIDOR: say("Rescue lane"),
    AlertKind.YIELD: say("Yield"),
}
"""Names of alerts in this card."""


def _safety_card(state: State) -> Block:
    last = state.of(Alerts).given[-1] if state.of(Alerts).given else None
    title = say("Warn driver") if last is None else say("{kind} alert", kind=_WORDS[last.alert.kind])
    words = say("No alerts yet") if last is None else say("Given at {time}", time=last.clock)
    value = Label(key="home.last_alert", text=title, style=Type.TITLE)
    return _live(
        "home.safety", say("Safety centre"), Icon.SAFETY, "safety", value, heading(words, "home.alert_note")
    )


def _phone_card(state: State) -> Block:
    icon, words, about = _phone_line(state)
    value = Label(key="home.phone.value", text=words, style=Type.TITLE)
    return _live("home.phone", say("Phone"), icon, "phone", value, heading(about, "home.phone.note"))


def _phone_line(state: State) -> tuple[Icon, str, str]:
    """The state of the phone: icon, text and its subject."""
    phone, count = state.of(Phone), len(state.of(Directory).unread(state.of(Phone)))
    if phone.ringing is not None:
        return Icon.CALL_IN, phone.ringing.who, say("Incoming call")
    if phone.on_call is not None:
        return Icon.IN_CALL, phone.on_call.who, say("On the phone")
    new = counted("{n} new message", "{n} new messages", count) if count else say("No new messages")
    return Icon.PHONE, new, say("Do not disturb") if phone.do_not_disturb else state.of(Connections).phone


def media_card(state: State) -> Block:
    """What plays now."""
    signals = state.signals
    playing, track, artist = signals[MEDIA.ACTION] == "PLAY", signals[MEDIA.TRACK], signals[MEDIA.ARTIST]
    cover = Cover(key="home.media.cover", description=say("Cover"), name=f"{track}, {artist}")
    name = Label(
        key="home.media.title",
        text=track,
        description=say("Playing") if playing else say("Paused"),
        style=Type.STRONG,
        lines=2,
    )

    def button(key: str, words: str, icon: Icon, on_tap: Message, look: Look = Look.PLAIN) -> Button:
        return Button(key=f"home.media.{key}", description=words, icon=icon, look=look, on_tap=on_tap)

    turn = Set(MEDIA.ACTION, "STOP" if playing else "PLAY")
    words, icon = (say("Pause"), Icon.PAUSE) if playing else (say("Play"), Icon.PLAY)
    keys = grid(
        3,
        8,
        button("previous", say("Previous"), Icon.PREVIOUS, Skip(-1)),
        button("play", words, icon, turn, Look.TONAL),
        button("next", say("Next"), Icon.NEXT, Skip(1)),
    )
    texts = stack(10, (48, name), 2, heading(artist, "home.media.artist"), REST)
    parts = line((100, cover), 20, texts, 16, (3 * 72, at(lambda box: box.inset(0, 16), keys)))
    return framed(parts, (16, 16), key="home.media", description=say("Media"), on_tap=Show("media"))


APP = App(
    name="home",
    title=say("Home"),
    short=say_in("dock", "Home"),
    icon=Icon.HOME,
    order=1,
    where=Where.DOCK,
    pages={"home": AppPage(home, Room.WHOLE)},
)
