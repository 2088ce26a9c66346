"""The rows of a study: one per drive with its decisions, and one per policy's choice at a decision."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, fields
from statistics import fmean
from typing import Annotated, Any

from automotive_cosim.run.job_row import InColumns, JobRow
from automotive_cosim.studies.calls.accounts import Consumption, TrafficSummary
from automotive_cosim.studies.calls.chance import Fresh


@dataclass(frozen=True, slots=True, kw_only=True)
class Totals:
    """The ego's whole drive, as SUMO's tripinfo counts it; or the savings of one drive over another."""

    time_s: float
    distance_m: float
    stops: float
    standing_s: float
    co2_g: float
    fuel_g: float
    energy_wh: float = 0.0
    """Taken from the battery of an electric ego."""
    lost_s: float | None = None
    """Time lost to traffic and signals, SUMO's ``timeLoss``; None in rows of earlier versions."""

    @property
    def way_s(self) -> float | None:
        """The rest of the time: what the way itself takes, driven as fast as limits and driver allow.

        So a gain of time is the sum of two savings: time not lost (congestion avoided), and a quicker way. The
        way's own time is what Jahn, Möhring, Schulz and Stier-Moses call its normal length (System-Optimal
        Routing of Traffic Flows with User Constraints in Networks with Congestion, Operations Research 53, 2005):
        its time on empty roads, which the traffic does not change."""
        return None if self.lost_s is None else round(self.time_s - self.lost_s, 3)

    @classmethod
    def mean(cls, drives: Sequence[Totals]) -> Totals:
        """The mean over the drives; that of a single one is itself."""
        if len(drives) == 1:
            return drives[0]
        return cls._made(fmean, drives)

    def saved(self, other: Totals) -> Totals:
        """What another drive saves over this one."""
        return Totals._made(lambda values: values[0] - values[1], (self, other))

    @classmethod
    def _made(cls, of: Callable[[Sequence[float]], float], drives: Sequence[Totals]) -> Totals:
        """Every figure of the drives in one; None where one lacks it."""
        made: dict[str, Any] = {}
        for each in fields(cls):
            values = [getattr(drive, each.name) for drive in drives]
            made[each.name] = None if None in values else round(of(values), 3)
        return cls(**made)


NOTHING = Totals(time_s=0.0, distance_m=0.0, stops=0, standing_s=0.0, co2_g=0.0, fuel_g=0.0, lost_s=0.0)
"""The savings of keeping the route: none."""


@dataclass(frozen=True, slots=True, kw_only=True)
class OthersTotals:
    """All vehicles present at the fork, in one future compared with that in which the ego keeps its route."""

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
class FleetClass(Consumption):
    """What the vehicles of one emission class save that were present and arrived in both futures.

    The ego is a class of its own, ``ego: `` and its name."""

    count: int


