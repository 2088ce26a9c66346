"""What an import found, guessed and measured."""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from automotive_cosim.contracts import GroundKind, LimitSource
from automotive_cosim.contracts.plain import counted
from automotive_cosim.formats.files import file_sha256
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.osm import ramps
from automotive_cosim.osm.agreement import differences
from automotive_cosim.osm.area import Area
from automotive_cosim.osm.country import LEFT_HAND
from automotive_cosim.osm.doubts import doubts, in_words, unconnected
from automotive_cosim.osm.extract import Extract
from automotive_cosim.osm.folder import ATTRIBUTION
from automotive_cosim.osm.land_cover import DrawnGround
from automotive_cosim.osm.network import Built
from automotive_cosim.osm.roads import MappedRoad, way_of
from automotive_cosim.traffic.network import Edge
from automotive_cosim.traffic.stability import Stability, Stuck


@dataclass(frozen=True, slots=True)
class ImportReport:
    """The figures of one import; ``import.json`` in the scenario's folder."""

    source: str
    """File name of the extract."""
    source_sha256: str
    attribution: str
    country: str
    """ISO 3166-1 code."""
    bbox: tuple[float, float, float, float] | None
    """The crop: west, south, east, north in degrees."""
    left_hand: bool
    ways: int
    """Ways of the extract that are open to cars."""
    edges: int
    """Edges of the network, without those inside junctions."""
    road_km: float
    """Length of the roads, each direction counted."""
    posted_share: float
    """Share of the road length where the map states the limit (or that there is none)."""
    derestricted_km: float
    """Length of road where the map states that there is no limit."""
    signals: int
    roundabouts: int
    ground: Mapping[str, int]
    """Areas of water, green and buildings around the roads, by kind."""
    tunnels: int
    """Edges in tunnels."""
    tunnel_km: float
    lit_known_share: float
    """Share of the road length where the map says whether there are street lamps."""
    built_up_known_share: float
    school_zone_km: float
    timed_limit_km: float
    """Length of road with other limits at certain hours."""
    timed_access_km: float
    """Length of road that cars may use at certain hours only."""
    timed_turns: int
    """Turns that they may make at certain hours only."""
    bus_lane_km: float
    speed_cameras: int
    """Speed cameras at imported roads; one for both directions counts once."""
    density_per_km: float
    """Requested density; ``vehicles_per_hour`` is the demand after scaling."""
    vehicles_per_hour: float
    seed: int
    scale: float
    stability: Stability
    """Measured at that scale and the scenario's own step length."""
    guessed: tuple[str, ...]
    """What was guessed or left out, in words."""
    differences: tuple[str, ...]
    """Everything in which the network differs from the map: limits, names, classes, tunnels and lanes of edges;
    and, by a second reading of the tags, access, directions, limits, barriers and turns."""

    def write(self, target: Path) -> None:
        write_whole(target, json.dumps(asdict(self), indent=2, ensure_ascii=False) + "\n")


