"""What the plans of studies share: the scenario that they drive, and how their values are checked and read."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from functools import lru_cache
from typing import Any, Generic, TypeVar

from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.formats.annotations import option
from automotive_cosim.formats.checked import checked
from automotive_cosim.formats.incidents import AnyIncident, Incident
from automotive_cosim.run.executor import Job, R
from automotive_cosim.scenarios import Scenario, open_scenario
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.studies.settings import TrafficSettings

P = TypeVar("P", bound=TrafficSettings)


@dataclass(frozen=True, slots=True)
class SeedJob(Job, Generic[P, R]):
    """The traffic of one seed of a plan."""

    plan: P
    seed: int
    row: Callable[..., R]
    """Its kind of row."""
    limit_s: float

    @property
    def id(self) -> str:
        """Its id, which can be a file name."""
        return f"seed{self.seed}"

    @property
    def simulation(self) -> tuple[str, int]:
        """The traffic that it warms up."""
        return self.plan.scenario, self.seed

    @property
    def wall_s(self) -> float:
        """Limit of its wall time."""
        return self.limit_s

    def planned(self) -> R:
        """Its row before it runs."""
        return self.row(id=self.id, scenario=self.plan.scenario, seed=self.seed)


@lru_cache(maxsize=4)
def opened(name: str, from_place: str = "", to_place: str = "") -> Scenario:
    """A scenario with the ego's routes, cached: every job needs it and a foreign network takes a second to read.

    Raises ScenarioError: it cannot be read, or has no such route."""
    return open_scenario(name, from_place=from_place, to_place=to_place)


def driven_at(
    scenario: Scenario,
    *,
    step_s: float,
    share: float | None,
    scale: float | None,
    warm_up_s: float | None,
    redraw: bool,
    incidents: Sequence[AnyIncident],
) -> Scenario:
    """A scenario as a study drives it; what is None stays the scenario's own, and incidents come on top."""
    sumo = scenario.sumo.stepping(step_s)
    sumo = replace(
        sumo,
        background_rerouting=sumo.background_rerouting if share is None else share,
        scale=sumo.scale if scale is None else scale,
        warm_up_s=sumo.warm_up_s if warm_up_s is None else warm_up_s,
        redraws_trips=redraw or sumo.redraws_trips,
    )
    return replace(scenario, sumo=sumo, incidents=(*scenario.incidents, *incidents))


def check_edges(incident: Incident, place: str, scenario: Scenario) -> None:
    """Checks that an incident is on edges that the network has. Raises UserError: one is missing."""
    edges = network_of(scenario).edges
    for name in ("edge", "edges", "from_edge", "to_edge"):
        value = getattr(incident, name, ())
        for edge in (value,) if isinstance(value, str) else value:
            if edge not in edges:
                raise UnknownNameError(f"edge for cars in {place}", edge, edges)


def plan_of(plan: type[P], values: Mapping[str, Any]) -> P:
    """The plan of a study from a manifest's table.

    Raises UserError: it is another kind of study, or of another version."""
    given = dict(values)
    if given.pop("study", None) == plan.kind:
        with suppress(UserError):  # its message would mention options that the user has not given
            return _checked(plan, given)
    raise UserError(f"the folder has no {plan.kind} study of this version; use the version that wrote it")


def check_values(plan: TrafficSettings) -> None:
    """Checks the values of a plan one by one. Raises UserError: one is not valid; the message names the option."""
    _checked(type(plan), asdict(plan))
    for name in plan.sets:
        values = getattr(plan, name)
        if len(set(values)) < len(values):
            raise UserError(f"{option(type(plan), name)} lists a value twice: {', '.join(map(str, values))}")


def _checked(plan: type[P], values: Mapping[str, Any]) -> P:
    return checked(plan, values, lambda steps: ("the study", option(plan, str(steps[0])) if steps else ""))
