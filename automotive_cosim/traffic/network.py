"""Reads a SUMO network (``.net.xml``, also gzipped), for maps and the driving state.

SUMO knows lanes, speeds and shapes. A road's type may have a limit for cars, which holds instead of the lanes'.
Everything else from the map is in the edges: ``type`` is
``highway.<OSM highway value>``, and ``<param>`` keys are OpenStreetMap's own:

| key | meaning |
|---|---|
| ``maxspeed`` | present: the limit is posted, else it was assumed; ``none``: there is no limit; also of a lane |
| ``maxspeed:assumed`` | ``none``: no limit is posted, and the import assumed that there is none |
| ``tunnel`` | anything except ``no``: in a tunnel |
| ``lit`` | ``yes`` or ``no``: street lighting |
| ``zone:traffic`` | ``XX:urban``, ``XX:rural`` or ``XX:motorway``: built-up or not |
| ``zone:traffic:assumed`` | the same, assumed from the density of the streets |
| ``lane_markings`` | ``no``: no centre line |
| ``maxspeed:conditional`` | limits at certain hours (``posted``) |
| ``access:conditional`` | ``yes`` and ``no``: open to cars at certain hours |
| ``restriction:conditional:EDGE`` | the same of the turn into an edge |
| ``hazard`` | ``school_zone``: beside a school |
| ``bicycle_road``, ``cyclestreet`` | ``yes``: a cycle street |
| ``traffic_sign`` | ``stop`` or ``give_way``: the sign at the end of the edge |
| ``speed_camera`` | positions of cameras, in metres from the start of the edge |

The file is read element by element, several times as fast as by sumolib's reader and without its object per
connection.
"""

from __future__ import annotations

import itertools
import math
import pickle
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import lru_cache
from pathlib import Path
from sys import intern
from typing import Any, NamedTuple, TypeAlias

from automotive_cosim.contracts import KMH_PER_MPS, Limit, LimitSource, Road, RoadNetwork
from automotive_cosim.contracts.roads import Columns, in_columns, of_columns
from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats.xml import read_root, scan, without_collection
from automotive_cosim.traffic import georeference
from automotive_cosim.traffic.naming import local_names
from automotive_cosim.traffic.posted_limits import TimedAccess, TimedLimit, timed_access, timed_limits

NO_LIMIT_FROM_MPS = 39.0
"""A lane at least this fast whose edge says that there is none has no limit: SUMO's OSM import writes 142 km/h."""

DERESTRICTED_MPS = 142 / KMH_PER_MPS
"""SUMO's speed for roads without a limit, as in its own import."""

BUILT_UP = {"urban": True, "rural": False, "motorway": False}
"""Whether a zone in ``zone:traffic`` is built-up."""

CYCLE_STREET_KEYS = ("bicycle_road", "cyclestreet")
"""Keys of cycle streets: the first in Germany and Austria, the second in Belgium and the Netherlands."""

FORM = "a complete SUMO network (build it again with netconvert)"
"""What the file should be, for errors."""

SIGN = "traffic_sign"
TIMED_ACCESS = "access:conditional"
TIMED_TURN = "restriction:conditional:"
"""Before the id of the edge that the turn leads into."""

EDGE_DEPTH, LANE_DEPTH = 1, 2
"""How deep edges and their lanes stand in the file, whose root is at 0."""

SIGNED = "signed"
"""What a lane's attributes have here of a limit of its own."""

NO_LANES: frozenset[str] = frozenset()
"""One object for all edges."""

Shape = tuple[tuple[float, float], ...]
Attributes: TypeAlias = dict[str, str]

LARGEST = 1e9
"""No length or coordinate of a network is beyond it: the earth's circumference is 4e7 m."""


SLOWEST_MPS = 0.01
"""On a slower lane no vehicle arrives."""

CARS = "passenger"
"""SUMO's class of cars."""

FOR_TRAINS = frozenset(("rail_crossing", "rail_signal"))
"""Types of junctions whose lights show that a train comes; nobody else is controlled by them."""


def quantity(text: str, least: float = -LARGEST) -> float:
    """A number of a network.

    Raises ValueError: it is not a number, not finite, below ``least`` or impossibly large."""
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not least <= number <= LARGEST:
        raise ValueError(f"{text[:80]!r} is not a number")
    return number