def make_report(
    source: Path,
    extract: Extract,
    roads: Mapping[int, MappedRoad],
    built: Built,
    around: DrawnGround,
    stability: Stability,
    *,
    country: str,
    area: Area | None,
    density_per_km: float,
    seed: int,
    demand_per_hour: float,
    stuck: Sequence[Stuck],
    quick: bool,
) -> ImportReport:
    """Counts what an import found.

    ``demand_per_hour`` is the traffic before scaling; ``stuck`` are the vehicles that stood for good in a trial;
    ``quick`` is whether the traffic was only tried with long steps.
    """
    edges = built.edges
    length_m = sum(edge.length_m for edge in edges)
    posted_m = sum(edge.length_m for edge in edges if edge.limit_source is LimitSource.POSTED)
    free_m = sum(edge.length_m for edge in edges if edge.limit_mps is None)
    tunnels = [edge for edge in edges if edge.in_tunnel]
    return ImportReport(
        source=source.name,
        source_sha256=file_sha256(source),
        attribution=ATTRIBUTION,
        country=country,
        bbox=area,
        left_hand=country in LEFT_HAND,
        ways=len(extract.ways),
        edges=len(edges),
        road_km=round(length_m / 1000, 3),
        posted_share=round(posted_m / length_m, 4),
        derestricted_km=round(free_m / 1000, 3),
        signals=built.signals,
        roundabouts=built.roundabouts,
        ground={kind.value: around.count(kind) for kind in GroundKind},
        tunnels=len(tunnels),
        tunnel_km=round(sum(edge.length_m for edge in tunnels) / 1000, 3),
        lit_known_share=_share(length_m, (edge for edge in edges if edge.lit is not None)),
        built_up_known_share=_share(length_m, (edge for edge in edges if edge.built_up is not None)),
        school_zone_km=_km(edge for edge in edges if edge.school_zone),
        timed_limit_km=_km(edge for edge in edges if edge.timed_limits),
        timed_access_km=_km(edge for edge in edges if edge.timed_access),
        timed_turns=sum(len(edge.timed_turns) for edge in edges),
        bus_lane_km=_km(edge for edge in edges if edge.bus_lane),
        speed_cameras=built.cameras.count,
        density_per_km=density_per_km,
        vehicles_per_hour=round(demand_per_hour * stability.scale, 1),
        seed=seed,
        scale=stability.scale,
        stability=stability,
        guessed=(
            *_guesses(extract, built, country, (length_m - posted_m) / 1000),
            *_of_ramps(built, roads),
            *doubts(extract, roads, built, country),
            *unconnected(extract, built),
            *_of_ground(around),
            *_of_traffic(stability, stuck, quick=quick),
        ),
        differences=tuple(map(str, differences(extract, built, roads, country))),
    )


def _km(edges: Iterable[Edge]) -> float:
    return round(sum(edge.length_m for edge in edges) / 1000, 3)


def _share(whole_m: float, edges: Iterable[Edge]) -> float:
    return round(sum(edge.length_m for edge in edges) / whole_m, 4)


def _guesses(extract: Extract, built: Built, country: str, assumed_km: float) -> Iterator[str]:
    if assumed_km > 0:
        yield f"speed limits on {assumed_km:.2f} km: assumed from the law of {country} or common practice"
    mapped = sum(node.tags.get("highway") == "traffic_signals" for node in extract.nodes.values())
    if mapped:
        points = counted(mapped, "point")
        yield f"junctions and phases of {counted(built.signals, 'signal')}, from {points} in the map"
    if built.roundabouts:
        yield f"right of way in {built.roundabouts} roundabouts"
    density_m = sum(edge.length_m for edge in built.edges if edge.built_up is None)
    if density_m:
        yield f"built-up area on {density_m / 1000:.2f} km: inferred from street density"
    if built.opened:
        ways = sorted({way_of(edge_id) for edge_id in built.opened})
        yield f"lanes for buses or taxis that part the lanes for cars, opened to cars: {in_words('way', ways)}"
    yield "lanes and right of way that the map does not state: by road class"
    yield "date, weather and ego trips: to be changed in scenario.toml"


def _of_ramps(built: Built, roads: Mapping[int, MappedRoad]) -> Iterator[str]:
    found = tuple(ramps.widened(built.edges, roads))
    if found:
        beside = {each.edge_id for each in found}
        km = _km(edge for edge in built.edges if edge.edge_id in beside)
        yield (
            f"lanes for leaving and joining on {km:.2f} km, beside those that the map states (netconvert adds them"
            f" for 100 m at most): {ramps.in_words(found)}"
        )


def _of_ground(around: DrawnGround) -> Iterator[str]:
    if around.areas:
        yield "water, green and buildings: coarse, merged where they touch, without the small ones"
    if around.too_many:
        yield f"{counted(around.too_many, 'area')} of them left out: there are more than pictures need"


def _of_traffic(stability: Stability, stuck: Sequence[Stuck], *, quick: bool) -> Iterator[str]:
    yield "traffic: random trips, half of them across the map's edge"
    if quick:
        yield (
            f"traffic that flows: modest, tried for {stability.observed_s / 60:.0f} min in steps of"
            f" {stability.step_length_s:g} s (--quick)"
        )
    if stuck:
        ways = sorted({way_of(each.lane) for each in stuck if not each.lane.startswith(":")})
        reasons = ", ".join(sorted({each.reason for each in stuck}))
        yield f"{counted(len(stuck), 'trip')} left out that stood for good ({reasons}): {in_words('way', ways)}"
