"""What a rerouting study runs: every departure of every trip, in the traffic of every seed and rerouting share."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from functools import lru_cache
from itertools import product
from typing import Annotated, Any, Literal, TypeVar

from annotated_types import Ge, Le, MinLen

from automotive_cosim.agents import make_agent
from automotive_cosim.contracts import Json
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.formats.checked import checked
from automotive_cosim.run.executor import LoneJob
from automotive_cosim.scenarios import Scenario, Trip
from automotive_cosim.scenarios.incidents import AnyIncident, Incident
from automotive_cosim.scenarios.wording import KINDS, read_line
from automotive_cosim.scenery import open_scenario
from automotive_cosim.scenery.opening import network_of
from automotive_cosim.studies.policies import AGENT, parse_policy
from automotive_cosim.traffic.congestion import OLDEST_NEWS_S
from automotive_cosim.traffic.profiles import profile

KIND = "reroute"
"""Kind of study in the manifest, so that a report knows what it reads."""

EQUILIBRIUM_GAP = 0.01
"""Relative gap below which a dynamic user assignment counts as converged."""

AHEAD = "ahead"
"""Closes a road on the ego's route."""

AUTO_DRAWS = range(4, 14)
"""With ``auto``, each future is driven at least and at most this often after the first time."""
AUTO_ERRORS = 2.0
"""Driving stops early once the mean gain of every branch is this many standard errors from zero."""


