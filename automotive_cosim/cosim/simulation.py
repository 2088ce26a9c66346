"""The co-simulation: one car, its road, its place on earth and its cockpit, stepped together.

perform:  action -> cockpit -> requests -> road -> answers -> cockpit
advance:  road -> receiver and sky -> cockpit -> place and law, once every simulated second
"""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime, timedelta

from automotive_cosim.cockpit import actions
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import (
    Action,
    DrivingState,
    Element,
    Feedback,
    RouteOption,
    Surroundings,
)
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.geo.connectivity import Modem
from automotive_cosim.geo.gps import Gps
from automotive_cosim.geo.locate import Geo
from automotive_cosim.geo.sun import elevation_deg
from automotive_cosim.scenarios import LinkAt, WeatherAt, weather_at
from automotive_cosim.traffic.base import Event, Traffic

WAYS_FROM_S = 10.0
WAYS_EVERY_S = 60.0
"""So long after departure, and so often while online, the navigation asks for other ways to the goal."""

TICK_S = 1.0
"""The cockpit, the receiver and the place are updated this often; the road runs on SUMO's own step."""


class CoSimulation:
    """Owns its parts: closing it ends its traffic. ``moment`` is the newest state."""

    def __init__(
        self,
        traffic: Traffic,
        cockpit: Cockpit,
        gps: Gps | None,
        geo: Geo,
        weather: tuple[WeatherAt, ...],
        departure: datetime,
        links: tuple[LinkAt, ...] = (),
    ) -> None:
        """Couples parts that are ready to run.

        Args:
            traffic: the ego's drive at its first instant.
            cockpit: not yet sensed.
            gps: the receiver; None if the car has none, so that no place is known.
            geo: law, sky and place.
            weather: the timeline, in seconds after departure.
            departure: local time of the traffic's present state, zone-aware.
            links: the best link to the outside there is, in seconds after departure.
        """
        self.traffic = traffic
        self.cockpit = cockpit
        self._gps = gps
        self._modem = Modem(links)
        self._geo = geo
        self._weather = weather
        self._departure = departure
        self._departure_s = traffic.state.time_s
        self._ways: tuple[RouteOption, ...] = ()
        self._ways_due_s = self._departure_s + WAYS_FROM_S
        self.moment = self._sense(traffic.state, (traffic.state,), (), 0.0)

    def perform(self, action: Action, elements: tuple[Element, ...]) -> Feedback:
        """Carries out an action now and passes on what it asks of the road; no time passes."""
        feedback = actions.perform(action, self.cockpit, elements)
        for request in self.cockpit.drain_requests():
            self.cockpit.answered(request, self.traffic.request(request))
        return self.cockpit.spoken(feedback)

    def advance(self, duration_s: float) -> tuple[Moment, ...]:
        """Lets time pass, in ticks; shorter than asked if the ego's drive ends.

        Raises:
            TrafficError: the road side failed.
        """
        moments = []
        left_s = duration_s
        while left_s > 1e-9 and self.moment.driving.end is None:
            tick_s = min(TICK_S, left_s)
            drive = self.traffic.advance(tick_s)
            self.moment = self._sense(self.traffic.state, drive.states, drive.events, tick_s)
            moments.append(self.moment)
            left_s -= tick_s
        return tuple(moments)

    def branch(self) -> CoSimulation:
        """An exact copy that goes its own way from this instant."""
        twin = object.__new__(CoSimulation)
        twin.traffic = self.traffic.branch()
        twin.cockpit = self.cockpit.copy()
        twin._gps = None if self._gps is None else self._gps.copy()
        twin._modem = self._modem.copy()
        twin._geo = self._geo
        twin._weather = self._weather
        twin._departure = self._departure
        twin._departure_s = self._departure_s
        twin._ways = self._ways
        twin._ways_due_s = self._ways_due_s
        twin.moment = self.moment
        return twin

    def close(self) -> None:
        """Ends the drive; harmless when called again."""
        self.traffic.close()

    def _navigated(self, driving: DrivingState, *, online: bool) -> DrivingState:
        """The state with the other ways to the goal that still begin here, as of the last minute."""
        if online and driving.end is None and driving.time_s >= self._ways_due_s:
            self._ways_due_s = driving.time_s + WAYS_EVERY_S
            self._ways = self.traffic.alternatives()[1:]
        if not self._ways:
            return driving
        route = driving.ahead.route_edges
        still = tuple(
            replace(way, edges=way.edges[way.edges.index(route[0]) :])
            for way in self._ways
            if route and route[0] in way.edges
        )
        others = tuple(way for way in still if way.edges != route)
        return replace(driving, ahead=replace(driving.ahead, alternatives=others))

    def _sense(
        self, driving: DrivingState, passed: tuple[DrivingState, ...], events: tuple[Event, ...], dt_s: float
    ) -> Moment:
        elapsed_s = driving.time_s - self._departure_s
        local_time = (self._departure.astimezone(UTC) + timedelta(seconds=elapsed_s)).astimezone(
            self._departure.tzinfo
        )
        weather = weather_at(self._weather, elapsed_s)
        gps = None if self._gps is None else self._gps.read(driving, dt_s)
        connectivity = self._modem.read(driving, dt_s, round(elapsed_s, 6))
        driving = self._navigated(driving, online=connectivity.online)
        sun = (
            None
            if driving.lat_deg is None or driving.lon_deg is None
            else elevation_deg(driving.lat_deg, driving.lon_deg, local_time)
        )
        self.cockpit.sense(Surroundings(driving, weather, local_time, sun, gps, connectivity), dt_s)
        return Moment(
            time_s=driving.time_s,
            local_time=local_time,
            driving=driving,
            passed=passed,
            events=events,
            weather=weather,
            gps=gps,
            connectivity=connectivity,
            context=self._geo.locate(driving, gps, weather, local_time),
            signals=self.cockpit.signals.snapshot(),
            commands=self.cockpit.commands(),
        )