@dataclass(frozen=True, slots=True)
class Edge:
    """One edge open to cars."""

    edge_id: str
    from_node: str
    to_node: str
    name: str
    road_class: str
    lane_ids: tuple[str, ...]
    """Lanes open to cars, from the kerb."""
    length_m: float
    speed_mps: float
    """The present speed of its fastest lane, even without a limit."""
    lane_mps: tuple[float, ...]
    """Those of all its lanes."""
    limit_mps: float | None
    limit_source: LimitSource
    in_tunnel: bool
    lit: bool | None
    built_up: bool | None
    centre_line: bool | None
    shape_m: Shape
    bus_lane: bool = False
    """Whether another of its lanes is for buses and not for cars."""
    cameras_m: tuple[float, ...] = ()
    """Positions of speed cameras, from its start."""
    sign: str = ""
    """The sign at its end, ``"stop"`` or ``"give_way"``; empty without one."""
    school_zone: bool = False
    timed_limits: tuple[TimedLimit, ...] = ()
    """Limits that are posted for certain hours."""
    signed_lanes: frozenset[str] = NO_LANES
    """Lanes with a limit of their own on a sign."""
    variable_lanes: frozenset[str] = NO_LANES
    """Lanes over which a variable sign shows something now."""
    timed_limit: TimedLimit | None = None
    """The one of them that is in force; ``limit_mps`` is the present limit."""
    timed_access: tuple[TimedAccess, ...] = ()
    """When it is open to cars, if not always (``posted.is_open``)."""
    timed_turns: tuple[tuple[str, tuple[TimedAccess, ...]], ...] = ()
    """The edges into which cars may not always turn, and when they may."""
    cars_mps: float | None = None
    """The limit that its type has for cars."""
    built_up_assumed: bool | None = None
    """What the import assumed where the map does not say: for reports, no verdict rests on it."""

    @property
    def limit(self) -> Limit:
        """The limit, and where it comes from."""
        return Limit(self.limit_mps, self.limit_source)

    @property
    def limit_hours(self) -> str:
        """The limits posted for certain hours, in words."""
        return "; ".join(limit.text for limit in self.timed_limits)


@dataclass(frozen=True, slots=True)
class Crossing:
    """The connection through a junction from one edge to the next. A city has few that differ, and many alike are
    one object."""

    length_m: float
    speed_mps: float
    """Speed of its slowest lane."""
    is_straight: bool = True
    has_signal: bool = False
    lanes: frozenset[tuple[int, int]] = frozenset()
    """The lanes that it leads from and to, for cars, by their numbers."""

    def between(self, here: str, there: str) -> list[tuple[str, str]]:
        """The lanes of two edges that it leads from and to."""
        return [(f"{here}_{from_lane}", f"{there}_{to_lane}") for from_lane, to_lane in self.lanes]


Crossings: TypeAlias = Mapping[str, Mapping[str, Crossing]]
"""From edge, to edge."""


@dataclass(frozen=True, slots=True)
class JunctionLengths(Mapping[tuple[str, str], float]):
    """The length of the way through the junction between two edges, read from the crossings."""

    crossings: Crossings

    def __getitem__(self, pair: tuple[str, str]) -> float:
        here, there = pair
        return self.crossings[here][there].length_m

    def __iter__(self) -> Iterator[tuple[str, str]]:
        return ((here, there) for here, ways in self.crossings.items() for there in ways)

    def __len__(self) -> int:
        return sum(map(len, self.crossings.values()))