@dataclass(frozen=True, slots=True)
class StudyPlan:
    """A rerouting study; times in seconds."""

    scenario: Annotated[str, MinLen(1)]
    """Name or folder, a ``.sumocfg`` or a network."""
    departures_s: Annotated[tuple[Annotated[float, Ge(0), Le(86_400)], ...], MinLen(1)] = (0.0, 300.0, 600.0, 900.0)
    """Departures of the ego, after the warm-up; each in its own copy of the traffic."""
    trips: tuple[str, ...] = ()
    """Names of the scenario's trips, as ``Scenario.trip`` takes them; empty for all."""
    from_place: str = ""
    """Where the ego's route begins, instead of a trip: an edge, a street or ``LON,LAT``."""
    to_place: str = ""
    """Where it ends; if only one of the two is given, the other is drawn, several times."""
    seeds: Annotated[tuple[Annotated[int, Ge(0)], ...], MinLen(1)] = tuple(range(10))
    """Seeds of the traffic; decisions of one seed are not independent of each other."""
    shares: tuple[Annotated[float, Ge(0), Le(1)], ...] = ()
    """Shares of the other cars that reroute; each is warmed up separately. None takes the scenario's."""
    ages_s: Annotated[tuple[Annotated[float, Ge(0), Le(OLDEST_NEWS_S)], ...], MinLen(1)] = (0.0,)
    """Ages of the traffic news by which the alternative route is selected."""
    driver: str = ""
    """Name of a driver profile; empty takes the scenario's."""
    compliance: Annotated[tuple[Annotated[float, Ge(0), Le(1)], ...], MinLen(1)] = (1.0,)
    """Probabilities that the driver follows the advice, at the same decisions; most tables use only the first."""
    policies: Annotated[tuple[str, ...], MinLen(1)] = ("never", "always", "delay:60", "sumo", "best")
    least_delay_s: Annotated[float, Ge(0), Le(3_600)] = 30.0
    """A decision is due while the expected delay ahead is at least this."""
    every_s: Annotated[float, Ge(10), Le(3_600)] = 60.0
    """Time between two decisions of one drive."""
    per_drive: Annotated[int, Ge(1), Le(50)] = 5
    """Maximum number of decisions per drive."""
    placebo_every: Annotated[int, Ge(0), Le(1_000_000)] = 1
    """One placebo in this many drives with a decision; 0 for none. Replicates contain it."""
    replicates: Annotated[int, Ge(1), Le(100)] | Literal["auto"] = 1
    """How many times each future is driven; ``auto`` drives more where the sign of the gain is unclear."""
    arrived: Annotated[float, Ge(0.5), Le(1)] = 0.95
    """Share of the vehicles there at the decision that must arrive before a future ends."""
    limit_s: Annotated[float, Ge(60), Le(86_400)] = 7_200.0
    """Simulated time after which a future ends anyway."""
    step_s: Annotated[float, Ge(0.1), Le(1)] = 1.0
    """SUMO's step length."""
    scale: Annotated[float, Ge(0.01), Le(100)] | None = None
    """Factor on the demand; None takes the scenario's."""
    warm_up_s: Annotated[float, Ge(0), Le(86_400)] | None = None
    """Traffic before the first departure; None takes the scenario's."""
    equilibrium_gap: float | None = None
    """Relative gap of the assignment (duaIterate) that produced the demand's routes; None without one."""
    half_width_s: Annotated[float, Ge(0.1), Le(3_600)] | None = None
    """Half-width of the mean gain's interval at which no further seeds are added; None runs all."""
    whole_drives: bool = False
    """Whether every policy also drives from the departure to the destination."""
    together: tuple[Annotated[float, Ge(0), Le(1)], ...] = ()
    """Shares of the eligible cars that take the quickest other route with the ego."""
    close: str = ""
    """An edge that is closed at the first decision of a drive, whichever route the ego takes; ``ahead`` is one
    on its route where the two routes differ. Empty closes none."""
    incidents: tuple[str, ...] = ()
    """Incidents staged in every future besides the scenario's own, as ``scenarios.wording`` reads them; their times
    count from the end of the warm-up."""
    via: Literal["stops", "route"] = "stops"
    """What the edges in a trip's ``via`` are: stops that every route passes, or the way that it sets out on."""
    redraw: bool = False
    """Whether every seed is a different day of the demand; see ``redraws_trips`` of a scenario."""
    emissions: bool = False
    """Whether to measure what every vehicle emits and consumes."""
    ego_class: str = ""
    """SUMO's emission class of the ego; empty takes SUMO's for passenger cars."""
    trajectories: bool = False
    """Whether to keep where the ego was in every future."""
    agent_steps: Annotated[int, Ge(1), Le(100)] = 12
    """Maximum number of an agent's actions per decision."""

    def as_json(self) -> Json:
        """The plan as a JSON object, for the manifest."""
        values = {name: list(value) if isinstance(value, tuple) else value for name, value in asdict(self).items()}
        return {"study": KIND} | values

    def check(self) -> None:
        """Checks every name and number before anything runs.

        Raises:
            UserError: one does not exist or is out of range.
        """
        checked_plan(type(self), asdict(self))
        for name in ("departures_s", "seeds", "shares", "ages_s", "compliance", "policies", "trips", "together"):
            values = getattr(self, name)
            if len(set(values)) < len(values):
                raise UserError(f"{option(name)} lists a value twice: {', '.join(map(str, values))}")
        if self.equilibrium_gap is not None and not 0 <= self.equilibrium_gap < EQUILIBRIUM_GAP:
            raise UserError(
                f"--equilibrium-gap is {self.equilibrium_gap:g}; demand counts as an equilibrium below "
                f"{EQUILIBRIUM_GAP:g}; run duaIterate longer, or omit the option"
            )
        for text in self.policies:
            parse_policy(text)
        for agent in self.agents:
            if agent == "human":
                raise UserError(
                    "policy 'agent:human' needs a person, but a study runs unattended; choose another agent"
                )
            make_agent(*named(agent))
        if self.driver:
            profile(self.driver)
        if self.ego_class and not re.fullmatch(r"[A-Za-z0-9_.]+(/[A-Za-z0-9_.]+)?", self.ego_class):
            raise UserError(f"--ego-class is {self.ego_class!r}; give an emission class of SUMO, as Energy/default")
        scenario = self.scene(0.0)
        if self.close not in ("", AHEAD):
            edges = network_of(scenario).edges
            if self.close not in edges:
                raise UnknownNameError("edge for cars", self.close, edges)
        for text in self.incidents:
            check_edges(read_line(text, KINDS, "--incident"), "--incident", scenario)
        for name in self.trips:
            scenario.trip(name)

    def scene(self, share: float) -> Scenario:
        """The scenario with that share of rerouting cars.

        Raises:
            ScenarioError: it cannot be read.
        """
        return driven_at(
            self.opened,
            step_s=self.step_s,
            share=share,
            scale=self.scale,
            warm_up_s=self.warm_up_s,
            redraw=self.redraw,
            incidents=[read_line(text, KINDS, "--incident") for text in self.incidents],
        )

    @property
    def agents(self) -> tuple[str, ...]:
        """The agents among the policies, as names for ``make_agent``."""
        return tuple(text.removeprefix(AGENT) for text in self.policies if text.startswith(AGENT))

    @property
    def draws(self) -> range:
        """The fewest and the most further draws of each future, as start and stop."""
        if self.replicates == "auto":
            return AUTO_DRAWS
        return range(self.replicates - 1, self.replicates - 1)

    def demand(self) -> str:
        """A description of where the other vehicles' routes come from."""
        if self.equilibrium_gap is not None:
            return f"routes from duaIterate, relative gap {self.equilibrium_gap:.2%}"
        told = sorted({job.share for job in self.jobs()})
        drawn = "; every seed redraws the trips" if self.scene(0.0).sumo.redraws_trips else ""
        if told == [0.0]:
            return f"one-shot: free-flow routes at departure, kept to the end{drawn}"
        shares = " / ".join(f"{share:.0%}" for share in told)
        return f"rerouting: {shares} of the cars reroute by current travel times{drawn}"

    @property
    def opened(self) -> Scenario:
        """The scenario with the ego's routes, before the study's changes.

        Raises:
            ScenarioError: it cannot be read, or has no such route.
        """
        return _opened(self.scenario, self.from_place, self.to_place)

    def jobs(self) -> tuple[StudyJob, ...]:
        """Every drive, grouped by simulation and ordered by departure."""
        scenario = self.opened
        shares = self.shares or (scenario.sumo.background_rerouting,)
        chosen = {scenario.trip(name).name for name in self.trips}
        trips = [trip for trip in scenario.ego.trips if not chosen or trip.name in chosen]
        return tuple(
            StudyJob(self, share, seed, departure_s, trip)
            for seed, share, departure_s, trip in product(self.seeds, shares, sorted(self.departures_s), trips)
        )


