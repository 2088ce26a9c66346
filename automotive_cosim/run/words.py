"""Describes actions and roads in words, for timelines, live views and pages."""

from __future__ import annotations

from collections.abc import Sequence

from automotive_cosim.contracts import KMH_PER_MPS, Action, ActionType, Element, Limit, Reason, RoadHere
from automotive_cosim.geo.text import amount_of_speed

ROUNDING_KMH = 1.0
"""A speedometer's last digit: a speed this much above the limit counts as at the limit."""

NAMELESS = {
    "motorway": "a motorway",
    "residential": "a residential street",
    "track": "a track",
    "unclassified": "a minor road",
    **{f"{road}_link": "a slip road" for road in ("motorway", "trunk", "primary", "secondary", "tertiary")},
}
"""Names of unnamed roads, by class, where OpenStreetMap's word for the class is not what people say."""


def action_in_words(action: Action | None, elements: Sequence[Element]) -> str:
    """Describes an action, as a sentence without a subject.

    Args:
        action: None if the agent raised, or its answer could not be read.
        elements: the list the agent saw when it acted.
    """
    if action is None:
        return "gives no action"
    on = _target(action, elements)
    match action.action_type:
        case ActionType.CLICK:
            return f"taps {on}"
        case ActionType.DOUBLE_TAP:
            return f"double-taps {on}"
        case ActionType.LONG_PRESS:
            return f"holds {on}"
        case ActionType.INPUT_TEXT:
            return f"types “{action.text}” into {on}"
        case ActionType.SCROLL:
            return f"scrolls {action.direction}"
        case ActionType.SWIPE:
            far = "" if action.distance_px is None else f" by {action.distance_px} px"
            return f"swipes {action.direction}{far} from {on}"
        case ActionType.OPEN_APP:
            return f"opens {action.app_name}"
        case ActionType.NAVIGATE_HOME:
            return "goes home"
        case ActionType.NAVIGATE_BACK:
            return "goes back"
        case ActionType.WAIT:
            return f"waits {action.seconds or 1} s"
        case ActionType.ANSWER:
            return f"says “{action.text}”"
        case ActionType.STATUS:
            because = f" ({_plain(action.reason)})" if action.reason not in (None, Reason.NONE) else ""
            return f"declares {_plain(action.goal_status)}{because}"
        case ActionType.SHOW_ALERT:
            return f"warns the driver of {_plain(action.kind)}"
        case ActionType.HAZARD_LIGHTS:
            return f"switches the hazard lights {'on' if action.on else 'off'}"
        case ActionType.REQUEST_SLOW_DOWN:
            return f"asks for {action.speed_kmh:g} km/h"
        case ActionType.REQUEST_REROUTE:
            return f"asks for another route {f'to {action.destination}' if action.destination else ''}".rstrip()
        case ActionType.QUERY:
            return f"asks “{action.text}”"
        case ActionType.ASK_DRIVER:
            return f"asks the driver “{action.text}”"
        case ActionType.CALL:
            given = ", ".join(f"{name} {_said(value)}" for name, value in (action.arguments or {}).items())
            return f"calls {action.function}" + (f" with {given}" if given else "")
        case ActionType.ESTIMATE_POSITION:
            return f"estimates the position at {action.text}"
        case _:  # keyboard_enter, emergency_call, pull_over: their names say it
            return _plain(action.action_type)


def road_in_words(road: RoadHere) -> str:
    """A road by its name, else by its class."""
    if road.name or not road.road_class:
        return road.name or "an unnamed road"
    if road.road_class in NAMELESS:
        return NAMELESS[road.road_class]
    words = _plain(road.road_class)
    return f"{'an' if words[0] in 'aeiou' else 'a'} {words}" + ("" if words.endswith("street") else " road")


def speed_in_words(speed_mps: float, limit: Limit, unit: str) -> str:
    """A speed and the limit in the unit of the place: ``"48 km/h, 50 posted"``, ``"30 mph, no limit known"``."""
    return f"{amount_of_speed(speed_mps * KMH_PER_MPS, unit)}, {limit_in_words(limit, unit)}"


def limit_in_words(limit: Limit, unit: str) -> str:
    """A limit with its source, in the unit of the place but without it."""
    if limit.kmh is None:
        return "no limit" if limit.is_posted else "no limit known"
    amount = amount_of_speed(limit.kmh, unit).partition(" ")[0]
    return f"{amount} posted" if limit.is_posted else f"{amount} by law"


def limit_kmh(limit: Limit) -> float | None:
    """A limit in km/h, to a tenth; None if there is none."""
    return None if limit.kmh is None else round(limit.kmh, 1)


def is_over(speed_kmh: float, limit_kmh: float | None) -> bool:
    """Above the limit by more than a speedometer's last digit."""
    return limit_kmh is not None and speed_kmh > limit_kmh + ROUNDING_KMH


def _target(action: Action, elements: Sequence[Element]) -> str:
    if action.index is None:
        return "the screen" if action.x is None else f"the screen at {action.x}, {action.y}"
    if not 0 <= action.index < len(elements):
        return f"element {action.index}, which does not exist"
    element = elements[action.index]
    name = element.text or element.content_description or element.resource_id or f"element {action.index}"
    return f"“{name}”"


def _said(value: object) -> str:
    return {True: "true", False: "false"}[value] if isinstance(value, bool) else f"{value}"


def _plain(name: str | None) -> str:
    return (name or "").replace("_", " ")
