"""What a format's words mean as actions of the car, and back."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from math import isfinite
from typing import Any

from automotive_cosim.agents.native.grid import GuiScreen
from automotive_cosim.cockpit.actions import SECONDS_LIMIT, check, parse, to_json
from automotive_cosim.contracts import Action, ActionType, Direction, Element, GoalStatus, Json
from automotive_cosim.errors import ActionError, UnknownNameError

CAR = "car"
"""Name of the function with the car's own actions."""
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
KEYS: Mapping[str, ActionType] = {
    "home": ActionType.NAVIGATE_HOME,
    "back": ActionType.NAVIGATE_BACK,
    "goback": ActionType.NAVIGATE_BACK,
    "esc": ActionType.NAVIGATE_BACK,
    "escape": ActionType.NAVIGATE_BACK,
    "enter": ActionType.KEYBOARD_ENTER,
    "return": ActionType.KEYBOARD_ENTER,
}
"""The keys that this car has, by the names that the formats give them."""
STATUSES: Mapping[str, GoalStatus] = {
    "success": GoalStatus.COMPLETE,
    "complete": GoalStatus.COMPLETE,
    "failure": GoalStatus.INFEASIBLE,
    "fail": GoalStatus.INFEASIBLE,
    "infeasible": GoalStatus.INFEASIBLE,
    "not_needed": GoalStatus.NOT_NEEDED,
}


@dataclass(frozen=True, slots=True)
class GuiCall:
    """One call in a model's answer: a name and arguments, as the format has them."""

    name: str
    arguments: Mapping[str, Any]


class Meaning(StrEnum):
    """What a verb does."""

    MOVE = "move"
    """Points at something without touching it."""
    TAP = "tap"
    DOUBLE_TAP = "double_tap"
    HOLD = "hold"
    TYPE = "type"
    SCROLL = "scroll"
    """Shows what lies in that direction."""
    FLICK = "flick"
    """Moves the finger in that direction, the opposite of a scroll."""
    DRAG = "drag"
    """Moves the finger from one point to another."""
    KEY = "key"
    OPEN = "open"
    WAIT = "wait"
    SAY = "say"
    ASK = "ask"
    """Asks the driver."""
    END = "end"
    CAR = "car"
    """An action of the car that screens in general do not know, as a JSON object."""


POINTS = ("point", "start_point", "coordinate", "start_box", "box_2d")
"""Arguments with a point, in any format."""
TOUCHES: Mapping[Meaning, ActionType] = {
    Meaning.TAP: ActionType.CLICK,
    Meaning.DOUBLE_TAP: ActionType.DOUBLE_TAP,
    Meaning.HOLD: ActionType.LONG_PRESS,
}


@dataclass(frozen=True, slots=True)
class Verb:
    """One word of a format, and which of its arguments says what."""

    meaning: Meaning
    at: tuple[str, ...] = ()
    """The argument with the point, or the two with x and y."""
    to: tuple[str, ...] = ()
    """The same for where a drag ends."""
    text: str = ""
    """The argument with the text: what is typed, said, opened, pressed, or the status. Others that are read after a
    ``|``."""
    direction: str = ""
    seconds: str = ""
    means: str = ""
    """Without an argument for it, the text that the word stands for."""
    says: str = ""
    """The argument with what the driver is told at the end."""
    enter: str = ""
    clear: str = ""
    """The argument that says whether enter is pressed after a text, and whether what stood in the field goes, with
    what holds without it: ``name:true``. Without a name, it is fixed."""
    ways: tuple[str, ...] = ()
    """The directions of an amount above and below zero, if the direction is told so."""
    point_optional: bool = False
    """Whether it may come without a point: then it is where the last one was; a drag without an end is a tap."""
    unasked: bool = False
    """Whether the word is read if a model says it, but not offered."""

    @property
    def may_decline(self) -> bool:
        """Whether it can end with a status other than success."""
        return self.meaning is Meaning.END and self.means != "success"

    def arguments(self) -> tuple[str, ...]:
        switches = (switch.partition(":")[0] for switch in (self.enter, self.clear))
        named = (self.text.partition("|")[0], self.direction, self.seconds, self.says, *switches)
        return (*self.at, *self.to, *filter(None, named))


@dataclass(frozen=True, slots=True)
class Hand:
    """What the device knows and the model need not say: where texts go, and which list lies under a point."""

    screen: GuiScreen
    elements: Sequence[Element] = ()
    last: tuple[int, int] | None = None
    """The pixel that was touched or pointed at last."""
    has_touched: bool = False
    """Whether that was in the same answer, so that the focus is where it has gone since the picture."""


