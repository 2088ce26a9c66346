"""A flat view of drives for reinforcement learning: ``Discrete`` actions, a ``Box`` of numbers, a reward per event.

| action | meaning |
|---|---|
| 0 | waits until something changes, at most a minute |
| 1 | waits two seconds |
| then one per ``AlertKind`` | shows that alert |

| observation, float32 in [-1, 1] | number |
|---|---|
| ``FEATURES``: speed, limits, gaps, sight, grip, what is ahead, ... | ``len(FEATURES)`` |
| words of the car's readings, of road and weather, of the law's lines, each hashed into slots | ``sum(SLOTS)`` |
| per reading: whether it is marked as changed | ``len(READINGS)`` |
| per kind of alert: how lately it was shown, 1 just now, 0 never | ``len(AlertKind)`` |

Everything is read from what an agent is given: its vehicle state, readings and local context.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import chain
from math import exp, log10
from typing import Any

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from automotive_cosim.contracts import Action, ActionType, AlertKind
from automotive_cosim.drives.families import family_named
from automotive_cosim.drives.reading import Gathered, Reader
from automotive_cosim.drives.score import LEAST_WORTH, score
from automotive_cosim.drives.session import DriveSession
from automotive_cosim.drives.specification import DriveSpec
from automotive_cosim.drives.wakes import DUE_S, LONGEST_S, WAKES
from automotive_cosim.drives.watchers import READS
from automotive_cosim.envs.base import SessionEnv, ended
from automotive_cosim.envs.drive import settings_of
from automotive_cosim.envs.numbers import hashed, number_of
from automotive_cosim.episode.specification import SCREEN
from automotive_cosim.errors import UserError
from automotive_cosim.tasking.draws import SEED_LIMIT
from automotive_cosim.traffic.fork import Simulations

SLOTS = (64, 48, 64)
"""Slots of the words of readings, of road and weather, and of the law's lines."""
READINGS = tuple(wake.name for wake in WAKES)
"""Names of the car's readings."""
SOON_S = 2
"""The short wait: how often the rule-perfect watcher looks again (``looks.LOOK_S``)."""
ACTIONS = (
    Action(ActionType.WAIT),
    Action(ActionType.WAIT, seconds=SOON_S),
    *(Action(ActionType.SHOW_ALERT, kind=kind) for kind in AlertKind),
)
"""Actions by their number."""
SOON = 1
"""Number of the short wait."""
LATELY_S = 60.0
"""Time constant of how lately an alert was shown: as long as the judge calls the same one a repeat."""
HORIZON_S = 30.0
"""What is further ahead than this at the speed driven is not told from what is not there."""
FASTEST_KMH = 130.0
"""Scale of speeds and limits."""
Feature = Callable[[Gathered], float]


def _over(known: Gathered, limit_kmh: float | None) -> float:
    """By how much of 30 km/h the car is above a limit; -1 without one."""
    return -1.0 if limit_kmh is None else (known.speed_kmh - limit_kmh) / 30


def _reduced(known: Gathered) -> float | None:
    return min((line.kmh for line in known.reduced if line.kmh is not None), default=None)


def _ahead(name: str) -> Feature:
    """How near something ahead is in time, 1 at the car and 0 where there is none."""

    def near(known: Gathered) -> float:
        away_m = known.away_m(name)
        return 0.0 if away_m is None else 1 - min(away_m / max(known.mps, 1.0), HORIZON_S) / HORIZON_S

    return near


def _share(name: str, full: float, pattern: str = r"(\d+\.?\d*)") -> Feature:
    """The first number of a reading as a share of ``full``; 0 without the reading."""

    def share(known: Gathered) -> float:
        found = re.search(pattern, known.words(name))
        return 0.0 if found is None else float(found[1]) / full

    return share


def _gap_s(known: Gathered) -> float:
    """Nearness of the vehicle ahead: 1 at no gap, 0 from four seconds on."""
    gap_m = known.vehicle.leader_gap_m
    return 0.0 if gap_m is None else 1 - min(gap_m / max(known.mps, 1.0), 4.0) / 4


