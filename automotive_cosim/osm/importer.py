"""Turns a map file into a scenario's folder; after an error, nothing is left."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from automotive_cosim.contracts import Tell
from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import UserError
from automotive_cosim.geo.place import Place, shipped
from automotive_cosim.osm import demand, extract, folder, land_cover, network, trips
from automotive_cosim.osm.country import country_codes
from automotive_cosim.osm.demand import Demand, Journey
from automotive_cosim.osm.doubts import shortened
from automotive_cosim.osm.report import ImportReport, make_report
from automotive_cosim.osm.roads import describe, on_one_side
from automotive_cosim.osm.settings import ImportOptions
from automotive_cosim.scenarios import Scenario, Sumo, Trip, load
from automotive_cosim.traffic.stability import HALTED_SHARE_LIMIT, Stability, Stuck, measure

DEMAND_S = 7200.0
"""Traffic departs for two hours: the warm-up, an hour, and a margin."""

HALTED_SHARE_AIM = 0.8 * HALTED_SHARE_LIMIT
"""The search is stricter than the check, because other seeds and step lengths may do a little worse."""

SCALE_MIN = 0.05
"""The demand is lowered at most to a twentieth."""

SCALE_STEPS = (0.4, 0.8)
"""A trial that fails lowers the demand by a factor between these: the more it jammed, the more."""

TRIALS = 8
"""Maximum number of trials with long steps, and with the scenario's own."""

TRIAL_STEP_S = 1.0
"""The search starts with steps this long: nearly as strict as 0.1 s, and faster."""

SHORT_TRIAL_S = 600.0
"""Traffic that flowed for all of the time with long steps must flow this long with the scenario's own, and in a
quick import with long ones; locked junctions show within minutes."""

QUICK_DENSITY = 0.5
"""Share of the requested density with which a quick import starts."""

STUCK_SHARE_MAX = 0.01
"""Trips that stood for good in a trial that flowed otherwise are left out, up to this share of all."""

HALF_TURN_DEG = 180.0
"""A map as wide as this reaches over the 180th meridian."""

FULL_PER_KM = 1000 / 7.5
"""Cars that fit on a kilometre of lane: SUMO's default length of 5 m and gap of 2.5 m."""


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

    Raises:
        UserError: the extract or an option cannot be used, or ``out`` cannot be written.
        SetupError: eclipse-sumo or osmium is not installed.
    """
    options = options or ImportOptions()
    options = replace(options, name=options.name or scenario_name(source), country=options.country.upper())
    _check(options)
    tell = on_progress or (lambda _stage, _share: None)
    with folder.appearing(out, replaces=options.replaces) as building:
        tell("reading the map", None)
        mapped = extract.read(source)
        if options.area is not None:
            mapped = mapped.crop(options.area)
        west, _, east, _ = mapped.bounds
        if east - west > HALF_TURN_DEG:
            raise UserError(
                f"{source} has roads on both sides of the 180th meridian, which no SUMO network can; give one: "
                "--bbox 0,-90,180,90 or --bbox=-180,-90,0,90"
            )
        atlas = shipped()
        place = atlas.place(*mapped.centre)
        options = replace(options, country=options.country or place.country)
        mapped = on_one_side(mapped, atlas, options.country)
        place = atlas.place(*mapped.centre)
        tell(f"reading the limits of {counted(len(mapped.ways), 'road')}", None)
        roads = describe(mapped, atlas, options.country)
        tell("building the network", None)
        net = building / f"{options.name}.net.xml.gz"
        built = network.convert(mapped, roads, net, options.country, building.parent, tell)
        tell("drawing the ground around it", None)
        around = land_cover.draw(mapped.ground, built.network.map)
        if around.areas:
            land_cover.write(around.areas, building / _ground(options))
        tell("drawing trips", None)
        rng = np.random.default_rng(options.seed)
        drawn = demand.draw(
            built,
            net,
            scratch=building.parent,
            density_per_km=options.density_per_km,
            duration_s=DEMAND_S,
            rng=rng,
        )
        flow, journeys, stuck = _Search(building, options, place, drawn, rng, tell, edges=len(built.edges)).run()
        tell("comparing the network with the map", None)
        report = make_report(
            source,
            mapped,
            roads,
            built,
            around,
            flow,
            country=options.country,
            area=options.area,
            density_per_km=options.density_per_km,
            seed=options.seed,
            demand_per_hour=len(journeys) * 3600 / DEMAND_S,
            stuck=stuck,
            quick=options.quick,
        )
        report.write(building / "import.json")
        lines = list(map(shortened, report.guessed))
        folder.write_readme(building / "README.md", title=_title(options), source=source.name, lines=lines)
    return report


def _check(options: ImportOptions) -> None:
    if not re.fullmatch(r"\w[\w.-]*", options.name):
        raise UserError(f"{options.name!r} is not a valid scenario name; use letters, digits, - and _")
    if options.country and options.country not in country_codes():
        raise UserError(f"country {options.country!r} is not an ISO 3166-1 code; give two letters such as FR")
    for what, value in (("density", options.density_per_km), ("duration", options.stable_for_min)):
        if not 0 < value < math.inf:
            raise UserError(f"a {what} of {value:g} is impossible; give a number above zero")
    if options.density_per_km > FULL_PER_KM:
        raise UserError(
            f"a density of {options.density_per_km:g} vehicles per km of lane is impossible: at most "
            f"{FULL_PER_KM:.0f} fit, bumper to bumper; give a number such as 1"
        )
    if options.seed < 0:
        raise UserError(f"seed {options.seed} is below zero; give a whole number from 0")


def _ground(options: ImportOptions) -> str:
    """Name of the file with water, green and buildings."""
    return f"{options.name}.poly.xml.gz"


def _title(options: ImportOptions) -> str:
    words = options.name.replace("_", " ").replace("-", " ").split()
    return " ".join(word[:1].upper() + word[1:] for word in words)


def _write(
    building: Path, options: ImportOptions, place: Place, ways: Sequence[Trip], *, scale: float, edges: int
) -> Scenario:
    """Writes the scenario's own files and reads them back."""
    sumo = Sumo(config=f"{options.name}.sumocfg", scale=scale)
    folder.write_config(
        building / sumo.config,
        f"{options.name}.net.xml.gz",
        f"{options.name}.trips.xml.gz",
        sumo,
        ground=_ground(options) if (building / _ground(options)).exists() else "",
        edges=edges,
    )
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