def actions(verbs: Mapping[str, Verb], call: GuiCall, hand: Hand) -> list[Action]:
    """The actions that a call asks for, one after the other.

    Raises ActionError: the format has no such word, an argument is missing or wrong, or the car has nothing like
    it."""
    verb = verbs.get(call.name)
    if verb is None:
        raise ActionError(str(UnknownNameError("action in this format", call.name[:40], verbs)))
    return [check(action) for action in _actions(verb, call, hand)]


def _actions(verb: Verb, call: GuiCall, hand: Hand) -> list[Action]:
    text = _text(verb, call)
    match verb.meaning:
        case Meaning.MOVE:
            _point(verb.at, call, hand.screen)
            return []
        case Meaning.TAP | Meaning.DOUBLE_TAP | Meaning.HOLD:
            x, y = _start(verb, call, hand)
            return [Action(TOUCHES[verb.meaning], x=x, y=y)]
        case Meaning.TYPE:
            named = next((name for name in POINTS if name in call.arguments), "")
            if named and not verb.at:  # a target that the format does not ask for
                verb = replace(verb, at=(named,))
            typed = text.removesuffix("\n")
            is_entered = typed != text or _is_on(verb.enter, call)
            enter = [Action(ActionType.KEYBOARD_ENTER)] if is_entered else []
            return [*([_typed(typed, verb, call, hand)] if typed else []), *enter]
        case Meaning.SCROLL:
            return [Action(ActionType.SCROLL, index=_list(verb, call, hand), direction=_direction(verb, call))]
        case Meaning.FLICK:
            x, y = _point(verb.at, call, hand.screen) if _has_point(verb, call) else _middle(hand.screen)
            return [Action(ActionType.SWIPE, x=x, y=y, direction=_direction(verb, call))]
        case Meaning.DRAG:
            start = _start(verb, call, hand)
            if verb.point_optional and not any(name in call.arguments for name in verb.to):
                return [Action(ActionType.CLICK, x=start[0], y=start[1])]
            return [drag(start, _point(verb.to, call, hand.screen))]
        case Meaning.KEY:
            return [Action(_key(text))]
        case Meaning.OPEN:
            return [Action(ActionType.OPEN_APP, app_name=text)]
        case Meaning.WAIT:
            return [Action(ActionType.WAIT, seconds=_seconds(call.arguments.get(verb.seconds, verb.means)))]
        case Meaning.SAY:
            return [Action(ActionType.ANSWER, text=text)]
        case Meaning.ASK:
            return [Action(ActionType.ASK_DRIVER, text=text)]
        case Meaning.END:
            if text.casefold() not in STATUSES:
                raise ActionError(str(UnknownNameError("status", text[:40], STATUSES)))
            said = str(call.arguments.get(verb.says) or "")
            told = [Action(ActionType.ANSWER, text=said)] if said else []
            return [*told, Action(ActionType.STATUS, goal_status=STATUSES[text.casefold()])]
        case Meaning.CAR:
            return [parse(dict(call.arguments))]


def call_for(verbs: Mapping[str, Verb], action: Action, screen: GuiScreen) -> GuiCall | None:
    """The call that asks for an action; None if the format has no word for it.

    A text is typed into the field that has the focus, so its target is not said."""
    asked = ((name, verb) for name, verb in verbs.items() if not verb.unasked)
    return next((call for name, verb in asked if (call := _call(name, verb, action, screen))), None)


def _call(name: str, verb: Verb, action: Action, screen: GuiScreen) -> GuiCall | None:
    kind = action.action_type
    if verb.meaning is Meaning.CAR:
        return GuiCall(name, to_json(action)) if name == kind or (name == CAR and kind in CAR_ACTIONS) else None
    said = _said(verb, action)
    if said is None or (verb.means and said != verb.means):
        return None
    found: dict[str, Any] = {verb.text.partition("|")[0]: said} if verb.text else {}
    if verb.at and action.x is not None and action.y is not None:
        found |= _spread(verb.at, screen.point(action.x, action.y))
        if verb.to:
            found |= _spread(verb.to, screen.point(*_end(action)))
    elif verb.at and not verb.point_optional:
        return None
    if verb.direction:
        found[verb.direction] = str(action.direction)
    if verb.seconds and action.seconds is not None:
        found[verb.seconds] = action.seconds
    if verb.says:
        found[verb.says] = ""
    for switch, wanted in ((verb.enter, False), (verb.clear, bool(action.clear_text))):
        key, _, default = switch.partition(":")
        if key and wanted != (default == "true"):
            found[key] = wanted
    return GuiCall(name, found)