def _braking(known: Gathered) -> float:
    """The braking that the vehicle ahead asks for, of 5 m/s2."""
    gap_m, ttc_s = known.vehicle.leader_gap_m, known.vehicle.leader_time_to_collision_s
    if gap_m is None or ttc_s is None or ttc_s <= 0:
        return 0.0
    return (gap_m / ttc_s) ** 2 / (2 * max(gap_m, 0.1)) / 5


def _blind(known: Gathered) -> float:
    """The distance to stop as a share of what can be seen, half of it."""
    stopping_m = known.mps + known.mps**2 / (2 * max(known.grip, 0.1) * 9.81)
    return stopping_m / max(known.visibility_m, 1.0) / 2


def _softest(known: Gathered) -> float:
    """The softest tyre below 250 kPa, of 100."""
    pressures = [float(kpa) for kpa in re.findall(r"(?:left|right) (\d+)", known.words("tyres"))]
    return (250 - min(pressures, default=250.0)) / 100


FEATURES: Mapping[str, Feature] = {
    "speed": lambda known: known.speed_kmh / FASTEST_KMH,
    "moves": lambda known: float(known.speed_kmh >= 1),
    "limit": lambda known: 0.0 if known.limit_kmh is None else known.limit_kmh / FASTEST_KMH,
    "above the limit": lambda known: _over(known, known.limit_kmh),
    "above what is likely": lambda known: _over(known, known.likely_kmh),
    "above the hours' limit": lambda known: _over(known, known.hours_kmh),
    "above a reduced limit": lambda known: _over(known, _reduced(known)),
    "limit ahead": _share("limit ahead", FASTEST_KMH),
    "nearness of a limit ahead": _ahead("limit ahead"),
    **{f"nearness of a {name}": _ahead(name) for name in DUE_S},
    "nearness of the vehicle ahead": _gap_s,
    "braking that it asks for": _braking,
    "blue light behind": _share("behind", 300, r"blue light (\d+) m"),
    "sun": lambda known: 0.0 if known.sun_deg is None else known.sun_deg / 30,
    "sight": lambda known: log10(max(known.visibility_m, 1.0)) / 4.5,
    "speed for the sight": _blind,
    "rain": lambda known: known.rain_mm_h / 10,
    "grip": lambda known: known.grip,
    "in a tunnel": lambda known: float(known.in_tunnel),
    "low beam": lambda known: float(known.vehicle.is_low_beam_on),
    "high beam": lambda known: float(known.vehicle.is_high_beam_on),
    "front fog lamps": lambda known: float(known.vehicle.is_front_fog_on),
    "rear fog lamp": lambda known: float(known.vehicle.is_rear_fog_on),
    "fogged": _share("glass", 50),
    "unwiped": _share("rain", 50),
    "softest tyre": _softest,
    "driving time": _share("driving time", 4),
    "range beyond the route": lambda known: (
        1.0 if known.left_km is None else (known.vehicle.range_km - known.left_km) / 20
    ),
    "not belted": lambda known: float("not belted" in known.vehicle.aboard),
}
"""Numbers by what they tell, each clipped to [-1, 1]."""


