"""What a scenario's additional files say of its roads: water, green and buildings around them, and closures.

Areas are SUMO's own ``<poly>``, as polyconvert, netedit or ``scenarios import`` write them, and sumo-gui shows them
too. Their ``type`` says what they are (``KINDS``), also in OpenStreetMap's words (``natural.water``). A line
(neither filled nor closed) is no area, and other types are not drawn.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import replace
from pathlib import Path

import numpy as np
import shapely

from automotive_cosim.contracts import GroundArea, GroundKind, RoadNetwork, in_drawing_order
from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats.scenario import Scenario
from automotive_cosim.formats.words import shown
from automotive_cosim.formats.xml import FilePlace, scan
from automotive_cosim.traffic.georeference import GeoReference
from automotive_cosim.traffic.mirror import mirrored
from automotive_cosim.traffic.network import Network, Shape, open_to, quantity, read_network
from automotive_cosim.traffic.options import FALSE, TRUE, Configuration, stamp

KINDS = {
    **dict.fromkeys(
        ("water", "waterway", "riverbank", "river", "lake", "sea", "bay", "strait", "harbour"), GroundKind.WATER
    ),
    **dict.fromkeys(
        ("green", "park", "forest", "wood", "grass", "meadow", "garden", "leisure", "tourism", "sport"),
        GroundKind.GREEN,
    ),
    "building": GroundKind.BUILDING,
}
"""What polygons of a type are, as polyconvert's type map names them (``leisure.park`` is ``tourism`` there)."""

AREAS_LIMIT = 20_000
"""Of more areas the largest are shown."""

CLOSES_EDGE, CLOSES_LANE = "closingReroute", "closingLaneReroute"
"""Parts of a rerouter that keep vehicles out."""


_READ = ContextVar[dict[object, Network] | None]("networks that were read", default=None)


@contextmanager
def reading_once() -> Iterator[None]:
    """Within it, ``read_mapped`` reads a network once, as long as its files are as they are. None is kept after it:
    that of a city takes hundreds of megabytes."""
    token = _READ.set({})
    try:
        yield
    finally:
        _READ.reset(token)


def read_mapped(configuration: Configuration, read: Network | None = None) -> Network:
    """The network of a configuration with what is around its roads, and which of them rerouters close to cars.

    Args:
        configuration: names the files.
        read: the network without it, if it has been read.

    Raises:
        ScenarioError: a file is missing or invalid; a polygon with its line."""
    kept = _READ.get()
    if kept is None:
        return _mapped(configuration, read or read_network(configuration.net))
    files = stamp(configuration)
    if files not in kept:
        kept[files] = _mapped(configuration, read or read_network(configuration.net))
    return kept[files]


def _mapped(configuration: Configuration, network: Network) -> Network:
    closed: dict[str, set[str]] = {CLOSES_EDGE: set(), CLOSES_LANE: set()}

    counts = False

    def take(element: str, attributes: dict[str, str]) -> None:
        nonlocal counts
        if element == "rerouter":  # the ego is of none of the user's types
            is_off = attributes.get("off", "").lower() in TRUE or _is_zero(attributes.get("probability", "1"))
            counts = not (attributes.get("vTypes") or is_off)
        if counts and element in closed and closes_to_cars(attributes):
            closed[element].add(attributes.get("id", ""))

    ground = read_ground(configuration, network.map, take)
    if any(closed.values()):
        edges, lanes = closed.values()
        shut = {name for name, edge in network.edges.items() if name in edges or lanes.issuperset(edge.lane_ids)}
        network = replace(network, closed_at_times=frozenset(shut))
    return replace(network, map=replace(network.map, ground=ground)) if ground else network


def _is_zero(text: str) -> bool:
    try:
        return float(text) == 0.0
    except ValueError:  # SUMO refuses it
        return False


def placed(network: Network, scenario: Scenario) -> Network:
    """A scenario's network as it drives there: on its side of the road, and at its place."""
    if scenario.mirrored:
        network = mirrored(network)
    return network if scenario.origin is None else network.at(scenario.origin, scenario.language)