@dataclass(frozen=True, slots=True)
class Network:
    """A network, by edge id."""

    edges: dict[str, Edge]
    """The edges; a limit changed by time or an incident replaces its edge."""
    crossings: Crossings
    opposite: Mapping[str, str]
    """The opposite edge between the same junctions, if there is one."""
    map: RoadNetwork
    unplaced: str = ""
    """Why it has no position on earth, e.g. "has no projection"; empty if it has one."""
    moved: bool = False
    """Whether it was moved from the position in its file."""
    closed_at_times: frozenset[str] = frozenset()
    """Edges that a rerouter of the scenario closes to cars at any time."""
    closed_free_s: Mapping[str, float] = field(default_factory=dict)
    """The time of each edge without a lane for cars, as of a way for buses, at its limit."""

    def __reduce__(self) -> tuple[Any, ...]:
        _, *values = (getattr(self, each.name) for each in fields(self))
        return _unpacked, (in_columns(Edge, self.edges.values()), *values)

    @property
    def free_s(self) -> dict[str, float]:
        """The time of every edge that a route may contain, at its limit."""
        cars = {name: edge.length_m / max(SLOWEST_MPS, edge.speed_mps) for name, edge in self.edges.items()}
        return {**cars, **self.closed_free_s}

    @property
    def has_hours(self) -> bool:
        """Whether any of its roads or turns is open to cars at certain hours only."""
        return any(edge.timed_access or edge.timed_turns for edge in self.edges.values())

    def open_at_all_hours(self) -> Network:
        """The same network with the ways only that are open at any hour: planned there, no route is ever barred."""
        shut = {edge.edge_id for edge in self.edges.values() if edge.timed_access} | self.closed_at_times
        barred = {(edge.edge_id, to_edge) for edge in self.edges.values() for to_edge, _ in edge.timed_turns}
        if not shut and not barred:
            return self
        crossings = {
            here: {there: way for there, way in ways.items() if there not in shut and (here, there) not in barred}
            for here, ways in self.crossings.items()
            if here not in shut
        }
        return replace(self, crossings=crossings)

    @property
    def joints_m(self) -> list[Shape]:
        """Straight lines through the junctions, from the end of each edge to the starts of those that follow: with
        them, a map's roads are continuous."""
        return [
            (self.edges[here].shape_m[-1], self.edges[there].shape_m[0])
            for here, ways in self.crossings.items()
            for there in ways
        ]

    def at(self, origin: tuple[float, float], language: str = "") -> Network:
        """The same network with its middle at another place: (longitude, latitude).

        If it has a place of its own, its streets get names in the language of the other (``naming.local_names``).
        """
        there = replace(self, map=georeference.moved(self.map, origin), unplaced="", moved=True)
        return there if self.unplaced else there._renamed(language)

    def _renamed(self, language: str) -> Network:
        names = local_names(((edge.name, edge.road_class) for edge in self.edges.values()), language)
        edges = {edge_id: replace(edge, name=names.get(edge.name, "")) for edge_id, edge in self.edges.items()}
        roads = tuple(replace(road, name=names.get(road.name, "")) for road in self.map.roads)
        return replace(self, edges=edges, map=replace(self.map, roads=roads))


def _unpacked(edges: Columns[Edge], *values: Any) -> Network:
    return Network({edge.edge_id: edge for edge in of_columns(edges)}, *values)


class _Connection(NamedTuple):
    from_edge: str
    from_lane: int
    to_edge: str
    to_lane: int
    via: str | None
    is_straight: bool
    signal: str | None


@dataclass(frozen=True, slots=True)
class KnownNetwork:
    """What one process has read of a network, for another one."""

    digest: bytes
    """Of the file (``file_check.vet``)."""
    pickled: bytes


_KNOWN: dict[Path, tuple[KnownNetwork, RoadNetwork]] = {}
"""The last one, by the file that runs it, with its map as this process has it."""


def make_known(config: Path, digest: bytes, network: Network) -> None:
    """Keeps what has been read for the simulation's process, which is to read it a second time otherwise."""
    _KNOWN.clear()
    known = KnownNetwork(digest, pickle.dumps(network, pickle.HIGHEST_PROTOCOL))
    _KNOWN[config.absolute()] = known, network.map


def known_network(config: Path) -> tuple[KnownNetwork, RoadNetwork] | tuple[None, None]:
    """What is known of the network that a file runs, and its map."""
    return _KNOWN.get(config.absolute(), (None, None))


