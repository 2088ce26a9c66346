"""Any SUMO scenario, run as it is: the settings of a ``scenario.toml`` are taken from its own files.

Its folder is only read. What its files do not say is assumed and stated in ``Scenario.notes``.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from functools import lru_cache
from pathlib import Path

from automotive_cosim.contracts import Weather
from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats.scenario import Ego, Scenario, Sumo, WeatherAt
from automotive_cosim.formats.words import shown
from automotive_cosim.geo.place import NOWHERE, Atlas, Place
from automotive_cosim.scenarios.relocation import zone_of
from automotive_cosim.scenarios.routes import drawn_trips
from automotive_cosim.traffic.additional import read_mapped
from automotive_cosim.traffic.file_check import vet
from automotive_cosim.traffic.georeference import middle
from automotive_cosim.traffic.keeper import read_once
from automotive_cosim.traffic.network import FORM, Network, NetworkReader, make_known
from automotive_cosim.traffic.options import (
    INPUTS,
    INTERNAL,
    QUIET,
    REROUTING,
    SUMO_STEP_S,
    Configuration,
    read_configuration,
    stamp,
    stated_and_set,
)
from automotive_cosim.traffic.random_traffic import vehicles_per_hour
from automotive_cosim.traffic.sumo import VERSION

DAY = datetime(2026, 6, 16)
"""A Tuesday in June; SUMO's files have no date."""

DEPARTURE = timedelta(hours=10)
"""Time of day if the simulation begins at 0, which is not meant as a time of day."""

WARM_UP_S = 600.0

DRAWN_STEP_S, LONGEST_STEP_S = 0.1, 1.0
"""Step length of traffic that is drawn for a network, and the longest that is kept: the cockpit is updated once per
second."""

RANDOM_PER_KM_H = 15.0
"""Light traffic: at 40 km/h, one vehicle per 2 to 3 km of lane for each kilometre of its route."""

FAIR = Weather(20.0, 55.0, 0.0, 1, 25.0, 20_000.0, 10.0)
"""The weather if the place, and so the climate, is unknown."""

DIFFERS = "so figures differ from SUMO's"
"""In a note about what cannot be kept; ``difference`` measures its size."""

TRAVELLERS = frozenset(["vehicle", "trip", "flow"])
"""Elements of an additional file that are traffic."""


def foreign_scenario(path: Path, *, to_be_moved: bool = False) -> Scenario:
    """A ``.sumocfg`` or a network as a scenario.

    Time of day, step length, scale and rerouting come from the files, the country from the network's position, and
    the ego's routes are drawn.

    Args:
        to_be_moved: whether the network is moved to another place afterwards, so it need not have one.

    Raises ScenarioError: the files are missing or invalid, or no two roads are connected."""
    configuration = read_configuration(path)
    if configuration.files.keys() == {"net-file"}:
        return _as_it_is(path, to_be_moved, stamp(configuration))
    return _read(path, configuration, to_be_moved=to_be_moved)  # what its other files name may have changed


@lru_cache(maxsize=8)
def _as_it_is(path: Path, to_be_moved: bool, files: tuple[object, ...]) -> Scenario:
    """As ``foreign_scenario``, of a network alone; kept while it is as it is, for to read a city takes seconds."""
    configuration = read_configuration(path)
    if not to_be_moved:
        return read_once(
            "scenario",
            {path.absolute(), configuration.net.absolute()},
            lambda: _read(path, configuration, to_be_moved=to_be_moved),
        )
    return _read(path, configuration, to_be_moved=to_be_moved)


def _read(path: Path, configuration: Configuration, *, to_be_moved: bool) -> Scenario:
    reader = NetworkReader(configuration.net)
    digest = vet(configuration.net, reader, FORM)
    network = reader.network()
    if digest:
        make_known(path, digest, network)
    added = _Elements()
    for name in INPUTS[1:]:
        for file in configuration.files.get(name, ()):
            vet(file, added if name == "additional-files" else None)
    network = read_mapped(configuration, network)
    place = NOWHERE if network.unplaced else Atlas().place(*middle(network.map))
    notes = []
    if network.unplaced and not to_be_moved:
        notes.append(
            f"{configuration.net.name} {network.unplaced}: it runs without GPS, place and law, in fair weather; "
            "--origin LON,LAT gives it a place"
        )
    random_per_km_h = 0.0
    if "route-files" not in configuration.files and added.names.isdisjoint(TRAVELLERS):
        random_per_km_h = RANDOM_PER_KM_H
        count = vehicles_per_hour(network, random_per_km_h)
        notes.append(f"{path.name} has no traffic of its own: {count:.0f} vehicles per hour are drawn")
    sumo = _sumo(configuration, random_per_km_h)
    notes += (*_kept_and_not(configuration, sumo, network), *added.unread)
    name = re.sub(r"\.(net\.xml|sumocfg|xml)$", "", path.name.removesuffix(".gz"))
    return Scenario(
        name=name if name != "run" else path.absolute().parent.name,
        title=f"{path.name}, run as it is",
        about=_about(network, place),
        folder=path.absolute().parent,
        country=place.country,
        start=_start(configuration, sumo, place),
        sumo=sumo,
        ego=Ego(drawn_trips(network.open_at_all_hours()), any_trip=True),
        weather=(WeatherAt(0.0, FAIR),) if network.unplaced else (),
        has_place=not network.unplaced,
        notes=tuple(notes),
        as_stated=not random_per_km_h,
    )


