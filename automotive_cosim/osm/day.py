"""An imported scenario with a day of traffic, scaled by the hour until one road matches its counts.

This is no calibration: it matches one road, and nothing is known of all others. ``fit`` explains how.
"""

from __future__ import annotations

import json
import shutil
import xml.etree.ElementTree as ET
from dataclasses import asdict, dataclass
from pathlib import Path
from zoneinfo import ZoneInfo

from automotive_cosim.contracts import Tell
from automotive_cosim.errors import CountsError, ScenarioError, UnknownNameError
from automotive_cosim.formats.checked import checked
from automotive_cosim.formats.files import opened, read_json
from automotive_cosim.formats.toml import dotted
from automotive_cosim.osm import folder
from automotive_cosim.osm.counts import read_counts
from automotive_cosim.osm.demand import fastest_ways, write
from automotive_cosim.osm.fit import HOUR_S, WARM_UP_S, WHOLE_DAY, Hour, fit, make_demand
from automotive_cosim.scenarios import Scenario, Sumo, load
from automotive_cosim.traffic.network import Edge, Network, quantity, read_network
from automotive_cosim.traffic.options import Configuration, read_configuration

STEP_S = 1.0
"""Step length of the day's simulation and of the resulting scenario: its figures hold for no other."""

DAY_FILE, TRIPS = "day.json", "day.trips.xml.gz"

NO_CALIBRATION = (
    "The demand is scaled to the counts of one road. This is no calibration: the flows on other roads, and where"
    " vehicles come from and go to, are as random as before."
)


@dataclass(frozen=True, slots=True)
class DayOptions:
    """The user's options."""

    edge: str
    """The counted road: an edge, or the number of the OpenStreetMap way of all its edges."""
    arc: str = ""
    """Which detector of the counts' file; required if it has several."""
    at_hour: int = 8
    """When the ego departs, 1 to 23, local time."""
    background: float | None = None
    """Traffic that does not pass the counted road, in the busiest hour, as a share of the import's; None takes the
    rest beside the counted traffic."""
    days: int = 4
    """Maximum number of days to simulate."""
    minutes: float = 60.0
    """Minutes of each hour to simulate, 5 to 60: fewer are faster and noisier."""
    seed: int = 0
    """Seed of departures and of SUMO."""
    replace: bool = False
    """Whether to replace an existing scenario folder."""


@dataclass(frozen=True, slots=True)
class Day:
    """The result; ``day.json`` in the scenario's folder."""

    scenario: str
    source: str
    """Name of the scenario that was scaled."""
    counts: str
    """A description of the source of the counts."""
    edges: tuple[str, ...]
    """The counted edges."""
    road: str
    """Name of the road."""
    routes: int
    """Number of different trips of the import that pass there, which the day repeats."""
    background: float
    """Other traffic in the busiest hour, as a share of the import's."""
    minutes: float
    """Minutes simulated of each hour."""
    seed: int
    met: tuple[int, ...]
    """Hours with a GEH below 5 in each simulated day; the best day is the scenario."""
    hours: tuple[Hour, ...]

    @property
    def hours_met(self) -> int:
        """Number of hours with a GEH below 5."""
        return sum(each.is_met for each in self.hours)

    def write(self, target: Path) -> None:
        """Writes the result as JSON."""
        target.write_text(json.dumps(asdict(self), indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


def read_day(scenario_folder: Path) -> Day:
    """Reads a scenario folder's ``day.json``.

    Raises:
        ScenarioError: there is none, or it is invalid.
    """
    path = scenario_folder / DAY_FILE
    try:
        table = read_json(path)
    except (OSError, ValueError) as error:
        raise ScenarioError(f"{path} is not what `automotive-cosim scenarios day` writes: {error}") from error
    return checked(Day, table, lambda steps: (f"{path} of `scenarios day`", dotted(steps)), ScenarioError)


def make_day(
    source: Path, counts_file: Path, out: Path, options: DayOptions, on_progress: Tell | None = None
) -> Day:
    """Makes a scenario with a day of traffic from an imported one.

    Args:
        source: a folder made by ``import_map``; it is only read.
        counts_file: hourly counts, see ``counts``.
        out: the folder to create, completely or not at all.
        options: the user's options.
        on_progress: called with the current activity.

    Raises:
        CountsError: the counts cannot be used, or no trip passes the counted road.
        UnknownNameError: the network has no such edge.
        ScenarioError: ``source`` is not an imported scenario.
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
        tell("routing the trips", None)
        trips = _read_trips(configuration, network)
        ends = [(start, goal) for _, start, goal in trips]
        ways = [way for way in fastest_ways(ends, network, configuration.net, building.parent) if way]
        per_h = len(ways) / max(depart_s for depart_s, _, _ in trips) * HOUR_S * scenario.sumo.scale
        demand = make_demand(ways, per_h, counted, counts, background=options.background, seed=options.seed)
        if not demand.passing:
            raise CountsError(
                f"none of the {len(ways)} trips of {source} passes {options.edge} on its fastest route, so none"
                " can be repeated; count another road, or import with a higher --density"
            )
        made = _write(building, scenario, configuration.net, options)
        fitted = fit(
            made,
            building / TRIPS,
            demand,
            days=options.days,
            minutes=options.minutes,
            scratch=building.parent,
            tell=tell,
        )
        write(demand.journeys(fitted.sent, WHOLE_DAY), building / TRIPS)
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
            met=fitted.met,
            hours=fitted.hours,
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
        with opened(file) as stream:
            found = [
                (
                    quantity(trip.get("depart", "")),
                    network.edges[trip.get("from", "")],
                    network.edges[trip.get("to", "")],
                )
                for trip in ET.parse(stream).iter("trip")
            ]
    except (OSError, ET.ParseError, ValueError, KeyError) as error:
        raise ScenarioError(f"the trips of {configuration.path} cannot be read: {error}") from error
    if not any(depart_s > 0 for depart_s, _, _ in found):
        raise ScenarioError(
            f"{configuration.path} has no trips; give a folder that `automotive-cosim scenarios import` made"
        )
    return found


def _write(building: Path, source: Scenario, net: Path, options: DayOptions) -> Scenario:
    """Writes the scenario's own files except its trips."""
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


def _write_readme(target: Path, day: Day, title: str) -> None:
    text = [
        f"# {title}",
        "",
        f"{folder.ATTRIBUTION}: <{folder.COPYRIGHT_PAGE}>.",
        "The network in this folder is derived from it and stays under that licence. The demand is derived from",
        f"traffic counts ({day.counts}), whose licence applies to it.",
        "",
        f"Made from `{day.source}` by `automotive-cosim scenarios day`; `{DAY_FILE}` has the figures.",
        NO_CALIBRATION,
        "",
        "Seconds of the simulation are seconds after local midnight. To depart at another hour, change `start` in",
        "`scenario.toml`, and `begin` in the `.sumocfg` to that hour minus the warm-up.",
        "",
    ]
    target.write_text("\n".join(text), encoding="utf-8")
