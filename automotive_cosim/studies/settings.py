"""What can be set about a study. Each field is an option of its command and a value in its manifest."""

from __future__ import annotations

from dataclasses import KW_ONLY, asdict, dataclass
from typing import Annotated, ClassVar, Literal

from annotated_types import Ge, Le, MinLen

from automotive_cosim.contracts import OLDEST_NEWS_S, Json
from automotive_cosim.formats.annotations import Option
from automotive_cosim.formats.scenario import Scenario

CarShare = Annotated[float, Ge(0), Le(1)]
TrafficSeed = Annotated[int, Ge(0)]
DemandScale = Annotated[float, Ge(0.01), Le(100)]
WarmUpTime = Annotated[float, Ge(0), Le(86_400)]
SCENARIOS_OWN = Option(default="scenario's")


@dataclass(frozen=True, slots=True)
class TrafficSettings:
    """What every study sets; times in seconds."""

    scenario: Annotated[str, MinLen(1)] = "paris_centre"
    """A scenario's name or folder, or any .sumocfg or .net.xml."""
    _: KW_ONLY
    seeds: Annotated[tuple[TrafficSeed, ...], MinLen(1)] = tuple(range(10))
    """Seeds of the traffic, each of which is a day, as in 0-9; at least 10 for an interval, 30 to publish."""
    scale: Annotated[DemandScale | None, SCENARIOS_OWN] = None
    """Factor on the demand."""
    warm_up_s: Annotated[WarmUpTime | None, SCENARIOS_OWN] = None
    """Seconds of traffic before anything counts."""

    kind: ClassVar[str]
    """Kind of study in the manifest, so that a report knows what it reads."""
    sets: ClassVar[tuple[str, ...]] = ("seeds",)
    """Lists in which a value must not come twice."""

    def as_json(self) -> Json:
        """The plan as a JSON object, for the manifest."""
        values = {name: list(value) if isinstance(value, tuple) else value for name, value in asdict(self).items()}
        return {"study": self.kind} | values


@dataclass(frozen=True, slots=True, kw_only=True)
class _DrivenSettings(TrafficSettings):
    """What studies set that fork the traffic."""

    incidents: Annotated[tuple[str, ...], Option("incident", repeats=True)] = ()
    """An incident in every copy of the traffic, besides the scenario's own, with the fields of scenario.toml, as in
    'breakdown edge=c1c2 position_m=120'; its times count from the end of the warm-up; may be repeated."""
    redraw: bool = False
    """Redraw the trips of the demand for every seed, as on another day."""
    emissions: bool = False
    """Measure what every vehicle emits and consumes, by emission class."""
    step_s: Annotated[Annotated[float, Ge(0.1), Le(1)] | None, Option(default="1, or the .sumocfg's")] = None
    """SUMO's step length in seconds."""

    def driven_step_s(self, scenario: Scenario) -> float:
        """The step length with which the scenario is driven."""
        own_s = scenario.sumo.step_length_s if scenario.as_stated else 1.0
        return own_s if self.step_s is None else self.step_s


@dataclass(frozen=True, slots=True, kw_only=True)
class RerouteSettings(_DrivenSettings):
    """What a rerouting study sets."""

    kind: ClassVar[str] = "reroute"
    sets: ClassVar[tuple[str, ...]] = (
        "departures_s",
        "seeds",
        "shares",
        "ages_s",
        "compliance",
        "policies",
        "trips",
        "together",
    )

    departures_s: Annotated[
        tuple[Annotated[float, Ge(0), Le(86_400)], ...], MinLen(1), Option(form="LIST", read=str)
    ] = (0.0, 300.0, 600.0, 900.0)
    """When the ego departs, each time in its own copy of the traffic: seconds after the warm-up, or clock times."""
    trips: Annotated[tuple[str, ...], Option(default="all")] = ()
    """Ego trips of the scenario: names, the beginnings of names, or numbers as in `scenarios show`."""
    from_place: Annotated[str, Option("from")] = ""
    """Where the ego's route begins, instead of a trip: an edge, a street or LON,LAT."""
    to_place: Annotated[str, Option("to")] = ""
    """Where it ends; if only one of the two is given, the other is drawn, several times."""
    shares: Annotated[tuple[CarShare, ...], SCENARIOS_OWN] = ()
    """Shares of the other cars that reroute, 0 to 1; each is warmed up separately."""
    ages_s: Annotated[tuple[Annotated[float, Ge(0), Le(OLDEST_NEWS_S)], ...], MinLen(1)] = (0.0,)
    """Ages of the traffic news in seconds, by which the alternative route is selected."""
    compliance: Annotated[tuple[CarShare, ...], MinLen(1)] = (1.0,)
    """Probabilities that the driver follows the advice, at the same decisions; most tables use only the first."""
    policies: Annotated[tuple[str, ...], MinLen(1)] = ("never", "always", "delay:60", "sumo", "best")
    """Policies: never, always, delay:SECONDS, sumo, best, agent:NAME, agent:NAME/MODEL."""
    least_delay_s: Annotated[float, Ge(0), Le(3_600), Option("delay")] = 30.0
    """Expected delay ahead, in seconds, from which a decision is due."""
    every_s: Annotated[float, Ge(10), Le(3_600)] = 60.0
    """Seconds between two decisions of a drive."""
    per_drive: Annotated[int, Ge(1), Le(50)] = 5
    """Maximum number of decisions per drive."""
    placebo_every: Annotated[int, Ge(0), Le(1_000_000)] = 1
    """One placebo in this many drives with a decision; 0 for none. `--replicates` contain it."""
    replicates: Annotated[int, Ge(1), Le(100)] | Literal["auto"] = 1
    """How many times each route is driven, with fresh random numbers; auto: more times where the sign of the mean
    gain is unclear."""
    arrived: Annotated[float, Ge(0.5), Le(1)] = 0.95
    """Share of the vehicles present at a decision that must arrive before the drive ends."""
    limit_s: Annotated[float, Ge(60), Le(86_400)] = 7_200.0
    """Simulated seconds after which a drive ends anyway."""
    half_width_s: Annotated[Annotated[float, Ge(0.1), Le(3_600)] | None, Option("until")] = None
    """Add seeds until the mean gain is known to within this many seconds."""
    whole_drives: bool = False
    """Also drive every policy from departure to destination."""
    together: tuple[CarShare, ...] = ()
    """Shares, 0 to 1, of the eligible cars that take the quickest other route with the ego."""
    close: Annotated[str, Option(default="none")] = ""
    """Also close a road at the first decision of each drive: an edge, or `ahead` for one on the ego's route."""
    via: Literal["stops", "route"] = "stops"
    """What a trip's via edges are: stops, which every route passes, or route, which other routes may leave."""
    ego_class: Annotated[str, Option(default="SUMO's for cars")] = ""
    """SUMO's emission class of the ego, as Energy/default for an electric one."""
    trajectories: bool = False
    """Store the ego's position on every route, step by step."""
    agent_steps: Annotated[int, Ge(1), Le(100)] = 12
    """Maximum number of an agent's actions per decision."""