def _said(verb: Verb, action: Action) -> str | None:
    """The text that a verb says for an action; empty if it says none, None if it is not the action's verb."""
    kind = action.action_type
    match verb.meaning:
        case Meaning.TAP | Meaning.DOUBLE_TAP | Meaning.HOLD:
            return "" if TOUCHES[verb.meaning] is kind else None
        case Meaning.TYPE:
            return action.text if kind is ActionType.INPUT_TEXT else None
        case Meaning.SCROLL:
            return "" if kind is ActionType.SCROLL else None
        case Meaning.FLICK:
            return "" if kind is ActionType.SWIPE and action.distance_px is None else None
        case Meaning.DRAG:
            return "" if kind is ActionType.SWIPE and action.distance_px is not None else None
        case Meaning.KEY:
            return next((key for key, pressed in KEYS.items() if pressed is kind), None)
        case Meaning.OPEN:
            return action.app_name if kind is ActionType.OPEN_APP else None
        case Meaning.WAIT:
            return "" if kind is ActionType.WAIT else None
        case Meaning.SAY:
            return action.text if kind is ActionType.ANSWER else None
        case Meaning.ASK:
            return action.text if kind is ActionType.ASK_DRIVER else None
        case Meaning.END:
            if kind is not ActionType.STATUS:
                return None
            return next(word for word, status in STATUSES.items() if status is action.goal_status)
        case Meaning.CAR | Meaning.MOVE:
            return None


CAR_ACTIONS = frozenset(
    {
        ActionType.SHOW_ALERT,
        ActionType.HAZARD_LIGHTS,
        ActionType.EMERGENCY_CALL,
        ActionType.REQUEST_SLOW_DOWN,
        ActionType.REQUEST_REROUTE,
        ActionType.PULL_OVER,
        ActionType.ANSWER,
        ActionType.ASK_DRIVER,
        ActionType.STATUS,
    }
)
"""What a car can do beyond a touch screen; offered as a function where the format has functions."""


# --- arguments ------------------------------------------------------------------------------------------------


def _text(verb: Verb, call: GuiCall) -> str:
    name = next((each for each in verb.text.split("|") if each in call.arguments), None)
    if name is None:
        return verb.means
    value = call.arguments[name]
    if isinstance(value, list) and len(value) == 1:  # a list of keys
        value = value[0]
    if isinstance(value, int | float) and not isinstance(value, bool):
        value = str(value)
    if not isinstance(value, str):
        raise ActionError(f"{call.name}: {name} is {value!r:.60}; give one text")
    return value


def _has_point(verb: Verb, call: GuiCall) -> bool:
    return all(call.arguments.get(name) is not None for name in verb.at)


def _point(names: tuple[str, ...], call: GuiCall, screen: GuiScreen) -> tuple[int, int]:
    values = [call.arguments.get(name) for name in names]
    numbers = [number for value in values for number in _numbers(value)]
    if len(numbers) == 4 and len(names) == 1:  # a box: its middle
        numbers = [(numbers[0] + numbers[2]) / 2, (numbers[1] + numbers[3]) / 2]
    if len(numbers) != 2 or not all(map(isfinite, numbers)):
        came = ", ".join(f"{name} {value!r:.40}" for name, value in zip(names, values, strict=True))
        raise ActionError(f"{call.name}: {came} is no point; give two numbers, x and y")
    return screen.pixel(*numbers)


def _start(verb: Verb, call: GuiCall, hand: Hand) -> tuple[int, int]:
    """Where a touch begins: at its point, or without one where the last was."""
    if verb.at and (_has_point(verb, call) or not verb.point_optional or hand.last is None):
        return _point(verb.at, call, hand.screen)
    if hand.last is None:
        raise ActionError(f"{call.name} begins at the last touch, and there was none; touch or point there first")
    return hand.last


def pointed(verb: Verb, call: GuiCall, hand: Hand) -> tuple[int, int] | None:
    """The pixel that a word points at without touching it; None if it does not point."""
    return _point(verb.at, call, hand.screen) if verb.meaning is Meaning.MOVE else None


def _is_on(switch: str, call: GuiCall) -> bool:
    name, _, default = switch.partition(":")
    value = call.arguments.get(name, default)
    return str(value).casefold() == "true"


