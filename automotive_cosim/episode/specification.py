"""What an episode is: its specification, the conditions it is played under, its seeds and its end."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from enum import StrEnum
from typing import Annotated

import numpy as np
from annotated_types import Ge, Gt

from automotive_cosim.errors import UnknownNameError
from automotive_cosim.formats.annotations import Latitude, Longitude, OneOf
from automotive_cosim.formats.checked import checked
from automotive_cosim.formats.toml import dotted
from automotive_cosim.interface.controls import GeoInput
from automotive_cosim.interface.observe import ALL, Channel
from automotive_cosim.tasking.task import Mode

ACTION_COST_S = 1.0
"""Simulated seconds that an action takes: about what a tap takes a person (NHTSA 2013 counts glances of up to 2
s)."""
MAX_STEPS = 20
"""Actions that an episode may take."""
ROUNDING_S = 1e-9
"""Sums of simulated seconds are equal up to this."""
SEED_LIMIT = 2**31
"""SUMO takes seeds below this."""


@dataclass(frozen=True, slots=True)
class Conditions:
    """What an agent is given, and what it may take."""

    channels: frozenset[Channel] = ALL
    """What the agent wants to be given; ``geo`` may withhold some of it."""
    geo: GeoInput = GeoInput.FULL
    """What the agent is told of where it is."""
    max_steps: int = MAX_STEPS
    """Actions after which the episode is cut off."""
    max_sim_s: float | None = None
    """Simulated seconds from the hand-over after which it is cut off; None leaves that to ``max_steps``."""
    action_cost_s: float = ACTION_COST_S
    """Simulated seconds per action; a ``wait`` takes so many for each of its seconds."""

    @property
    def given(self) -> frozenset[Channel]:
        """The channels that the agent gets."""
        return self.channels - self.geo.withheld


@dataclass(frozen=True, slots=True)
class EpisodeSpec:
    """What is to be run, by names: the same specification and the same actions give the same trace."""

    task: str = "road_speed_80_in_50"
    half: str = "first"
    """``first`` or, for a pair, ``second``."""
    scenario: str | None = None
    """A name, a folder, a ``.sumocfg`` or a network; None takes the task's own."""
    origin: tuple[Longitude, Latitude] | None = None
    """Longitude and latitude that the middle of its network is moved to, with that place's law, clock and climate;
    what the task says of date, time and weather stays. None leaves it where it is."""
    gps: bool = True
    """False: no GPS, so that no place is known; a network without projection then runs too."""
    from_place: str = ""
    """Where the ego's way begins, in place of the task's trip: an edge, a street, ``LON,LAT``."""
    to_place: str = ""
    """Where it ends. If only one of the two is given the other is drawn."""
    seed: Annotated[int, Ge(0)] = 0
    """Of the traffic, and of everything that is drawn."""
    mode: Annotated[Mode, OneOf(Mode)] = Mode.PROMPTED
    """When the agent is called."""
    held_out: bool = False
    """Whether the driver says the task's held-out phrasing (``tasking.instance.Instance.held_out``); else any is
    drawn."""
    geo: Annotated[GeoInput, OneOf(GeoInput, "geo control")] = GeoInput.FULL
    """What the agent is told of where it is."""
    max_steps: Annotated[int, Ge(1)] = MAX_STEPS
    """Actions after which the episode is cut off."""
    max_sim_s: Annotated[float, Gt(0)] | None = None
    """Simulated seconds from the hand-over after which it is cut off; None leaves that to ``max_steps``."""
    action_cost_s: Annotated[float, Gt(0)] = ACTION_COST_S
    """Simulated seconds per action."""

    def check(self) -> None:
        """Tries the values; whether there is such a task or scenario is found out where those are looked up.

        Raises:
            UserError: one of the wrong type or out of its range.
        """
        checked(type(self), asdict(self), lambda steps: ("the episode", dotted(steps)))

    def conditions(self, channels: frozenset[Channel] = ALL) -> Conditions:
        """Those that it is played under by an agent that wants these channels."""
        return Conditions(channels, self.geo, self.max_steps, self.max_sim_s, self.action_cost_s)


def mode_of(name: str) -> Mode:
    """The mode of that name.

    Raises:
        UnknownNameError: there is none.
    """
    if name not in set(Mode):
        raise UnknownNameError("mode", name, Mode)
    return Mode(name)


@dataclass(frozen=True, slots=True)
class Seeds:
    """Where everything random of one episode comes from."""

    traffic: int
    """Of SUMO: the warm traffic that the ego departs into."""
    instance: int
    """Of words and parameters, and through ``drive`` of the rest."""

    @property
    def drive(self) -> int:
        """Of the driver, the cockpit's content, the receiver and the weather."""
        return int(np.random.default_rng([self.instance, 1]).integers(SEED_LIMIT))


class SeedSource:
    """Seeds of one episode after the other, as gymnasium's ``reset`` hands them out."""

    def __init__(self, seed: int | None = None) -> None:
        """Begins with this seed; None begins at random."""
        self._rng = np.random.default_rng(seed)
        self.traffic = int(self._rng.integers(SEED_LIMIT)) if seed is None else int(seed) % SEED_LIMIT
        """The next episodes' traffic; the seed's own, unless set to another."""

    def next(self) -> Seeds:
        """Seeds of the next episode: in the same traffic another instance."""
        return Seeds(self.traffic, int(self._rng.integers(SEED_LIMIT)))


class End(StrEnum):
    """Why an episode ended."""

    DECLARED = "declared"
    DRIVE_ENDED = "drive_ended"
    WATCH_OVER = "watch_over"
    """A watch's window is over."""
    OUT_OF_STEPS = "out_of_steps"
    OUT_OF_TIME = "out_of_time"
    """The simulated time it may take is over."""
    OUT_OF_BUDGET = "out_of_budget"
    """The agent has spent its tokens or its time."""
    INTERRUPTED = "interrupted"
    """By the user: no verdict."""
    ERROR = "error"
    """By the infrastructure, not by the agent: no verdict, never counted as a failure."""

    @property
    def is_cut_off(self) -> bool:
        """Whether it was ended from outside, before agent or road had come to an end."""
        return self not in (End.DECLARED, End.DRIVE_ENDED, End.WATCH_OVER)
