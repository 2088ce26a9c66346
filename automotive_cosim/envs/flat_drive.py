"""A flat view of drives for reinforcement learning: ``Discrete`` actions, a ``Box`` of numbers, a reward per event.

| action | meaning |
|---|---|
| 0 | waits until something changes, at most a minute |
| 1 | waits two seconds |
| then one per ``AlertKind`` | shows that alert |

| observation, float32 in [-1, 1] | number |
|---|---|
| ``FEATURES``: speed, limits, gaps, sight, grip, what is ahead, ... | ``len(FEATURES)`` |
| words of road and weather, of the law's lines, each hashed into slots | ``sum(SLOTS)`` |
| per reading: whether it is marked as changed | ``len(READINGS)`` |
| per sign: for how long it has been as it is, 0 without it, 1 from ten minutes on | ``len(SIGNS)`` |
| per sign: whether it is there and has not been told of | ``len(SIGNS)`` |
| per kind of alert: how long ago it was shown, 0 just now, 1 from ten minutes on or never | ``len(AlertKind)`` |

Everything is read from what an agent is given: its vehicle state, readings and local context, now and before.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from math import inf, log1p, log10
from typing import Any, NamedTuple

import gymnasium as gym
import numpy as np
import numpy.typing as npt

from automotive_cosim.contracts import Action, ActionType, AlertKind, Observation
from automotive_cosim.drives.changes import DUE_S, LONGEST_S, WAKES
from automotive_cosim.drives.families import family_named
from automotive_cosim.drives.reading import NO_LINE, Gathered, LawLine, Reader
from automotive_cosim.drives.score import LEAST_WORTH, score
from automotive_cosim.drives.specification import DriveSpec
from automotive_cosim.envs.base import Stepped, ended
from automotive_cosim.envs.drive import DrivesEnv, settings_of
from automotive_cosim.envs.numbers import hashed, number_of
from automotive_cosim.episode.session import TakesTime
from automotive_cosim.errors import UserError
from automotive_cosim.interface.observe import Channel
from automotive_cosim.traffic.fork import Simulations

CHANNELS = frozenset({Channel.VEHICLE, Channel.CONTEXT})
"""What the numbers are read from; no action of this view touches an element."""
SLOTS = (48, 64)
"""Slots of the words of road and weather, and of the law's lines."""
KINDS = tuple(AlertKind)
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
LONG_S = 600.0
"""Ages are told up to this, on a logarithmic scale: all alike, so that the age of what there is and the age of what
was said of it can be compared."""
METER_KMH = 3.0
"""What a speed meter may show too much (OIML R 91)."""
HORIZON_S = 30.0
"""What is further ahead than this at the speed driven is not told from what is not there."""
_PEOPLE = "adult|elderly|child|baby"
FASTEST_KMH = 130.0
"""Scale of speeds and limits."""
Feature = Callable[[Gathered], float]


def _over(known: Gathered, limit_kmh: float | None) -> float:
    """By how much of 30 km/h the car is above a limit; -1 without one."""
    return -1.0 if limit_kmh is None else (known.speed_kmh - limit_kmh) / 30


def _reduced(known: Gathered) -> float | None:
    """The lowest limit that the law states for weather, without those for a shorter sight."""
    lines = (line for line in known.reduced if known.visibility_m < _under_m(line.text))
    return min((line.kmh for line in lines if line.kmh is not None), default=None)


@lru_cache(maxsize=1024)
def _under_m(rule: str) -> float:
    """The sight below which a rule holds; infinite for a rule without one."""
    found = re.search(r"visibility under (\d+) m", rule)
    return inf if found is None else float(found[1])


def _ahead(name: str) -> Feature:
    """How near something ahead is in time, 1 at the car and 0 where there is none."""

    def near(known: Gathered) -> float:
        away_m = known.away_m(name)
        return 0.0 if away_m is None else 1 - min(away_m / max(known.mps, 1.0), HORIZON_S) / HORIZON_S

    return near