@dataclass(frozen=True, slots=True, kw_only=True)
class CongestionSettings(_DrivenSettings):
    """What a congestion study sets."""

    kind: ClassVar[str] = "congestion"
    sets: ClassVar[tuple[str, ...]] = ("interventions", "seeds")

    interventions: Annotated[tuple[str, ...], Option("intervention", repeats=True)] = ()
    """An intervention to compare with none: an incident with the fields of scenario.toml (as 'closure edge=c2c3'),
    'advice share=0.5 compliance=0.8 age_s=300' or 'signals control=static'. May be repeated."""
    minutes: Annotated[float, Ge(5), Le(1_440)] = 60.0
    """How long to measure after the warm-up, in whole five minutes."""
    demand: Annotated[tuple[DemandScale, ...], MinLen(1)] = (1.0,)
    """Factors on the demand in periods of equal length, as in 0.6,1,0.6 for a peak; the first also holds in the
    warm-up."""
    share: Annotated[CarShare | None, SCENARIOS_OWN] = None
    """Share of the cars with SUMO's rerouting device."""


@dataclass(frozen=True, slots=True, kw_only=True)
class AdoptionSettings(_DrivenSettings):
    """What a study of an assistant's adoption sets."""

    kind: ClassVar[str] = "adoption"
    sets: ClassVar[tuple[str, ...]] = ("shares", "seeds")

    agent: Annotated[str, MinLen(1)] = "worthwhile:1.2:60"
    """The assistant: a rule for routes (never, always, delay:SECONDS, worthwhile:FACTOR:SECONDS, sumo), an agent of
    drives, as in rule-perfect or NAME/MODEL, a FILE.jsonl of actions, or package.module:Class with `act` or
    `advise`."""
    shares: Annotated[tuple[Annotated[float, Ge(0), Le(100)], ...], MinLen(1)] = (0.0, 5.0, 10.0, 25.0, 50.0, 100.0)
    """Per cent of the cars that have it; a greater share has the cars of every smaller one; 0 is always run."""
    driver: str = "average"
    """Driver profile by which drivers react to the assistant; otherwise they drive as they would."""
    minutes: Annotated[float, Ge(1), Le(1_440)] = 60.0
    """How long after the warm-up the traffic is followed."""
    every_s: Annotated[float, Ge(10), Le(3_600)] = 60.0
    """Seconds between two looks of a rule, or of a class with advise, at the news."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DaysSettings(TrafficSettings):
    """What a study of advice from day to day sets."""

    kind: ClassVar[str] = "days"
    sets: ClassVar[tuple[str, ...]] = ("shares", "seeds")

    seeds: Annotated[tuple[TrafficSeed, ...], MinLen(1)] = tuple(range(3))
    """Seeds of the traffic, and of who is advised and follows."""
    shares: Annotated[tuple[CarShare, ...], MinLen(1)] = (0.0, 0.25, 0.5, 0.75, 1.0)
    """Shares of the drivers who are advised; a greater share contains the drivers of every smaller one."""
    compliance: CarShare = 0.5
    """Probability that a driver follows the advice of a day."""
    memory: CarShare = 0.7
    """Weight of all earlier days in what is remembered; the rest is that of the day just over."""
    lag: Annotated[int, Ge(0), Le(30)] = 0
    """Age of the news: how many days pass before a day is in the memory that advises."""
    adviser: Annotated[str, Option(default="quickest route by memory")] = ""
    """A class of your own that chooses the routes of the advised: `package.module:Class`."""
    days: Annotated[int, Ge(2), Le(365)] = 30
    """Most days to drive after the first."""
    minutes: Annotated[float, Ge(5), Le(1_440)] = 60.0
    """How long after the warm-up departures count."""


HOME = "automotive_cosim.studies"
NETWORKS = {
    CongestionSettings.kind: ("congestion.results:CongestionStudy", "congestion.page:shown", "seed"),
    AdoptionSettings.kind: ("adoption.adoption:AdoptionStudy", "adoption.page:shown", "seed"),
    DaysSettings.kind: ("days.days:DaysStudy", "days.page:shown", "share of a seed"),
}
"""Studies of a whole network: what reads the folder, what its report shows, and what a row is about."""
