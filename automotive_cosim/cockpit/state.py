"""Everything the screens are built from: one mutable state of immutable values, so copying is cheap."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from datetime import datetime
from typing import Any

from automotive_cosim.cockpit.arrivals import Arrival
from automotive_cosim.cockpit.cabin import Cabin, CabinStart
from automotive_cosim.cockpit.changes import CarChange
from automotive_cosim.cockpit.desk import Desk
from automotive_cosim.cockpit.map import RoadMap
from automotive_cosim.cockpit.media import Library, Listening
from automotive_cosim.cockpit.messages import Deed
from automotive_cosim.cockpit.navigation import Navigation
from automotive_cosim.cockpit.people import Directory, Phone
from automotive_cosim.cockpit.places import Gazetteer
from automotive_cosim.cockpit.restrictions import ENTRIES_LIMIT, REASONS, Restriction, restrictions
from automotive_cosim.cockpit.signals import HMI, LINK, MOTION, Signals
from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.cockpit.telltales import RoadSign
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.cockpit.tyres import Tyres
from automotive_cosim.cockpit.vehicle import Vehicle
from automotive_cosim.contracts import (
    Alert,
    AlertKind,
    DrivingState,
    Feedback,
    FeedbackCode,
    RoadRequest,
    Severity,
    Surroundings,
)

NOTICE_S = 10.0
"""How long a notice stays."""
NOTICES = 20
"""Number of notices kept in the list."""


PICKED: Mapping[str, str] = {
    "map.list": "saved",
    "explore": "all",
    "route": "turns",
    "outside": "rain",
    "media.list": "all",
    "phone": "favourites",
    "seats": "driver",
    "manual": "0",
}
"""The initial parts of screens with several parts."""


@dataclass(frozen=True, slots=True)
class AlertDraft:
    """The alert being prepared in the safety centre."""

    kind: AlertKind | None = None
    severity: Severity = Severity.WARNING
    speed_kmh: float | None = None
    """Advised speed; None means the posted limit."""


@dataclass(frozen=True, slots=True)
class AlertRecord:
    """One line of the history."""

    clock: str
    alert: Alert
    answer: str = ""
    """The road's reply."""


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
    deeds: int
    """Number of commands before it that changed something."""


@dataclass(slots=True)
class State:
    """The cockpit at one instant."""

    vehicle: Vehicle
    roads: RoadMap
    library: Library
    atlas: Gazetteer
    directory: Directory
    navigation: Navigation
    listening: Listening
    phone: Phone
    desk: Desk
    sign_camera: bool
    cabin_start: CabinStart
    cabin: Cabin | None = None
    """The surroundings; None before the first ``sense``."""
    tyres: Tyres | None = None
    injected: Mapping[str, Any] = field(default_factory=dict)
    """Injected values of sensors, by path."""
    outside: Surroundings | None = None
    heard: Surroundings | None = None
    """The surroundings when the car was last online, from which it knows the live traffic."""
    lookout: bool = False
    """Whether the car shows what it notices around, ahead and aboard (``screens.lookout``)."""
    news: DrivingState | None = None
    """The road at the last report of the traffic service, for the lookout."""
    driven_s: float = 0.0
    """How long the driver had been driving without a break before departure."""
    size: ScreenSize = ScreenSize.STANDARD
    screen: str = "home"
    past: tuple[tuple[str, str], ...] = ()
    """Screens to go back to, with their items."""
    scrolled: Mapping[str, int] = field(default_factory=dict)
    """Scroll position of each list, in rows."""
    picked: Mapping[str, str] = field(default_factory=lambda: PICKED)
    """Selected parts of screens, by key."""
    focus: str = ""
    """Key of the focused text field."""
    keyboard: bool = False
    """Whether its keys are on the screen."""
    typed: Mapping[str, str] = field(default_factory=dict)
    """Text typed so far, by field."""
    aside: Mapping[str, Mapping[str, str]] = field(default_factory=dict)
    """Text by field of the screens that were left because of a call, by screen."""
    zoom: int = 1
    north_up: bool = False
    last_sign: RoadSign | None = None
    """The road sign that the camera read last; None without one."""
    signs_here: tuple[bool, bool, float | None] | None = None
    """What decides whether a sign is passed: tunnel, school zone, and the posted limit in km/h."""
    panned: tuple[float, float] | None = None
    """The map's point in metres of the network, if not the car."""
    draft: AlertDraft = field(default_factory=AlertDraft)
    alerts: tuple[AlertRecord, ...] = ()
    notices: tuple[Notice, ...] = ()
    calls: tuple[str, ...] = ()
    asked: tuple[RoadRequest, ...] = ()
    """Every irrevocable request to the road so far."""
    questions: tuple[QuestionRecord, ...] = ()
    """Every question to the driver."""
    horns: int = 0
    washes: int = 0
    pending: tuple[RoadRequest, ...] = ()
    expected: tuple[Arrival, ...] = ()
    """Calls and messages still to come."""
    changes: tuple[CarChange, ...] = ()
    """Changes of the car that are still to come or going on."""
    departed_s: float = 0.0
    """Simulation time of the first ``sense``."""
    parked_s: float | None = None
    """Simulation time at which the driver parked on the way; None while under way."""
    played_s: float = 0.0
    """Playing time of the track."""
    deeds: tuple[Deed, ...] = ()
    """What was commanded, in order."""

    def copy(self) -> State:
        """An independent copy."""
        return replace(self, vehicle=self.vehicle.copy())

    @property
    def signals(self) -> Signals:
        """The vehicle's signals."""
        return self.vehicle.signals

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
        """The present restrictions."""
        return restrictions(self.signals[MOTION.GEAR], self.signals[MOTION.SPEED])

    @property
    def entries_limit(self) -> int | None:
        """Present limit of list entries; None for all."""
        return ENTRIES_LIMIT if Restriction.LIMIT_CONTENT in self.restrictions else None

    def locked(self, restriction: Restriction) -> str:
        """Why that is locked now; empty if it is not."""
        return REASONS[restriction] if restriction in self.restrictions else ""

    @property
    def wifi(self) -> str:
        """Name of the Wi-Fi network that the car is on; empty without."""
        return self.desk.network if self.signals[LINK.WIFI] else ""

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

    def commands(self) -> dict[str, Any]:
        """Everything that can be commanded: actuators, app data, and what was irrevocably sent."""
        return self.signals.commanded() | {
            "alerts": [
                {
                    "kind": str(given.alert.kind),
                    "severity": str(given.alert.severity),
                    "text": given.alert.text,
                    "speed_kmh": given.alert.speed_kmh,
                }
                for given in self.alerts
            ],
            "calls": list(self.calls),
            "requests": list(self.asked),
            "questions": [{"text": asked.text, "deeds": asked.deeds} for asked in self.questions],
            "horn": self.horns,
            "washer": self.washes,
            **self.navigation.commands(),
            **self.listening.commands(),
            **self.phone.commands(),
            **self.desk.commands(),
        }
