"""The rows of a study: one per drive with its decisions, and one per policy's choice at a decision."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

from automotive_cosim.run.row import InColumns, JobRow


@dataclass(frozen=True, slots=True, kw_only=True)
class Totals:
    """The ego's whole drive, as SUMO's tripinfo counts it; or the savings of one drive over another."""

    time_s: float
    distance_m: float
    stops: int
    standing_s: float
    co2_g: float
    fuel_g: float


NOTHING = Totals(time_s=0.0, distance_m=0.0, stops=0, standing_s=0.0, co2_g=0.0, fuel_g=0.0)
"""The savings of keeping the route: none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OthersTotals:
    """All vehicles there at the fork, in one future compared with that in which the ego keeps its route."""

    count: int
    gain_s: float
    """Their total savings."""
    changed: int
    """Number that arrive at another time."""
    unfinished_stay: int
    """Number that have not arrived in time if the ego keeps its route."""
    unfinished: int
    """The same in this future."""


NOBODY = OthersTotals(count=0, gain_s=0.0, changed=0, unfinished_stay=0, unfinished=0)
"""The comparison of a future with itself."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Branch:
    """A future on another route, compared with the drive itself."""

    gains: Totals
    totals: Totals
    others: OthersTotals


@dataclass(frozen=True, slots=True, kw_only=True)
class News:
    """What traffic news of one age says at a decision."""

    age_s: float
    stay_s: float | None
    """Expected travel time on the present route; None if unknown to the news."""
    delay_s: float
    """Expected delay on the present route."""
    offered_s: float | None
    """Expected travel time on the quickest other route; None without one."""
    branch: int | None
    """Number of the branch that takes it; None if none could."""

    @property
    def promised_s(self) -> float | None:
        """Predicted saving on the other route."""
        return None if self.stay_s is None or self.offered_s is None else self.stay_s - self.offered_s


@dataclass(frozen=True, slots=True, kw_only=True)
class Decision:
    """An instant at which another route could be taken, with its branches."""

    at_s: float
    """Simulation time."""
    edge: str
    delay_s: float
    """Expected delay ahead."""
    eta_s: float
    """Distance to the destination."""
    relative_speed: float
    """Mean speed ahead as a share of the free speed."""
    complies: bool
    """Whether the driver follows the advice."""
    news: tuple[News, ...]
    own: int | None
    """Branch that SUMO's rerouting device takes; None if it keeps the route."""
    agents: Mapping[str, int]
    """Branch of each agent."""
    agents_rerouted: tuple[str, ...]
    """Agents that left the route."""
    excluded: str = ""
    """Why it is excluded from the averages; empty if it counts."""
    why: str = ""
    branches: tuple[Branch, ...] = ()
    placebo: Branch | None = None
    """The future in which one other car is changed a little."""

    @property
    def time_index(self) -> float:
        """Expected travel time divided by that at free flow."""
        return self.eta_s / max(1.0, self.eta_s - self.delay_s)

    def gains(self, branch: int | None) -> Totals:
        """The savings of a branch; zero for keeping the route."""
        return NOTHING if branch is None else self.branches[branch].gains


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveRow(JobRow):
    """One drive of a study."""

    scenario: str
    share: float
    """Share of the other cars that reroute."""
    seed: int
    departure_s: float
    trip: str
    excluded: str = ""
    """Why it has no decision; empty if it has any."""
    why: str = ""
    looks: int = 0
    """Number of instants with congestion ahead but no alternative route."""
    stay: Totals | None = None
    """The drive itself; None without a decision."""
    decisions: tuple[Decision, ...] = ()


@dataclass(frozen=True, slots=True)
class DecisionPoint:
    """A decision with its drive."""

    id: str
    drive: DriveRow
    decision: Decision


@dataclass(frozen=True, slots=True, kw_only=True)
class PolicyChoice:
    """One policy's choice at one decision with news of one age: a line of ``choices.csv``."""

    id: str
    """Number of the decision."""
    scenario: str
    share: float
    seed: int
    departure_s: float
    trip: str
    at_s: float
    edge: str
    delay_s: float
    eta_s: float
    time_index: float
    """Expected travel time divided by that at free flow."""
    age_s: float
    policy: str
    complies: bool
    rerouted: bool
    promised_s: float | None
    """Predicted saving on the other route."""
    stay: Annotated[Totals, InColumns("stay")]
    gain: Annotated[Totals, InColumns("gain")]
    regret_s: float
    """Time lost compared with the best future."""
    others: int
    """Number of vehicles there at the decision; 0 if the policy keeps the route."""
    others_gain_s: float
    others_changed: int
    unfinished_stay: int
    unfinished: int
