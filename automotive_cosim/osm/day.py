"""An imported scenario with a day of traffic, scaled by the hour until one counted road carries what was counted.

This is no calibration: one road is met and nothing is known of all others. To scale all traffic until the one road
is met would lock up the network, as hardly any random trip passes there. So only the trips that pass the counted
road are repeated, as often in each hour as its count asks for, and never leave that road out when they reroute. All
others follow the counted road's profile, so that both together are in the busiest hour what the import found to
flow. A day is simulated, what was short or over is made up in proportion, and the next is simulated.
"""

from __future__ import annotations

import gzip
import json
import shutil
import xml.etree.ElementTree as ET
from collections.abc import Callable, Sequence
from contextlib import closing
from dataclasses import asdict, dataclass, replace
from functools import partial
from itertools import accumulate
from pathlib import Path
from typing import Any, NamedTuple
from xml.sax.saxutils import quoteattr
from zoneinfo import ZoneInfo

import numpy as np

from automotive_cosim.errors import CountsError, ScenarioError, UnknownNameError
from automotive_cosim.osm import folder
from automotive_cosim.osm.counts import GOOD_GEH, HOURS, Counts, geh, read_counts
from automotive_cosim.osm.demand import Journey, fastest_ways, write
from automotive_cosim.scenarios import Scenario, Sumo, load
from automotive_cosim.stability import Step, summary
from automotive_cosim.traffic.network import Edge, Network, read_network
from automotive_cosim.traffic.options import Configuration, Setup, command_line, read_configuration

HOUR_S = 3600.0

STEP_S = 1.0
"""Of the day's simulation, and of the scenario that comes of it: its figures hold for no other."""

WARM_UP_S = 900.0
"""Traffic before the ego departs."""

ENOUGH_GEH = 2.0
"""No further day is simulated once every hour is this near; other seeds will do a little worse."""

CHANGE_MAX = 2.0
"""An hour's trips are at most doubled or halved from one day to the next, and never more than twice what was
counted: a road that carries no more when more is sent there is full, and what is sent stands on other roads."""

LOOK_EVERY_S = 1.0
"""How often it is looked how many vehicles stand; SUMO's lines are its signs of life too, and come in bunches."""

DAY_FILE, TRIPS = "day.json", "day.trips.xml.gz"

NO_CALIBRATION = (
    "The demand is scaled to the counts of one road. That is no calibration: what other roads carry, and where"
    " anybody comes from or goes to, is as random as before."
)

Progress = Callable[[str, float | None], None]
"""Told what is being done, and the share of it that is done where that is known."""


@dataclass(frozen=True, slots=True)
class DayOptions:
    """What the user may choose."""

    edge: str
    """The counted road: an edge, or the number of the OpenStreetMap way that all its edges are of."""
    arc: str = ""
    """Which detector of the counts' file; needed if it has several."""
    at_hour: int = 8
    """When the ego departs, 1 to 23, local time."""
    background: float | None = None
    """Traffic that does not pass the counted road, in the busiest hour, as a share of the import's; None takes what
    the traffic past the road leaves of the import's."""
    days: int = 4
    """Simulated at most."""
    minutes: float = 60.0
    """Simulated of each hour, 5 to 60: fewer are faster, and their figures noisier."""
    seed: int = 0
    """Of departures, and of SUMO."""
    replace: bool = False
    """An existing scenario folder may be replaced."""


@dataclass(frozen=True, slots=True)
class Hour:
    """One local hour of the counted road, and of the network around it."""

    hour: int
    counted_per_h: float
    simulated_per_h: float
    """Distance driven on the counted edges over their length: vehicles per hour, also on several edges."""
    geh: float
    counted_occupancy: float | None
    """Share of time with a vehicle over the detector; None if the counts do not tell."""
    simulated_occupancy: float
    """Share of the counted edges' lanes that is under vehicles, mean of the hour. The detector's share of time is
    somewhat higher, as a vehicle leaves it only with its tail."""
    passing: int
    """Trips made to pass the counted road."""
    background: int
    """Other trips."""
    running: float
    """Vehicles in the network, mean."""
    halted_share: float
    """Of those."""
    teleports: int
    """Vehicles that SUMO moved on after standing for 300 s, or that were stuck otherwise."""

    @property
    def is_met(self) -> bool:
        """The flow is within a GEH of 5."""
        return self.geh < GOOD_GEH