class NetworkReader:
    """Reads a network from its elements, in one pass over the file, which may serve others too."""

    def __init__(self, path: Path, known: KnownNetwork | None = None) -> None:
        """Starts before the first element.

        Args:
            path: the file, for errors.
            known: what it was when another process read it, which holds until an element comes."""
        self.path = path
        self.known = known
        self._edge: Attributes = {}
        self._lanes: list[Attributes] = []
        """Of the edge that is being read, like its parameters."""
        self._params: dict[str, str] = {}
        self.edges: dict[str, Edge] = {}
        self.closed_free_s: dict[str, float] = {}
        self.inner_lanes: dict[str, tuple[float, float]] = {}
        """Length and speed of each within a junction."""
        self.onward: dict[str, str] = {}
        """The inner lane that follows one, where a waiting position splits a way through a junction."""
        self.connections: list[_Connection] = []
        """Those of edges outside of junctions."""
        self.cars_mps: dict[str, float] = {}
        """The limits for cars, by type of road."""
        self.for_trains: set[str] = set()
        """Junctions of ``FOR_TRAINS``."""
        self._type = ""
        self.location: Mapping[str, str] = {}
        self.left_hand = False

    def start(self, name: str, attributes: Attributes, depth: int) -> None:
        """Takes the start of an element.

        Raises:
            ScenarioError: it is no network's.
            LookupError: it, or the edge before it, lacks something, or
            ValueError: something of it is wrong; ``scan`` says so."""
        if depth == EDGE_DEPTH:
            if self._edge:
                self._take_edge()
            if name == "connection":
                self._take_connection(attributes)
            elif name == "edge":
                self._edge, self._lanes, self._params = attributes, [], {}
            elif name == "location":
                self.location = attributes
            elif name == "junction" and attributes.get("type") in FOR_TRAINS:
                self.for_trains.add(attributes["id"])
            self._type = attributes.get("id", "") if name == "type" else ""
        elif depth == LANE_DEPTH and name == "restriction":
            if self._type and attributes["vClass"] == CARS:
                self.cars_mps[self._type] = quantity(attributes["speed"], SLOWEST_MPS)
        elif depth == LANE_DEPTH and self._edge:
            if name == "lane":
                self._lanes.append(attributes)
            elif name == "param":
                self._params[attributes.get("key", "")] = attributes.get("value", "")
        elif depth == LANE_DEPTH + 1 and self._edge and self._lanes and attributes.get("key") == "maxspeed":
            self._lanes[-1][SIGNED] = attributes.get("value", "")
        elif depth == 0:
            self.known = None
            if name != "net":
                raise ScenarioError(f"{self.path} is not a SUMO network: its root is <{name}>, not <net>")
            self.left_hand = attributes.get("lefthand") in ("true", "1")

    @without_collection()
    def network(self) -> Network:
        """The network, once all is read. Raises ScenarioError: it has no road for cars, or no valid location."""
        if self.known is not None:
            known: Network = pickle.loads(self.known.pickled)
            return known
        try:
            if self._edge:
                self._take_edge()
        except (LookupError, ValueError) as error:
            raise ScenarioError(f"{self.path} is not {FORM}: {error}") from error
        if not self.edges:
            raise ScenarioError(f"{self.path} has no road that cars may use")
        try:
            roads = _map(self)
            doubt = georeference.doubt(roads, self.location)
        except ValueError as error:
            raise ScenarioError(
                f"{self.path} has no valid location ({error}); build it again with netconvert"
            ) from error
        if doubt:
            roads = replace(roads, projection=None)
        crossings = _crossings(self)
        roads = replace(roads, junctions_m=JunctionLengths(crossings))
        opposite = _opposite(self.edges.values())
        return Network(self.edges, crossings, opposite, roads, doubt, closed_free_s=self.closed_free_s)

    def _take_connection(self, link: Attributes) -> None:
        if not link["from"].startswith(":"):
            self.connections.append(_connection(link))
        elif via := link.get("via"):
            self.onward[f"{link['from']}_{link['fromLane']}"] = via

    def _take_edge(self) -> None:
        """Takes the edge that has been read."""
        edge, self._edge = self._edge, {}
        if function := edge.get("function"):
            for lane in self._lanes if function == "internal" else ():
                if open_to(lane):
                    speed_mps = quantity(lane["speed"], SLOWEST_MPS)
                    self.inner_lanes[lane["id"]] = quantity(lane["length"], 0.0), speed_mps
        elif lanes := [lane for lane in self._lanes if open_to(lane)]:
            cars_mps = self.cars_mps.get(edge.get("type", ""))
            self.edges[intern(edge["id"])] = _edge(edge, lanes, self._lanes, self._params, cars_mps)
        elif self._lanes:
            self.closed_free_s[edge["id"]] = min(
                quantity(lane["length"], 0.0) / max(SLOWEST_MPS, quantity(lane["speed"], 0.0))
                for lane in self._lanes
            )


def read_network(path: Path) -> Network:
    """Reads a network.

    Raises ScenarioError: the file is missing, is not a SUMO network, is truncated, or has no road for cars."""
    reader, ended = NetworkReader(path), list[str]()
    count = itertools.count()

    def start(name: str, attributes: Attributes) -> None:
        reader.start(name, attributes, next(count) - len(ended))

    scan(path, start, ended.append, error=ScenarioError, what=FORM)
    return reader.network()