def _share(name: str, full: float, pattern: str = r"(\d+\.?\d*)") -> Feature:
    """The first number of a reading as a share of ``full``; 0 without the reading."""

    search = re.compile(pattern).search

    def share(known: Gathered) -> float:
        words = known.words(name)
        found = search(words) if words else None
        return 0.0 if found is None else float(found[1]) / full

    return share


def _limit_ahead_kmh(known: Gathered) -> float | None:
    found = re.match(r"(\d+) km/h", known.words("limit ahead"))
    return None if found is None else float(found[1])


def _slowing(known: Gathered) -> float:
    """The slowing down that a lower limit ahead asks for, of 2 m/s2."""
    limit_kmh, away_m = _limit_ahead_kmh(known), known.away_m("limit ahead")
    if limit_kmh is None or away_m is None or known.speed_kmh <= limit_kmh:
        return 0.0
    return (known.mps**2 - (limit_kmh / 3.6) ** 2) / (2 * max(away_m, 1.0)) / 2


def _gap_s(known: Gathered) -> float:
    """The time gap to the vehicle ahead, four seconds from there on and without one."""
    gap_m = known.vehicle.leader_gap_m
    return 4.0 if gap_m is None else min(gap_m / max(known.mps, 1.0), 4.0)


def _lawful_gap_s(known: Gathered) -> float:
    """The time gap that the law states, one second without such a rule."""
    found = re.match(r"(\d+) s or more", known.law.get("Following distance", NO_LINE).text)
    return 1.0 if found is None else float(found[1])


def _closing_mps(known: Gathered) -> float:
    """How fast the vehicle ahead comes nearer; 0 if it does not."""
    gap_m, ttc_s = known.vehicle.leader_gap_m, known.vehicle.leader_time_to_collision_s
    return 0.0 if gap_m is None or ttc_s is None or ttc_s <= 0 else gap_m / ttc_s


def _braking(known: Gathered) -> float:
    """The braking that the vehicle ahead asks for, of 5 m/s2."""
    return _closing_mps(known) ** 2 / (2 * max(known.vehicle.leader_gap_m or 0.0, 0.1)) / 5


def _blind(known: Gathered) -> float:
    """The distance to stop as a share of what can be seen, half of it."""
    stopping_m = known.mps + known.mps**2 / (2 * max(known.grip, 0.1) * 9.81)
    return stopping_m / max(known.visibility_m, 1.0) / 2


def _aboard(known: Gathered, pattern: str) -> int:
    return len(_found(pattern, known.vehicle.aboard))


@lru_cache(maxsize=1024)
def _found(pattern: str, text: str) -> tuple[str, ...]:
    """Cached, as what is read is mostly the same from second to second."""
    return tuple(re.findall(pattern, text))


def _softest(known: Gathered) -> float:
    """The softest tyre below 250 kPa, of 100."""
    pressures = map(float, _found(r"(?:left|right) (\d+)", known.words("tyres")))
    return (250 - min(pressures, default=250.0)) / 100


