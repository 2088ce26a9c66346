"""Calibrates a scenario: counts in, a scenario out whose simulation carries them."""

from __future__ import annotations

import tempfile
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from automotive_cosim.contracts import Tell
from automotive_cosim.errors import ScenarioError, UserError
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.osm.network import entries, exits
from automotive_cosim.scenarios import Scenario, variant
from automotive_cosim.studies.calibration.capacity import read_capacity
from automotive_cosim.studies.calibration.counts import Counts, TravelTime, read_counts, read_travel_times
from automotive_cosim.studies.calibration.driving import HOUR_S, CountedTime, DrivenDemand, drive
from automotive_cosim.studies.calibration.result import RECORD, Calibration, Carried, Met, SiteHour, TimeRow, Try
from automotive_cosim.studies.calibration.search import FitRound, SearchWorld, search
from automotive_cosim.studies.calibration.settings import CalibrationOptions
from automotive_cosim.studies.calibration.sites import Mapped, map_sites
from automotive_cosim.studies.equilibrium.gap import vehicle_types
from automotive_cosim.traffic.network import read_network
from automotive_cosim.traffic.options import Copied, Setup, copied, read_configuration, run_options

ROUTES = "calibrated.rou.xml"

STEP_S = 1.0
"""Step length of the simulations: the figures hold for no other."""

FEWEST_TO_HOLD_OUT = 4
"""With fewer sites, none is held out."""

ENOUGH_GOOD, ENOUGH_TOTAL = 0.95, 0.03
"""No further round once this share of the calibrated counts has a GEH below 5 and the total is this near."""

COVERED = 0.1
"""An hour whose departures are fewer than this share of the busiest's has no demand of its own."""


def calibrate(
    scenario: Scenario,
    counts_file: Path,
    target: Path,
    options: CalibrationOptions,
    tell: Tell,
    finish: Callable[[Path], object] = lambda _draft: None,
) -> Calibration:
    """Writes a copy of a scenario whose demand carries the counts. A demand that gridlocks is not written.

    Args:
        target: the copy's, new or empty; it appears once it is complete.
        finish: adds to the copy before it appears.

    Raises:
        UserError: the counts cannot be used.
        UserError: the target exists or another program is making it, or the demand has stops or persons.
        ScenarioError: SUMO refuses the scenario, or it has no demand.
        SetupError: eclipse-sumo is not installed."""
    with variant.new_folder(target) as draft:
        configuration = read_configuration(scenario.config)
        variant.check_demand(configuration)
        zone = scenario.start.tzinfo
        assert zone is not None
        counts = read_counts(counts_file, zone, options.sites)
        measured = read_travel_times(options.times) if options.times else ()
        hours = _hours(counts, options)
        with tempfile.TemporaryDirectory(prefix="automotive-cosim-calibration-") as scratch:
            copies = copied(configuration, Path(scratch))
            made = _Calibration(scenario, copies, counts, measured, hours, options, Path(scratch), tell)
            found, best = made.run()
        if not found.gridlock:
            at_hour = hours[0] if options.at_hour is None else options.at_hour
            variant.write_variant(
                draft,
                scenario,
                configuration,
                (ROUTES, best.demand),
                (RECORD, found.record()),
                begin_s=configuration.begin_s + (at_hour - hours[0]) * HOUR_S,
                start_hour=at_hour,
            )
            finish(draft)
    return found


def _hours(counts: Counts, options: CalibrationOptions) -> tuple[int, ...]:
    """The hours to calibrate, in a row."""
    first, last = options.hours or (counts.hours[0], counts.hours[-1])
    hours = tuple(range(first, last + 1))
    missing = [hour for hour in hours if hour not in counts.hours]
    if missing or not hours:
        raise UserError(
            f"there are no counts of {missing[0] if missing else first} h; give --hours that were counted, in a"
            f" row: {', '.join(map(str, counts.hours))}"
        )
    if options.at_hour is not None and options.at_hour not in hours:
        raise UserError(f"--at {options.at_hour} is not one of the calibrated hours, {first} to {last}")
    return hours