@dataclass(frozen=True, slots=True)
class Day:
    """What came of it; ``day.json`` in the scenario's folder."""

    scenario: str
    source: str
    """Name of the scenario that was scaled."""
    counts: str
    """Where the counts are from, in words."""
    edges: tuple[str, ...]
    """The counted ones."""
    road: str
    """Their name."""
    routes: int
    """Different trips of the import that pass there, which the day repeats."""
    background: float
    """Other traffic in the busiest hour, as a share of the import's."""
    minutes: float
    """Simulated of each hour."""
    seed: int
    met: tuple[int, ...]
    """Hours with a GEH below 5, in each simulated day; the best of them is the scenario."""
    hours: tuple[Hour, ...]

    @property
    def hours_met(self) -> int:
        """Hours with a GEH below 5."""
        return sum(each.is_met for each in self.hours)

    def write(self, target: Path) -> None:
        """Writes it as JSON."""
        target.write_text(json.dumps(asdict(self), indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


def read_day(scenario_folder: Path) -> Day:
    """Reads a scenario folder's ``day.json``.

    Raises:
        ScenarioError: there is none, or it is broken.
    """
    path = scenario_folder / DAY_FILE
    try:
        table: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        edges, met = tuple(table.pop("edges")), tuple(table.pop("met"))
        hours = tuple(Hour(**each) for each in table.pop("hours"))
        return Day(edges=edges, met=met, hours=hours, **table)
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise ScenarioError(f"{path} is not what `automotive-cosim scenarios day` writes: {error}") from error


def make_day(
    source: Path, counts_file: Path, out: Path, options: DayOptions, on_progress: Progress | None = None
) -> Day:
    """Makes a scenario of a day from an imported one.

    Args:
        source: folder that ``import_map`` made; only read.
        counts_file: hourly counts, see ``counts``.
        out: the folder to be made; appears whole or not at all.
        options: what the user chose.
        on_progress: told what is being done.

    Raises:
        CountsError: the counts cannot be used, or no trip passes the counted road.
        UnknownNameError: the network has no such edge.
        ScenarioError: ``source`` is no imported scenario.
        ImportMapError: ``out`` cannot be written.
        SetupError: eclipse-sumo is not installed.
    """
    tell = on_progress or (lambda _stage, _share: None)
    scenario = load(source)
    zone = scenario.start.tzinfo
    assert isinstance(zone, ZoneInfo)
    counts = read_counts(counts_file, zone, options.arc)
    configuration = read_configuration(scenario.config)
    network = read_network(configuration.net)
    counted = _counted(network, options.edge)
    with folder.appearing(out, replaces=options.replace) as building:
        tell("finding the trips' ways", None)
        trips = _read_trips(configuration, network)
        ends = [(start, goal) for _, start, goal in trips]
        ways = [way for way in fastest_ways(ends, network, configuration.net, building.parent) if way]
        per_h = len(ways) / max(depart_s for depart_s, _, _ in trips) * HOUR_S * scenario.sumo.scale
        demand = _demand(ways, per_h, counted, counts, options)
        if not demand.passing:
            raise CountsError(
                f"none of the {len(ways)} trips of {source} passes {options.edge} on its fastest way, so that none"
                " can be repeated; count another road, or import with a higher --density"
            )
        made = _write(building, scenario, configuration.net, options)
        sent, met, hours = _fit(made, demand, options, building.parent, tell)
        write(demand.journeys(sent, WHOLE_DAY), building / TRIPS)
        day = Day(
            scenario=made.name,
            source=scenario.name,
            counts=counts.about,
            edges=tuple(edge.edge_id for edge in counted),
            road=counted[0].name,
            routes=len(demand.passing),
            background=demand.background,
            minutes=options.minutes,
            seed=options.seed,
            met=met,
            hours=hours,
        )
        day.write(building / DAY_FILE)
        _write_readme(building / "README.md", day, made.title)
    return day


def _counted(network: Network, wanted: str) -> tuple[Edge, ...]:
    """The edge of that name, or all those of that OpenStreetMap way."""
    edges = network.edges
    found = [edges[wanted]] if wanted in edges else [e for k, e in edges.items() if k.startswith(f"{wanted}#")]
    if not found:
        raise UnknownNameError("edge or OpenStreetMap way", wanted, edges)
    return tuple(found)


def _read_trips(configuration: Configuration, network: Network) -> list[tuple[float, Edge, Edge]]:
    """Departure, first and last edge of each trip."""
    file = Path(configuration.options.get("route-files", ""))
    try:
        with gzip.open(file) if file.suffix == ".gz" else file.open("rb") as stream:
            found = [
                (
                    float(trip.get("depart", "")),
                    network.edges[trip.get("from", "")],
                    network.edges[trip.get("to", "")],
                )
                for trip in ET.parse(stream).iter("trip")
            ]
    except (OSError, EOFError, ET.ParseError, ValueError, KeyError) as error:
        raise ScenarioError(f"the trips of {configuration.path} cannot be read: {error}") from error
    if not any(depart_s > 0 for depart_s, _, _ in found):
        raise ScenarioError(
            f"{configuration.path} has no trips; give a folder that `automotive-cosim scenarios import` made"
        )
    return found


class _Span(NamedTuple):
    """A time with the traffic of an hour."""

    hour: int
    start_s: float
    length_s: float


WHOLE_DAY = tuple(_Span(hour, hour * HOUR_S, HOUR_S) for hour in range(HOURS))


def _tried(minutes: float) -> tuple[_Span, ...]:
    """So many minutes of each hour in a row, after a warm-up with the traffic before midnight."""
    length_s = minutes * 60
    hours = (_Span(hour, WARM_UP_S + hour * length_s, length_s) for hour in range(HOURS))
    return (_Span(HOURS - 1, 0.0, WARM_UP_S), *hours)


@dataclass(frozen=True, slots=True)
class _Demand:
    """Trips that can be repeated, and how many of them an hour has."""

    passing: tuple[Journey, ...]
    """Those over the counted road; ``depart_s`` is how long before passing it they set out, as a number below 0."""
    others: tuple[Journey, ...]
    counted: tuple[Edge, ...]
    counts: Counts
    background: float
    """The others of the busiest hour, as a share of the import's."""
    others_per_h: tuple[int, ...]
    seed: int

    def journeys(self, sent: Sequence[float], spans: Sequence[_Span]) -> tuple[Journey, ...]:
        """Traffic in order of departure.

        Args:
            sent: trips over the counted road in each hour.
            spans: what of the hours is wanted, and when.
        """
        made: list[Journey] = []
        for kind, (choice, counts) in enumerate(((self.passing, sent), (self.others, self.others_per_h))):
            for number, span in enumerate(spans if choice else ()):
                # Span by span, so that one more trip in an hour leaves all the others as they are.
                seed, count = (self.seed, kind, number), round(counts[span.hour] * span.length_s / HOUR_S)
                times = np.random.default_rng((*seed, 0)).uniform(span.start_s, span.start_s + span.length_s, count)
                which = np.random.default_rng((*seed, 1)).integers(len(choice), size=count)
                made += [
                    replace(choice[index], depart_s=max(0.0, time_s + choice[index].depart_s))
                    for time_s, index in zip(times.tolist(), which.tolist(), strict=True)
                ]
        return tuple(sorted(made, key=lambda journey: journey.depart_s))


def _demand(
    ways: Sequence[tuple[Edge, ...]], per_h: float, counted: Sequence[Edge], counts: Counts, options: DayOptions
) -> _Demand:
    """``per_h``: trips that the import lets set out in an hour."""
    ids = {edge.edge_id for edge in counted}
    passing: list[Journey] = []
    others: list[Journey] = []
    for way in ways:
        first = next((place for place, edge in enumerate(way) if edge.edge_id in ids), None)
        if first is None:
            others.append(Journey(0.0, way))
        else:
            lead_s = sum(edge.length_m / edge.speed_mps for edge in way[:first])
            # SUMO strikes a via off when it is driven onto, which one that departs there never does.
            passing.append(Journey(-lead_s, way, via=way[first].edge_id if first else ""))
    busiest = max(counts.flow_per_h)
    others_per_h = per_h * len(others) / len(ways)
    background = options.background
    if background is None:
        background = round(max(0.0, per_h - busiest) / others_per_h, 2) if others else 0.0
    return _Demand(
        passing=tuple(passing),
        others=tuple(others),
        counted=tuple(counted),
        counts=counts,
        background=background,
        others_per_h=tuple(round(others_per_h * background * flow / busiest) for flow in counts.flow_per_h),
        seed=options.seed,
    )


def _write(building: Path, source: Scenario, net: Path, options: DayOptions) -> Scenario:
    """Writes the scenario's own files, all but its trips."""
    name = f"{source.name}_day"
    sumo = Sumo(
        config=f"{name}.sumocfg",
        step_length_s=STEP_S,
        warm_up_s=WARM_UP_S,
        background_rerouting=source.sumo.background_rerouting,
    )
    shutil.copyfile(net, building / net.name)
    write((), building / TRIPS)
    folder.write_config(building / sumo.config, net.name, TRIPS, sumo, begin_s=options.at_hour * HOUR_S - WARM_UP_S)
    folder.write_scenario(
        building / "scenario.toml",
        name=name,
        title=f"{source.title}: a working day",
        about=f"{source.about} Demand over 24 hours, scaled to the counts of one road: no calibration.",
        country=source.country,
        time_zone=str(source.start.tzinfo),
        sumo=sumo,
        trips=source.ego.trips,
        start=source.start.replace(hour=options.at_hour, minute=0, second=0, microsecond=0, tzinfo=None),
    )
    return load(building)


def _fit(
    made: Scenario, demand: _Demand, options: DayOptions, scratch: Path, tell: Progress
) -> tuple[tuple[float, ...], tuple[int, ...], tuple[Hour, ...]]:
    """Simulates days until the counts are met.

    Returns:
        Trips sent over the counted road in each hour of the best day, hours met in each day, and the best day's
        hours.
    """
    counted_per_h = demand.counts.flow_per_h
    sent = counted_per_h
    days: list[tuple[tuple[float, ...], tuple[Hour, ...]]] = []
    for number in range(options.days):
        stage = partial(tell, f"simulating day {number + 1} of at most {options.days}")
        hours = _drive(made, demand, sent, options.minutes, scratch, stage)
        days.append((sent, hours))
        if all(each.geh < ENOUGH_GEH for each in hours):
            break
        sent = tuple(_next(before, each) for before, each in zip(sent, hours, strict=True))
    best_sent, best_hours = max(days, key=lambda day: _quality(day[1]))
    return best_sent, tuple(sum(each.is_met for each in hours) for _, hours in days), best_hours


def _next(sent: float, hour: Hour) -> float:
    """How many trips to send in an hour, after one in which ``sent`` were."""
    if not hour.simulated_per_h:
        return min(sent * CHANGE_MAX, hour.counted_per_h * CHANGE_MAX)
    change = hour.counted_per_h / hour.simulated_per_h
    return min(sent * min(CHANGE_MAX, max(1 / CHANGE_MAX, change)), hour.counted_per_h * CHANGE_MAX)


def _quality(hours: Sequence[Hour]) -> tuple[int, float]:
    return sum(each.is_met for each in hours), -sum(each.geh for each in hours)


def _drive(
    made: Scenario,
    demand: _Demand,
    sent: Sequence[float],
    minutes: float,
    scratch: Path,
    tell: Callable[[float], None],
) -> tuple[Hour, ...]:
    """Simulates a day, or so many minutes of each hour, and looks at the counted road."""
    spans = _tried(minutes)
    length_s, end_s = spans[-1].length_s, spans[-1].start_s + spans[-1].length_s
    write(demand.journeys(sent, spans), made.folder / TRIPS)
    measured, collector = scratch / "counted.xml", scratch / "counted.add.xml"
    edges = " ".join(edge.edge_id for edge in demand.counted)
    collector.write_text(
        f'<additional><edgeData id="counted" file={quoteattr(str(measured))} edges={quoteattr(edges)}'
        f' begin="{WARM_UP_S:g}" period="{length_s:g}"/></additional>',
        encoding="utf-8",
    )
    _, *arguments = command_line(read_configuration(made.config), Setup(made, seed=demand.seed), scratch)
    options = dict(zip(arguments[::2], arguments[1::2], strict=True)) | {
        "--begin": "0",
        "--end": f"{end_s:g}",
        "--additional-files": str(collector),
        "--summary-output": "stdout",
        "--summary-output.period": f"{LOOK_EVERY_S:g}",
    }
    looks = [_Look() for _ in range(HOURS)]
    arguments = [part for option in options.items() for part in option]
    with closing(summary(made.config.name, arguments, scratch)) as steps:
        for step in steps:
            if step["time"] >= WARM_UP_S:
                looks[min(HOURS - 1, int((step["time"] - WARM_UP_S) // length_s))].add(step)
            tell(step["time"] / end_s)
    teleports = [0, *accumulate((look.teleports for look in looks), max)]
    road = _read_measured(measured, demand.counted, length_s)
    counts = demand.counts
    return tuple(
        Hour(
            hour=hour,
            counted_per_h=counts.flow_per_h[hour],
            simulated_per_h=round(flow_per_h, 1),
            geh=round(geh(flow_per_h, counts.flow_per_h[hour]), 2),
            counted_occupancy=counts.occupancy[hour] if counts.occupancy else None,
            simulated_occupancy=round(occupancy, 4),
            passing=round(sent[hour]),
            background=demand.others_per_h[hour],
            running=round(look.running / max(1, look.count), 1),
            halted_share=round(look.halting / max(1.0, look.running), 4),
            teleports=look.teleports - teleports[hour],
        )
        for hour, ((flow_per_h, occupancy), look) in enumerate(zip(road, looks, strict=True))
    )


@dataclass(slots=True)
class _Look:
    """Adds up SUMO's summary over an hour."""

    count: int = 0
    running: float = 0.0
    halting: float = 0.0
    teleports: int = 0
    """Since the day began."""

    def add(self, step: Step) -> None:
        self.count += 1
        self.running += step["running"]
        self.halting += step["halting"]
        self.teleports = int(step["teleports"])


def _read_measured(file: Path, counted: Sequence[Edge], length_s: float) -> list[tuple[float, float]]:
    """Flow (vehicles per hour) and occupancy (0 to 1) of the counted road in each interval of ``length_s``.

    The flow is Edie's: distance driven over the length of road and of time, which holds for several edges in a row.
    """
    length_m = {edge.edge_id: edge.length_m for edge in counted}
    lane_m = {edge.edge_id: edge.length_m * len(edge.lane_ids) for edge in counted}
    found: list[tuple[float, float]] = []
    for interval in ET.parse(file).iter("interval"):
        rows = {row.get("id", ""): row for row in interval.iter("edge")}
        driven_m = sum(float(row.get("sampledSeconds", 0)) * float(row.get("speed", 0)) for row in rows.values())
        covered = sum(lane_m[name] * float(row.get("occupancy", 0)) / 100 for name, row in rows.items())
        found.append((driven_m / sum(length_m.values()) * HOUR_S / length_s, covered / sum(lane_m.values())))
    return found


def _write_readme(target: Path, day: Day, title: str) -> None:
    text = [
        f"# {title}",
        "",
        f"{folder.ATTRIBUTION}: <{folder.COPYRIGHT_PAGE}>.",
        "The network in this folder is derived from it and stays under that licence. The demand is derived from",
        f"traffic counts ({day.counts}), whose licence holds for it.",
        "",
        f"Made from `{day.source}` by `automotive-cosim scenarios day`; `{DAY_FILE}` has the figures.",
        NO_CALIBRATION,
        "",
        "Seconds of the simulation are seconds after local midnight. To depart at another hour, change `start` in",
        "`scenario.toml`, and `begin` in the `.sumocfg` to that hour less the warm-up.",
        "",
    ]
    target.write_text("\n".join(text), encoding="utf-8")
