"""The cockpit: the effects of touches and of time on the car and its screen.

    cockpit.sense(surroundings, dt_s)      surroundings -> signals, air, glass, battery
    cockpit.tap(x, y) ...                  a finger -> a widget's message -> signals, app data, requests to the road
    cockpit.drain_requests()               its requests to the road; answered() takes the reply
    cockpit.screenshot(), elements()       the same widget tree, drawn and listed

Every action answers with a ``Feedback`` and never raises; a wrong one changes nothing. Everything is
determined by the calls: time comes only from ``sense``.
"""

from collections.abc import Collection, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, replace
from datetime import timedelta
from difflib import get_close_matches
from typing import Any, TypeVar

import numpy as np
import numpy.typing as npt
from PIL import Image

from automotive_cosim.cockpit import accessibility, calls, language, road
from automotive_cosim.cockpit.app import Where
from automotive_cosim.cockpit.apps.map.commands import Pan
from automotive_cosim.cockpit.apps.map.lookout import sights
from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.apps.phone.commands import CALL_EMERGENCY
from automotive_cosim.cockpit.apps.phone.state import Directory, Phone
from automotive_cosim.cockpit.apps.safety.commands import WarnDriver
from automotive_cosim.cockpit.apps.store import Installed
from automotive_cosim.cockpit.belongings import NOTHING, Belongings, bring
from automotive_cosim.cockpit.cabin import CabinStart
from automotive_cosim.cockpit.changes import CarChange, schedule
from automotive_cosim.cockpit.commands import AskDriver, Set
from automotive_cosim.cockpit.drawing import pixels_of
from automotive_cosim.cockpit.make import HOME, Make
from automotive_cosim.cockpit.map import road_map
from automotive_cosim.cockpit.messages import Back, Key, Show, write
from automotive_cosim.cockpit.missing_parts import Lacking
from automotive_cosim.cockpit.notices import TYRES
from automotive_cosim.cockpit.occupants import Occupant, in_words, take_seats
from automotive_cosim.cockpit.picture import picture
from automotive_cosim.cockpit.places import Gazetteer
from automotive_cosim.cockpit.registry import apps, by_any_name, docked, pages
from automotive_cosim.cockpit.render import render, repaint
from automotive_cosim.cockpit.restrictions import REASONS, Restriction
from automotive_cosim.cockpit.road import Ask
from automotive_cosim.cockpit.sensing import sense
from automotive_cosim.cockpit.signals import (
    ADAS,
    BODY,
    ENERGY,
    HMI,
    HVAC,
    LIGHTS,
    LINK,
    MEDIA,
    MOTION,
    OUTSIDE,
    SEAT,
    LeafKind,
    Signal,
    Signals,
    named,
)
from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.cockpit.state import CommandRecord, Message, State
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.cockpit.tree import opens
from automotive_cosim.cockpit.vehicle import Vehicle
from automotive_cosim.cockpit.widgets import Button, Field, MapView, Rows, Screen, Slider, Widget
from automotive_cosim.contracts import (
    Alert,
    Answer,
    Direction,
    Element,
    Feedback,
    FeedbackCode,
    PullOver,
    Reroute,
    RoadNetwork,
    RoadRequest,
    Sight,
    SlowDown,
    Surroundings,
    VehicleState,
    lon_lat,
)
from automotive_cosim.contracts.text import say, say_in
from automotive_cosim.errors import SignalError, UnknownNameError, UserError


@dataclass(frozen=True, slots=True)
class _Frame:
    """A widget tree and its picture, which is never modified."""

    screen: Screen
    picture: Image.Image
    pixels: npt.NDArray[np.uint8]