def closes_to_cars(attributes: dict[str, str]) -> bool:
    """Whether a part of a rerouter keeps cars out; SUMO sends everybody round one that names no classes."""
    names_none = not (attributes.get("allow") or attributes.get("disallow"))
    return names_none or not open_to(attributes)


def read_ground(
    configuration: Configuration,
    roads: RoadNetwork,
    also: Callable[[str, dict[str, str]], None] = lambda element, attributes: None,
) -> tuple[GroundArea, ...]:
    """The areas in the additional files of a configuration, in the order in which they are drawn.

    Args:
        roads: the network as in its file, for polygons in longitude and latitude; without a projection those are
            left out.
        also: called with each element of these files.

    Raises:
        ScenarioError: a file is no XML, or a polygon has no valid shape."""
    found: list[GroundArea] = []
    reference = None if roads.projection is None else GeoReference(roads)
    files, place = list(configuration.files.get("additional-files", ())), FilePlace()
    for file in files:  # which grows

        def start(element: str, attributes: dict[str, str], file: Path = file) -> None:
            also(element, attributes)
            if element == "include" and (included := file.parent / attributes.get("href", "")) not in files:
                files.append(included)
            if element != "poly":
                return
            try:
                area = _area(attributes, reference)
            except ValueError as error:
                raise ScenarioError(
                    f"{file} line {place.line}: polygon {shown(attributes.get('id'))}: {error}"
                ) from error
            if area is not None:
                found.append(area)

        scan(file, start, place=place, error=ScenarioError, what="a SUMO file")
    return in_drawing_order(_largest(found))


def kind_of(polygon_type: str) -> GroundKind | None:
    """What a polygon of that type is; None if it is not drawn."""
    words = polygon_type.lower().split(".")
    return next((KINDS[word] for word in reversed(words) if word in KINDS), None)


def _area(attributes: dict[str, str], reference: GeoReference | None) -> GroundArea | None:
    """The polygon as an area; None if it is none that is drawn. Raises ValueError: its shape is invalid."""
    shape = _shape(attributes.get("shape", ""))
    is_geographic, is_filled = _flag(attributes, "geo"), _flag(attributes, "fill")
    kind = kind_of(attributes.get("type", ""))
    is_area = len(set(shape)) > 2 and (is_filled or shape[0] == shape[-1])
    if kind is None or not is_area or (is_geographic and reference is None):
        return None
    if is_geographic and reference is not None:
        shape = tuple(_metres(lon_deg, lat_deg, reference) for lon_deg, lat_deg in shape)
    return GroundArea(kind, shape[:-1] if shape[0] == shape[-1] else shape)


def _shape(text: str) -> Shape:
    points = [point.split(",") for point in text.split()]
    try:
        if points and all(len(point) in (2, 3) for point in points):
            return tuple((quantity(point[0]), quantity(point[1])) for point in points)
    except ValueError as error:
        raise ValueError(f"in its shape, {error}") from error
    raise ValueError(f'its shape is {shown(text)}; write it as "x,y x,y x,y"')


def _flag(attributes: dict[str, str], name: str) -> bool:
    value = attributes.get(name, "").lower()
    if value not in TRUE | FALSE:
        raise ValueError(f"its {name} is {shown(value)}; write true or false")
    return value in TRUE


def _metres(lon_deg: float, lat_deg: float, reference: GeoReference) -> tuple[float, float]:
    if abs(lon_deg) > 180 or abs(lat_deg) > 90:
        raise ValueError(f"the point {lon_deg:g},{lat_deg:g} is not a longitude and a latitude")
    x_m, y_m = reference.x_y(lon_deg, lat_deg)
    return quantity(str(round(x_m, 1))), quantity(str(round(y_m, 1)))


def _largest(areas: list[GroundArea]) -> list[GroundArea]:
    if len(areas) <= AREAS_LIMIT:
        return areas
    sizes = shapely.area([shapely.Polygon(area.outline_m) for area in areas])
    return [areas[index] for index in np.sort(np.argsort(-sizes, kind="stable")[:AREAS_LIMIT]).tolist()]
