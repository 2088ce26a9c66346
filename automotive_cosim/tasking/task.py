"""The form of a task.

A ``Task`` is data: what the driver says, where it can be said, which situation starts it, what is right then
and the reference solution. A safety task is a pair: two halves with the same words and screens and one declared
difference; what is right in one is wrong in the other.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import Annotated, Any

from annotated_types import Ge, Gt, Le

from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.belongings import NOTHING, Belongings
from automotive_cosim.cockpit.changes import CarChange
from automotive_cosim.cockpit.missing_parts import Lacking
from automotive_cosim.cockpit.occupants import Occupant, Seat
from automotive_cosim.cockpit.restrictions import Motion
from automotive_cosim.contracts import GoalStatus, Reason, Weather
from automotive_cosim.contracts.given import NEEDS_PICTURE, Language
from automotive_cosim.errors import UnknownNameError
from automotive_cosim.tasking.checks import Check, asked_in
from automotive_cosim.tasking.dialogue import NEUTRAL, Says, Topic
from automotive_cosim.tasking.moves import Move, Open, Slide, Tap, TapUntil, TypeText
from automotive_cosim.tasking.parameters import Choices, names
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.speech import Speech
from automotive_cosim.tasking.triggers import Trigger


class Module(StrEnum):
    """The eight modules of the cockpit (paper, figure of task distributions)."""

    MAPS = "maps"
    HVAC = "hvac"
    ROAD = "road"
    PHENOMENON = "phenomenon"
    MEDIA = "media"
    APPS = "apps"
    SYSTEM = "system"
    COMMS = "comms"


class Dimension(StrEnum):
    """The paper's taxonomy: two general dimensions, two safety-aware ones."""

    EXPLICIT_CONTROL = "explicit_control"
    IMPLICIT_INTENT = "implicit_intent"
    DRIVING_ALIGNMENT = "driving_alignment"
    ENVIRONMENT_ALERTS = "environment_alerts"

    @property
    def is_safety(self) -> bool:
        """Whether its tasks come in pairs."""
        return self in (Dimension.DRIVING_ALIGNMENT, Dimension.ENVIRONMENT_ALERTS)

    @property
    def is_implicit(self) -> bool:
        """Whether the words do not say what to do, or leave the danger unsaid."""
        return self in (Dimension.IMPLICIT_INTENT, Dimension.ENVIRONMENT_ALERTS)

    @property
    def subset(self) -> Subset:
        """The same on the axes of the authors' newer edition."""
        kind, words = "safety" if self.is_safety else "general", "implicit" if self.is_implicit else "explicit"
        return Subset(f"{kind}-{words}")


class Subset(StrEnum):
    """The subsets of the authors' newer edition: general or safety, explicit or implicit."""

    GENERAL_EXPLICIT = "general-explicit"
    GENERAL_IMPLICIT = "general-implicit"
    SAFETY_EXPLICIT = "safety-explicit"
    SAFETY_IMPLICIT = "safety-implicit"


class Ability(StrEnum):
    """What a task of the hard suite is hard by; each has one."""

    RULE = "rule"
    """Which rule holds here: by place, hour, road, a text or general knowledge; no line of the context says it."""
    CONTENT = "content"
    """A fact in a message, a memo, a photo or another app that contradicts the first impression."""
    CHAIN = "chain"
    """Many steps, of which one, a remark or an event changes what the later ones have to be."""
    MEMORY = "memory"
    """Several trips of one driver: what was told on one day is needed on another, unless it was withdrawn."""
    OCCUPANTS = "occupants"
    """People aboard, or who write, want different things, and not all of them may decide."""
    ORDERS = "orders"
    """Text that gives orders and comes from nobody who may: in messages, songs, places, appointments."""
    SENSORS = "sensors"
    """A sensor that measures wrongly, to be noticed because something else contradicts it."""
    PLANNING = "planning"
    """Facts that have to be looked up, people who refuse or counter, charge, ways and hours that must fit."""
    RESTRAINT = "restraint"
    """To watch, and to leave things alone though something tempts."""


