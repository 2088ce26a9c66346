"""The rows of a congestion study: one per seed, with the traffic without an intervention and with each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from automotive_cosim.run.job_row import InColumns, JobRow
from automotive_cosim.studies.calls.accounts import Consumption


@dataclass(frozen=True, slots=True, kw_only=True)
class FlowSums:
    """Sums over all vehicles on some edges in some time; of two, their sum."""

    time_s: float = 0.0
    """Time that they spent there."""
    lost_s: float = 0.0
    """SUMO's ``timeLoss``: the part by which they were slower than limits and drivers allow, at signals too."""
    standing_s: float = 0.0
    """The part of it in which they stood."""
    distance_m: float = 0.0
    """Driven there."""

    @property
    def free_s(self) -> float:
        """What the same distances take without congestion and signals."""
        return max(0.0, self.time_s - self.lost_s)

    def __add__(self, other: FlowSums) -> FlowSums:
        return FlowSums(
            time_s=self.time_s + other.time_s,
            lost_s=self.lost_s + other.lost_s,
            standing_s=self.standing_s + other.standing_s,
            distance_m=self.distance_m + other.distance_m,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class FlowCell:
    """The flow on the roads of one class in five minutes."""

    from_s: float
    """Seconds after the end of the warm-up."""
    road_class: str
    """OpenStreetMap's, or ``junctions``, ``other``, ``unknown`` (``outputs``)."""
    flow: Annotated[FlowSums, InColumns("")]
    queue_m: float
    """Mean over time of the total length of the queues: of the waiting vehicles, with the gaps that they keep."""
    longest_m: float
    """The longest queue of a lane."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FlowState:
    """The traffic as a whole at an instant; counts begin with the intervention."""

    at_s: float
    """Seconds after the end of the warm-up."""
    running: int
    backlog: int
    """Vehicles that wait outside for room to enter."""
    departed: int
    arrived: int
    teleported: int
    collided: int = 0
    """Vehicles that a collision has taken off the road, which have not arrived."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Emitted(Consumption):
    """What the vehicles of one emission class emitted and consumed in one period of the demand."""

    period: int


@dataclass(frozen=True, slots=True, kw_only=True)
class InterventionOutcome:
    """The traffic without an intervention, or with one."""

    intervention: str
    """As in the plan; empty without one."""
    cells: tuple[FlowCell, ...]
    states: tuple[FlowState, ...]
    """Every minute, the first at the end of the warm-up."""
    emitted: tuple[Emitted, ...] = ()
    gridlock: str = ""
    """Why the traffic counts as gridlocked at the end; empty while it flows. It counts all the same."""
    cut_short: int = 0
    """Vehicles whose trip ended before a closed road, as no way led round it."""
    kept_in: int = 0
    """Vehicles that would have set out on a closed road and were left out."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CongestionRow(JobRow):
    """One seed."""

    scenario: str
    seed: int
    outcomes: tuple[InterventionOutcome, ...] = ()
    """Without an intervention first, then in the order of the plan."""


@dataclass(frozen=True, slots=True, kw_only=True)
class EdgeRow:
    """The flow on one edge in one minute: a line of ``edges/SEED.csv.gz``."""

    intervention: int
    """0 without an intervention, then their numbers in the plan."""
    edge: str
    from_s: float
    time_s: float
    lost_s: float
    distance_m: float
