"""What a study keeps: a row for each drive with its decisions, and what each policy made of a decision."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

from automotive_cosim.run.row import InColumns, JobRow


@dataclass(frozen=True, slots=True, kw_only=True)
class Totals:
    """The ego's whole drive, as SUMO's tripinfo counts it; or what one drive saves against another."""

    time_s: float
    distance_m: float
    stops: int
    standing_s: float
    co2_g: float
    fuel_g: float


NOTHING = Totals(time_s=0.0, distance_m=0.0, stops=0, standing_s=0.0, co2_g=0.0, fuel_g=0.0)
"""What is saved by staying."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OthersTotals:
    """Everybody who was there at the fork, in one future against that in which the ego stays."""

    count: int
    gain_s: float
    """What they save together."""
    changed: int
    """How many arrive at another time."""
    unfinished_stay: int
    """How many have not arrived in time if the ego stays."""
    unfinished: int
    """How many in this future."""


NOBODY = OthersTotals(count=0, gain_s=0.0, changed=0, unfinished_stay=0, unfinished=0)
"""Where the ego stays there is nothing to compare."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Branch:
    """A future that leaves the drive, against the one that stays."""

    gains: Totals
    totals: Totals
    others: OthersTotals


@dataclass(frozen=True, slots=True, kw_only=True)
class News:
    """What traffic news of one age says at a decision."""

    age_s: float
    stay_s: float | None
    """Of the present way; None where the news knows of none."""
    delay_s: float
    """On the present way."""
    offered_s: float | None
    """Of the quickest other way; None if there is none."""
    branch: int | None
    """Number of the branch that takes it; None where none could."""

    @property
    def promised_s(self) -> float | None:
        """What the other way is said to save."""
        return None if self.stay_s is None or self.offered_s is None else self.stay_s - self.offered_s


@dataclass(frozen=True, slots=True, kw_only=True)
class Decision:
    """An instant at which another way could have been taken, its branches driven."""

    at_s: float
    """Simulation time."""
    edge: str
    delay_s: float
    """Expected on the way ahead."""
    eta_s: float
    """To the goal."""
    relative_speed: float
    """On the way ahead, of the free speed."""
    complies: bool
    """Whether the driver does as told."""
    news: tuple[News, ...]
    own: int | None
    """Branch that SUMO's rerouting device takes; None where it stays."""
    agents: Mapping[str, int]
    """Branch of each agent."""
    agents_rerouted: tuple[str, ...]
    """Agents that left the way."""
    excluded: str = ""
    """Reason for which it is in no average; empty if it counts."""
    why: str = ""
    branches: tuple[Branch, ...] = ()
    placebo: Branch | None = None
    """The future in which one other car is changed a little."""

    @property
    def time_index(self) -> float:
        """Expected travel time over that at free flow."""
        return self.eta_s / max(1.0, self.eta_s - self.delay_s)

    def gains(self, branch: int | None) -> Totals:
        """What a branch saves; nothing for staying."""
        return NOTHING if branch is None else self.branches[branch].gains


@dataclass(frozen=True, slots=True, kw_only=True)
class DriveRow(JobRow):
    """One drive of a study."""

    scenario: str
    share: float
    """Of the other cars, that reroute."""
    seed: int
    departure_s: float
    trip: str
    excluded: str = ""
    """Reason for which it has no decision; empty if it has any."""
    why: str = ""
    looks: int = 0
    """Instants at which congestion lay ahead but no other way was there."""
    stay: Totals | None = None
    """The drive itself; None without a decision."""
    decisions: tuple[Decision, ...] = ()


@dataclass(frozen=True, slots=True)
class DecisionPoint:
    """A decision with the drive that it belongs to."""

    id: str
    drive: DriveRow
    decision: Decision


@dataclass(frozen=True, slots=True, kw_only=True)
class PolicyChoice:
    """What one policy made of one decision with news of one age: a line of ``choices.csv``."""

    id: str
    """Of the decision."""
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
    """Expected travel time over that at free flow."""
    age_s: float
    policy: str
    complies: bool
    rerouted: bool
    promised_s: float | None
    """What the news says that the other way saves."""
    stay: Annotated[Totals, InColumns("stay")]
    gain: Annotated[Totals, InColumns("gain")]
    regret_s: float
    """Time lost against the best of the futures."""
    others: int
    """Who was there at the decision; 0 where the policy stays."""
    others_gain_s: float
    others_changed: int
    unfinished_stay: int
    unfinished: int