@dataclass(frozen=True, slots=True)
class StudyJob(LoneJob):
    """One drive of a study, with all its decisions."""

    plan: StudyPlan
    share: float
    seed: int
    departure_s: float
    trip: Trip

    @property
    def simulation(self) -> tuple[str, int]:
        """The warm traffic it departs from."""
        return f"traffic in which {100 * self.share:g} % reroute", self.seed

    @property
    def wall_s(self) -> float:
        """Limit of its wall time: agents may think for a while."""
        whole = self.plan.whole_drives * len(self.plan.compliance)
        parts = 1 + whole + len(self.plan.together) + 2 * bool(self.plan.close)
        return (7_200.0 if self.plan.agents else 1_800.0) * (1 + self.plan.draws.stop) * parts

    @property
    def id(self) -> str:
        """Its id, which can be a file name."""
        name = re.sub(r"[^A-Za-z0-9_.]+", "_", self.trip.name)
        return f"share{self.share:g}-seed{self.seed}-at{self.departure_s:g}-{name}"

    @property
    def entropy(self) -> tuple[int, ...]:
        """The seed of all randomness of this drive; it does not depend on the share."""
        return self.seed, round(self.departure_s * 10), *self.trip.name.encode()


@lru_cache(maxsize=4)
def _opened(name: str, from_place: str, to_place: str) -> Scenario:
    """Cached, because every drive needs it and a foreign network takes a second to read."""
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
    sumo = scenario.sumo
    sumo = replace(
        sumo,
        step_length_s=step_s,
        action_step_length_s=max(step_s, sumo.action_step_length_s),
        background_rerouting=sumo.background_rerouting if share is None else share,
        scale=sumo.scale if scale is None else scale,
        warm_up_s=sumo.warm_up_s if warm_up_s is None else warm_up_s,
        redraws_trips=redraw or sumo.redraws_trips,
    )
    return replace(scenario, sumo=sumo, incidents=(*scenario.incidents, *incidents))


def check_edges(incident: Incident, place: str, scenario: Scenario) -> None:
    """Checks that an incident is on edges that the network has.

    Raises:
        UserError: one is missing.
    """
    edges = network_of(scenario).edges
    for name in ("edge", "edges", "from_edge", "to_edge"):
        value = getattr(incident, name, ())
        for edge in (value,) if isinstance(value, str) else value:
            if edge not in edges:
                raise UnknownNameError(f"edge for cars in {place}", edge, edges)


def named(agent: str) -> tuple[str, str]:
    """An agent's name and its model's, from ``NAME`` or ``NAME/MODEL``."""
    name, _, model = agent.partition("/")
    return name, model or "rules"


def make_study(values: Mapping[str, Any]) -> StudyPlan:
    """A plan from a manifest's table.

    Raises:
        UserError: it is another kind of study, or of another version.
    """
    return plan_of(StudyPlan, KIND, "rerouting study", values)


P = TypeVar("P")


def plan_of(plan: type[P], kind: str, words: str, values: Mapping[str, Any]) -> P:
    """The plan of a study from a manifest's table.

    Args:
        plan: its type.
        kind: the word by which a manifest names it.
        words: the same in a message.
        values: the table.

    Raises:
        UserError: it is another kind of study, or of another version.
    """
    given = dict(values)
    if given.pop("study", None) == kind:
        with suppress(UserError):  # its message would mention options that the user has not given
            return checked_plan(plan, given)
    raise UserError(f"the folder has no {words} of this version; use the version that wrote it")


def checked_plan(plan: type[P], values: Mapping[str, Any]) -> P:
    """A plan of valid values.

    Raises:
        UserError: one is not valid; the message names the option.
    """
    return checked(plan, values, lambda steps: ("the study", option(str(steps[0])) if steps else ""))


def option(name: str) -> str:
    """The option of a field of a plan."""
    return "--" + name.removesuffix("_s").replace("_", "-")