def drives_on_left(path: Path) -> bool:
    """Whether a network's traffic keeps left, read from its first element.

    Raises ScenarioError: the file is missing or not XML."""
    return read_root(path, error=ScenarioError).get("lefthand") in ("true", "1")


def _edge(
    edge: Attributes,
    lanes: list[Attributes],
    all_lanes: list[Attributes],
    params: Attributes,
    cars_mps: float | None,
) -> Edge:
    lane_mps = tuple(cars_mps or quantity(lane["speed"], SLOWEST_MPS) for lane in lanes)
    speed_mps = max(lane_mps)
    says_none = "none" in (params.get("maxspeed"), params.get("maxspeed:assumed"))
    unlimited = cars_mps is None and says_none and speed_mps >= NO_LIMIT_FROM_MPS
    is_posted = cars_mps is not None or params.get("maxspeed")
    middle = lanes[len(lanes) // 2]
    return Edge(
        edge_id=intern(edge["id"]),
        from_node=intern(edge["from"]),
        to_node=intern(edge["to"]),
        name=intern(edge.get("name", "")),
        road_class=class_of(_highway(edge.get("type", "")), params),
        lane_ids=tuple(intern(lane["id"]) for lane in lanes),
        length_m=quantity(lanes[0]["length"], 0.0),
        speed_mps=speed_mps,
        lane_mps=lane_mps,
        limit_mps=None if unlimited else speed_mps,
        limit_source=LimitSource.POSTED if is_posted else LimitSource.ASSUMED,
        cars_mps=cars_mps,
        shape_m=_shape(edge.get("shape") or middle["shape"]),
        bus_lane=any(map(_for_buses, all_lanes)),
        signed_lanes=frozenset(intern(lane["id"]) for lane in lanes if SIGNED in lane) or NO_LANES,
        **(_told(params) if params else _NOTHING_TOLD),
    )


def _told(params: Attributes) -> dict[str, Any]:
    """What an edge's parameters alone say."""
    return {
        "in_tunnel": params.get("tunnel", "no") != "no",
        "lit": {"yes": True, "no": False}.get(params.get("lit", "")),
        "built_up": _built_up(params.get("zone:traffic", "")),
        "built_up_assumed": _built_up(params.get("zone:traffic:assumed", "")),
        "centre_line": {"yes": True, "no": False}.get(params.get("lane_markings", "")),
        "cameras_m": tuple(quantity(place_m) for place_m in params.get("speed_camera", "").split()),
        "sign": intern(params.get(SIGN, "")),
        "school_zone": params.get("hazard") == "school_zone",
        "timed_limits": timed_limits(params.get("maxspeed:conditional", ""))[0],
        "timed_access": timed_access(params.get(TIMED_ACCESS, "")),
        "timed_turns": tuple(
            (intern(key.removeprefix(TIMED_TURN)), timed_access(value))
            for key, value in params.items()
            if key.startswith(TIMED_TURN)
        ),
    }


def _built_up(zone: str) -> bool | None:
    return BUILT_UP.get(zone.rpartition(":")[2])


_NOTHING_TOLD = _told({})


def open_to(lane: Attributes, vehicle_class: str = CARS) -> bool:
    """Whether this class of SUMO's may use what has these attributes, a lane's ``allow`` and ``disallow``."""
    allowed = lane.get("allow")
    if allowed is not None:
        return allowed == "all" or vehicle_class in allowed.split()
    forbidden = lane.get("disallow")
    return not forbidden or frozenset(forbidden.split()).isdisjoint((vehicle_class, "all"))


def _for_buses(lane: Attributes) -> bool:
    """Whether buses may use it and cars may not; a footway that happens to allow buses does not count."""
    return "bus" in lane.get("allow", "").split() and not open_to(lane)


def class_of(highway: str, tags: Mapping[str, str]) -> str:
    """The road class of an OSM way or its edges: its highway value, or ``cycle_street``, whatever the value is."""
    return "cycle_street" if any(tags.get(key) == "yes" for key in CYCLE_STREET_KEYS) else highway


@lru_cache(maxsize=1024)
def _highway(edge_type: str) -> str:
    kinds = (kind.partition(".") for kind in edge_type.split("|"))
    return next((value for key, _, value in kinds if key == "highway"), "")


def _shape(text: str) -> Shape:
    points = (point.split(",") for point in text.split())
    return tuple((quantity(point[0]), quantity(point[1])) for point in points)


def _connection(link: Attributes) -> _Connection:
    return _Connection(
        intern(link["from"]),
        int(link["fromLane"]),
        intern(link["to"]),
        int(link["toLane"]),
        link.get("via"),
        link.get("dir", "s") == "s",
        link.get("tl"),
    )


def _crossings(reading: NetworkReader) -> dict[str, dict[str, Crossing]]:
    """Adds up the inner lanes of each connection through a junction; a waiting position splits it in two.

    A connection from or to a lane that is closed to cars is none for them.

    Raises ScenarioError: a connection names an edge that the network does not have."""
    lanes = {lane for edge in reading.edges.values() for lane in edge.lane_ids}
    links: dict[str, dict[str, list[_Connection]]] = {}
    for link in reading.connections:
        here, from_lane, there, to_lane, *_ = link
        if f"{here}_{from_lane}" in lanes and f"{there}_{to_lane}" in lanes:
            for edge_id in (here, there):
                if edge_id not in reading.edges:
                    raise ScenarioError(
                        f"{reading.path} has a connection of the edge {edge_id!r}, which is not in it; "
                        "build the network anew with netconvert"
                    )
            links.setdefault(here, {}).setdefault(there, []).append(link)
    alike: dict[tuple[Any, ...], Crossing] = {}
    return {
        here: {there: _through(between, reading, alike) for there, between in ways.items()}
        for here, ways in links.items()
    }


def _through(links: list[_Connection], reading: NetworkReader, alike: dict[tuple[Any, ...], Crossing]) -> Crossing:
    """The crossing of some connections between two edges; its way is that of the first."""
    link = links[0]
    length_m, speed_mps, via = 0.0, float("inf"), link.via
    while via in reading.inner_lanes:
        lane_m, lane_mps = reading.inner_lanes[via]
        length_m += lane_m
        speed_mps = min(speed_mps, lane_mps)
        via = reading.onward.get(via)
    has_signal = link.signal is not None and link.signal not in reading.for_trains
    lanes = tuple((each.from_lane, each.to_lane) for each in links)
    found = length_m, speed_mps, link.is_straight, has_signal, lanes
    if found not in alike:
        alike[found] = Crossing(length_m, speed_mps, link.is_straight, has_signal, frozenset(lanes))
    return alike[found]


def _opposite(edges: Iterable[Edge]) -> dict[str, str]:
    between = {(edge.from_node, edge.to_node, edge.name): edge.edge_id for edge in edges}
    backwards = {
        edge_id: between.get((to_node, from_node, name)) for (from_node, to_node, name), edge_id in between.items()
    }
    return {edge_id: back for edge_id, back in backwards.items() if back is not None}


def _map(reading: NetworkReader) -> RoadNetwork:
    bounds = tuple(quantity(number) for number in reading.location.get("convBoundary", "").split(",") if number)
    east_m, north_m = map(quantity, reading.location.get("netOffset", "0,0").split(","))
    projection = georeference.in_full(reading.location)
    return RoadNetwork(
        roads=tuple(road_of(edge) for edge in reading.edges.values()),
        bounds_m=(bounds[0], bounds[1], bounds[2], bounds[3]) if len(bounds) == 4 else _bounds(reading),
        projection=None if projection in ("!", "-") else projection,
        offset_m=(east_m, north_m),
        left_hand=reading.left_hand,
    )


def road_of(edge: Edge) -> Road:
    """The edge for maps."""
    return Road(
        edge_id=edge.edge_id,
        name=edge.name,
        road_class=edge.road_class,
        lane_count=len(edge.lane_ids),
        length_m=edge.length_m,
        limit_mps=edge.limit_mps,
        limit_source=edge.limit_source,
        in_tunnel=edge.in_tunnel,
        shape_m=edge.shape_m,
        school_zone=edge.school_zone,
        limit_hours="; ".join(limit.hours.text for limit in edge.timed_limits),
    )


def _bounds(reading: NetworkReader) -> tuple[float, float, float, float]:
    points = [point for edge in reading.edges.values() for point in edge.shape_m]
    xs, ys = [x for x, _ in points], [y for _, y in points]
    return min(xs), min(ys), max(xs), max(ys)