def _numbers(value: Any) -> list[float]:
    if isinstance(value, bool) or value is None:
        return []
    if isinstance(value, int | float):
        return [float(value)]
    if isinstance(value, str):
        return [float(number) for number in NUMBER.findall(value)]
    if isinstance(value, list | tuple):
        return [number for entry in value for number in _numbers(entry)]
    return []


def _spread(names: tuple[str, ...], point: tuple[int, int]) -> Json:
    return {names[0]: list(point)} if len(names) == 1 else dict(zip(names, point, strict=True))


def _direction(verb: Verb, call: GuiCall) -> Direction:
    value = str(call.arguments.get(verb.direction, "")).casefold()
    if verb.ways and (amounts := _numbers(value)):
        value = verb.ways[0] if amounts[0] > 0 else verb.ways[1]
    if value not in set(Direction):
        raise ActionError(str(UnknownNameError("direction", value[:40], Direction)))
    return Direction(value)


def _seconds(value: Any) -> int:
    numbers = _numbers(value)
    return max(1, min(SECONDS_LIMIT, round(numbers[0]))) if numbers and isfinite(numbers[0]) else 1


def _key(name: str) -> ActionType:
    key = KEYS.get(re.sub(r"^keycode_|[\s_]", "", name.casefold()))
    if key is None:
        raise ActionError(f"this car has no key {name[:40]!r}; it has home, back and enter")
    return key


def _typed(text: str, verb: Verb, call: GuiCall, hand: Hand) -> Action:
    clear = _is_on(verb.clear, call)
    if verb.at and _has_point(verb, call):
        x, y = _point(verb.at, call, hand.screen)
        return Action(ActionType.INPUT_TEXT, x=x, y=y, text=text, clear_text=clear or None)
    if hand.has_touched and hand.last is not None and _under(hand.last, hand, lambda each: each.is_editable):
        return typed(text, (), hand.last, clear=clear)
    return typed(text, hand.elements, hand.last, clear=clear)


def typed(text: str, elements: Sequence[Element], last: tuple[int, int] | None, *, clear: bool = False) -> Action:
    """The action that types a text where a device would: into the field with the focus, or else at the last touch.

    Raises ActionError: there is neither."""
    cleared = clear or None
    focused = next((i for i, entry in enumerate(elements) if entry.is_editable and entry.is_focused), None)
    if focused is not None:
        return Action(ActionType.INPUT_TEXT, index=focused, text=text, clear_text=cleared)
    if last is None:
        raise ActionError("no text field has the focus; tap one first")
    return Action(ActionType.INPUT_TEXT, x=last[0], y=last[1], text=text, clear_text=cleared)


def _list(verb: Verb, call: GuiCall, hand: Hand) -> int | None:
    """The list under the point, if one is given: the smallest that can be scrolled."""
    if not verb.at or not _has_point(verb, call):
        return None
    under = _under(_point(verb.at, call, hand.screen), hand, lambda each: each.is_scrollable)
    return min(under)[1] if under else None


def _under(at: tuple[int, int], hand: Hand, wanted: Callable[[Element], bool]) -> list[tuple[int, int]]:
    """Area in square pixels and index of the wanted elements under a pixel."""
    return [
        ((box.x_max - box.x_min) * (box.y_max - box.y_min), index)
        for index, element in enumerate(hand.elements)
        for box in (element.bbox_pixels,)
        if wanted(element) and box.x_min <= at[0] < box.x_max and box.y_min <= at[1] < box.y_max
    ]


def _middle(screen: GuiScreen) -> tuple[int, int]:
    return screen.width // 2, screen.height // 2


def drag(start: tuple[int, int], end: tuple[int, int]) -> Action:
    """The swipe from one pixel to another, along the axis on which the finger moves farther."""
    across, down = end[0] - start[0], end[1] - start[1]
    if abs(across) > abs(down):
        direction = Direction.RIGHT if across > 0 else Direction.LEFT
    else:
        direction = Direction.DOWN if down > 0 else Direction.UP
    far = max(1, abs(across), abs(down))
    return Action(ActionType.SWIPE, x=start[0], y=start[1], direction=direction, distance_px=far)


def _end(action: Action) -> tuple[int, int]:
    """Where the finger lifts."""
    x, y, far = action.x or 0, action.y or 0, action.distance_px or 0
    steps = {
        Direction.LEFT: (-far, 0),
        Direction.RIGHT: (far, 0),
        Direction.UP: (0, -far),
        Direction.DOWN: (0, far),
    }
    across, down = steps[action.direction or Direction.UP]
    return x + across, y + down
