"""The car at one place and time: its cockpit, receivers and navigation, updated from the road."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from datetime import UTC, datetime, timedelta
from functools import lru_cache

from automotive_cosim.cockpit.changes import CarChange
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.notices import NOTICED
from automotive_cosim.cockpit.occupants import SIGNALS, seated
from automotive_cosim.cockpit.signals import BODY, CALL, GLASS, HVAC, LIGHTS, Signals
from automotive_cosim.contracts import DrivingState, Limit, RouteOption
from automotive_cosim.contracts.errand import Errand, ErrandKind
from automotive_cosim.cosim.attention import Attention
from automotive_cosim.cosim.moment import Moment, around
from automotive_cosim.geo.connectivity import OFFLINE, Modem
from automotive_cosim.geo.gps import Gps
from automotive_cosim.geo.locate import Geo
from automotive_cosim.geo.signs import LocalSigns
from automotive_cosim.scenarios import WeatherAt, weather_at
from automotive_cosim.traffic.base import Event, Traffic
from automotive_cosim.traffic.ego import BUCKLES, CLEARS_VIEW, PARKS, SETS_OFF, WAKES_UP
from automotive_cosim.traffic.records import with_ahead, with_alternatives

SEEN = NOTICED / 4
"""Share of the glass that is wet or fogged from which a driver who is told of it does something about it."""


def handled(reaction: str, signals: Signals) -> Iterator[CarChange]:
    """What is turned, opened or shut now.

    Args:
        reaction: kind of the driver's reaction on the road (``traffic.base.Event``)."""
    if reaction == WAKES_UP and signals[CALL.PHONE] == "HAND":
        yield CarChange(0.0, CALL.PHONE.path, "AWAY")
    elif reaction == CLEARS_VIEW:
        if signals[BODY.FRONT_WIPER] == "OFF" and signals[GLASS.WINDSHIELD_FILM] >= SEEN:
            yield CarChange(0.0, BODY.FRONT_WIPER.path, "RAIN_SENSOR")
        if signals[GLASS.WINDSHIELD_FOG] >= SEEN:
            yield CarChange(0.0, HVAC.FRONT_DEFROSTER.path, True)
        if signals[LIGHTS.SWITCH] == "OFF":
            yield CarChange(0.0, LIGHTS.SWITCH.path, "AUTO")
    elif reaction == BUCKLES:
        for one in seated(signals):
            if not one.belted:
                yield CarChange(0.0, SIGNALS[one.seat].belted.path, True)


ALTERNATIVES_FROM_S = 10.0
ALTERNATIVES_EVERY_S = 60.0
"""Delay after departure, and interval while online, at which the navigation looks for alternative routes."""


