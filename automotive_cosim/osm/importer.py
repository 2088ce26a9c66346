"""Turns a map file into a scenario's folder; after an error, nothing is left."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from automotive_cosim.contracts import Tell
from automotive_cosim.errors import ImportMapError
from automotive_cosim.geo.place import Place, shipped
from automotive_cosim.osm import demand, extract, folder, network, trips
from automotive_cosim.osm.area import Area
from automotive_cosim.osm.country import country_codes
from automotive_cosim.osm.report import ImportReport, make_report
from automotive_cosim.osm.roads import describe
from automotive_cosim.scenarios import Scenario, Sumo, Trip, load
from automotive_cosim.traffic.stability import HALTED_SHARE_LIMIT, Stability, measure

DEMAND_S = 7200.0
"""Traffic departs for two hours: the warm-up, an hour, and a margin."""

HALTED_SHARE_AIM = 0.8 * HALTED_SHARE_LIMIT
"""The search is stricter than the check, because other seeds and step lengths may do a little worse."""

SCALE_STEP = 0.8
SCALE_MIN = 0.05
"""The demand is repeatedly lowered to four fifths until it flows, at most to a twentieth."""

QUICK_STEP_S = 1.0
"""The search starts with steps this long: five times as fast as 0.1 s, and nearly as strict."""

FULL_PER_KM = 1000 / 7.5
"""Cars that fit on a kilometre of lane: SUMO's default length of 5 m and gap of 2.5 m."""


@dataclass(frozen=True, slots=True)
class ImportOptions:
    """The user's options."""

    name: str = ""
    """Name of the scenario; empty takes the file's."""
    country: str = ""
    """ISO 3166-1 code; empty takes it from the map's position."""
    area: Area | None = None
    """The part of the map to use; None for all of it."""
    density_per_km: float = 1.0
    """Vehicles per kilometre of lane at a time if all drove freely, before scaling down."""
    seed: int = 0
    """Seed of the traffic and the ego trips."""
    stable_for_s: float = 3600.0
    """Traffic must flow this long after the warm-up."""
    replace: bool = False
    """Whether to replace an existing scenario folder."""


def scenario_name(source: Path) -> str:
    """A scenario's name from its extract's file name: lower case, without suffixes."""
    return trips.slug(re.sub(r"(\.(osm|pbf|xml|json|gz|bz2))+$", "", source.name)).replace("-", "_") or "map"


def import_map(
    source: Path, out: Path, options: ImportOptions | None = None, on_progress: Tell | None = None
) -> ImportReport:
    """Turns an OSM extract into a scenario folder that ``scenarios.load`` accepts.

    The same extract, options and SUMO give the same files.

    Args:
        source: ``.osm``, ``.osm.gz``, ``.osm.bz2``, ``.osm.pbf`` or Overpass JSON, whatever it is called.
        out: the folder to create, completely or not at all.
        options: the user's options.
        on_progress: called with the current activity.

    Raises:
        ImportMapError: the extract or an option cannot be used, or ``out`` cannot be written.
        SetupError: eclipse-sumo or osmium is not installed.
    """
    options = options or ImportOptions()
    options = replace(options, name=options.name or scenario_name(source), country=options.country.upper())
    _check(options)
    tell = on_progress or (lambda _stage, _share: None)
    with folder.appearing(out, replaces=options.replace) as building:
        tell("reading the map", None)
        mapped = extract.read(source)
        if options.area is not None:
            mapped = mapped.crop(options.area)
        atlas = shipped()
        place = atlas.place(*mapped.centre)
        options = replace(options, country=options.country or place.country)
        tell("building the network", None)
        roads = describe(mapped, atlas, options.country)
        net = building / f"{options.name}.net.xml.gz"
        built = network.convert(mapped, roads, net, options.country, building.parent)
        tell("drawing trips", None)
        rng = np.random.default_rng(options.seed)
        journeys = demand.draw(
            built,
            net,
            scratch=building.parent,
            density_per_km=options.density_per_km,
            duration_s=DEMAND_S,
            rng=rng,
        )
        demand.write(journeys, building / f"{options.name}.trips.xml.gz")
        ways = trips.pick(journeys, rng)
        flow = _find_scale(_write(building, options, place, ways, scale=1.0), options, tell)
        _write(building, options, place, ways, scale=flow.scale)
        report = make_report(
            source,
            mapped,
            roads,
            built,
            flow,
            country=options.country,
            area=options.area,
            density_per_km=options.density_per_km,
            seed=options.seed,
            demand_per_hour=len(journeys) * 3600 / DEMAND_S,
        )
        report.write(building / "import.json")
        folder.write_readme(building / "README.md", title=_title(options), source=source.name, lines=report.guessed)
    return report