FEATURES: Mapping[str, Feature] = {
    "speed": lambda known: known.speed_kmh / FASTEST_KMH,
    "moves": lambda known: float(known.speed_kmh >= 1),
    "limit": lambda known: 0.0 if known.limit_kmh is None else known.limit_kmh / FASTEST_KMH,
    "above the limit": lambda known: _over(known, known.limit_kmh),
    "above what is likely": lambda known: _over(known, known.likely_kmh),
    "above the hours' limit": lambda known: _over(known, known.hours_kmh),
    "above a reduced limit": lambda known: _over(known, _reduced(known)),
    "just above the limit": lambda known: _over(known, known.limit_kmh) * 5,
    "limit ahead": _share("limit ahead", FASTEST_KMH),
    "above a limit ahead": lambda known: _over(known, _limit_ahead_kmh(known)),
    "slowing that it asks for": _slowing,
    "nearness of a limit ahead": _ahead("limit ahead"),
    **{f"nearness of a {name}": _ahead(name) for name in DUE_S},
    "nearness of the vehicle ahead": lambda known: 1 - _gap_s(known) / 4,
    "shortness of the gap": lambda known: _lawful_gap_s(known) - _gap_s(known),
    "braking that it asks for": _braking,
    "speed at which it comes nearer": lambda known: _closing_mps(known) / 20,
    "its speed": lambda known: (known.speed_kmh - 3.6 * _closing_mps(known)) / FASTEST_KMH,
    "nearness of a collision": lambda known: 1 - min(known.vehicle.leader_time_to_collision_s or 16.0, 16.0) / 16,
    "blue light behind": _share("behind", 300, r"blue light (\d+) m"),
    "sun": lambda known: 0.0 if known.sun_deg is None else known.sun_deg / 30,
    "sight": lambda known: log10(max(known.visibility_m, 1.0)) / 4.5,
    "speed for the sight": _blind,
    "rain": lambda known: known.rain_mm_h / 10,
    "slipperiness": lambda known: 1 - known.grip,
    "in a tunnel": lambda known: float(known.in_tunnel),
    "low beam": lambda known: float(known.vehicle.is_low_beam_on),
    "high beam": lambda known: float(known.vehicle.is_high_beam_on),
    "front fog lamps": lambda known: float(known.vehicle.is_front_fog_on),
    "rear fog lamp": lambda known: float(known.vehicle.is_rear_fog_on),
    "fogged": _share("glass", 50),
    "unwiped": _share("rain", 50),
    "softest tyre": _softest,
    "driving time": _share("driving time", 4),
    "shortness of the range": lambda known: (
        0.0 if known.left_km is None else 1 - (known.vehicle.range_km - known.left_km) / 10
    ),
    "people not belted": lambda known: _aboard(known, f"(?:{_PEOPLE}), [^;]*not belted") / 2,
    "animals and things not belted": lambda known: _aboard(known, "(?:pet|object), [^;]*not belted") / 2,
    "who needs care": lambda known: _aboard(known, "child|baby|pet") / 2,
    "adults": lambda known: _aboard(known, "adult|elderly") / 4,
    "driver has left": lambda known: float("has left" in known.words("parked")),
    "phone in the hand": lambda known: float("hand" in known.words("phone")),
    "open trunk or charging flap": lambda known: float(re.search("trunk|flap", known.words("open")) is not None),
}
"""Numbers by what they tell, each clipped to [-1, 1]."""


class Sign(NamedTuple):
    """Something that a driver may have to be told of."""

    alert: AlertKind
    """The alert that tells of it."""
    seen: Callable[[Gathered, Mapping[str, float]], Hashable]
    """What there is to see, also in the features; None without it. It is another one when it changes."""


def _reading(alert: AlertKind, name: str, pattern: str = ".+") -> Sign:
    """A reading whose words have a pattern."""

    search = re.compile(pattern).search

    def seen(known: Gathered, numbers: Mapping[str, float]) -> Hashable:
        words = known.words(name)
        found = search(words) if words else None
        return None if found is None else found[0]

    return Sign(alert, seen)


def _number(alert: AlertKind, name: str, above: float, what: Callable[[Gathered], Hashable] = bool) -> Sign:
    """A feature above a value, of one thing or another."""
    return Sign(alert, lambda known, numbers: what(known) if numbers[name] > above else None)


