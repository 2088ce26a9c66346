"""The cockpit: the effects of touches and of time on the car and its screen.

    cockpit.sense(surroundings, dt_s)      surroundings -> signals, air, glass, battery
    cockpit.tap(x, y) ...                  a finger -> a widget's message -> signals, app data, requests to the road
    cockpit.drain_requests()               its requests to the road; answered() takes the reply
    cockpit.screenshot(), elements()       the same widget tree, drawn and listed

Every action answers with a ``Feedback`` and never raises; a wrong one changes nothing. Everything is
determined by the calls: time comes only from ``sense``.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from datetime import timedelta
from typing import Any

import numpy as np

from automotive_cosim.cockpit import calls, language, road
from automotive_cosim.cockpit.apps.map.lookout import sights
from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.apps.phone.commands import CALL_EMERGENCY
from automotive_cosim.cockpit.apps.phone.state import Directory, Phone
from automotive_cosim.cockpit.apps.safety.commands import WarnDriver
from automotive_cosim.cockpit.belongings import NOTHING, Belongings, bring
from automotive_cosim.cockpit.cabin import CabinStart
from automotive_cosim.cockpit.changes import CarChange, schedule
from automotive_cosim.cockpit.commands import AskDriver, Set
from automotive_cosim.cockpit.display import Display
from automotive_cosim.cockpit.make import HOME, Make
from automotive_cosim.cockpit.map import road_map
from automotive_cosim.cockpit.missing_parts import Lacking
from automotive_cosim.cockpit.occupants import Occupant, take_seats
from automotive_cosim.cockpit.pois import Gazetteer
from automotive_cosim.cockpit.registry import apps
from automotive_cosim.cockpit.road import Ask
from automotive_cosim.cockpit.sensing import put_back, readings, sense
from automotive_cosim.cockpit.signals import HMI, LIGHTS, LINK, LeafKind, Signal, Signals, named
from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.cockpit.state import CommandRecord, State
from automotive_cosim.cockpit.touchscreen import Touchscreen
from automotive_cosim.cockpit.vehicle import Vehicle
from automotive_cosim.cockpit.widgets import Screen
from automotive_cosim.contracts import (
    Alert,
    Answer,
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
from automotive_cosim.contracts.text import say
from automotive_cosim.errors import SignalError, UserError


class Cockpit(Touchscreen):
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
            UserError: an arrival, a change or an occupant is impossible."""
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

    def copy(self) -> Cockpit:
        twin = Cockpit.__new__(Cockpit)
        twin._state = self._state.copy()
        twin._tree = self._tree
        twin._display = Display(self._display.scale)  # most copies are never looked at, and a picture takes 6 MB
        return twin

    # --- the world ----------------------------------------------------------------------------------------

    def sense(self, surroundings: Surroundings, dt_s: float) -> None:
        """Lets ``dt_s`` seconds pass; the surroundings are those at their end."""
        sense(self._state, surroundings, dt_s)
        self._hold_injected()
        self._tree = None

    def freshened(
        self, departed: Cockpit, surroundings: Surroundings, way: timedelta, *, with_air: bool
    ) -> Cockpit:
        """A copy as if it had just departed here, for the arguments of ``sensing.put_back``."""
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

        Raises UserError: one is impossible, or an arrival names nobody."""
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
            SignalError: the value is illegal."""
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
    def signals(self) -> Signals:
        return self._state.signals

    @property
    def state(self) -> State:
        """What the screens are built from, to be read only."""
        return self._state

    @property
    def content(self) -> dict[str, tuple[str, ...]]:
        """Names by kind, for tasks that draw one of them.

        ``contacts`` (those that the list shows even while driving), ``favourite_contacts``, ``threads`` and
        ``unread`` (senders of messages, and of unread ones), ``places``, ``favourite_places``, ``streets`` (neither
        among these nor hidden behind another in a search), ``playlists``, ``tracks``, ``podcasts``, ``fm``, ``dab``
        (stations)."""
        return {kind: names for data in self._state.apps for kind, names in data.names(self._state).items()}

    def spoken(self, feedback: Feedback) -> Feedback:
        """An answer in the language of the screens."""
        return language.answered(feedback, self.signals[HMI.LANGUAGE], self._state.make)

    def commands(self) -> Mapping[str, Any]:
        """Everything that can be commanded: actuators by path, app data, and what was sent; the same object as long
        as nothing is."""
        return self._state.commands()

    def vehicle_state(self) -> VehicleState:
        """The readings of the car's sensors and switches."""
        return readings(self._state)

    @property
    def sights(self) -> tuple[Sight, ...]:
        """What the car notices now; empty without a lookout."""
        return sights(self._state)

    # --- inside -------------------------------------------------------------------------------------------

    def _set_up(self, path: str, value: Any) -> None:
        signal = named(path)
        if signal.kind is not LeafKind.ACTUATOR:
            self.signals[signal] = value
            return
        refusal = self._state.vehicle.command(signal, value)
        if refusal:
            raise SignalError(f"{path} can't start as {value!r}: {refusal}")
