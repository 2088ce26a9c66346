"""The specification of an episode, the conditions that it is played under, its seeds and its end."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from enum import StrEnum
from typing import Annotated, TypeVar

import numpy as np
from annotated_types import Ge, Gt

from automotive_cosim.cockpit.language import Language
from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.formats.annotations import Latitude, Longitude, OneOf
from automotive_cosim.formats.checked import checked
from automotive_cosim.formats.toml import dotted
from automotive_cosim.interface.controls import GeoInput
from automotive_cosim.interface.feedback import FeedbackDetail
from automotive_cosim.interface.observe import ALL, Channel, See
from automotive_cosim.tasking.draws import SEED_LIMIT

Named = TypeVar("Named", bound=StrEnum)

ACTION_COST_S = 1.0
"""Simulated seconds per action: about the time of a person's tap (NHTSA 2013 counts glances of up to 2 s)."""
ROUNDING_S = 1e-9
"""Tolerance of sums of simulated seconds."""


class Clock(StrEnum):
    """What an agent's answer costs on the road, besides the action itself."""

    FIXED = "fixed"
    """The same for every answer, by default nothing."""
    MODEL = "model"
    """The seconds that the model really took, in addition."""


SCREEN = frozenset({Channel.SCREENSHOT, Channel.ELEMENTS})
_AS = {Channel.SCREENSHOT: "its picture", Channel.ELEMENTS: "its list of elements"}


@dataclass(frozen=True, slots=True)
class Conditions:
    """The agent's input and limits."""

    channels: frozenset[Channel] = ALL
    """Channels that the agent wants; ``geo`` and ``see`` may withhold some of them."""
    geo: GeoInput = GeoInput.FULL
    """What the agent is told about its place."""
    max_steps: int | None = None
    """Actions after which the episode is cut off; None takes the task's own limit (``Suite.max_steps``)."""
    max_sim_s: float | None = None
    """Simulated seconds from the hand-over after which it is cut off; None leaves that to ``max_steps``."""
    action_cost_s: float = ACTION_COST_S
    """Simulated seconds per action; a ``wait`` takes as many for each of its seconds."""
    see: See = See.BOTH
    """How the agent sees the screen."""
    feedback: FeedbackDetail = FeedbackDetail.QUIET
    """What it is told about its last action."""
    screen: ScreenSize = ScreenSize.STANDARD
    """Size of the car's screen."""

    def __post_init__(self) -> None:
        """Refuses to blind the agent.

        Raises:
            UserError: nothing of the screen is left that it can see.
        """
        if self.channels & SCREEN and not self.given & SCREEN:
            (only,) = self.channels & SCREEN
            raise UserError(
                f"the agent sees the screen only as {_AS[only]}, which --see {self.see} withholds; "
                f"choose another agent, or --see {'tree' if only is Channel.ELEMENTS else 'picture'} or both"
            )

    @property
    def given(self) -> frozenset[Channel]:
        """The channels that the agent gets."""
        return self.channels - self.geo.withheld - self.see.withheld


@dataclass(frozen=True, slots=True)
class EpisodeSpec:
    """What to run, by name: the same specification and the same actions give the same trace."""

    task: str = "road_speed_80_in_50"
    half: str = "first"
    """``first`` or, for a pair, ``second``."""
    scenario: str | None = None
    """A name, a folder, a ``.sumocfg`` or a network; None takes the task's own."""
    origin: tuple[Longitude, Latitude] | None = None
    """Longitude and latitude that the middle of its network is moved to, with that place's law, clock and climate;
    the task's own date, time and weather stay. None leaves it where it is."""
    gps: bool = True
    """False for no GPS, so the place is unknown; a network without projection then runs too."""
    from_place: str = ""
    """Where the ego's route begins, instead of the task's trip: an edge, a street, ``LON,LAT``."""
    to_place: str = ""
    """Where it ends. If only one of the two is given, the other is drawn."""
    seed: Annotated[int, Ge(0)] = 0
    """Seed of the traffic, and of everything that is drawn."""
    held_out: bool = False
    """Whether the driver says the task's held-out phrasing (``tasking.instance.Instance.held_out``); otherwise any
    phrasing is drawn."""
    geo: Annotated[GeoInput, OneOf(GeoInput, "geo control")] = GeoInput.FULL
    """What the agent is told about its place."""
    max_steps: Annotated[int, Ge(1)] | None = None
    """Actions after which the episode is cut off; None takes the task's own limit, 20 or in the hard suite 40."""
    max_sim_s: Annotated[float, Gt(0)] | None = None
    """Simulated seconds from the hand-over after which it is cut off; None leaves that to ``max_steps``."""
    action_cost_s: Annotated[float, Gt(0)] = ACTION_COST_S
    """Simulated seconds per action."""
    see: Annotated[See, OneOf(See, "way to see the screen")] = See.BOTH
    """How the agent sees the screen."""
    feedback: Annotated[FeedbackDetail, OneOf(FeedbackDetail, "kind of feedback")] = FeedbackDetail.QUIET
    """What it is told about its last action."""
    screen: Annotated[ScreenSize, OneOf(ScreenSize, "size of the screen")] = ScreenSize.STANDARD
    """Size of the car's screen."""
    language: Annotated[Language, OneOf(Language, "language")] = Language.ENGLISH
    """What the driver speaks, and the car shows."""

    def check(self) -> None:
        """Tries the values; whether there is such a task or scenario is found out where those are looked up.

        Raises:
            UserError: one of the wrong type or out of its range.
        """
        checked(type(self), asdict(self), lambda steps: ("the episode", dotted(steps)))

    def conditions(self, channels: frozenset[Channel] = ALL) -> Conditions:
        """The conditions for an agent that wants these channels.

        Raises:
            UserError: it could see nothing of the screen.
        """
        return Conditions(
            channels,
            self.geo,
            self.max_steps,
            self.max_sim_s,
            self.action_cost_s,
            self.see,
            self.feedback,
            self.screen,
        )