class Basis(StrEnum):
    """What a verdict rests on."""

    POSTED = "posted"
    """A sign in the network."""
    LAW = "law"
    """A rule whose text was read; its id is ``Half.rule``."""
    PHYSICS = "physics"
    """A sourced threshold."""
    WISH = "wish"
    """Asked for outright."""


class Differs(StrEnum):
    """What the halves of a pair may differ in."""

    PLACE = "place"
    """Where on earth the same road lies."""
    ROAD = "road"
    """Which road, or where on it."""
    TRAFFIC = "traffic"
    """The other vehicles, or the distance that the driver keeps to them."""
    WEATHER = "weather"
    VISIBILITY = "visibility"
    DATE = "date"
    """Date or hour, with the light and the laws of that time."""
    TIME = "time of day"
    MOTION = "motion"
    """Parked or moving."""
    SETTINGS = "settings"
    """How the car is set before it departs."""
    UNITS = "units"
    """What the display counts in before it departs."""
    EVENTS = "events"
    """Calls, messages, remarks and changes of the car after the hand-over."""
    ABOARD = "occupants"
    """Who is aboard, awake or asleep, belted or not."""
    VOICE = "voice"
    """Who says it."""
    EQUIPMENT = "equipment"
    """What the car has and what works, which nobody sees before its screens are opened."""
    CONTENT = "content"
    """What messages, memos, appointments or places say, which nobody sees before they are opened."""


@dataclass(frozen=True, slots=True)
class Deadline:
    """Simulated seconds from the trigger by which the goal must hold, and why that many."""

    seconds: Annotated[float, Gt(0)]
    reason: str


@dataclass(frozen=True, slots=True)
class Start:
    """Where an episode begins. None means the scenario's own."""

    scenario: str
    trip: str
    origin: tuple[Annotated[float, Ge(-180), Le(180)], Annotated[float, Ge(-90), Le(90)]] | None = None
    """Longitude and latitude that the middle of the scenario's network is moved to, with the law, the clock and the
    climate of that place; None leaves it where it is. Both halves of a translated pair have one, because a scenario
    that has not been moved warms up in its own weather."""
    driver: str | None = None
    start: str | None = None
    """Local date and time at departure, ISO 8601 without zone."""
    parked: bool = False
    """Whether the car stays parked where the trip begins, in park and with the brake on."""
    weather: Weather | None = None
    aboard: tuple[Occupant, ...] = ()
    """Who is in the car besides the driver."""
    voice: Seat = Seat.DRIVER
    """The seat that the wish comes from. An agent hears which, unless it is the driver's."""
    cabin: Mapping[str, Any] = field(default_factory=dict)
    """Initial conditions of the cabin (``cockpit.cabin.CabinStart``)."""
    signals: Mapping[str, Any] = field(default_factory=dict)
    """VSS paths set before departure."""
    arrivals: tuple[Arrival, ...] = ()
    """Incoming calls and messages, in seconds after departure; ``CALL.RINGING`` and ``CALL.UNREAD`` reflect
    them."""
    belongings: Belongings = NOTHING
    """People, messages, appointments, memos and places in the cockpit besides those that are drawn."""
    interruptions: tuple[Arrival | CarChange, ...] = ()
    """Calls, messages and changes of the car that nobody commands, in seconds after the hand-over."""
    sign_camera: bool = True
    """Whether the car reads limit signs; without it, the status bar shows no sign."""
    trailer: bool = False
    """Whether the car tows a trailer, for which the law may have other limits."""
    lacks: tuple[Lacking, ...] = ()
    """What the car was not fitted with, or is out of order."""
    sensors: Mapping[str, Any] = field(default_factory=dict)
    """VSS paths of sensors that measure wrongly, and what they always read."""
    motions: frozenset[Motion] = frozenset(Motion)
    """Driving states in which the task may be handed over, in addition to its trigger."""


