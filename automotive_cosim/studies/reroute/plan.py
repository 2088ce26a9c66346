"""What a rerouting study runs: every departure of every trip, in the traffic of every seed and rerouting share."""

from __future__ import annotations

import re
from dataclasses import dataclass
from itertools import product

from automotive_cosim.agents import make_agent
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.run.executor import Job
from automotive_cosim.scenarios import Scenario, Trip
from automotive_cosim.scenarios.opening import network_of
from automotive_cosim.scenarios.wording import KINDS, read_line
from automotive_cosim.studies.plan import check_edges, check_values, driven_at, opened
from automotive_cosim.studies.reroute.policies import AGENT, parse_policy
from automotive_cosim.studies.reroute.rows import TripRow
from automotive_cosim.studies.settings import RerouteSettings

"""Relative gap below which a dynamic user assignment counts as converged."""

AHEAD = "ahead"
"""Closes a road on the ego's route."""

AUTO_DRAWS = range(4, 14)
"""With ``auto``, each future is driven at least and at most this often after the first time."""
AUTO_ERRORS = 2.0
"""Driving stops early once the mean gain of every branch is this many standard errors from zero."""


@dataclass(frozen=True, slots=True)
class StudyPlan(RerouteSettings):
    """A rerouting study."""

    def check(self) -> None:
        """Checks every name and number before anything runs.

        Raises UserError: one does not exist or is out of range."""
        check_values(self)
        for text in self.policies:
            parse_policy(text)
        for agent in self.agents:
            if agent == "human":
                raise UserError(
                    "policy 'agent:human' needs a person, but a study runs unattended; choose another agent"
                )
            make_agent(*named(agent))
        if self.ego_class and not re.fullmatch(r"[A-Za-z0-9_.]+(/[A-Za-z0-9_.]+)?", self.ego_class):
            raise UserError(f"ego_class is {self.ego_class!r}; give an emission class of SUMO, as Energy/default")
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
        """The scenario with that share of rerouting cars. Raises ScenarioError: it cannot be read."""
        return driven_at(
            self.opened,
            step_s=self.driven_step_s(self.opened),
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
        told = sorted({job.share for job in self.jobs()})
        drawn = "; every seed redraws the trips" if self.scene(0.0).sumo.redraws_trips else ""
        if told == [0.0]:
            return f"one-shot: free-flow routes at departure, kept to the end{drawn}"
        shares = " / ".join(f"{share:.0%}" for share in told)
        return f"rerouting: {shares} of the cars reroute by current travel times{drawn}"

    @property
    def opened(self) -> Scenario:
        """The scenario with the ego's routes, before the study's changes.

        Raises ScenarioError: it cannot be read, or has no such route."""
        return opened(self.scenario, self.from_place, self.to_place)

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
class StudyJob(Job):
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

    def planned(self) -> TripRow:
        """Its row before it runs."""
        return TripRow(
            id=self.id,
            scenario=self.plan.scenario,
            share=self.share,
            seed=self.seed,
            departure_s=self.departure_s,
            trip=self.trip.name,
        )

    @property
    def entropy(self) -> tuple[int, ...]:
        """The seed of all randomness of this drive; it does not depend on the share."""
        return self.seed, round(self.departure_s * 10), *self.trip.name.encode()


def named(agent: str) -> tuple[str, str]:
    """An agent's name and its model's, from ``NAME`` or ``NAME/MODEL``."""
    name, _, model = agent.partition("/")
    return name, model or "rules"