class Display:
    """Keeps the last picture and the last list. Copies are independent: what they keep is never modified."""

    def __init__(self, scale: float) -> None:
        """Nothing is drawn yet; the picture has ``scale`` pixels per logical pixel."""
        self._scale = scale
        self._frame: _Frame | None = None
        self._listed: tuple[Screen, tuple[Element, ...]] | None = None

    @property
    def scale(self) -> float:
        """Pixels of the picture per logical pixel."""
        return self._scale

    def elements(self, screen: Screen) -> tuple[Element, ...]:
        if self._listed is None or self._listed[0] is not screen:
            self._listed = screen, accessibility.elements(screen, self.scale)
        return self._listed[1]

    def screenshot(self, screen: Screen) -> npt.NDArray[np.uint8]:
        """The picture, (height, width, 3), RGB, read-only; the same array as long as nothing changes."""
        if self._frame is None or self._frame.screen is not screen:
            if self._frame is not None and self._frame.screen == screen:
                self._frame = replace(self._frame, screen=screen)
            else:
                self._frame = self._drawn(screen)
        return self._frame.pixels

    def _drawn(self, screen: Screen) -> _Frame:
        """Draws the frame, or only where it differs from the last one."""
        if self._frame is None:
            picture = render(screen, self._scale).image
            return _Frame(screen, picture, pixels_of(picture))
        picture, boxes = repaint(self._frame.screen, self._frame.picture, screen)
        pixels = self._frame.pixels.copy()
        for box in boxes:
            edges = box.edges(self.scale)
            left, top, right, bottom = edges
            pixels[top:bottom, left:right] = pixels_of(picture.crop(edges))
        pixels.flags.writeable = False
        return _Frame(screen, picture, pixels)


USED: tuple[Signal[Any], ...] = (ENERGY.LEVEL, ENERGY.RANGE, MEDIA.PLAYED, MEDIA.TRACK, MEDIA.ARTIST)
BODIES: tuple[Signal[Any], ...] = (*TYRES, SEAT.DRIVER_TEMPERATURE, SEAT.PASSENGER_TEMPERATURE)


def put_back(state: State, departed: State, surroundings: Surroundings, way: timedelta, *, with_air: bool) -> None:
    """Puts a state back and senses the surroundings anew.

    Args:
        state: changed in place.
        departed: the same cockpit's at departure.
        surroundings: the present ones, at the departure's time of day.
        with_air: whether air, glass, seats and tyres are put back too.
    """
    for signal in (*USED, *(BODIES if with_air else ())):
        state.signals[signal] = departed.signals[signal]
    if with_air:
        state.cabin, state.tyres = departed.cabin, departed.tyres
    departed_s, state.outside = state.departed_s, None  # the trip computer starts anew
    if state.heard is not None:
        state.heard = replace(state.heard, local_time=state.heard.local_time - way)
    sense(state, surroundings, 0.0)
    state.departed_s = departed_s  # what is still to arrive arrives when it would have
    for data in state.apps:
        data.put_back(state, departed)
    state.notices = tuple(
        replace(notice, clock=state.clock) for notice in state.notices if notice.icon is not Icon.CALL_MISSED
    )


def readings(state: State) -> VehicleState:
    """The present readings."""
    now = state.signals
    return VehicleState(
        speed_kmh=now[MOTION.SPEED],
        gear=now[MOTION.GEAR],
        restrictions=int(state.restrictions),
        ambient_temperature_c=now[OUTSIDE.TEMPERATURE],
        cabin_temperature_c=now[HVAC.CABIN_TEMPERATURE],
        cabin_humidity_pct=now[HVAC.CABIN_HUMIDITY],
        rain_intensity_pct=now[BODY.RAIN_INTENSITY],
        driver_temperature_set_c=now[HVAC.DRIVER_TEMPERATURE],
        fan_speed_pct=now[HVAC.FAN_SPEED],
        is_low_beam_on=now[LIGHTS.LOW_BEAM],
        is_high_beam_on=now[LIGHTS.HIGH_BEAM],
        is_front_fog_on=now[LIGHTS.FRONT_FOG],
        is_rear_fog_on=now[LIGHTS.REAR_FOG],
        is_hazard_on=now[LIGHTS.HAZARD],
        energy_level_pct=now[ENERGY.LEVEL],
        range_km=now[ENERGY.RANGE] / 1000,
        speed_limit_sign_kmh=now[ADAS.LIMIT_SIGN],
        leader_gap_m=now[ADAS.LEADER_DISTANCE],
        leader_time_to_collision_s=now[ADAS.LEADER_TIME_TO_COLLISION],
        aboard=in_words(now),
    )


def content(state: State) -> dict[str, tuple[str, ...]]:
    """Names by kind, for tasks that draw one of them.

    ``contacts`` (those that the list shows even while driving), ``favourite_contacts``, ``threads`` and
    ``unread`` (senders of messages, and of unread ones), ``places``, ``favourite_places``, ``streets`` (neither
    among these nor hidden behind another in a search), ``playlists``, ``tracks``, ``podcasts``, ``fm``, ``dab``
    (stations).
    """
    return {kind: names for data in state.apps for kind, names in data.names(state).items()}