@dataclass(frozen=True, slots=True)
class Half:
    """One situation and what is right in it."""

    start: Start
    trigger: Trigger
    goal: Check
    moves: tuple[Move, ...]
    """The reference solution, as public actions; empty if the right act is to decline."""
    deadline: Deadline
    basis: Basis
    rule: str = ""
    """Id of the verified rule (``law``), or the source of the threshold (``physics``)."""
    declares: GoalStatus = GoalStatus.COMPLETE
    reasons: frozenset[Reason] = frozenset()
    """Reason codes that fit a declined task; scored apart, not part of success."""
    may_write: frozenset[str] = frozenset()
    """Keys of ``Moment.commands`` that may be commanded in addition to the goal's own. What the car itself couples
    to a command need not be named."""
    ways: tuple[tuple[Move, ...], ...] = ()
    """Other reference solutions: to every further end state that the goal accepts, or in another order."""
    slips: tuple[tuple[Move, ...], ...] = ()
    """What is usually done wrong here, as public actions before ``complete``: each must fail."""
    topics: tuple[Topic, ...] = ()
    """What the driver can be asked about."""
    neutral: str = NEUTRAL
    """What he answers to any other question, which does not help."""
    tells: tuple[tuple[str, ...], ...] = ()
    """What the driver has to be told before the end, each by any of its words."""
    most_words: int | None = None
    """Words of all answers together that the driver has time for; None for any number."""
    says: tuple[Says, ...] = ()
    """What the driver says later, besides the wish; the order counts if several are due at once."""

    @property
    def needed_topics(self) -> tuple[Topic, ...]:
        """The topics that the driver has to be asked about."""
        return tuple(asked_in(self.goal))

    @property
    def allowed_writes(self) -> frozenset[str]:
        """Keys of ``Moment.commands`` that may be commanded: the goal's own, and those allowed beside it."""
        return self.goal.writes | self.may_write


class Hurry(StrEnum):
    """What hurries whoever acts in a pair."""

    ROAD = "road"
    """Something on the road is due within ``HURRIED_S``."""
    CALL = "call"
    """Somebody rings, and gives up."""
    WORDS = "words"
    """The driver says more on the way, and half of what was to be done is done."""


HURRIED_S = 8.0
"""The shortest deadline of a half up to which the road hurries: four glances of two seconds (NHTSA 2013)."""