@dataclass(slots=True)
class Car:
    """Everything about the ego except its motion. ``departure_s`` is the simulation time at ``departure``."""

    cockpit: Cockpit
    gps: Gps | None
    """The receiver; None if the car has none, so the place is unknown."""
    modem: Modem
    geo: Geo
    weather: tuple[WeatherAt, ...]
    """Times in seconds after departure."""
    departure: datetime
    """Local time, zone-aware."""
    departure_s: float
    signs: LocalSigns | None = None
    """How limits are signed where a network was moved to; None reads them as the network has them."""
    alternatives: tuple[RouteOption, ...] = ()
    alternatives_asked_s: float | None = None
    """Simulation time at which the navigation last looked for them."""
    is_parked: bool = False
    """Whether the driver has parked on the way."""
    errands: tuple[Errand, ...] = ()
    """What people aboard ask for, by simulation time."""
    trailer: bool = False
    """Whether it tows one, for the law: it drives as without."""
    attention: Attention | None = None
    """The driver's; None if nothing can take it."""
    read_sign: tuple[Limit, str, str] | None = None
    """The limit that is signed here, and the unit and the country of its sign; None before departure."""

    def copy(self) -> Car:
        """An independent copy that continues exactly as this one would."""
        gps = None if self.gps is None else self.gps.copy()
        attention = None if self.attention is None else self.attention.copy()
        return replace(self, cockpit=self.cockpit.copy(), gps=gps, modem=self.modem.copy(), attention=attention)

    def freshened(self, departed: Cockpit, now: Moment, *, with_air: bool) -> tuple[Car, Moment]:
        """The same car at the same spot as if it had just departed there, at its departure's time of day. The road
        keeps its own: what is posted for certain hours goes by that.

        Args:
            with_air: whether air, glass, seats and tyres are put back too.

        Returns:
            The car, and the moment as that car has it."""
        way = timedelta(seconds=now.time_s - self.departure_s)
        earlier = now.earlier(way)
        cockpit = self.cockpit.freshened(departed, earlier.surroundings, way, with_air=with_air)
        departure = (self.departure.astimezone(UTC) - way).astimezone(self.departure.tzinfo)
        signals, commands = cockpit.signals.snapshot(), cockpit.commands()
        return replace(self, cockpit=cockpit, departure=departure), replace(
            earlier, signals=signals, commands=commands
        )

    def sense(
        self, traffic: Traffic, passed: tuple[DrivingState, ...], events: tuple[Event, ...], dt_s: float
    ) -> Moment:
        """Lets ``dt_s`` seconds pass in the car, and records the moment at their end.

        Args:
            traffic: the drive, at its newest state.
            passed: the states since the previous moment.
            events: what happened on the road meanwhile.
            dt_s: seconds since the previous moment; 0 for the first."""
        driving = traffic.state
        if self.signs is not None:
            driving, passed = self.signs.on(driving), tuple(map(self.signs.on, passed))
        if self.trailer:
            driving, passed = replace(driving, trailer=True), tuple(replace(each, trailer=True) for each in passed)
        elapsed_s = driving.time_s - self.departure_s
        local_time = (self.departure.astimezone(UTC) + timedelta(seconds=elapsed_s)).astimezone(
            self.departure.tzinfo
        )
        weather = weather_at(self.weather, elapsed_s)
        gps = None if self.gps is None else self.gps.read(driving, dt_s)
        connectivity = self.modem.read(driving, dt_s, round(elapsed_s, 6))
        if self.cockpit.is_cut_off:
            connectivity = OFFLINE
        if connectivity.online and driving.end is None and self._is_asking(driving.time_s):
            self.alternatives_asked_s = driving.time_s
            self.alternatives = traffic.alternatives()[1:]
        driving = self._navigated(driving)
        for event in events:
            if event.kind in (PARKS, SETS_OFF):
                self.is_parked = event.kind == PARKS
            if changes := tuple(handled(event.kind, self.cockpit.signals)):
                self.cockpit.expect(changes)
        context = self.geo.locate(driving, gps, weather, local_time)
        if self.read_sign is None or self.read_sign[0] != driving.road.limit:
            # only then: to find the place takes long
            self.read_sign = driving.road.limit, context.speed_unit, context.country
        outside = around(
            driving,
            weather,
            local_time,
            gps,
            connectivity,
            parked=self.is_parked,
            sign_unit=self.read_sign[1],
            sign_country=self.read_sign[2],
        )
        self.cockpit.sense(outside, dt_s)
        if self.attention is not None:
            self.attention.passed(self.cockpit.state, dt_s)
        ringing = str(self.cockpit.signals[CALL.RINGING])
        self.errands = with_cause(self.errands, driving.time_s - dt_s, driving.time_s, ringing)
        return Moment(
            time_s=driving.time_s,
            local_time=local_time,
            driving=driving,
            passed=passed,
            events=events,
            weather=weather,
            gps=gps,
            connectivity=connectivity,
            context=context,
            signals=self.cockpit.signals.snapshot(),
            commands=self.cockpit.commands(),
            sights=self.cockpit.sights,
            awareness=None if self.attention is None else self.attention.told,
            asked=tuple(errand for errand in self.errands if errand.at_s <= driving.time_s + 1e-6),
        )

    def _is_asking(self, now_s: float) -> bool:
        if self.alternatives_asked_s is None:
            return now_s >= self.departure_s + ALTERNATIVES_FROM_S
        return now_s >= self.alternatives_asked_s + ALTERNATIVES_EVERY_S

    def _navigated(self, driving: DrivingState) -> DrivingState:
        """The state with the alternative routes that still begin here."""
        if not self.alternatives:
            return driving
        route = driving.ahead.route_edges
        still = (_rest(way, route[0]) for way in self.alternatives if route and route[0] in way.edges)
        others = tuple(way for way in still if way.edges != route)
        return with_ahead(driving, with_alternatives(driving.ahead, others))


@lru_cache(maxsize=1024)
def _rest(way: RouteOption, edge: str) -> RouteOption:
    """A route from one of its edges on: the same one as long as the car is on it."""
    return way if way.edges[0] == edge else replace(way, edges=way.edges[way.edges.index(edge) :])


def with_cause(errands: Iterable[Errand], since_s: float, now_s: float, ringing: str) -> tuple[Errand, ...]:
    """The errands that are said, or may yet be: nobody speaks of a call that does not ring, as without a network.

    Args:
        errands: all of them, by simulation time.
        since_s: the previous instant.
        ringing: who calls now; empty if nobody does."""

    def is_due(errand: Errand) -> bool:
        return since_s + 1e-6 < errand.at_s <= now_s + 1e-6

    return tuple(
        errand
        for errand in errands
        if errand.kind is not ErrandKind.CALL or errand.about == ringing or not is_due(errand)
    )
