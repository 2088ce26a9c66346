"""The co-simulation: one car, its road, its place on earth and its cockpit, stepped together.

perform:  action -> cockpit -> requests -> road -> answers -> cockpit
advance:  road -> receiver and sky -> cockpit -> place and law, once every simulated second
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from datetime import datetime

import numpy as np
import numpy.typing as npt

from automotive_cosim.cockpit import actions
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.signals import GLASS, LIGHTS, MOTION
from automotive_cosim.cockpit.state import CommandRecord
from automotive_cosim.contracts import Action, Aware, Element, Feedback, RoadSnapshot
from automotive_cosim.contracts.errand import Errand
from automotive_cosim.cosim.attention import Asked, Attention
from automotive_cosim.cosim.car import Car
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.geo.connectivity import Modem
from automotive_cosim.geo.gps import Gps
from automotive_cosim.geo.locate import Geo
from automotive_cosim.geo.signs import signs_of
from automotive_cosim.geo.sun import sun_at
from automotive_cosim.scenarios import LinkAt, Scenario, WeatherAt
from automotive_cosim.traffic.base import Traffic
from automotive_cosim.traffic.shadow import SharedTraffic
from automotive_cosim.view.paint import picture
from automotive_cosim.view.scene import Outside, OwnCar, sight_of

TICK_S = 1.0
"""Update interval of the cockpit, the receiver and the place; the road runs at SUMO's own step."""


@dataclass(slots=True)
class CoSimulation:
    """Owns its parts: closing it ends its traffic. ``moment`` is the newest state."""

    traffic: SharedTraffic
    car: Car
    moment: Moment
    on_look: Callable[[RoadSnapshot], None] | None = None
    """Is shown the road after each tick; copies have none. The traffic is not asked unless there is one."""

    @property
    def cockpit(self) -> Cockpit:
        """The car's cockpit."""
        return self.car.cockpit

    def perform(self, action: Action, elements: Sequence[Element]) -> Feedback:
        """Performs an action now and passes on its requests to the road; no time passes."""
        feedback = actions.perform(action, self.cockpit, elements)
        for request in self.cockpit.drain_requests():
            self.cockpit.answered(request, self.traffic.request(request))
        if self.car.attention is not None and (look_s := self.car.attention.new_text_s(self.cockpit.state)):
            self.ask(Asked(self.moment.time_s, look_s))
        return self.cockpit.spoken(feedback)

    def ask(self, what: Asked) -> None:
        """What was done asks something of the driver."""
        if self.car.attention is not None:
            self.car.attention.ask(what)
            self._attend()

    def _attend(self) -> None:
        """Tells the road how much of the driver's attention it has from now on."""
        attention = self.car.attention
        if attention is None:
            return
        attention.think(self.cockpit.state)
        if attention.awareness != attention.told and self.traffic.state.end is None:
            attention.told = attention.awareness
            self.traffic.request(Aware(attention.told))

    def give(self, record: CommandRecord) -> None:
        """Gives a recorded command once more, whatever is on the screen; the road answers anew. What it asked of
        the driver is recorded by itself (``Attention.asked``)."""
        self.cockpit.give(record)
        for request in self.cockpit.drain_requests():
            self.cockpit.answered(request, self.traffic.request(request))
        if self.car.attention is not None:
            self.car.attention.new_text_s(self.cockpit.state)

    def advance(self, duration_s: float) -> tuple[Moment, ...]:
        """Lets time pass, in ticks; less than requested if the ego's drive ends.

        Raises TrafficError: the traffic simulation failed."""
        moments = []
        left_s = duration_s
        while left_s > 1e-9 and self.moment.driving.end is None:
            tick_s = min(TICK_S, left_s)
            drive = self.traffic.advance(tick_s)
            if self.on_look is not None:
                self.on_look(self.traffic.look())
            self.moment = self.car.sense(self.traffic, drive.states, drive.events, tick_s)
            self._attend()
            moments.append(self.moment)
            left_s -= tick_s
        return tuple(moments)

    def view(self) -> npt.NDArray[np.uint8]:
        """The view through the windshield now, or behind the car in reverse: (360, 640, 3), RGB, read-only.

        Raises TrafficError: the traffic simulation failed."""
        moment, signals = self.moment, self.cockpit.signals
        driving = moment.driving
        sun = None
        if driving.lon_deg is not None and driving.lat_deg is not None:
            sun = sun_at(driving.lon_deg, driving.lat_deg, moment.local_time)
        unit, country = (self.car.read_sign or (None, "km/h", ""))[1:]
        outside = Outside(
            moment.weather,
            None if sun is None else sun.elevation_deg,
            None if sun is None else sun.azimuth_deg,
            driving.road.in_tunnel,
            bool(driving.road.lit),
            country,
            unit,
        )
        car = OwnCar(
            bool(signals[LIGHTS.LOW_BEAM]),
            bool(signals[LIGHTS.HIGH_BEAM]),
            float(signals[GLASS.WINDSHIELD_FOG]),
            float(signals[GLASS.WINDSHIELD_FILM]),
            reverse=signals[MOTION.GEAR] == "R",
        )
        sight = sight_of(self.traffic.shapes(), self.traffic.network, self.car.signs)
        return picture(sight.scene(self.traffic.look(), driving, outside, car))

    def freshened(self, departed: Cockpit, *, with_air: bool) -> CoSimulation:
        """This drive with the car as if it had just departed here (``Car.freshened``); the road is the same one."""
        car, moment = self.car.freshened(departed, self.moment, with_air=with_air)
        return replace(self, car=car, moment=moment)

    def branch(self) -> CoSimulation:
        """An exact copy that is independent from this instant."""
        return CoSimulation(self.traffic.branch(), self.car.copy(), self.moment)

    def shadow(self) -> CoSimulation:
        """An exact copy with nobody at its cockpit, to be driven along with this one.

        It gets a simulation of its own only when a request is made to this road. Close it first."""
        return CoSimulation(self.traffic.shadow(), self.car.copy(), self.moment)

    def close(self) -> None:
        """Ends the drive; may be called again."""
        self.traffic.close()