@dataclass(slots=True)
class _Calibration:
    """One calibration."""

    scenario: Scenario
    configuration: Copied
    counts: Counts
    measured: Sequence[TravelTime]
    hours: tuple[int, ...]
    options: CalibrationOptions
    scratch: Path
    tell: Tell

    def run(self) -> tuple[Calibration, FitRound]:
        """The result, and the round that it keeps."""
        network = read_network(self.configuration.net)
        given_options = self._options(self.scenario, self.options.seed)
        capacity = read_capacity(self.configuration.net, self.configuration.files.get("additional-files", ()))
        mapped = map_sites(self.counts, network, capacity)
        flows = {
            (mapped.edges[site], hour - self.hours[0]): flow
            for (site, hour), flow in self.counts.flows_per_h.items()
            if site in mapped.edges and hour in self.hours
        }
        held_out = self._held_out(mapped)
        known = {key: flow for key, flow in flows.items() if key[0] not in held_out}
        if not any(known.values()):
            raise UserError(
                "no site could be placed on the network; give each an edge, or lon,lat and bearing"
                + "".join(f"\n{site}: {why}" for site, why in list(mapped.unmapped.items())[:10])
            )
        self.tell("driving the given demand", None)
        clock = CountedTime(self.configuration.begin_s, self.scenario.sumo.warm_up_s, len(self.hours))
        with self.configuration.named_as_given():
            given = drive(self.scenario.config.name, given_options, clock, self.scratch)
        if not given.trips:
            raise ScenarioError(f"{self.scenario.folder} has no demand to begin with; import a map, or add trips")
        edges = tuple(network.edges.values())
        world = SearchWorld(
            clock,
            self.configuration.net,
            vehicle_types(self.configuration),
            vehicle_types(self.configuration, ["route-files"]),
            network.free_s,
            capacity,
            (tuple(sorted(entries(edges))), tuple(sorted(exits(edges)))),
            known,
            self.options.seed,
            partial(self._drive, clock, self.options.seed),
            self.scratch,
        )
        covered = _covered(given, clock)
        rounds, tries = [], []
        for found in search(world, given, _per_h(given, clock, covered), self.options.rounds):
            met = Met.of([(found.drive.flows.get(key, 0), flow) for key, flow in known.items()])
            carried = Carried(found.vehicles, found.routes, *_figures(found.drive))
            rounds.append(found)
            tries.append(Try(met, carried))
            self.tell(f"round {len(tries)}: {met}; {carried.teleports} teleports, {carried.backlog} waiting", None)
            if not carried.gridlock and met.share >= ENOUGH_GOOD and abs(met.total - 1) <= ENOUGH_TOTAL:
                break
        kept = max(range(len(tries)), key=lambda number: _quality(tries[number]))
        best = rounds[kept]
        self.tell("driving it with another seed", None)
        path = self.scratch / "again.rou.xml"
        write_whole(path, best.demand)
        again = self._drive(clock, self.options.seed + 1, path)
        unfitted = _unfitted(given, covered)
        site_of = {edge: site for site, edge in mapped.edges.items()}
        rows = tuple(
            SiteHour(
                site=site_of[edge],
                edge=edge,
                hour=hour + self.hours[0],
                held_out=edge in held_out,
                counted=flow,
                unfitted=round(unfitted(edge, hour), 1),
                fitted=round(best.fitted[edge, hour], 1) if (edge, hour) in best.fitted else None,
                simulated=float(best.drive.flows.get((edge, hour), 0)),
            )
            for (edge, hour), flow in sorted(flows.items(), key=lambda each: (site_of[each[0][0]], each[0][1]))
        )
        thin = (f"{site_of[edge]}: hardly any route passes it" for edge in best.thin)
        return Calibration(
            source=self.scenario.name,
            counts=self.counts.about,
            hours=self.hours,
            rows=rows,
            times=tuple(self._times(given, best.drive, clock)),
            unmapped=mapped.unmapped,
            doubts=(*mapped.doubts, *thin),
            tries=tuple(tries),
            kept=kept,
            given=Carried(len(given.trips), len({trip.edges for trip in given.trips}), *_figures(given)),
            again=Met.of([(again.flows.get(key, 0), flow) for key, flow in known.items()]),
            seed=self.options.seed,
        ), best

    def _held_out(self, mapped: Mapped) -> frozenset[str]:
        """Edges of the sites that the fit does not see; whole sites, since hours of one site are alike."""
        edges = sorted(mapped.edges.values())
        if len(edges) < FEWEST_TO_HOLD_OUT:
            return frozenset()
        chosen = np.random.default_rng(self.options.seed).permutation(len(edges))
        return frozenset(edges[index] for index in chosen[: round(self.options.hold_out * len(edges))].tolist())

    def _options(self, scenario: Scenario, seed: int) -> dict[str, str]:
        sumo = replace(scenario.sumo, step_length_s=STEP_S)
        return run_options(self.configuration, Setup(replace(scenario, sumo=sumo), seed))

    def _drive(self, clock: CountedTime, seed: int, routes: Path) -> DrivenDemand:
        """Drives a file of vehicles in place of the given demand."""
        options = self._options(variant.with_fixed_routes(self.scenario), seed) | {"route-files": routes.name}
        return drive(self.scenario.config.name, options, clock, self.scratch)

    def _times(self, given: DrivenDemand, kept: DrivenDemand, clock: CountedTime) -> Iterable[TimeRow]:
        for each in self.measured:
            hour = each.hour - self.hours[0]
            if 0 <= hour < clock.hours:
                ends = each.from_edge, each.to_edge
                yield TimeRow(
                    *ends,
                    each.hour,
                    each.seconds,
                    given.mean_time_s(*ends, hour, clock),
                    kept.mean_time_s(*ends, hour, clock),
                )


def _figures(found: DrivenDemand) -> tuple[int, int, float]:
    return found.teleports, found.backlog, round(found.halted_share, 4)


def _quality(found: Try) -> tuple[bool, float, float]:
    return not found.carried.gridlock, found.calibrated.share, -found.calibrated.mean_geh


def _covered(given: DrivenDemand, clock: CountedTime) -> tuple[int, ...]:
    """The hours in which the given demand departs; a demand of one hour is not missing in the next."""
    departed = Counter(clock.hour(trip.departed_s) for trip in given.trips)
    hours = range(clock.hours)
    most = max(departed[hour] for hour in hours)
    found = tuple(hour for hour in hours if departed[hour] > COVERED * most)
    if not found:
        raise ScenarioError("the given demand has no departure after the warm-up; shorten warm_up_s or add trips")
    return found


def _per_h(given: DrivenDemand, clock: CountedTime, covered: Sequence[int]) -> float:
    departed = Counter(clock.hour(trip.departed_s) for trip in given.trips)
    return sum(departed[hour] for hour in covered) / len(covered)


def _unfitted(given: DrivenDemand, covered: Sequence[int]) -> Callable[[str, int], float]:
    """What the given demand carries, per edge and hour; in hours without demand, as in the others."""

    def flow(edge: str, hour: int) -> float:
        if hour in covered:
            return float(given.flows.get((edge, hour), 0))
        return sum(given.flows.get((edge, each), 0) for each in covered) / len(covered)

    return flow
