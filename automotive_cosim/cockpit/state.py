"""Everything the screens are built from, and what acts on it.

``State`` is one mutable object of immutable values, so that copying is cheap. What an app keeps is its own
``AppData``. A touched widget sends a ``Message``; it is a ``Command`` if it commands the car, an app or the road.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field, replace
from datetime import datetime
from operator import is_
from typing import Any, ClassVar, TypeVar, cast

from automotive_cosim.cockpit.cabin import Cabin, CabinStart
from automotive_cosim.cockpit.changes import CarChange
from automotive_cosim.cockpit.make import HOME, Make
from automotive_cosim.cockpit.map import RoadMap
from automotive_cosim.cockpit.restrictions import ENTRIES_LIMIT, REASONS, Restriction, restrictions
from automotive_cosim.cockpit.room import Frame
from automotive_cosim.cockpit.signals import CALL, HMI, MOTION, Signal, Signals
from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.cockpit.telltales import RoadSign
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.cockpit.tyres import Tyres
from automotive_cosim.cockpit.vehicle import Vehicle
from automotive_cosim.contracts import (
    Answer,
    DrivingState,
    Feedback,
    FeedbackCode,
    RoadRequest,
    Severity,
    Surroundings,
)
from automotive_cosim.contracts.text import say

D = TypeVar("D", bound="AppData")

CARRIED_OUT = frozenset({FeedbackCode.OK, FeedbackCode.NO_EFFECT})
"""Answers after which a command counts as given."""
NOTICE_S = 10.0
"""How long a notice stays."""
NOTICES = 20
"""Number of notices kept in the list."""


class AppData:
    """What an app keeps, a frozen dataclass. It is replaced as a whole; ``State`` keeps one of each class."""

    __slots__ = ()

    prepares: ClassVar[bool] = False
    """Whether a change commands nothing by itself but is used by a later command, as a draft is."""

    def commands(self) -> Mapping[str, Any]:
        return {}

    def parts(self) -> Mapping[str, str]:
        """The initial parts of screens that depend on it (``State.picked``)."""
        return {}

    def names(self, state: State) -> Mapping[str, tuple[str, ...]]:
        """Names by kind that a task can ask for."""
        return {}

    def settled(self, state: State) -> None:
        """Follows signals that were commanded."""

    def commanded(self, state: State, signal: Signal[Any]) -> None:
        """Follows one signal that was commanded by itself, to another value."""

    def entered(self, state: State) -> None:
        """Follows the change to another screen."""

    def passed(self, state: State, before: Surroundings | None, dt_s: float) -> None:
        """Lets time pass.

        Args:
            state: in the present surroundings.
            before: the surroundings at the last time; None at departure.
            dt_s: seconds since."""

    def received(self, state: State) -> None:
        """Takes in what has come from outside."""

    def answered(self, state: State, request: RoadRequest, answer: Answer) -> None:
        """Takes the road's reply to a request."""

    def put_back(self, state: State, departed: State) -> None:
        """Puts back what the way used up, as it was at departure (``fresh.put_back``)."""


class Message(ABC):
    """What a touched widget sends. A message that is no command changes only what is shown."""

    __slots__ = ()

    @property
    def command(self) -> Command | None:
        return None

    @abstractmethod
    def perform(self, state: State) -> Feedback:
        """Its effect."""


class Command(Message):
    """A message that commands something, so that the counterfactual can give it once more."""

    __slots__ = ()

    @property
    def command(self) -> Command | None:
        return self

    @property
    def prepares(self) -> bool:
        """Whether it is used by a later command although it aims at nothing itself."""
        return False

    @abstractmethod
    def aims(self, state: State) -> frozenset[str]:
        """The keys of ``State.commands`` that it is given for, without what the car couples to them.

        Args:
            state: before it is performed."""

    def changes(self, state: State) -> Mapping[str, Any]:
        """The fields of app data that it will change, if it replaces app data."""
        return {}

    def repeat(self, state: State, record: CommandRecord, keys: Collection[str]) -> None:
        """Gives it once more as far as it aims at these keys: in full or not at all."""
        if record.aims & frozenset(keys):
            state.perform(self)


@dataclass(frozen=True, slots=True)
class CommandRecord:
    """A command that the car has carried out."""

    time_s: float
    """Simulation time."""
    command: Command
    aims: frozenset[str]
    """The keys of ``State.commands`` that it was given for, without what the car couples to them."""
    changes: Mapping[str, Any] = field(default_factory=dict)
    """The fields of app data that it replaced."""
    answers: tuple[tuple[RoadRequest, Answer], ...] = ()
    """What it asked of the road, and the replies."""


