"""How far a demand's routes are from an equilibrium, measured from the trips that SUMO really drives.

An equilibrium is traffic in which nobody could have been quicker on another route (Wardrop's first principle). The
relative gap is what all drivers together lose against it, as a share of their best times. Times of edges are means
over the vehicles that left them, per five minutes, junctions included; edges that nobody drove take their free
time. The first edge of a trip is the same on every route and is left out.
"""

from __future__ import annotations

import tempfile
import xml.etree.ElementTree as ET
from codecs import getwriter
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
import numpy.typing as npt

from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats.scenario import Scenario
from automotive_cosim.formats.writing import drafted, write_whole
from automotive_cosim.formats.xml import read_tree
from automotive_cosim.traffic import sumo_programs
from automotive_cosim.traffic.network import read_network
from automotive_cosim.traffic.options import (
    Configuration,
    Copied,
    Setup,
    command_line,
    copied,
    read_configuration,
    run_options,
)
from automotive_cosim.traffic.stability import summary

INTERVAL_S = 300.0
"""Length of the intervals over which times of edges are averaged."""

TAIL_S = 1800.0
"""Simulated time after the last departure that counts, in which its driver can arrive."""

NOTICED_S = 1.0
"""A route is better from this difference on."""


@dataclass(frozen=True, slots=True)
class Gap:
    """The gap of a demand."""

    trips: int
    """Trips that departed in the time observed and arrived."""
    unfinished: int
    """Trips that departed in it and had not arrived at the end; they are in no other figure."""
    own_s: float
    """Total time of the routes driven."""
    best_s: float
    """The same if each had taken the route that was quickest at its time, and nothing else had changed."""
    better: float
    """Share of the trips with a route that is quicker by ``NOTICED_S``."""
    teleports: int

    @property
    def relative(self) -> float:
        """What was lost as a share of the best times."""
        return (self.own_s - self.best_s) / self.best_s if self.best_s > 0 else 0.0

    def __str__(self) -> str:
        return (
            f"relative gap {self.relative:.1%} of {self.trips} trips; {self.better:.0%} had a quicker route; "
            f"{self.unfinished} had not arrived, {self.teleports} teleports"
        )


@dataclass(frozen=True, slots=True)
class DrivenTrip:
    """A trip as SUMO drove it."""

    id: str
    type_id: str
    departed_s: float
    edges: tuple[str, ...]
    exits_s: tuple[float, ...]
    """When it left each edge; -1 for those that it has not left."""

    @property
    def has_arrived(self) -> bool:
        """Whether it left its last edge."""
        return self.exits_s[-1] >= 0