def _named(kind: type[Named], what: str, name: str) -> Named:
    if name not in set(kind):
        raise UnknownNameError(what, name, kind)
    return kind(name)


def clock_of(name: str) -> Clock:
    """The clock by name.

    Raises:
        UnknownNameError: there is none.
    """
    return _named(Clock, "clock", name)


def see_of(name: str) -> See:
    """The way to see the screen by name.

    Raises:
        UnknownNameError: there is none.
    """
    return _named(See, "way to see the screen", name)


def feedback_of(name: str) -> FeedbackDetail:
    """The kind of feedback by name.

    Raises:
        UnknownNameError: there is none.
    """
    return _named(FeedbackDetail, "kind of feedback", name)


def screen_of(name: str) -> ScreenSize:
    """The size of the screen by name.

    Raises:
        UnknownNameError: there is none.
    """
    return _named(ScreenSize, "size of the screen", name)


def language_of(name: str) -> Language:
    """The language by its code.

    Raises:
        UnknownNameError: there is none.
    """
    return _named(Language, "language", name)


@dataclass(frozen=True, slots=True)
class Seeds:
    """The seeds of everything random in one episode."""

    traffic: int
    """Seed of SUMO: the warm traffic that the ego departs into."""
    instance: int
    """Number of the task's instance, from which everything else is drawn (``tasking.draws``)."""


class SeedSource:
    """Seeds of successive episodes, with the semantics of gymnasium's ``reset``."""

    def __init__(self, seed: int | None = None) -> None:
        """Begins with this seed; None begins randomly."""
        self._rng = np.random.default_rng(seed)
        self._next = int(self._rng.integers(SEED_LIMIT)) if seed is None else int(seed)
        self.traffic = self._next % SEED_LIMIT
        """The next episodes' traffic; the seed's own, unless set to another."""

    def next(self) -> Seeds:
        """Seeds of the next episode: first the seed's own instance, then in the same traffic others."""
        seeds = Seeds(self.traffic, self._next)
        self._next = int(self._rng.integers(SEED_LIMIT))
        return seeds


class End(StrEnum):
    """Why an episode ended."""

    DECLARED = "declared"
    DRIVE_ENDED = "drive_ended"
    WATCH_OVER = "watch_over"
    """The time of a drive is over."""
    OUT_OF_STEPS = "out_of_steps"
    OUT_OF_TIME = "out_of_time"
    """Its limit of simulated time is over."""
    OUT_OF_BUDGET = "out_of_budget"
    """The agent has spent its tokens or its time."""
    AGENT_FAILED = "agent_failed"
    """The agent's side crashed, ended or did not answer: judged, and never a success."""
    INTERRUPTED = "interrupted"
    """Interrupted by the user: no verdict."""
    ERROR = "error"
    """An infrastructure error: no verdict, never counted as the agent's failure."""

    @property
    def is_cut_off(self) -> bool:
        """Whether it was ended from outside, before the agent or the drive had ended."""
        return self not in (End.DECLARED, End.DRIVE_ENDED, End.WATCH_OVER)
