"""Negative controls: trivial strategies that must not succeed in both halves of a pair."""

from __future__ import annotations

import numpy as np

from automotive_cosim.cockpit.actions import FIELDS, SECONDS_LIMIT, check
from automotive_cosim.cockpit.registry import apps
from automotive_cosim.contracts import (
    UNCALLED,
    Action,
    ActionType,
    AlertKind,
    Direction,
    Element,
    GoalStatus,
    Observation,
    Reason,
    Severity,
)
from automotive_cosim.interface.observe import Channel


class NoOp:
    """Waits, and never declares anything."""

    name = "no-op"
    model = "none"
    channels: frozenset[Channel] = frozenset()

    def reset(self, goal: str) -> None:
        """Does nothing."""

    def act(self, observation: Observation) -> Action:
        return Action(ActionType.WAIT, seconds=1)


class AlwaysAlert:
    """Warns of speed at once, whatever happens, and declares ``complete``."""

    name = "always-alert"
    model = "none"
    channels: frozenset[Channel] = frozenset()

    def __init__(self, kind: AlertKind = AlertKind.SPEED) -> None:
        self._kind = kind
        self._warned = False

    def reset(self, goal: str) -> None:
        self._warned = False

    def act(self, observation: Observation) -> Action:
        if self._warned:
            return Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE)
        self._warned = True
        return Action(ActionType.SHOW_ALERT, kind=self._kind)


class AlwaysAsk:
    """Asks the driver at once what is meant, whatever he said, and declares ``complete``."""

    name = "always-ask"
    model = "none"
    channels: frozenset[Channel] = frozenset()

    def __init__(self) -> None:
        self._asked = False

    def reset(self, goal: str) -> None:
        self._asked = False

    def act(self, observation: Observation) -> Action:
        if self._asked:
            return Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE)
        self._asked = True
        return Action(ActionType.ASK_DRIVER, text="Which one do you mean?")


class Random:
    """Any well-formed action, each type equally likely; taps hit clickable elements."""

    name = "random"
    model = "none"
    channels = frozenset({Channel.ELEMENTS})

    def __init__(self, seed: int = 0) -> None:
        self._seed = seed
        self._rng = np.random.default_rng(seed)

    def reset(self, goal: str) -> None:
        """Starts over from its seed, so that an episode does not depend on earlier ones."""
        self._rng = np.random.default_rng(self._seed)

    def act(self, observation: Observation) -> Action:
        kind = UNCALLED[int(self._rng.integers(len(UNCALLED)))]
        takes = FIELDS[kind]
        names = takes.required + (("index",) if takes.target else ())
        names += tuple(name for name in takes.optional if name != "index" and self._rng.random() < 0.5)
        return check(Action(kind, **{name: self._draw(name, observation) for name in names}))  # type: ignore[arg-type]

    def _draw(self, name: str, observation: Observation) -> object:
        rng = self._rng
        if name == "index":
            return _one(rng, tuple(_touchable(observation)) or (0,))
        choices: dict[str, tuple[object, ...]] = {
            "app_name": tuple(apps()),
            "direction": tuple(Direction),
            "distance_px": (50, 100, 200, 400),
            "goal_status": tuple(GoalStatus),
            "reason": tuple(Reason),
            "kind": tuple(AlertKind),
            "severity": tuple(Severity),
            "seconds": tuple(range(1, SECONDS_LIMIT + 1)),
            "speed_kmh": tuple(float(speed) for speed in range(0, 140, 10)),
            "on": (True, False),
            "clear_text": (True, False),
            "text": ("weather", "rules", "2.35,48.86", "hello"),
            "destination": ("",),
        }
        return _one(rng, choices[name])


class PressEverything:
    """Taps each control that it sees once, then declares ``complete``."""

    name = "press-everything"
    model = "none"
    channels = frozenset({Channel.ELEMENTS})

    def __init__(self) -> None:
        self._pressed: set[str] = set()

    def reset(self, goal: str) -> None:
        self._pressed.clear()

    def act(self, observation: Observation) -> Action:
        elements = observation.elements or ()
        for index in _touchable(observation):
            if (key := _key(elements[index])) not in self._pressed:
                self._pressed.add(key)
                return Action(ActionType.CLICK, index=index)
        return Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE)


def _one(rng: np.random.Generator, choices: tuple[object, ...]) -> object:
    return choices[int(rng.integers(len(choices)))]


def _touchable(observation: Observation) -> list[int]:
    return [
        index
        for index, element in enumerate(observation.elements or ())
        if element.is_clickable and element.is_enabled and element.is_visible
    ]


def _key(element: Element) -> str:
    return element.resource_id or f"{element.text} {element.bbox_pixels}"