def _check(options: ImportOptions) -> None:
    if not re.fullmatch(r"\w[\w.-]*", options.name):
        raise ImportMapError(f"{options.name!r} is not a valid scenario name; use letters, digits, - and _")
    if options.country and options.country not in country_codes():
        raise ImportMapError(f"country {options.country!r} is not an ISO 3166-1 code; give two letters such as FR")
    for what, value in (("density", options.density_per_km), ("duration", options.stable_for_s)):
        if not 0 < value < math.inf:
            raise ImportMapError(f"a {what} of {value:g} is impossible; give a number above zero")
    if options.density_per_km > FULL_PER_KM:
        raise ImportMapError(
            f"a density of {options.density_per_km:g} vehicles per km of lane is impossible: standing bumper to "
            f"bumper they are {FULL_PER_KM:.0f}; give a number such as 1"
        )
    if options.seed < 0:
        raise ImportMapError(f"seed {options.seed} is below zero; give a whole number from 0")


def _title(options: ImportOptions) -> str:
    return options.name.replace("_", " ").replace("-", " ").capitalize()


def _write(building: Path, options: ImportOptions, place: Place, ways: Sequence[Trip], *, scale: float) -> Scenario:
    """Writes the scenario's own files and reads them back."""
    sumo = Sumo(config=f"{options.name}.sumocfg", scale=scale)
    folder.write_config(building / sumo.config, f"{options.name}.net.xml.gz", f"{options.name}.trips.xml.gz", sumo)
    folder.write_scenario(
        building / "scenario.toml",
        name=options.name,
        title=_title(options),
        about=f"Imported from OpenStreetMap. {folder.ATTRIBUTION}.",
        country=options.country,
        time_zone=place.time_zone,
        sumo=sumo,
        trips=ways,
    )
    return load(building)


def _find_scale(scenario: Scenario, options: ImportOptions, tell: Tell) -> Stability:
    """Scales the traffic down until it flows, first with long steps, then with the scenario's own."""
    quick = _lower_until_it_flows(scenario, 1.0, QUICK_STEP_S, options, tell)
    return _lower_until_it_flows(scenario, quick.scale, scenario.sumo.step_length_s, options, tell)


def _lower_until_it_flows(
    scenario: Scenario, scale: float, step_length_s: float, options: ImportOptions, tell: Tell
) -> Stability:
    while True:
        run = measure(
            scenario,
            observe_s=options.stable_for_s,
            scale=scale,
            seed=options.seed,
            step_length_s=step_length_s,
            stop_at=HALTED_SHARE_AIM,
            on_progress=partial(tell, f"traffic at scale {scale:g}, in steps of {step_length_s:g} s"),
        )
        if run.stable and run.halted_share_max < HALTED_SHARE_AIM:
            return run
        if scale * SCALE_STEP < SCALE_MIN:
            why = "; ".join(run.problems) or f"{run.halted_share_max:.0%} halted in the worst minute"
            raise ImportMapError(
                f"traffic on this map locks up even at a scale of {scale:g} ({why});"
                " give a larger extract or a lower --density"
            )
        scale = round(scale * SCALE_STEP, 3)