W = TypeVar("W", bound=Widget)

DIRECTIONS = {
    Direction.UP: say_in("towards", "up"),
    Direction.DOWN: say_in("towards", "down"),
    Direction.LEFT: say_in("towards", "left"),
    Direction.RIGHT: say_in("towards", "right"),
}
OPPOSITE = {
    Direction.UP: Direction.DOWN,
    Direction.DOWN: Direction.UP,
    Direction.LEFT: Direction.RIGHT,
    Direction.RIGHT: Direction.LEFT,
}
"""The scroll direction of a swipe."""
PAN_SHARE = 0.4
"""Share of the map's width and height moved by one swipe."""


class Cockpit:
    """One car's cockpit. Copies are independent and cheap: they share only immutable data."""

    def __init__(
        self,
        network: RoadNetwork,
        *,
        rng: np.random.Generator,
        aboard: Sequence[Occupant] = (),
        cabin: Mapping[str, Any] | None = None,
        signals: Mapping[str, Any] | None = None,
        arrivals: Sequence[Arrival] = (),
        changes: Sequence[CarChange] = (),
        belongings: Belongings = NOTHING,
        sign_camera: bool = True,
        lacks: Sequence[Lacking] = (),
        sensors: Mapping[str, Any] | None = None,
        lookout: bool = False,
        driven_s: float = 0.0,
        places_on: frozenset[str] | None = None,
        size: ScreenSize = ScreenSize.STANDARD,
        make: Make = HOME,
        width: int | None = None,
    ) -> None:
        """A cockpit before its first ``sense``.

        Args:
            rng: draws media, places, people and the driver's stored data.
            aboard: who is in the car besides the driver.
            cabin: fields of ``CabinStart``.
            signals: VSS paths and values before departure; actuators also set what is coupled to them, in the given
                order.
            arrivals: incoming calls and messages while driving.
            changes: changes of the car while driving that nobody commands.
            belongings: people, messages, appointments, memos and places besides those that are drawn.
            sign_camera: whether it reads limit signs; without it, the status bar shows no sign.
            lacks: what it was not fitted with, or is out of order.
            sensors: VSS paths of sensors that measure wrongly, and what they always read.
            lookout: whether home and map show what the car notices around, ahead and aboard.
            driven_s: how long the driver had been driving without a break before departure.
            places_on: edges on which places may lie; None means any.
            make: whose cockpit it is.
            width: width of the screenshot in pixels, by default that of the size; the height follows.

        Raises:
            UnknownNameError: no such signal or initial condition.
            SignalError: an illegal value, or one the car refuses.
            UserError: an arrival, a change or an occupant is impossible.
        """
        state = self._state = State(
            Vehicle(Signals()), road_map(network), sign_camera, CabinStart.read(cabin or {})
        )
        state.places_on = places_on
        for app in sorted(apps().values(), key=lambda app: app.turn):
            state.keep(*app.starts(state, rng))
        bring(state, belongings, rng)
        state.keep(replace(state.of(Phone), expected=state.of(Directory).timeline(arrivals, rng)))
        state.changes = schedule(changes)
        state.lookout, state.driven_s = lookout, driven_s
        state.picked = {
            key: part
            for picked in (*(app.picked for app in apps().values()), *(data.parts() for data in state.apps))
            for key, part in picked.items()
        }
        state.size = size
        state.make = make
        self._display = Display(1.0 if width is None else width / size.width)
        take_seats(self.signals, aboard)
        for path, value in (signals or {}).items():
            self._set_up(path, value)
        state.settle()
        state.vehicle.lacks = tuple(lacks)
        self._tree: Screen | None = None
        for path, value in (sensors or {}).items():
            self.inject(path, value)

    def copy(self) -> "Cockpit":
        twin = Cockpit.__new__(Cockpit)
        twin._state = self._state.copy()
        twin._tree = self._tree
        twin._display = copy(self._display)
        return twin

    def fit(self, size: ScreenSize, make: Make | None = None) -> None:
        """Takes a display of this size, and of a make if one is given, unless it has that already."""
        if size is not self._state.size:
            self._state.size, self._tree = size, None
            self._display = Display(1.0)
        if make is not None and make is not self._state.make:
            self._state.make, self._tree = make, None

    # --- the world ----------------------------------------------------------------------------------------

    def sense(self, surroundings: Surroundings, dt_s: float) -> None:
        """Lets ``dt_s`` seconds pass; the surroundings are those at their end."""
        sense(self._state, surroundings, dt_s)
        self._hold_injected()
        self._tree = None

    def freshened(
        self, departed: "Cockpit", surroundings: Surroundings, way: timedelta, *, with_air: bool
    ) -> "Cockpit":
        """A copy as if it had just departed here, for the arguments of ``fresh.put_back``."""
        twin = self.copy()
        put_back(twin._state, departed._state, surroundings, way, with_air=with_air)
        twin._hold_injected()
        twin._tree = None
        return twin

    def _hold_injected(self) -> None:
        for path, value in self._state.injected.items():
            self.signals[named(path)] = value

    def expect(self, interruptions: Sequence[Arrival | CarChange]) -> None:
        """Lets calls, messages and changes of the car come, at seconds from now; answers, from what they answer.

        Raises:
            UserError: one is impossible, or an arrival names nobody.
        """
        since_s = self._state.time_s - self._state.departed_s
        coming = [
            each if isinstance(each, Arrival) and each.after else replace(each, at_s=since_s + each.at_s)
            for each in interruptions
        ]
        arrivals = tuple(each for each in coming if isinstance(each, Arrival))
        if any(not arrival.who or (arrival.kind == "message" and not arrival.text) for arrival in arrivals):
            raise UserError("an interruption has no caller or no text; give both, they are not drawn here")
        phone = self._state.of(Phone)
        arrivals = self._state.of(Directory).timeline(arrivals, np.random.default_rng(0))
        changes = schedule(each for each in coming if isinstance(each, CarChange))
        self._state.keep(replace(phone, expected=phone.expected + arrivals))
        self._state.changes += changes

    def inject(self, path: str, value: Any) -> None:
        """Sets a signal directly, bypassing switches and physics, for tests and studies.

        An actuator can be commanded again afterwards; a sensor keeps the value.

        Raises:
            UnknownNameError: no such signal.
            SignalError: the value is illegal.
        """
        signal = named(path)
        self.signals[signal] = value
        if signal.kind is not LeafKind.ACTUATOR:
            self._state.injected = {**self._state.injected, path: self.signals[signal]}
        self._tree = None

    @property
    def is_cut_off(self) -> bool:
        """Whether it was set to have no connection, whatever networks there are."""
        return self._state.injected.get(LINK.ONLINE.path) is False

    def drain_requests(self) -> tuple[RoadRequest, ...]:
        """The requests to the road since the last call."""
        pending, self._state.pending = self._state.pending, ()
        return pending

    def answered(self, request: RoadRequest, answer: Answer) -> None:
        """Takes the road's reply to one of the requests."""
        road.answered(self._state, request, answer)
        road.note_answer(self._state, request, answer)
        self._tree = None

    # --- fingers ------------------------------------------------------------------------------------------

    def tap(self, x: int, y: int) -> Feedback:
        """A short touch at a pixel of the screenshot."""
        logical = self._logical(x, y)
        widget = self._screen.at(*logical)
        if widget is None:
            return Feedback(FeedbackCode.NO_EFFECT, say("nothing at ({x}, {y}) reacts to a tap", x=x, y=y))
        if not widget.usable:
            return self._unusable(widget)
        if isinstance(widget, Slider):
            return self._perform(widget.message_at(logical[0]))
        assert widget.on_tap is not None
        return self._perform(widget.on_tap)

    def double_tap(self, x: int, y: int) -> Feedback:
        """A double tap: zooms into the map; elsewhere, it is two taps."""
        widget = self._screen.at(*self._logical(x, y)) or self._under(x, y, MapView)
        if isinstance(widget, MapView) and widget.on_double_tap is not None:
            return self._perform(widget.on_double_tap)
        first = self.tap(x, y)
        return self.tap(x, y) if first.code is FeedbackCode.OK else first

    def long_press(self, x: int, y: int) -> Feedback:
        """A long press: minus and plus, wherever they are, go several steps at once; nothing else reacts to it."""
        widget = self._screen.at(*self._logical(x, y))
        if widget is not None and not widget.usable:
            return self._unusable(widget)
        if isinstance(widget, Button) and widget.on_hold is not None:
            return self._perform(widget.on_hold)
        return Feedback(FeedbackCode.NO_EFFECT, say("nothing at ({x}, {y}) reacts to a long press", x=x, y=y))

    def swipe(self, x: int, y: int, direction: Direction, distance_px: int | None = None) -> Feedback:
        """Drags the widget under the finger: a slider, a list or the map.

        Args:
            x: where the finger touches, in pixels of the screenshot.
            y: where the finger touches, in pixels of the screenshot.
            distance_px: its length. A slider takes the value where the finger lifts, a list moves by the rows
                passed, the map moves along. Without it: a tenth of the range, a page, over a third of the map.
        """
        far = None if distance_px is None else distance_px / self._scale
        slider = self._under(x, y, Slider)
        if slider is not None and direction in (Direction.LEFT, Direction.RIGHT):
            if not slider.usable:
                return self._unusable(slider)
            way = 1 if direction is Direction.RIGHT else -1
            if far is not None:
                return self._perform(slider.message_at(x / self._scale + way * far))
            tenth = max(1, round((slider.signal.high - slider.signal.low) / slider.signal.step / 10))
            return self._perform(slider.message_by(way * tenth))
        rows = self._under(x, y, Rows)
        if rows is not None:
            return self._scroll(rows, OPPOSITE[direction], far)
        view = self._under(x, y, MapView)
        if view is not None and view.pans:
            return self._pan(view, OPPOSITE[direction], far)
        return Feedback(
            FeedbackCode.NO_EFFECT,
            say("nothing at ({x}, {y}) moves {direction}", x=x, y=y, direction=DIRECTIONS[direction]),
        )

    def scroll(self, key: str, direction: Direction) -> Feedback:
        """Scrolls a list by a page; ``down`` reveals what is below.

        Args:
            key: of the list or of something in it; empty for the first list on the screen.
        """
        lists = [widget for widget in self._screen.walk() if isinstance(widget, Rows)]
        if key:
            if all(widget.key != key for widget in self._screen.walk()):
                return Feedback(FeedbackCode.NO_SUCH_ELEMENT, say("{name} is not on the screen", name=key))
            view = next((w for w in self._screen.walk() if w.key == key and isinstance(w, MapView)), None)
            if view is not None and view.pans:
                return self._pan(view, direction)
            lists = [rows for rows in lists if any(widget.key == key for widget in rows.walk())]
        if not lists:
            return Feedback(FeedbackCode.NO_EFFECT, say("there is nothing to scroll here"))
        return self._scroll(lists[0], direction)

    def type_text(self, text: str, clear: bool = False) -> Feedback:
        """Enters text into the focused field at once and closes the keyboard."""
        field = next((widget for widget in self._screen.walk() if isinstance(widget, Field)), None)
        if field is None or not field.focused:
            return self._nowhere_to_type(field)
        if field.locked:
            return self._unusable(field)
        kept = "" if clear else field.text
        write(self._state, field.key, kept + text)
        self._state.keyboard = False
        self._tree = None
        return Feedback(FeedbackCode.OK, say("the field reads {text}", text=repr(self._state.typed[field.key])))

    def key_enter(self) -> Feedback:
        """Presses enter in the focused field, which usually selects the first result."""
        if Restriction.NO_KEYBOARD in self._state.restrictions:
            return Feedback(FeedbackCode.RESTRICTED, REASONS[Restriction.NO_KEYBOARD])
        field = next((widget for widget in self._screen.walk() if isinstance(widget, Field)), None)
        if field is None or not field.focused:
            return self._nowhere_to_type(field)
        if field.on_enter is None:
            return Feedback(FeedbackCode.REFUSED, say("nothing matches {text}", text=repr(field.text)))
        self._state.focus = ""
        return self._perform(field.on_enter)

    def _nowhere_to_type(self, field: Field | None) -> Feedback:
        """Why nothing can be typed, and what to do where something can."""
        if field is not None:
            why = say("no text field has the focus; tap one first")
        elif any(isinstance(widget.on_tap, Key) for widget in self._screen.walk()):
            why = say("there is no text field here; press the keys on the screen one by one")
        else:
            why = say("there is no text field here")
        return Feedback(FeedbackCode.NO_SUCH_ELEMENT, why)

    def home(self) -> Feedback:
        return self.open_app("home")

    def back(self) -> Feedback:
        return self._perform(Back())

    def open_app(self, name: str) -> Feedback:
        wanted, make = " ".join(name.casefold().split()), self._state.make
        if make is not HOME:
            known = opens(make)
            if wanted in known:
                return self._perform(Show(known[wanted]))
            missing, offered = repr(name[:40]), ", ".join(dict.fromkeys(known.values()))
            words = say("no app is named {name}; choose from {apps}", name=missing, apps=offered)
            return Feedback(FeedbackCode.NO_SUCH_ELEMENT, words)
        if wanted not in by_any_name():
            page_of = docked().get(wanted)
            if page_of is not None:
                return Feedback(
                    FeedbackCode.NO_SUCH_ELEMENT,
                    say("{name} is not an app; it is a page of {app}", name=wanted, app=page_of),
                )
            close = get_close_matches(wanted, apps(), n=1)
            missing = repr(name[:40])
            return Feedback(
                FeedbackCode.NO_SUCH_ELEMENT,
                say("no app is named {name}: did you mean {other}?", name=missing, other=repr(close[0]))
                if close
                else say("no app is named {name}; choose from {apps}", name=missing, apps=", ".join(apps())),
            )
        app, part = by_any_name()[wanted]
        if apps()[app].where is Where.STORE and app not in self._state.of(Installed).apps:
            return Feedback(FeedbackCode.REFUSED, say("{app} is not installed; the store has it", app=app))
        return self._perform(Show(app, part))

    def visit(self, screen: str) -> Feedback:
        """Shows any screen by its name directly, for pictures and studies.

        Raises:
            UnknownNameError: no such screen.
        """
        known = {*pages(), *self._state.make.screens}
        if screen not in known:
            raise UnknownNameError("screen", screen, known)
        return self._perform(Show(screen))

    # --- safety calls, the same as the safety centre's buttons ----------------------------------------------

    def alert(self, alert: Alert) -> Feedback:
        return self._perform(WarnDriver(alert))

    def hazards(self, on: bool) -> Feedback:
        """Switches the hazard lights."""
        return self.command(LIGHTS.HAZARD, on)

    def emergency_call(self) -> Feedback:
        return self._perform(CALL_EMERGENCY)

    def ask_driver(self, text: str) -> Feedback:
        """Asks the driver something; what he answers is not the cockpit's."""
        return self._perform(AskDriver(text))

    def ask_road(self, request: SlowDown | PullOver | Reroute) -> Feedback:
        """Makes a request to the driver or the router; a destination may be a place that the driver has saved."""
        if isinstance(request, Reroute) and request.destination:
            known = self._state.of(Gazetteer).find(request.destination)
            request = request if known is None else replace(request, destination=known.edge_id)
            try:
                if lon_lat(request.destination) is None and not self._state.roads.knows(request.destination):
                    return Feedback(FeedbackCode.REFUSED, say("No street or place with this name"))
            except ValueError as error:
                return Feedback(FeedbackCode.REFUSED, str(error))
        return self._perform(Ask(request))

    # --- what was commanded --------------------------------------------------------------------------------

    @property
    def given(self) -> tuple[CommandRecord, ...]:
        """Every command that was carried out, in order, through screens or safety calls."""
        return self._state.given

    def command(self, signal: Signal[Any], value: Any) -> Feedback:
        """Commands an actuator as its switch does."""
        return self._perform(Set(signal, value))

    def call(self, name: str, arguments: Mapping[str, Any]) -> Feedback:
        """Calls a function of the car, with checked arguments (``calls.function_named(name).read``)."""
        self._tree = None
        return calls.call(self._state, name, arguments)

    def repeat(self, record: CommandRecord, keys: Collection[str]) -> None:
        """Gives once more a command that was given at another cockpit, as far as it aims at these keys of
        ``commands``; the road replies as it did."""
        road.repeat(self._state, record, frozenset(keys))
        self._tree = None

    def give(self, record: CommandRecord) -> None:
        """Gives a recorded command once more, in full; what it asks of the road waits for ``drain_requests``."""
        record.command.repeat(self._state, record, record.aims)
        self._tree = None

    # --- its visible state -----------------------------------------------------------------------------

    @property
    def screen(self) -> str:
        """Name of the present screen."""
        return self._state.screen

    @property
    def size(self) -> ScreenSize:
        return self._state.size

    @property
    def signals(self) -> Signals:
        return self._state.signals

    @property
    def state(self) -> State:
        """What the screens are built from, to be read only."""
        return self._state

    @property
    def tree(self) -> Screen:
        """The widgets on the display."""
        return self._screen

    def elements(self) -> tuple[Element, ...]:
        return self._display.elements(self._screen)

    def drawn(self) -> tuple[Element, ...]:
        """The same list with only the texts that the picture shows, for a reference that works by pixels."""
        return accessibility.drawn(self._screen, self._scale)

    def screenshot(self) -> npt.NDArray[np.uint8]:
        """The display, (height, width, 3), RGB, read-only; the same array as long as nothing changes."""
        return self._display.screenshot(self._screen)

    def touched(self, x: int, y: int) -> Widget | None:
        """The widget that a tap at a pixel of the screenshot would reach."""
        return self._screen.at(*self._logical(x, y))

    @property
    def content(self) -> dict[str, tuple[str, ...]]:
        """Names of this cockpit's content by kind, as ``content.content`` lists them."""
        return content(self._state)

    def spoken(self, feedback: Feedback) -> Feedback:
        """An answer in the language of the screens."""
        return language.answered(feedback, self.signals[HMI.LANGUAGE], self._state.make)

    def commands(self) -> dict[str, Any]:
        """Everything that can be commanded: actuators by path, app data, and what was sent."""
        return self._state.commands()

    def vehicle_state(self) -> VehicleState:
        """The readings of the car's sensors and switches."""
        return readings(self._state)

    @property
    def sights(self) -> tuple[Sight, ...]:
        """What the car notices now; empty without a lookout."""
        return sights(self._state)

    # --- inside -------------------------------------------------------------------------------------------

    @property
    def _screen(self) -> Screen:
        if self._tree is None:
            self._tree = picture(self._state)
        return self._tree

    @property
    def _scale(self) -> float:
        return self._display.scale

    def _logical(self, x: int, y: int) -> tuple[float, float]:
        return x / self._scale, y / self._scale

    def _perform(self, message: Message) -> Feedback:
        self._tree = None
        return self._state.perform(message)

    def _unusable(self, widget: Widget) -> Feedback:
        if widget.locked:
            return Feedback(FeedbackCode.RESTRICTED, widget.locked)
        return Feedback(FeedbackCode.DISABLED, widget.disabled)

    def _scroll(self, rows: Rows, direction: Direction, far: float | None = None) -> Feedback:
        """Scrolls by a page, or by the rows in a number of logical pixels."""
        by = max(1, rows.shown - 1 if far is None else round(far * rows.shown / rows.rect.height))
        step = by * {Direction.DOWN: 1, Direction.UP: -1}.get(direction, 0)
        first = min(rows.last_first, max(0, rows.first + step))
        if first == rows.first:
            return Feedback(
                FeedbackCode.NO_EFFECT,
                say(
                    "{list} cannot move further {direction}", list=rows.description, direction=DIRECTIONS[direction]
                ),
            )
        self._state.scrolled = {**self._state.scrolled, rows.key: first}
        self._tree = None
        return Feedback(
            FeedbackCode.OK,
            say(
                "{list} shows rows {first} to {last} of {total}",
                list=rows.description,
                first=first + 1,
                last=first + rows.shown,
                total=rows.total,
            ),
        )

    def _pan(self, view: MapView, direction: Direction, far: float | None = None) -> Feedback:
        """Pans by a number of logical pixels, or by over a third of the visible map."""
        across = {Direction.RIGHT: 1, Direction.LEFT: -1}.get(direction, 0)
        down = {Direction.DOWN: 1, Direction.UP: -1}.get(direction, 0)
        wide, high = (PAN_SHARE * view.rect.width, PAN_SHARE * view.rect.height) if far is None else (far, far)
        return self._perform(Pan(across * wide, down * high))

    def _under(self, x: int, y: int, kind: type[W]) -> W | None:
        """The uppermost widget of a kind under a pixel."""
        logical = self._logical(x, y)
        found = [w for w in self._screen.walk() if isinstance(w, kind) and w.rect.contains(*logical)]
        return found[-1] if found else None

    def _set_up(self, path: str, value: Any) -> None:
        signal = named(path)
        if signal.kind is not LeafKind.ACTUATOR:
            self.signals[signal] = value
            return
        refusal = self._state.vehicle.command(signal, value)
        if refusal:
            raise SignalError(f"{path} can't start as {value!r}: {refusal}")