class _Search:
    """Finds traffic that flows, from above: first with long steps, then with the scenario's own."""

    def __init__(
        self,
        building: Path,
        options: ImportOptions,
        place: Place,
        drawn: Demand,
        rng: np.random.Generator,
        tell: Tell,
        *,
        edges: int,
    ) -> None:
        self._building = building
        self._options = options
        self._place = place
        self._journeys = list(drawn.journeys)
        self._most_stuck = math.ceil(STUCK_SHARE_MAX * len(drawn.journeys))
        self._ways = trips.pick(drawn.routes, rng)
        self._tell = tell
        self._edges = edges
        self._stuck: list[Stuck] = []

    def run(self) -> tuple[Stability, Sequence[Journey], tuple[Stuck, ...]]:
        """Writes the scenario.

        Returns:
            The figures of the last trial, the trips that drive, and what stood for good in a trial.

        Raises UserError: no traffic flows."""
        self._write_demand()
        scale = QUICK_DENSITY if self._options.quick else 1.0
        whole_s = 60 * self._options.stable_for_min
        short_s = min(SHORT_TRIAL_S, whole_s)
        flow = self._until_it_flows(scale, TRIAL_STEP_S, short_s if self._options.quick else whole_s)
        if not self._options.quick:
            own_s = self._scenario(flow.scale).sumo.step_length_s
            flow = self._until_it_flows(flow.scale, own_s, short_s)
        self._scenario(flow.scale)
        return flow, self._journeys, tuple(self._stuck)

    def _until_it_flows(self, scale: float, step_length_s: float, observe_s: float) -> Stability:
        for trials_left in reversed(range(TRIALS)):
            what = (
                f"testing whether traffic flows at scale {scale:g}, in steps of {step_length_s:g} s, after its "
                f"warm-up for {observe_s / 60:.0f} min"
            )
            self._tell(what, 0.0)
            run = measure(
                self._scenario(scale),
                observe_s=observe_s,
                scale=scale,
                seed=self._options.seed,
                step_length_s=step_length_s,
                stop_at=HALTED_SHARE_AIM,
                on_progress=partial(self._tell, what),
            )
            if run.stable and run.halted_share_max < HALTED_SHARE_AIM:
                return run
            self._tell(f"scale {scale:g} does not flow: {_why(run)}", None)
            rest_flows = run.halted_share_max < HALTED_SHARE_AIM and self._left_out(run)
            if not trials_left or (scale <= SCALE_MIN and not rest_flows):
                raise UserError(
                    f"traffic on this map locks up even at a scale of {scale:g} ({_why(run)});"
                    " give a larger extract or a lower --density"
                )
            if not rest_flows:
                factor = HALTED_SHARE_AIM / max(run.halted_share_max, HALTED_SHARE_AIM)
                scale = round(max(SCALE_MIN, scale * min(max(factor, SCALE_STEPS[0]), SCALE_STEPS[1])), 3)
        raise AssertionError("the last try returns or raises")

    def _left_out(self, run: Stability) -> bool:
        """Whether trips that stood for good where the rest flowed could be left out."""
        numbers = {int(each.vehicle) for each in run.stuck if each.vehicle.isdecimal()}
        if not numbers or len(self._stuck) + len(numbers) > self._most_stuck:
            return False
        self._stuck += run.stuck
        self._journeys = [journey for number, journey in enumerate(self._journeys) if number not in numbers]
        self._write_demand()
        return True

    def _write_demand(self) -> None:
        demand.write(self._journeys, self._building / f"{self._options.name}.trips.xml.gz")

    def _scenario(self, scale: float) -> Scenario:
        return _write(self._building, self._options, self._place, self._ways, scale=scale, edges=self._edges)


def _why(run: Stability) -> str:
    """Why a trial failed, with the lanes on which vehicles stood for good."""
    problems = "; ".join(run.problems) or f"{run.halted_share_max:.0%} halted in the worst minute"
    lanes = sorted({each.lane for each in run.stuck})
    return f"{problems}; they stood on {', '.join(lanes[:3])}{', …' * (len(lanes) > 3)}" if lanes else problems