@dataclass(frozen=True, slots=True)
class Task:
    """One entry of the catalogue."""

    id: str
    module: Module
    dimension: Dimension
    templates: tuple[str, ...]
    """What the driver says, at least four phrasings; ``{name}`` is filled from ``parameters``."""
    first: Half
    second: Half | None = None
    difference: str = ""
    """What the second half changes: kinds (``Differs``), joined by commas and "and", a colon, and both sides in
    words. The first observations of the halves differ in nothing else."""
    parameters: Mapping[str, Choices] = field(default_factory=dict)
    """Values to draw for an instance: one of a list, or of the cockpit's content."""
    tags: frozenset[str] = frozenset()
    """Further properties, e.g. ``preference``, ``conflict``, ``place`` (place decides)."""
    scenarios: tuple[str, ...] = ()
    """Other scenarios in which it can run, in addition to its own."""
    suite: Suite = Suite.STANDARD
    spoken: Mapping[Language, Speech] = field(default_factory=dict)
    """How the driver says it in other languages than English."""
    only_english: str = ""
    """Why it is said in English alone, if it is for a reason: its point is the car's language."""
    ability: Ability | None = None
    """What it is hard by; only of tasks of the hard suite."""
    guess_loses: str = ""
    """Why a guess loses, of tasks of the hard suite."""
    changed: tuple[str, ...] = ()
    """What changed in what is asked or right, and why; each begins with its date, as in 2026-11-29."""

    @property
    def languages(self) -> tuple[Language, ...]:
        """The languages that the driver has words for it in, English first."""
        return Language.ENGLISH, *self.spoken

    @property
    def max_steps(self) -> int:
        """Default limit of actions per episode."""
        return self.suite.max_steps

    def half(self, name: str) -> Half:
        """The half ``first`` or ``second``. Raises UnknownNameError: there is no such half."""
        halves = {"first": self.first} | ({"second": self.second} if self.second else {})
        if name not in halves:
            raise UnknownNameError(f"half of task {self.id!r}", name, halves)
        return halves[name]

    @property
    def differs(self) -> frozenset[Differs]:
        """The kinds of its declared difference.

        Raises ValueError: the declaration does not begin with such kinds."""
        kinds = self.difference.partition(":")[0].replace(" and ", ", ").split(", ")
        return frozenset(map(Differs, kinds)) if self.difference else frozenset()

    @property
    def halves(self) -> tuple[str, ...]:
        return ("first", "second") if self.second else ("first",)

    @property
    def optimal_steps(self) -> int:
        """Number of actions of the reference solution, declaration included; scrolling may add some."""
        taps = (move.times if isinstance(move, Tap) else 1 for move in self.first.moves)
        return 1 + sum(times if isinstance(times, int) else 1 for times in taps)  # a parameter counts once

    @property
    def needs_picture(self) -> bool:
        """Whether something needed is in the picture alone."""
        return NEEDS_PICTURE in self.tags

    @property
    def hurries(self) -> Hurry | None:
        """What hurries whoever acts; None if nothing does, or of a task that is no pair."""
        if self.second is None:
            return None
        halves = (self.first, self.second)
        if any(half.says for half in halves):
            return Hurry.WORDS
        events = (each for half in halves for each in (*half.start.arrivals, *half.start.interruptions))
        if any(isinstance(each, Arrival) and each.kind == "call" for each in events):
            return Hurry.CALL
        is_short = min(half.deadline.seconds for half in halves) <= HURRIED_S
        return Hurry.ROAD if is_short and not any(half.start.parked for half in halves) else None

    @property
    def is_safety(self) -> bool:
        """Whether it is a safety task rather than a general one."""
        return self.dimension.is_safety

    @property
    def is_implicit(self) -> bool:
        """Whether it is implicit rather than explicit: the words do not say what to do."""
        return self.dimension.is_implicit

    @property
    def subset(self) -> Subset:
        """Its subset in the authors' newer edition."""
        return self.dimension.subset

    @property
    def skills(self) -> frozenset[str]:
        """What an agent must be able to do, derived from the reference solutions and the halves.

        ``ask`` (what is meant must be asked), ``navigate`` (leave the screen), ``repeat`` (the same control until
        it is right), ``slide``, ``type``, ``alert``, ``decline``, ``infer`` (implicit words), ``place`` (place
        decides), ``prefer`` (a stated preference), ``weigh`` (needs against each other)."""
        halves = [self.half(name) for name in self.halves]
        moves = [move for half in halves for move in half.moves]
        found = {
            "ask": any(half.needed_topics for half in halves),
            "navigate": any(isinstance(move, Open) for move in moves),
            "repeat": any(
                isinstance(move, TapUntil) or (isinstance(move, Tap) and move.times != 1) for move in moves
            ),
            "slide": any(isinstance(move, Slide) for move in moves),
            "type": any(isinstance(move, TypeText) for move in moves),
            "alert": any("alerts" in half.goal.writes for half in halves if not names(half.goal)),
            "decline": any(half.declares is not GoalStatus.COMPLETE for half in halves),
            "infer": self.is_implicit,
            "place": "place" in self.tags,
            "prefer": "preference" in self.tags,
            "weigh": "conflict" in self.tags,
        }
        return frozenset(skill for skill, needed in found.items() if needed)

    @property
    def runs_in(self) -> tuple[str, ...]:
        """Every scenario it can run in, its own first; translated halves may each have their own."""
        own = [self.half(half).start.scenario for half in self.halves]
        return tuple(dict.fromkeys([*own, *self.scenarios]))

    def runs_whole_in(self, scenario: str) -> bool:
        """Whether every half can run there."""
        own = [self.half(half).start.scenario for half in self.halves]
        return scenario in self.scenarios or all(scenario == each for each in own)
