"""An agent's actions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from automotive_cosim.contracts.requests import AlertKind, Severity


class ActionType(StrEnum):
    """AndroidWorld's action types, the car's safety calls, two for places, and a question to the driver. The order
    is that of the action space; a new type comes last, so that the others keep their numbers."""

    CLICK = "click"
    DOUBLE_TAP = "double_tap"
    LONG_PRESS = "long_press"
    INPUT_TEXT = "input_text"
    SCROLL = "scroll"
    SWIPE = "swipe"
    KEYBOARD_ENTER = "keyboard_enter"
    NAVIGATE_HOME = "navigate_home"
    NAVIGATE_BACK = "navigate_back"
    OPEN_APP = "open_app"
    WAIT = "wait"
    ANSWER = "answer"
    STATUS = "status"
    SHOW_ALERT = "show_alert"
    HAZARD_LIGHTS = "hazard_lights"
    EMERGENCY_CALL = "emergency_call"
    REQUEST_SLOW_DOWN = "request_slow_down"
    REQUEST_REROUTE = "request_reroute"
    PULL_OVER = "pull_over"
    QUERY = "query"
    ESTIMATE_POSITION = "estimate_position"
    ASK_DRIVER = "ask_driver"
    CALL = "call"
    """A function of the car, by its name; what it can be, ``cockpit.calls`` lists."""


BY_HAND = frozenset(
    {
        ActionType.CLICK,
        ActionType.DOUBLE_TAP,
        ActionType.LONG_PRESS,
        ActionType.INPUT_TEXT,
        ActionType.SCROLL,
        ActionType.SWIPE,
        ActionType.KEYBOARD_ENTER,
        ActionType.NAVIGATE_HOME,
        ActionType.NAVIGATE_BACK,
        ActionType.OPEN_APP,
    }
)
"""Actions on the screen."""
UNCALLED = tuple(kind for kind in ActionType if kind is not ActionType.CALL)
"""Every action but a call of a function: those of an agent at the touch screen."""


class GoalStatus(StrEnum):
    """The statuses that ``status`` declares."""

    COMPLETE = "complete"
    INFEASIBLE = "infeasible"
    NOT_NEEDED = "not_needed"


class Reason(StrEnum):
    """Reasons for declining a task."""

    NONE = "none"
    LAW = "law"
    SAFETY = "safety"
    ALREADY_SO = "already_so"
    NOT_POSSIBLE = "not_possible"


class Direction(StrEnum):
    """Directions of ``scroll`` and ``swipe``."""

    UP = "up"
    DOWN = "down"
    LEFT = "left"
    RIGHT = "right"


@dataclass(frozen=True, slots=True)
class Action:
    """One action; ``cockpit.actions`` reads it from JSON and defines which fields each type takes."""

    action_type: ActionType
    index: int | None = None
    x: int | None = None
    y: int | None = None
    text: str | None = None
    direction: Direction | None = None
    distance_px: int | None = None
    app_name: str | None = None
    goal_status: GoalStatus | None = None
    reason: Reason | None = None
    clear_text: bool | None = None
    seconds: int | None = None
    kind: AlertKind | None = None
    severity: Severity | None = None
    speed_kmh: float | None = None
    on: bool | None = None
    destination: str | None = None
    function: str | None = None
    """The function that is called."""
    arguments: Mapping[str, Any] | None = None
    """Its arguments by name, in JSON's types."""