SIGNS: Mapping[str, Sign] = {
    "above the limit": _number(AlertKind.SPEED, "above the limit", METER_KMH / 30, lambda known: known.limit_kmh),
    "above a reduced limit": _number(AlertKind.SPEED, "above a reduced limit", METER_KMH / 30, _reduced),
    "limit ahead": Sign(AlertKind.SPEED, lambda known, _: _limit_ahead_kmh(known)),
    "short gap": _number(AlertKind.DISTANCE, "shortness of the gap", 0.0),
    "braking": _number(AlertKind.COLLISION, "braking that it asks for", 0.2),
    "slow vehicle": _number(AlertKind.TRAFFIC, "speed at which it comes nearer", 0.15),
    "jam": _reading(AlertKind.TRAFFIC, "jam", "in"),
    "roadworks": _reading(AlertKind.TRAFFIC, "roadworks", "in"),
    "breakdown": _reading(AlertKind.MOVE_OVER, "breakdown", "in"),
    "tunnel": _reading(AlertKind.TUNNEL, "tunnel", "in"),
    "school zone": _number(AlertKind.SCHOOL, "above the hours' limit", METER_KMH / 30),
    "blue light": _reading(AlertKind.YIELD, "behind", "blue light"),
    "speed for the sight": _number(AlertKind.VISIBILITY, "speed for the sight", 0.5),
    "fogged": _reading(AlertKind.VISIBILITY, "glass", "by"),
    "unwiped": _reading(AlertKind.VISIBILITY, "rain", "by"),
    "low beam off": Sign(AlertKind.VISIBILITY, lambda known, _: not known.vehicle.is_low_beam_on or None),
    "high beam on": _number(AlertKind.VISIBILITY, "high beam", 0.5),
    "front fog lamps on": _number(AlertKind.VISIBILITY, "front fog lamps", 0.5),
    "rear fog lamp on": _number(AlertKind.VISIBILITY, "rear fog lamp", 0.5),
    "slippery": _number(AlertKind.SLIPPERY, "slipperiness", 0.3),
    "not belted": _reading(AlertKind.SEAT_BELT, "belt", "[^;]*(?:adult|elderly|child|baby)[^;]*?(?=, and the|$)"),
    "phone in the hand": _number(AlertKind.DISTRACTION, "phone in the hand", 0.5),
    "driving time": _number(AlertKind.FATIGUE, "driving time", 0.45),
    "open": _reading(AlertKind.VEHICLE, "open", "trunk|charging flap"),
    "soft tyre": _number(AlertKind.VEHICLE, "softest tyre", 0.1),
    "short range": _number(AlertKind.VEHICLE, "shortness of the range", 0.5),
    "left": _number(AlertKind.VEHICLE, "driver has left", 0.5),
}
"""What an agent keeps in mind: for how long each has been there, and whether it has told of it."""
GONE_S = 30.0
"""What was away for longer has to be told of anew."""


class DriveNumbers:
    """The numbers of a drive's observations, in chronological order; it remembers what there was and was shown."""

    size = len(FEATURES) + sum(SLOTS) + len(READINGS) + 2 * len(SIGNS) + len(AlertKind)

    def __init__(self) -> None:
        self._reader = Reader()
        self._shown_s: dict[AlertKind, float] = {}
        self._since: dict[str, tuple[Hashable, float]] = {}
        self._told: dict[str, tuple[Hashable, float]] = {}

    def show(self, kind: AlertKind, now_s: float) -> None:
        """Notes an alert: it tells of all its signs that are there."""
        self._shown_s[kind] = now_s
        for name, (what, _) in self._since.items():
            if SIGNS[name].alert is kind:
                self._told[name] = what, now_s

    def read(self, seen: Observation) -> npt.NDArray[np.float32]:
        """The numbers of the next observation."""
        known = self._reader.read(seen)
        assert known is not None  # the channels are always given
        numbers = {name: feature(known) for name, feature in FEATURES.items()}
        texts = (known.road, known.weather), tuple(_rule_words(label, law.text) for label, law in known.law.items())
        since, told, shown_s, now_s = self._since, self._told, self._shown_s, known.time_s
        for name, (_, seen_in) in SIGNS.items():
            what = seen_in(known, numbers)
            if what is not None or name in since or name in told:
                self._see(name, what, now_s)
        kept = [
            *map(float, map(known.changed.__contains__, READINGS)),
            *(_age(now_s - since[name][1]) if name in since else 0.0 for name in SIGNS),
            *(float(name in since and name not in told) for name in SIGNS),
            *(_age(now_s - shown_s[kind]) if kind in shown_s else 1.0 for kind in KINDS),
        ]
        read = np.array([*numbers.values()], np.float32)
        np.minimum(np.maximum(read, -1.0, out=read), 1.0, out=read)
        return np.concatenate((read, *map(_words, texts, SLOTS), np.array(kept, np.float32)))

    def _see(self, name: str, what: Hashable, now_s: float) -> None:
        """Notes a sign: since when it has been as it is, and whether it is still the one that was told of."""
        told, told_s = self._told.get(name, (None, now_s))
        if now_s - told_s > GONE_S or (what is not None and what != told):
            self._told.pop(name, None)
        elif what is not None:
            self._told[name] = told, now_s
        if what is None:
            self._since.pop(name, None)
        elif self._since.get(name, (None,))[0] != what:
            self._since[name] = what, now_s