class EdgeTimes:
    """Times of edges, from the trips."""

    def __init__(self, free_s: Mapping[str, float], trips: Iterable[DrivenTrip]) -> None:
        """Averages what the trips took.

        Args:
            free_s: time of every edge at its limit."""
        sums: dict[tuple[str, int], list[float]] = defaultdict(lambda: [0.0, 0.0])
        for trip in trips:
            for edge, entered_s, left_s in zip(trip.edges[1:], trip.exits_s, trip.exits_s[1:], strict=False):
                if left_s < 0:
                    break
                total = sums[edge, int(entered_s // INTERVAL_S)]
                total[0] += left_s - entered_s
                total[1] += 1
        self._free_s = free_s
        self._means_s = {key: total / count for key, (total, count) in sums.items()}

    def at(self, edge: str, interval: int) -> float:
        """The time of an edge that is entered in an interval."""
        return self._means_s.get((edge, interval), self._free_s[edge])

    def table(self, edges: Mapping[str, int]) -> tuple[int, npt.NDArray[np.float64]]:
        """The first interval of all, and the times of some edges in it and the following ones.

        Args:
            edges: edge -> row of an array, (edges, intervals + 1), whose last column is the free time."""
        intervals = [interval for _, interval in self._means_s] or [0]
        first, count = min(intervals), max(intervals) + 1 - min(intervals)
        free_s = np.array([self._free_s[edge] for edge in edges])
        table = np.repeat(free_s[:, None], count + 1, axis=1)
        for (edge, interval), mean_s in self._means_s.items():
            if edge in edges:
                table[edges[edge], interval - first] = mean_s
        return first, table

    def of(self, edges: Sequence[str], from_s: float) -> float:
        """The time of a route whose first edge is left at an instant, to its end."""
        now_s = from_s
        for edge in edges[1:]:
            now_s += self.at(edge, int(now_s // INTERVAL_S))
        return now_s - from_s

    @property
    def least_s(self) -> dict[str, float]:
        """Of each edge that was driven, the time of the interval in which it was least."""
        found: dict[str, float] = {}
        for (edge, _), mean_s in self._means_s.items():
            found[edge] = min(mean_s, found.get(edge, mean_s))
        return found

    def raised(self, calm_s: Mapping[str, float], factor: float) -> EdgeTimes:
        """Times that count what exceeds that of a calm road again, times a factor."""
        raised = EdgeTimes(self._free_s, ())
        raised._means_s = {
            key: mean_s + factor * max(0.0, mean_s - calm_s.get(key[0], mean_s))
            for key, mean_s in self._means_s.items()
        }
        return raised

    def blended(self, newer: EdgeTimes, weight: float) -> EdgeTimes:
        """What is remembered of these times after newer ones: ``weight`` of these, the rest of the newer."""
        made = EdgeTimes(self._free_s, ())
        made._means_s = dict(self._means_s)
        for key, mean_s in newer._means_s.items():
            made._means_s[key] = weight * self._means_s.get(key, mean_s) + (1 - weight) * mean_s
        return made

    def write(self, path: Path) -> None:
        """Writes them as SUMO's edge data, every edge that was driven in every interval."""
        intervals = sorted({interval for _, interval in self._means_s})
        edges = sorted({edge for edge, _ in self._means_s})
        with drafted(path) as written:
            file = getwriter("utf-8")(written)
            file.write("<meandata>\n")
            for each in range(intervals[0], intervals[-1] + 1) if intervals else ():
                file.write(f'<interval begin="{each * INTERVAL_S:g}" end="{(each + 1) * INTERVAL_S:g}" id="t">\n')
                file.writelines(
                    f'<edge id={quoteattr(edge)} traveltime="{self.at(edge, each):.3f}"/>\n' for edge in edges
                )
                file.write("</interval>\n")
            file.write("</meandata>\n")


@dataclass(frozen=True, slots=True)
class Driven:
    """A run of SUMO without the ego, its trips, and what would have been better for each.

    Better is what costs less: the driver's own time, unless the run was asked for another cost."""

    trips: tuple[DrivenTrip, ...]
    """All trips, in the order of their departures."""
    gap: Gap
    excess_s: Mapping[str, float]
    """What each trip that counts lost against its best route."""
    best: Mapping[str, tuple[str, ...]]
    """Each trip's best route, as edge ids."""


def measure(scenario: Scenario, *, observe_s: float = 3600.0, seed: int = 0) -> Gap:
    """Drives the scenario's demand once and measures its gap after the warm-up.

    Args:
        scenario: the scenario, with its own share of cars that reroute.
        observe_s: how long after the warm-up departures count.

    Raises:
        ScenarioError: SUMO refuses the scenario; the message is SUMO's.
        SetupError: eclipse-sumo is not installed.
        TrafficError: SUMO hung or was killed."""
    configuration = read_configuration(scenario.config)
    return drive(configuration, scenario, observe_s, seed).gap


def drive(
    configuration: Configuration,
    scenario: Scenario,
    observe_s: float,
    seed: int,
    cost: Callable[[EdgeTimes], EdgeTimes] = lambda times: times,
) -> Driven:
    """Drives a demand once, with what would have been better; raises like ``measure``.

    Args:
        observe_s: how long after the warm-up departures count.
        cost: what edges cost a driver, from their times."""
    first_s = configuration.begin_s + scenario.sumo.warm_up_s
    last_s = first_s + observe_s
    with tempfile.TemporaryDirectory(prefix="automotive-cosim-gap-") as folder:
        scratch = Path(folder)
        ran = run(configuration, scenario, observe_s, seed, scratch)
        trips = ran.trips
        network = read_network(configuration.net)
        times = cost(EdgeTimes(network.free_s, trips))
        counted = [trip for trip in trips if first_s <= trip.departed_s < last_s]
        arrived = [trip for trip in counted if trip.has_arrived and len(trip.edges) > 1]
        own_s, best_s, found = against_best(arrived, times, ran, scratch)
    excess_s = {name: own_s[name] - best_s[name] for name in own_s}
    gap = Gap(
        trips=len(arrived),
        unfinished=sum(not trip.has_arrived for trip in counted),
        own_s=sum(own_s.values()),
        best_s=sum(best_s.values()),
        better=sum(each >= NOTICED_S for each in excess_s.values()) / max(1, len(excess_s)),
        teleports=ran.teleports,
    )
    return Driven(trips, gap, excess_s, found)


def against_best(
    trips: Sequence[DrivenTrip], times: EdgeTimes, ran: Ran, scratch: Path
) -> tuple[dict[str, float], dict[str, float], dict[str, tuple[str, ...]]]:
    """By trip, the time of its route and of the best one, in seconds, and the quickest route."""
    found = quickest(trips, times, ran.net, ran.types, scratch)
    own_s = {trip.id: times.of(trip.edges, trip.exits_s[0]) for trip in trips}
    best_s = {
        trip.id: min(own_s[trip.id], times.of(found.get(trip.id, trip.edges), trip.exits_s[0])) for trip in trips
    }
    return own_s, best_s, found


def vehicle_types(configuration: Copied, inputs: Sequence[str] = ("route-files", "additional-files")) -> str:
    """All vehicle types of some inputs, as SUMO's XML."""
    found = []
    for name in inputs:
        for path in configuration.files.get(name, ()):
            root = read_tree(path, error=ScenarioError)
            found += [ET.tostring(each, "unicode") for each in root.iter("vType")]
    return "".join(found)


def read_trips(path: Path) -> Iterable[DrivenTrip]:
    """The trips of SUMO's output of routes with exit times."""
    for _, element in ET.iterparse(path):
        if element.tag == "vehicle":
            route = element.find("route")
            if route is not None and route.get("edges"):
                yield DrivenTrip(
                    element.attrib["id"],
                    element.get("type", "DEFAULT_VEHTYPE"),
                    float(element.attrib["depart"]),
                    tuple(route.attrib["edges"].split()),
                    tuple(map(float, route.attrib["exitTimes"].split())),
                )
            element.clear()


@dataclass(frozen=True, slots=True)
class Ran:
    """SUMO's output of a run."""

    trips: tuple[DrivenTrip, ...]
    """All trips, in the order of their departures."""
    teleports: int
    types: str
    """The vehicle types, as SUMO's XML."""
    net: Path
    """The network that it drove on."""


def run(configuration: Configuration, scenario: Scenario, observe_s: float, seed: int, scratch: Path) -> Ran:
    """Runs SUMO on a demand until ``TAIL_S`` after the time observed; raises like ``measure``.

    Args:
        observe_s: how long after the warm-up departures count."""
    sumo = replace(scenario.sumo, step_length_s=1.0)
    copies = copied(configuration, scratch)
    options = run_options(copies, Setup(replace(scenario, sumo=sumo), seed))
    end_s = configuration.begin_s + sumo.warm_up_s + observe_s + TAIL_S
    whole = dict(options) | {
        "end": f"{end_s:g}",
        "summary-output": "stdout",
        "vehroute-output": "routes.xml",
        "vehroute-output.exit-times": "true",
        "vehroute-output.last-route": "true",
        "vehroute-output.write-unfinished": "true",
    }
    teleports = 0
    with (
        copies.named_as_given(),
        closing(summary(configuration.path.name, command_line(whole)[1:], scratch)) as steps,
    ):
        for step in steps:
            teleports = int(step.get("teleports", 0))
    trips = tuple(sorted(read_trips(scratch / "routes.xml"), key=lambda trip: trip.departed_s))
    return Ran(trips, teleports, vehicle_types(copies), copies.net)


def quickest(
    trips: Sequence[DrivenTrip],
    times: EdgeTimes,
    net: Path,
    types: str,
    scratch: Path,
    via: Mapping[str, str] | None = None,
) -> dict[str, tuple[str, ...]]:
    """The quickest route of each trip, by its id, by the times of the edges.

    Args:
        trips: only departures, types, first and last edges are read.
        net: the network's file, in that folder.
        types: the vehicle types, as SUMO's XML.
        via: an edge that the route of a trip must use, by the trip's id.

    Raises ScenarioError: duarouter refuses the network or the types."""
    if not trips:
        return {}
    via = via or {}
    wanted, weights, answer = "trips.xml", "weights.xml", "best.xml"
    times.write(scratch / weights)
    lines = (
        f'<trip id={quoteattr(trip.id)} type={quoteattr(trip.type_id)} depart="{trip.departed_s:.2f}" '
        f"from={quoteattr(trip.edges[0])} to={quoteattr(trip.edges[-1])}"
        f"{f' via={quoteattr(via[trip.id])}' if trip.id in via else ''}/>\n"
        for trip in trips
    )
    write_whole(scratch / wanted, f"<routes>{types}\n{''.join(lines)}</routes>")
    ok, printed = sumo_programs.run(
        "duarouter",
        [
            *("-n", net.name, "--route-files", wanted, "-o", answer),
            *("--weight-files", weights, "--weight-attribute", "traveltime", "--weights.expand", "true"),
            *("--ignore-errors", "true", "--no-warnings", "true"),
        ],
        scratch,
    )
    if not ok:
        raise ScenarioError(f"duarouter cannot route the trips: {sumo_programs.first_error(printed)}")
    found: dict[str, tuple[str, ...]] = {}
    for _, element in ET.iterparse(scratch / answer):
        if element.tag == "vehicle":
            route = element.find("route")
            if route is not None:
                found[element.attrib["id"]] = tuple(route.attrib["edges"].split())
            element.clear()
    return found