class FlatDriveEnv(SessionEnv[npt.NDArray[np.float32], np.int64, DriveSession]):
    """Drives of one or several families, one drawn at each reset.

    The reward of a step is what it changed in the utility of the drive (``drives.score``), as a share of what the
    events of a usual drive are worth together: twice an event's weight once it is met, minus the cost of each
    nuisance. What an alert earns comes with the step in which the event turns out to be due; until then it may be
    taken back. ``info`` is empty but for ``score`` and ``trace_sha256`` at the end, where ``score`` is the judge's.
    """

    def __init__(
        self,
        families: str | Sequence[str] = "grid_june",
        *,
        scenario: str = "",
        minutes: float | None = None,
        lean: bool = False,
        render_mode: str | None = None,
        simulations: Simulations | None = None,
    ) -> None:
        """Makes an environment; nothing runs before ``reset``.

        Args:
            families: ids of families, or one; ``automotive-cosim show drives`` lists them.
            scenario: where to drive instead of on the families' own roads.
            minutes: when a drive is over, if its script ends later.
            lean: for training at several times the speed: SUMO in steps of a second, no screen is laid out, and
                ``info`` holds no ``trace_sha256``. The traffic is not that of the same seed in steps of 0.1 s.
            render_mode: ``"rgb_array"`` or None.
            simulations: warm simulations; by default those that the environments of this process share.

        Raises:
            UnknownNameError: no such family.
            UserError: no family is given, ``minutes`` is out of bounds, or there is no such render mode.
        """
        names = (families,) if isinstance(families, str) else tuple(families)
        if not names:
            raise UserError("a flat environment of drives requires at least one family")
        settings = settings_of(minutes=minutes, coarse=lean or None)
        self._lean = lean
        self._specs = [DriveSpec(family_named(name).id, scenario=scenario, settings=settings) for name in names]
        super().__init__(simulations, render_mode)
        size = len(FEATURES) + sum(SLOTS) + len(READINGS) + len(AlertKind)
        self.observation_space = gym.spaces.Box(-1.0, 1.0, (size,), np.float32)
        self.action_space = gym.spaces.Discrete(len(ACTIONS))

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[npt.NDArray[np.float32], dict[str, Any]]:
        """Departs on a drive: that of the seed, of a family that it draws; without a seed on another one.

        Raises:
            ScenarioError: a drive cannot take place in the scenario.
            InfrastructureError: no gap opened for the car, or the traffic simulation failed.
        """
        super().reset(seed=seed)
        self._end()
        drawn = int(self.np_random.integers(SEED_LIMIT)) if seed is None else seed
        spec = replace(self._specs[int(self.np_random.integers(len(self._specs)))], seed=drawn)
        self._episode = spec.begin(self._simulations, READS - SCREEN if self._lean else READS, lean=self._lean)
        self._reader, self._utility = Reader(), 0.0
        self._shown_s: dict[AlertKind, float] = {}
        return self._numbers(), {}

    def number(self, action: Action) -> int | None:
        """The number of an action; the nearest of the two for a wait, None if this view has none for it."""
        if action.action_type is ActionType.WAIT:
            return int((action.seconds or LONGEST_S) <= SOON_S)
        if action.action_type is ActionType.SHOW_ALERT and action.kind is not None:
            return ACTIONS.index(Action(ActionType.SHOW_ALERT, kind=action.kind))
        return None

    def step(self, action: np.int64) -> tuple[npt.NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        """Performs one action of the table, and lets its time pass.

        Raises:
            ActionError: the action is not in the action space; nothing has happened.
            ResetNeeded: the drive is over, or there has been none.
            TrafficError: the traffic simulation failed.
        """
        session = self._running()
        chosen = ACTIONS[number_of(action, len(ACTIONS))]
        if chosen.kind is not None:
            self._shown_s[chosen.kind] = session.observation.time_s
        session.step(chosen)
        found = score(session.judged_so_far(), session.seconds)
        before, self._utility = self._utility, found.utility / (2 * LEAST_WORTH)
        info: dict[str, Any] = {}
        if session.end is not None:
            info = {"score": found.value} | ({} if self._lean else {"trace_sha256": session.trace_sha256})
        return self._numbers(), self._utility - before, *ended(session), info

    def _numbers(self) -> npt.NDArray[np.float32]:
        seen = self.episode.observation
        known = self._reader.read(seen)
        assert known is not None  # the channels are always given
        texts = (
            (f"{name} {words}" for name, words in known.noticed.items()),
            (known.road, known.weather),
            (f"{label} {line.said}" for label, line in known.law.items()),
        )
        parts = [
            *(feature(known) for feature in FEATURES.values()),
            *chain.from_iterable(map(_words, texts, SLOTS)),
            *(float(name in known.changed) for name in READINGS),
            *(self._lately(kind, seen.time_s) for kind in AlertKind),
        ]
        return np.clip(np.array(parts, np.float32), -1.0, 1.0)

    def _lately(self, kind: AlertKind, now_s: float) -> float:
        at_s = self._shown_s.get(kind)
        return 0.0 if at_s is None else exp((at_s - now_s) / LATELY_S)


def _words(lines: Iterable[str], slots: int) -> list[float]:
    """Slots of the words of some lines, without numbers: these are features."""
    return hashed(map(_without_numbers, lines), slots)


@lru_cache(maxsize=4096)
def _without_numbers(line: str) -> str:
    return re.sub(r"\d+(\.\d+)?", " ", line)
