"""The specification of an episode, what its session begins with, its seeds and its end."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from enum import StrEnum
from functools import lru_cache
from typing import Annotated

import numpy as np
from annotated_types import Ge, Gt, Le

from automotive_cosim.contracts.given import GeoInput, Hearing, Language
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.settings import EpisodeSettings
from automotive_cosim.errors import SetupError, UserError, install_hint
from automotive_cosim.formats.checked import checked
from automotive_cosim.formats.toml import dotted
from automotive_cosim.interface.observe import ALL, Channel, See
from automotive_cosim.tasking.draws import SEED_LIMIT
from automotive_cosim.voice.engines import is_installed

ACTION_COST_S = 1.0
"""Simulated seconds per action: about the time of a person's tap (NHTSA 2013 counts glances of up to 2 s)."""
ROUNDING_S = 1e-9
"""Tolerance of sums of simulated seconds."""


SCREEN = frozenset({Channel.SCREENSHOT, Channel.ELEMENTS})
_AS = {Channel.SCREENSHOT: "its picture", Channel.ELEMENTS: "its list of elements"}


@dataclass(frozen=True, slots=True)
class SessionSetup:
    """What a session begins with, besides the car and the driver's words."""

    channels: frozenset[Channel] = ALL
    """Channels that the agent wants; the conditions may withhold some of them."""
    conditions: Conditions = Conditions()  # noqa: RUF009, frozen
    """What the agent is given, and at what speed."""
    max_steps: int | None = None
    """Actions after which the session is cut off; None takes the task's own limit (``Suite.max_steps``)."""
    max_sim_s: float | None = None
    """Simulated seconds from the beginning after which it is cut off; None leaves that to ``max_steps``."""
    action_cost_s: float = ACTION_COST_S
    """Simulated seconds per action; a ``wait`` takes as many for each of its seconds."""
    lean: bool = False
    """Whether no screen is laid out, which saves time: nobody sees an element or can name one, and the trace has
    none."""

    def __post_init__(self) -> None:
        """Refuses to blind the agent.

        Raises:
            UserError: nothing of the screen is left that it can see, it wants a screen that is not laid out, or
                there is no voice in the driver's language.
            SetupError: it is to get sound, and the extra ``voice`` is missing.
        """
        if self.lean and self.channels & SCREEN:
            raise UserError("a lean session has no screen; leave screenshot and elements out of the channels")
        if self.conditions.see is See.NOTHING and not self.conditions.interface.calls:
            raise UserError("--see nothing leaves an agent at the screen nothing; give --interface functions too")
        hear, language = self.conditions.hear, self.conditions.language
        if hear.is_by_ear and language is not Language.ENGLISH:
            raise UserError(f"--hear {hear} has no voice in {language.words}; give --language en, or --hear text")
        if hear is Hearing.AUDIO and not is_installed():
            raise SetupError(f"--hear audio needs the extra voice: {install_hint('voice')}, or give --hear cabin")
        if self.channels & SCREEN and not self.given & SCREEN and not self.conditions.interface.calls:
            (only,) = self.channels & SCREEN
            raise UserError(
                f"the agent sees the screen only as {_AS[only]}, which --see {self.conditions.see} withholds; "
                f"choose another agent, or --see {'tree' if only is Channel.ELEMENTS else 'picture'} or both"
            )

    @property
    def given(self) -> frozenset[Channel]:
        """The channels that the agent gets."""
        return _given(self.channels, self.conditions.see, self.conditions.geo)


@lru_cache(maxsize=64)
def _given(channels: frozenset[Channel], see: See, geo: GeoInput) -> frozenset[Channel]:
    """Cached, as it is asked for with every observation."""
    return (channels | see.added(channels)) - geo.withheld - see.withheld


@dataclass(frozen=True, slots=True)
class EpisodeSpec(EpisodeSettings):
    """What to run, by name: the same specification and the same actions give the same trace."""

    held_out: bool = False
    """Whether the driver says the task's held-out phrasing (``tasking.instance.Instance.held_out``); otherwise any
    phrasing is drawn."""
    redrawn: Annotated[int, Ge(0), Le(1000)] = 0
    """Which other draw of the same instance: so many phrasings further, and with other content of the cockpit
    (people, places, music). Traffic, weather and parameters stay."""
    conditions: Conditions = Conditions()  # noqa: RUF009, frozen
    """What the agent is given, and at what speed."""
    max_steps: Annotated[int, Ge(1)] | None = None
    """Actions after which the episode is cut off; None takes the task's own: 20, in hard and people 40."""
    max_sim_s: Annotated[float, Gt(0)] | None = None
    """Simulated seconds from the hand-over after which it is cut off; None leaves that to ``max_steps``."""
    action_cost_s: Annotated[float, Gt(0)] = ACTION_COST_S
    """Simulated seconds per action."""

    def check(self) -> None:
        """Tries the values; whether there is such a task or scenario is found out where those are looked up.

        Raises UserError: one of the wrong type or out of its range."""
        checked(type(self), asdict(self), lambda steps: ("the episode", dotted(steps)))

    def session(self, channels: frozenset[Channel] = ALL) -> SessionSetup:
        """What a session begins with, for an agent that wants these channels.

        Raises UserError: it could see nothing of the screen."""
        return SessionSetup(channels, self.conditions, self.max_steps, self.max_sim_s, self.action_cost_s)


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
    MINUTES_OVER = "minutes_over"
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
        return self not in (End.DECLARED, End.DRIVE_ENDED, End.MINUTES_OVER)
