"""Reads SUMO's output of the flow on every edge, and sums it and the queues by class of road."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from automotive_cosim.formats.csvs import read_packed_csv, write_packed_csv
from automotive_cosim.studies.calls.accounts import QUEUE_PERIOD_S
from automotive_cosim.studies.congestion.plan import EPOCH_S, INTERVAL_S
from automotive_cosim.studies.congestion.rows import EdgeRow, FlowCell, FlowSums
from automotive_cosim.traffic.network import Network
from automotive_cosim.traffic.options import EDGE_FLOWS

EDGES = "edges"
"""Folder of the flows on every edge, in a study's."""
JUNCTIONS, OTHER, UNKNOWN = "junctions", "other", "unknown"
"""Inside junctions; edges on which no car may drive; roads whose class the network does not tell."""
COLUMNS = ("intervention", "edge", "from_s", "time_s", "lost_s", "distance_m")


@dataclass(frozen=True, slots=True)
class EdgeFlow:
    """The flow on an edge in one interval."""

    edge: str
    from_s: float
    flow: FlowSums


def read_flows(
    folder: Path, begin_s: float, slowed: Sequence[Mapping[str, tuple[float, float]]] = ()
) -> Iterator[EdgeFlow]:
    """The flows of a run, edge by edge and interval by interval.

    Args:
        begin_s: simulation time from which ``from_s`` counts.
        slowed: for every interval, edges with a lower limit than usual: its share of the usual one, against which
            time is lost there, and the time of vehicles at their stops, which is not lost."""
    from_s = 0.0
    for event, element in ET.iterparse(folder / EDGE_FLOWS, ("start", "end")):
        if element.tag == "interval" and event == "start":
            from_s = float(element.attrib["begin"]) - begin_s
        elif element.tag == "interval":
            element.clear()
        elif element.tag == "edge" and event == "end":
            time_s = float(element.get("sampledSeconds", 0.0))
            number = round(from_s / INTERVAL_S)
            here = slowed[number] if number < len(slowed) else {}
            share, stopped_s = here.get(element.attrib["id"], (1.0, 0.0))
            lost_s = float(element.get("timeLoss", 0.0))
            flow = FlowSums(
                time_s=time_s,
                lost_s=lost_s + (1 - share) * max(0.0, time_s - lost_s - stopped_s),
                standing_s=float(element.get("waitingTime", 0.0)),
                distance_m=time_s * float(element.get("speed", 0.0)),
            )
            yield EdgeFlow(element.attrib["id"], from_s, flow)


def class_in(network: Network) -> Callable[[str], str]:
    """What gives the class of an edge's road."""

    def of(edge: str) -> str:
        if edge.startswith(":"):
            return JUNCTIONS
        found = network.edges.get(edge)
        return OTHER if found is None else found.road_class or UNKNOWN

    return of


def cells(
    flows: Sequence[EdgeFlow], queues: Sequence[Sequence[Mapping[str, float]]], of: Callable[[str], str]
) -> tuple[FlowCell, ...]:
    """The flows and the queues of every interval (``FlowSummary.queues``), by class of road and five minutes."""
    sums: dict[tuple[float, str], FlowSums] = defaultdict(FlowSums)
    for each in flows:
        sums[each.from_s // EPOCH_S * EPOCH_S, of(each.edge)] += each.flow
    total_m: dict[tuple[float, str], float] = defaultdict(float)
    longest_m: dict[tuple[float, str], float] = defaultdict(float)
    for number, interval in enumerate(queues):
        for lane, length_m in (each for lanes in interval for each in lanes.items()):
            key = number * INTERVAL_S // EPOCH_S * EPOCH_S, of(lane.rpartition("_")[0])
            total_m[key] += length_m
            longest_m[key] = max(longest_m[key], length_m)
    samples = EPOCH_S / QUEUE_PERIOD_S
    return tuple(
        FlowCell(
            from_s=from_s,
            road_class=road_class,
            flow=rounded(flow),
            queue_m=round(total_m[from_s, road_class] / samples, 1),
            longest_m=round(longest_m[from_s, road_class], 1),
        )
        for (from_s, road_class), flow in sorted(sums.items())
    )


def rounded(flow: FlowSums) -> FlowSums:
    """A flow as it is stored."""
    return FlowSums(
        time_s=round(flow.time_s, 2),
        lost_s=round(flow.lost_s, 2),
        standing_s=round(flow.standing_s, 2),
        distance_m=round(flow.distance_m, 1),
    )


def write_edges(folder: Path, job: str, measured: Sequence[Sequence[EdgeFlow]]) -> None:
    """Writes the flows of a seed, those without an intervention first, without the inside of junctions.

    Raises OSError: it cannot be written."""
    lines = (
        (intervention, each.edge, f"{each.from_s:g}", flow.time_s, flow.lost_s, flow.distance_m)
        for intervention, flows in enumerate(measured)
        for each in flows
        if not each.edge.startswith(":") and (flow := rounded(each.flow))
    )
    write_packed_csv(folder / f"{job}.csv.gz", COLUMNS, lines)


def read_edges(path: Path) -> Iterator[EdgeRow]:
    """What ``write_edges`` wrote; nothing if the file is not there."""
    for row in read_packed_csv(path):
        yield EdgeRow(
            intervention=int(row["intervention"]),
            edge=row["edge"],
            from_s=float(row["from_s"]),
            time_s=float(row["time_s"]),
            lost_s=float(row["lost_s"]),
            distance_m=float(row["distance_m"]),
        )