def couple(
    traffic: Traffic,
    cockpit: Cockpit,
    scenario: Scenario,
    *,
    gps_rng: np.random.Generator,
    gps_is_steady: bool = False,
    weather: tuple[WeatherAt, ...],
    departure: datetime,
    links: tuple[LinkAt, ...] = (),
    errands: tuple[Errand, ...] = (),
    trailer: bool = False,
    attention: bool = False,
) -> CoSimulation:
    """Couples a drive and a cockpit that has not looked outside yet.

    Args:
        scenario: the scenario; without a place on earth, the car has no receiver.
        gps_is_steady: whether it shows a car that stands in one place.
        weather: the timeline, in seconds after departure.
        departure: local time of the traffic's present state, zone-aware.
        links: the best available link over time, in seconds after departure.
        errands: what people aboard ask for, in seconds after departure.
        trailer: whether the car tows one.
        attention: whether the driver's can be taken, as the plan of the drive says (``EgoPlan.attention``)."""
    state, geo = traffic.state, Geo()
    car = Car(
        cockpit,
        Gps(gps_rng, is_steady=gps_is_steady) if scenario.has_place else None,
        Modem(links),
        geo,
        weather,
        departure,
        state.time_s,
        None if scenario.origin is None else signs_of(geo.atlas.place(*scenario.origin).law),
        errands=tuple(replace(errand, at_s=state.time_s + errand.at_s) for errand in errands),
        trailer=trailer,
        attention=Attention() if attention else None,
    )
    shared = SharedTraffic(traffic, scenario.sumo.step_length_s)
    return CoSimulation(shared, car, car.sense(shared, (state,), (), 0.0))