def _sumo(configuration: Configuration, random_per_km_h: float) -> Sumo:
    step_s = configuration.number("step-length", DRAWN_STEP_S if random_per_km_h else SUMO_STEP_S)
    if step_s <= 0:
        raise ScenarioError(f"{configuration.path}: step-length is {step_s:g} s; give a number above 0")
    # Drawn traffic in steps that are ours acts once a second. SUMO 1.28 has been seen to crash when vehicles
    # reroute and act on every other step of 0.5 s.
    ours = random_per_km_h and "step-length" not in configuration.options
    return Sumo(
        config=configuration.path.name,
        step_length_s=min(step_s, LONGEST_STEP_S),
        action_step_length_s=LONGEST_STEP_S if ours else None,
        warm_up_s=WARM_UP_S,
        scale=configuration.number("scale", 1.0, 100),
        background_rerouting=max(0.0, configuration.number(REROUTING, 0.0)),
        random_traffic_per_km_h=random_per_km_h,
    )


def _kept_and_not(configuration: Configuration, sumo: Sumo, network: Network) -> Iterator[str]:
    """What a run sets or leaves out whatever the configuration says."""
    name = configuration.path.name
    if not sumo.random_traffic_per_km_h:
        other = [
            f"{option} {value:g} instead of {stated:g}"
            for option, (stated, value) in stated_and_set(configuration, sumo).items()
            if stated != value
        ]
        hours = sum(
            bool(each.timed_limits or each.timed_access or each.timed_turns) for each in network.edges.values()
        )
        other += [f"the hours of limits and closures on {hours} edges"] * bool(hours)
        other += [f"{INTERNAL}, which is left out"] * (INTERNAL in configuration.ignored)
        but = f", but for {', '.join(other)}, {DIFFERS}" if other else ""
        yield (
            f"{name} runs as `sumo -c` runs it with the run's seed{but}; an ego is one car more from its departure "
            "on, and a drive's weather slows everybody"
        )
    yield from set_aside(configuration)
    if ignored := [option for option in configuration.ignored if option not in (*QUIET, INTERNAL)]:
        yield f"{name} runs without its {', '.join(ignored)}"


def set_aside(configuration: Configuration) -> Iterator[str]:
    """What would make SUMO work in parallel."""
    if configuration.parallel:
        named = ", ".join(configuration.parallel)
        yield f"{configuration.path.name}'s {named} set aside: what is copied works with one thread"


def _start(configuration: Configuration, sumo: Sumo, place: Place) -> datetime:
    """Time of the ego's departure: SUMO's seconds count from midnight unless they begin at 0."""
    zone = zone_of(place)
    begin_s = configuration.begin_s
    since_midnight = timedelta(seconds=begin_s % 86_400 + sumo.warm_up_s) if begin_s else DEPARTURE
    return (DAY + since_midnight).replace(tzinfo=UTC if place is NOWHERE else zone)


def _about(network: Network, place: Place) -> str:
    road_km = sum(edge.length_m for edge in network.edges.values()) / 1000
    where = ", ".join(filter(None, (place.city, place.region, place.country_name))) or "nowhere on earth"
    return f"{len(network.edges)} edges, {road_km:.1f} km of road; {where}."


class _Elements:
    """Reads which elements files have."""

    def __init__(self) -> None:
        self.names: set[str] = set()
        self.unread: list[str] = []
        """What rerouters have in files of their own, which SUMO passes over without a word."""

    def start(self, name: str, attributes: dict[str, str], depth: int) -> None:
        """Takes the start of an element."""
        self.names.add(name)
        if name == "rerouter" and (file := attributes.get("file")):
            self.unread.append(
                f"SUMO {VERSION} does not read the file {shown(file)} of rerouter {shown(attributes.get('id'))}: "
                "write its <interval> elements inside the <rerouter>"
            )