@dataclass(frozen=True, slots=True, kw_only=True)
class TripClass:
    """Vehicles with about the same time left on their trips at the fork."""

    from_s: float
    """Lower bound of the time left if the ego keeps its route; the next class has the upper bound."""
    count: int
    gain_s: float
    """Their total savings."""
    later: int
    """Number that arrive noticeably later."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Horizon:
    """The effect on the others up to an earlier or later instant than that of ``OthersTotals``."""

    share: float
    """The instant at which this share of them had arrived in the first of the two futures."""
    gain_s: float | None
    """Their total savings until then; None if the futures ended before."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Spread:
    """What single vehicles save in a branch, the ego included; each as its mean over the draws."""

    count: int
    mean_s: float
    low_s: float
    """5 % of the vehicles save less."""
    lower_s: float
    """25 %."""
    median_s: float
    upper_s: float
    """75 %."""
    high_s: float
    """95 %."""
    earlier: int
    """Number that arrive noticeably earlier."""
    later: int
    gini_stay: float
    """Gini coefficient of the times from fork to arrival if the ego keeps its route."""
    gini: float
    """The same in the branch."""
    trips: tuple[TripClass, ...]
    horizons: tuple[Horizon, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Branch:
    """A future on another route, compared with the drive itself."""

    gains: Totals
    totals: Totals
    others: OthersTotals
    fleet: tuple[FleetClass, ...] = ()
    """How much less everyone emits and consumes, if the plan asks for it."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Replicate:
    """All futures of a decision driven once more, with fresh random numbers from the decision on."""

    seed: int
    """Seed of those numbers, the same for every future of the replicate."""
    stay: Branch
    """The future in which the ego keeps its route, compared with the drive itself: they differ by chance alone."""
    branches: tuple[Branch, ...]
    """The decision's branches, in their order, each compared with ``stay``."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Together:
    """A future in which other cars take the other route with the ego, compared with that in which nobody does."""

    share: float
    """Share of the cars that could take it; with 0 the ego is alone."""
    draw: int
    could: int
    """Number of cars whose routes pass both ends of the section in which the two routes differ."""
    took: int
    ego_gain_s: float
    took_gain_s: float
    """Total savings of the cars that took it too."""
    rest_gain_s: float
    """Total savings of all others that were present."""
    excluded: str = ""
    """Why it is excluded from the averages; empty if it counts."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Closed:
    """The two routes with a road closed at the decision, compared with the same routes with it open."""

    edge: str
    draw: int
    stay_loss_s: float
    """What the closure costs the ego if it keeps its route and takes a detour at the closure."""
    other_loss_s: float
    """What it costs the ego if it takes the other route."""
    gain_s: float
    """What the other route saves with the road closed."""
    open_gain_s: float
    """The same with it open."""
    others_loss_s: float
    """What it costs all others together, if the ego keeps its route."""
    others_later: int
    """Number of them that arrive later."""
    excluded: str = ""
    """Why it is excluded from the averages; empty if it counts."""


@dataclass(frozen=True, slots=True, kw_only=True)
class News:
    """What traffic news of one age says at a decision."""

    age_s: float
    stay_s: float | None
    """Expected travel time on the current route; None if the news does not have it."""
    delay_s: float
    """How much more of it than on empty roads."""
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
    """Delay ahead: how much longer the rest of the route takes at present speeds than at the limits."""
    eta_s: float
    """How long it takes at present speeds."""
    relative_speed: float
    """Mean speed ahead as a share of the free speed."""
    lost_s: float | None = None
    """Time that the ego had lost until then; None in rows of earlier versions."""
    complies_above: float = 0.0
    """The driver follows the advice at any compliance above this number, which was drawn from 0 to 1."""
    news: tuple[News, ...]
    ways: tuple[tuple[str, ...], ...] = ()
    """Edges from here to the destination: of the present route, then of each branch; empty in older rows."""
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
    """The kept route driven once more, with fresh random numbers; None if not drawn. Replicates contain it."""
    replicates: tuple[Replicate, ...] = ()
    """Further draws of all futures; the drive itself and ``branches`` are draw 0."""
    planned_draws: int = 0
    """Number of draws that did not depend on the results so far; 0 for all."""
    spreads: tuple[Spread, ...] = ()
    """How each branch affects everyone."""
    traffic: TrafficSummary | None = None
    """The traffic as a whole at the decision."""
    together: tuple[Together, ...] = ()
    """Futures in which others take the quickest other route too, at the first decision of a drive."""
    closed: tuple[Closed, ...] = ()
    """Futures in which a road is closed, at the first decision of a drive."""

    def complies(self, compliance: float) -> bool:
        """Whether a driver with that compliance follows the advice here."""
        return self.complies_above < compliance

    @property
    def time_index(self) -> float:
        """Expected travel time divided by that at free flow."""
        return self.eta_s / max(1.0, self.eta_s - self.delay_s)

    @property
    def draws(self) -> int:
        """How many times each future was driven."""
        return 1 + len(self.replicates)

    @property
    def scored(self) -> range:
        """The draws over which means are taken.

        Draws that were added until the sign of the gain was clear choose and tell the sign, but are in no mean:
        stopping there would bias it away from zero."""
        return range(self.planned_draws or self.draws)

    def drawn(self, draw: int, branch: int | None) -> Branch | None:
        """A branch in one draw; None for keeping the route."""
        if branch is None:
            return None
        return (self.replicates[draw - 1].branches if draw else self.branches)[branch]

    def gain(self, draw: int, branch: int | None) -> Totals:
        """The savings of a branch in one draw; zero for keeping the route."""
        found = self.drawn(draw, branch)
        return NOTHING if found is None else found.gains

    def gains(self, branch: int | None) -> Totals:
        """The mean savings of a branch over the scored draws; zero for keeping the route."""
        return Totals.mean([self.gain(draw, branch) for draw in self.scored])

    @property
    def unchanged(self) -> tuple[Branch, ...]:
        """The futures that differ from the drive itself by chance alone."""
        return (*((self.placebo,) if self.placebo else ()), *(each.stay for each in self.replicates))


@dataclass(frozen=True, slots=True, kw_only=True)
class WholeTrip:
    """A drive from departure to destination under one policy, compared with the one that keeps its route."""

    policy: str
    compliance: float = 1.0
    """Probability with which the driver followed it at each decision."""
    draw: int
    """0 with the random numbers of the drive itself, then with fresh ones."""
    reroutings: int
    """How many times the policy left its route; with 0 the two drives are the same."""
    branch: Branch
    excluded: str = ""
    """Why it is excluded from the averages; empty if it counts."""
    why: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class TripRow(JobRow):
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
    fresh: Fresh | None = None
    """How futures got fresh random numbers; None if none did."""
    stay: Totals | None = None
    """The drive itself; None without a decision."""
    decisions: tuple[Decision, ...] = ()
    whole: tuple[WholeTrip, ...] = ()
    """Whole drives under each policy, if the plan has them."""

    @property
    def line(self) -> dict[str, Any]:
        """The fields of a ``TripLine``."""
        return {each.name: getattr(self, each.name) for each in fields(TripLine)}


@dataclass(frozen=True, slots=True, kw_only=True)
class TripLine:
    """What a line of a table says of its drive."""

    id: str
    """Of the drive, or the number of the decision, as in ``choices.csv``."""
    scenario: str
    share: float
    seed: int
    departure_s: float
    trip: str


@dataclass(frozen=True, slots=True, kw_only=True)
class DecisionLine(TripLine):
    """What a line of a table says of its decision."""

    at_s: float
    edge: str
    delay_s: float
    eta_s: float


@dataclass(frozen=True, slots=True)
class DecisionPoint:
    """A decision with its drive."""

    id: str
    drive: TripRow
    decision: Decision

    @property
    def line(self) -> dict[str, Any]:
        """The fields of a ``DecisionLine``."""
        names = ("at_s", "edge", "delay_s", "eta_s")
        return {**self.drive.line, "id": self.id, **{name: getattr(self.decision, name) for name in names}}


@dataclass(frozen=True, slots=True, kw_only=True)
class PolicyChoice(DecisionLine):
    """One policy's choice at one decision with news of one age: a line of ``choices.csv``."""

    time_index: float
    """Expected travel time divided by that at free flow."""
    lost_ahead_s: float | None
    """Time that the kept route lost from there on: the most congestion that another one can avoid."""
    age_s: float
    policy: str
    compliance: float
    """Probability that the driver follows the advice."""
    complies: bool
    """Whether the driver does here; if so, at every greater probability too."""
    rerouted: bool
    branch: int | None
    """Number of the branch that it chose in most draws; None for keeping the route."""
    promised_s: float | None
    """Predicted saving on the other route."""
    stay: Annotated[Totals, InColumns("stay")]
    gain: Annotated[Totals, InColumns("gain")]
    regret_s: float
    """Time lost compared with the best future, which was chosen by the other draws if there are any."""
    others: int
    """Number of vehicles there at the decision; 0 if the policy keeps the route."""
    others_gain_s: float
    others_changed: float
    unfinished_stay: float
    unfinished: float
    draws: int
    """How many times each future was driven; ``gain`` and the figures of the others are means over them."""
    gain_error_s: float | None
    """Standard error of the mean time gained at this decision; None with a single draw."""
    won: float | None
    """Share of the draws that gained time where the mean of the others did too; None with a single draw."""
    lost: float | None
    """The same for time lost."""
    chose_best: float | None
    """Share of the draws for which this choice is the best by the other draws; None with a single draw."""
