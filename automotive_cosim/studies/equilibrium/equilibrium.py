"""Makes a scenario whose drivers have found their routes: a dynamic user equilibrium in the micro simulation.

Every step drives all trips in SUMO, measures the gap (``gap``), and gives some of the trips that lost time their
best route: one in two after the first step, one in three after the second, and so on (method of successive
averages). The step with the smallest gap is kept. The gap of a micro simulation neither falls evenly nor reaches
zero. Every trip departs when it entered the network in the first step.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from automotive_cosim.contracts import Json
from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats.scenario import Scenario
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.scenarios import variant
from automotive_cosim.scenarios.opening import open_scenario
from automotive_cosim.studies.equilibrium.gap import NOTICED_S, Driven, DrivenTrip, Gap, drive, vehicle_types
from automotive_cosim.studies.equilibrium.settings import EquilibriumSettings
from automotive_cosim.traffic.options import Configuration, copied, read_configuration

ROUTES = "equilibrium.rou.xml"
RECORD = "equilibrium.json"

PATIENCE = 5
"""Steps without a smaller gap after which it ends."""


@dataclass(frozen=True, slots=True)
class AssignmentStep:
    """One step."""

    number: int
    """0 is the demand as it is, driven with its own share of cars that reroute."""
    gap: Gap
    changed: int
    """Trips that get another route for the next step."""


@dataclass(frozen=True, slots=True)
class Assigned:
    """A scenario's drivers on the routes of one step."""

    scenario: Scenario
    """How SUMO runs."""
    configuration: Configuration
    """The network, and a demand that ``trips`` replace."""
    types: str
    """The vehicle types of the demand, as SUMO's XML."""
    trips: tuple[DrivenTrip, ...]

    def written(self, path: Path) -> Configuration:
        """The configuration with the trips as its demand, which are written to a file."""
        write_whole(path, self.demand)
        return replace(self.configuration, files={**self.configuration.files, "route-files": (path,)})

    @property
    def demand(self) -> str:
        """The trips as SUMO's demand, in the order of their departures."""
        lines = (variant.vehicle(trip.id, trip.type_id, trip.departed_s, trip.edges) for trip in self.trips)
        return variant.demand(self.types, lines)


def equilibrate(
    folder: Path, target: Path, options: EquilibriumSettings, tell: Callable[[AssignmentStep], None]
) -> tuple[AssignmentStep, ...]:
    """Writes a copy of a scenario whose demand is the best step's; returns all steps.

    Args:
        folder: the scenario's, or a ``.sumocfg``.
        target: the copy's, new or empty; it appears once it is complete.

    Raises:
        UserError: the target exists, or the demand has stops or persons.
        ScenarioError: it is no scenario, or SUMO refuses it.
        SetupError: eclipse-sumo is not installed."""
    with variant.new_folder(target) as draft:
        scenario = opened(folder, options)
        configuration = read_configuration(scenario.config)
        variant.check_demand(configuration)
        with tempfile.TemporaryDirectory(prefix="automotive-cosim-equilibrium-") as scratch:
            given = copied(configuration, Path(scratch))
            types = vehicle_types(given, ["route-files"])  # those of additional files stay where they are
            steps, best = _search(scenario, configuration, types, options, tell, Path(scratch))
        kept = min(steps, key=lambda step: step.gap.relative)
        record: Json = {
            "options": asdict(options),
            "kept": kept.number,
            "steps": [asdict(step) | {"relative_gap": step.gap.relative} for step in steps],
        }
        variant.write_variant(draft, scenario, configuration, (ROUTES, best.demand), (RECORD, record))
    return steps


def opened(folder: Path, options: EquilibriumSettings) -> Scenario:
    """The scenario, with the warm-up of the options. Raises ScenarioError: it cannot be read."""
    scenario = open_scenario(folder)
    if options.warm_up_s is None:
        return scenario
    return replace(scenario, sumo=replace(scenario.sumo, warm_up_s=options.warm_up_s))


def _search(
    scenario: Scenario,
    configuration: Configuration,
    types: str,
    options: EquilibriumSettings,
    tell: Callable[[AssignmentStep], None],
    scratch: Path,
) -> tuple[tuple[AssignmentStep, ...], Assigned]:
    """All steps, and the routes of the best one."""
    rng = np.random.default_rng(options.seed)
    fixed = variant.with_fixed_routes(scenario)
    last_s = configuration.begin_s + scenario.sumo.warm_up_s + options.observe_s
    driven = drive(configuration, scenario, options.observe_s, options.seed)
    trips = tuple(trip for trip in driven.trips if trip.departed_s < last_s)
    now = Assigned(fixed, configuration, types, trips)
    steps: list[AssignmentStep] = []
    best = now, driven.gap.relative
    for number in range(options.steps + 1):
        if number:
            driven = drive(now.written(scratch / ROUTES), fixed, options.observe_s, options.seed)
        if not driven.gap.trips:
            raise ScenarioError(f"no trip departs within {options.observe_s:g} s after the warm-up and arrives")
        if driven.gap.relative < best[1]:
            best = now, driven.gap.relative
        gaps = [*(step.gap.relative for step in steps), driven.gap.relative]
        is_last = number == options.steps or driven.gap.relative <= options.gap or is_stuck(gaps)
        routes = {} if is_last else changes(driven, 1 / (number + 2), rng)
        steps.append(AssignmentStep(number, driven.gap, len(routes)))
        tell(steps[-1])
        if is_last:
            break
        now = rerouted(now, routes)
    return tuple(steps), best[0]


def is_stuck(figures: Sequence[float]) -> bool:
    """Whether a figure has not become smaller for some steps."""
    return len(figures) > PATIENCE and min(figures[-PATIENCE:]) >= min(figures[:-PATIENCE])


def changes(driven: Driven, share: float, rng: np.random.Generator) -> Mapping[str, tuple[str, ...]]:
    """New routes for a share of the trips that lost time."""
    lost = [name for name, excess_s in driven.excess_s.items() if excess_s >= NOTICED_S and name in driven.best]
    return {name: driven.best[name] for name in lost if rng.random() < share}


def rerouted(assigned: Assigned, routes: Mapping[str, tuple[str, ...]]) -> Assigned:
    """The same trips, some with new routes."""
    trips = tuple(replace(trip, edges=routes.get(trip.id, trip.edges)) for trip in assigned.trips)
    return replace(assigned, trips=trips)