def _age(seconds: float) -> float:
    return min(log1p(max(seconds, 0.0)) / _LOG_LONG, 1.0)


_LOG_LONG = log1p(LONG_S)


@lru_cache(maxsize=1024)
def _words(lines: tuple[str, ...], slots: int) -> npt.NDArray[np.float32]:
    """Slots of the words of some lines, without numbers: these are features. Cached, as most
    lines are the same from second to second."""
    return np.array(hashed(map(_without_numbers, lines), slots), np.float32)


@lru_cache(maxsize=4096)
def _rule_words(label: str, text: str) -> str:
    return f"{label} {LawLine(text, None, False).said}"


@lru_cache(maxsize=4096)
def _without_numbers(line: str) -> str:
    return re.sub(r"\d+(\.\d+)?", " ", line)


class FlatDriveEnv(DrivesEnv[npt.NDArray[np.float32], np.int64]):
    """Drives of one or several families, one drawn at each reset.

    The reward of a step is what it changed in the utility of the drive (``drives.score``), as a share of what the
    events of a usual drive are worth together: twice an event's weight once it is met, minus the cost of each
    nuisance. What an alert earns comes with the step in which the event turns out to be due; until then it may be
    taken back. ``info`` is empty but for ``score`` at the end, the judge's. ``env.unwrapped.episode.trace_sha256``
    lays out the screens of the whole drive, which nobody has looked at.
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
            lean: for training, faster by a fifth: SUMO in steps of a second, and screens are not in
                the trace. The traffic is not that of the same seed in steps of 0.1 s.
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
        self._specs = [DriveSpec(family_named(name).id, scenario=scenario, settings=settings) for name in names]
        super().__init__(simulations, render_mode, CHANNELS, lean=lean)
        self.observation_space = gym.spaces.Box(-1.0, 1.0, (DriveNumbers.size,), np.float32)
        self.action_space = gym.spaces.Discrete(len(ACTIONS))

    def _drawn(self, seed: int) -> DriveSpec:
        return replace(self._specs[int(self.np_random.integers(len(self._specs)))], seed=seed)

    def _departed(self) -> tuple[npt.NDArray[np.float32], dict[str, Any]]:
        self._numbers, self._utility = DriveNumbers(), 0.0
        return self._numbers.read(self.episode.observation), {}

    def number(self, action: Action) -> int | None:
        """The number of an action; the nearest of the two for a wait, None if this view has none for it."""
        if action.action_type is ActionType.WAIT:
            return int((action.seconds or LONGEST_S) <= SOON_S)
        if action.action_type is ActionType.SHOW_ALERT and action.kind is not None:
            return ACTIONS.index(Action(ActionType.SHOW_ALERT, kind=action.kind))
        return None

    def stepping(self, action: np.int64) -> TakesTime[Stepped[npt.NDArray[np.float32]]]:
        """Performs one action of the table, and lets its time pass."""
        session = self._running()
        chosen = ACTIONS[number_of(action, len(ACTIONS))]
        if chosen.kind is not None:
            self._numbers.show(chosen.kind, session.observation.time_s)
        yield from session.stepping(chosen)
        found = score(session.judged_so_far(), session.seconds)
        before, self._utility = self._utility, found.utility / (2 * LEAST_WORTH)
        info: dict[str, Any] = {}
        if session.end is not None:
            info = {"score": found.value}
        return self._numbers.read(session.observation), self._utility - before, *ended(session), info