@dataclass(frozen=True, slots=True)
class Notice:
    """A line in the status bar that disappears by itself and stays among the notifications."""

    at_s: float
    clock: str
    text: str
    icon: Icon
    tone: Severity
    seen: bool = False
    """Whether it was removed from the status bar."""
    opens: tuple[str, str] | None = None
    """Screen and item that a tap on the notice leads to."""


@dataclass(frozen=True, slots=True)
class QuestionRecord:
    """A question to the driver."""

    text: str
    after: int
    """Number of commands before it that changed something."""


@dataclass(slots=True)
class State:
    """The cockpit at one instant."""

    vehicle: Vehicle
    roads: RoadMap
    sign_camera: bool
    cabin_start: CabinStart
    kept: Mapping[type[AppData], AppData] = field(default_factory=dict)
    """What the apps keep (``of``)."""
    cabin: Cabin | None = None
    """The surroundings; None before the first ``sense``."""
    tyres: Tyres | None = None
    injected: Mapping[str, Any] = field(default_factory=dict)
    """Injected values of sensors, by path."""
    outside: Surroundings | None = None
    heard: Surroundings | None = None
    """The surroundings when the car was last online, from which it knows the live traffic."""
    lookout: bool = False
    """Whether the car shows what it notices around, ahead and aboard (``apps.map.lookout``)."""
    places_on: frozenset[str] | None = None
    """Edges on which places may lie; None means any."""
    news: DrivingState | None = None
    """The road at the last report of the traffic service, for the lookout."""
    driven_s: float = 0.0
    """How long the driver had been driving without a break before departure."""
    size: ScreenSize = ScreenSize.STANDARD
    make: Make = HOME
    screen: str = "home"
    past: tuple[tuple[str, str], ...] = ()
    """Screens to go back to, with their items."""
    scrolled: Mapping[str, int] = field(default_factory=dict)
    """Scroll position of each list, in rows."""
    picked: Mapping[str, str] = field(default_factory=dict)
    """Selected parts of screens, by key."""
    focus: str = ""
    """Key of the focused text field."""
    keyboard: bool = False
    """Whether its keys are on the screen."""
    listening: bool = False
    """Whether it takes what is spoken next, which driving does not lock."""
    typed: Mapping[str, str] = field(default_factory=dict)
    """Text typed so far, by field."""
    aside: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    """Text by field of the screens that were left because of a call, by screen."""
    last_sign: RoadSign | None = None
    """The road sign that the camera read last; None without one."""
    signs_here: tuple[bool, bool, float | None] | None = None
    """What decides whether a sign is passed: tunnel, school zone, and the posted limit in km/h."""
    notices: tuple[Notice, ...] = ()
    asked: tuple[RoadRequest, ...] = ()
    """Every irrevocable request to the road so far."""
    questions: tuple[QuestionRecord, ...] = ()
    """Every question to the driver."""
    pending: tuple[RoadRequest, ...] = ()
    changes: tuple[CarChange, ...] = ()
    """Changes of the car that are still to come or going on."""
    departed_s: float = 0.0
    """Simulation time of the first ``sense``."""
    parked_s: float | None = None
    """Simulation time at which the driver parked on the way; None while under way."""
    given: tuple[CommandRecord, ...] = ()
    """What was commanded, in order."""
    told: tuple[tuple[Any, ...], Mapping[str, Any]] = ((None,) * 4, {})
    """What ``commands`` gave last, and what that was read from."""

    def copy(self) -> State:
        return replace(self, vehicle=self.vehicle.copy())

    def of(self, kind: type[D]) -> D:
        """What an app keeps of that class."""
        return cast(D, self.kept[kind])

    def keep(self, *data: AppData) -> None:
        """Replaces what an app keeps."""
        self.kept = {**self.kept, **{type(each): each for each in data}}

    def change(self, data: AppData, words: str) -> Feedback:
        """Replaces what an app keeps, unless it is the same, and says so."""
        if self.of(type(data)) == data:
            return UNCHANGED
        self.keep(data)
        return Feedback(FeedbackCode.OK, words)

    @property
    def apps(self) -> Iterable[AppData]:
        """What all apps keep, as it is now."""
        return tuple(self.kept.values())

    @property
    def signals(self) -> Signals:
        return self.vehicle.signals

    def beside(self, screen: str) -> bool:
        """Whether another screen of the same app is offered on this one: unless the make has it elsewhere."""
        return self.make.holders.get(screen) == self.make.holders.get(self.screen)

    @property
    def frame(self) -> Frame:
        """Where the parts of the display lie."""
        return self.make.frame(self.size)

    @property
    def time_s(self) -> float:
        """Simulation time; 0 before the first ``sense``."""
        return 0.0 if self.outside is None else self.outside.driving.time_s

    @property
    def clock(self) -> str:
        """Local time as the status bar shows it."""
        return "--:--" if self.outside is None else self.clock_at(self.outside.local_time)

    def clock_at(self, time: datetime) -> str:
        """A time of day in the driver's format."""
        if self.signals[HMI.TIME_FORMAT] == "HR_24":
            return time.strftime("%H:%M")
        return f"{(time.hour - 1) % 12 + 1}:{time.minute:02d} {'am' if time.hour < 12 else 'pm'}"

    @property
    def restrictions(self) -> Restriction:
        return restrictions(self.signals[MOTION.GEAR], self.signals[MOTION.SPEED])

    @property
    def entries_limit(self) -> int | None:
        """Present limit of list entries; None for all."""
        return ENTRIES_LIMIT if Restriction.LIMIT_CONTENT in self.restrictions else None

    def locked(self, restriction: Restriction) -> str:
        """Why that is locked now; empty if it is not."""
        return REASONS[restriction] if restriction in self.restrictions else ""

    @property
    def is_typing(self) -> bool:
        """Whether the keyboard is on the screen."""
        return self.keyboard and bool(self.focus)

    @property
    def notice(self) -> Notice | None:
        """The newest notice, if it is still shown."""
        newest = self.notices[-1] if self.notices else None
        fresh = newest is not None and not newest.seen and self.time_s - newest.at_s < NOTICE_S
        return newest if fresh else None

    def notify(
        self,
        text: str,
        icon: Icon,
        tone: Severity = Severity.INFO,
        *,
        seen: bool = False,
        opens: tuple[str, str] | None = None,
    ) -> None:
        """Shows a line in the status bar, or keeps it silently among the notifications if ``seen``."""
        notice = Notice(self.time_s, self.clock, text, icon, tone, seen, opens)
        self.notices = (*self.notices[1 - NOTICES :], notice)

    def said(self, words: str, icon: Icon) -> Feedback:
        """Shows and returns a success."""
        self.notify(words, icon)
        return Feedback(FeedbackCode.OK, words)

    def refused(self, why: str) -> Feedback:
        """Shows and returns a failure."""
        self.notify(why, Icon.INFO)
        return Feedback(FeedbackCode.REFUSED, why)

    def perform(self, message: Message) -> Feedback:
        """Performs a message, and records it if it commands or prepares something and the car carries it out."""
        command = message.command
        if command is None:
            return message.perform(self)
        aims, changes = command.aims(self), command.changes(self)
        feedback = message.perform(self)
        if (aims or command.prepares) and feedback.code in CARRIED_OUT:
            self.given += (CommandRecord(self.time_s, command, aims, changes),)
        return feedback

    def settle(self) -> None:
        """Lets the apps follow signals that were commanded."""
        for data in self.apps:
            data.settled(self)

    def enter(self, screen: str) -> None:
        """Shows a screen without what was typed on it, unless it was left because of a call."""
        calling: bool = self.signals[CALL.RINGING] != "" or self.signals[CALL.PARTNER] != ""
        if self.typed and calling:
            self.aside = {**self.aside, self.screen: self.typed}
        self.screen = screen
        self.focus, self.typed = "", self.aside.get(screen, {})
        self.aside = {name: typed for name, typed in self.aside.items() if name != screen}
        for data in self.apps:
            data.entered(self)

    def rewind(self, lists: str) -> None:
        """Resets the lists whose key has this prefix to their start, since their content changed."""
        self.scrolled = {key: first for key, first in self.scrolled.items() if not key.startswith(lists)}

    def commands(self) -> Mapping[str, Any]:
        """Everything that can be commanded: actuators, app data, and what was irrevocably sent. The same object as
        long as nothing is: a drive keeps it once a second."""
        sources = self.signals.actuators, self.asked, self.questions, self.kept
        known, told = self.told
        if not all(map(is_, sources, known)):
            commanded = self._commanded()
            self.told = sources, told if told == commanded else commanded
        return self.told[1]

    def _commanded(self) -> dict[str, Any]:
        commanded = self.signals.commanded() | {
            "requests": list(self.asked),
            "questions": [{"text": asked.text, "commands": asked.after} for asked in self.questions],
        }
        for data in self.apps:
            commanded |= data.commands()
        return commanded


UNCHANGED = Feedback(FeedbackCode.NO_EFFECT, say("it is already set that way"))
"""The answer to a change that changes nothing."""
