"""Actions: read from JSON, checked field by field, performed on the cockpit.

The vocabulary is AndroidWorld's JSON action plus the car's safety calls. ``FIELDS`` has a row for each type: what
it takes, what it does, and how it is told. Prompts are made of it (``grammar``), so the two cannot diverge.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from dataclasses import fields as dataclass_fields
from enum import StrEnum
from functools import partial
from typing import TYPE_CHECKING, Any

from automotive_cosim.cockpit.calls import function_named
from automotive_cosim.cockpit.functions import number_in, whole_in
from automotive_cosim.contracts import (
    UNCALLED,
    Action,
    ActionType,
    Alert,
    AlertKind,
    Direction,
    Element,
    Feedback,
    FeedbackCode,
    GoalStatus,
    Json,
    PullOver,
    Reason,
    Reroute,
    Severity,
    SlowDown,
    lon_lat,
)
from automotive_cosim.contracts.ids import key_of
from automotive_cosim.contracts.text import say
from automotive_cosim.errors import ActionError, UnknownNameError
from automotive_cosim.formats.blank import is_blank
from automotive_cosim.formats.words import shown

if TYPE_CHECKING:
    from automotive_cosim.cockpit.cockpit import Cockpit

TEXT_LIMIT = 120
"""Longest text of an action; CarUxRestrictions allow 120 characters while driving."""
DISTANCE_LIMIT_PX = 8192
"""Longest drag, larger than any screen."""
SECONDS_LIMIT = 10
"""Longest ``wait`` that a task's agent is told of."""
LONGEST_WAIT_S = 60
"""Longest ``wait``, as an agent that watches over a drive is told."""
LARGEST = 2**31 - 1
"""A number beyond it counts no element and no pixel."""
RANGES: Mapping[str, tuple[int, int]] = {
    **dict.fromkeys(("index", "x", "y"), (-LARGEST, LARGEST)),
    "seconds": (1, LONGEST_WAIT_S),
    "distance_px": (1, DISTANCE_LIMIT_PX),
    "speed_kmh": (0, 300),
}
"""Bounds of some fields."""


def _nothing(car: Cockpit, do: Action) -> Feedback:
    """Nothing in the cockpit moves."""
    return Feedback(FeedbackCode.OK, "")


@dataclass(frozen=True, slots=True)
class Takes:
    """One action type: its fields, effect and words. With ``target``, it requires an ``index``, or ``x`` and ``y``,
    never both."""

    about: str
    about_by_point: str = ""
    """The same for who is given no list of elements, where it differs."""
    about_bounded: str = ""
    """The same beside the bounds of the fields, where it differs."""
    target: bool = False
    required: tuple[str, ...] = ()
    optional: tuple[str, ...] = ()
    effect: Callable[..., Feedback] = _nothing
    """Performs it on the cockpit, which decides what is possible and says why not. It is also given the pixel of a
    target, or the key of the list that an optional index names, empty without one."""
    words: str = ""
    """How it is told, as a sentence without a subject (``action_in_words``); without one, its name says it."""


def _typed(car: Cockpit, do: Action, x: int, y: int) -> Feedback:
    focused = car.tap(x, y)
    if focused.code not in (FeedbackCode.OK, FeedbackCode.NO_EFFECT):
        return focused
    return car.type_text(do.text or "", clear=bool(do.clear_text))


def _alerted(car: Cockpit, do: Action) -> Feedback:
    assert do.kind is not None
    return car.alert(Alert(do.kind, do.severity or Severity.WARNING, do.text or "", do.speed_kmh))


def _slowed(car: Cockpit, do: Action) -> Feedback:
    assert do.speed_kmh is not None
    return car.ask_road(SlowDown(do.speed_kmh))


def _estimated(car: Cockpit, do: Action) -> Feedback:
    if position(do.text or "") is None:
        return Feedback(FeedbackCode.REFUSED, say('no position; give "LON,LAT" in degrees, e.g. "2.3522,48.8566"'))
    return _nothing(car, do)


FIELDS: Mapping[ActionType, Takes] = {
    ActionType.CLICK: Takes(
        "tap an element or a point",
        "tap a point",
        target=True,
        effect=lambda car, do, x, y: car.tap(x, y),
        words="taps {on}",
    ),
    ActionType.DOUBLE_TAP: Takes(
        "tap it twice", target=True, effect=lambda car, do, x, y: car.double_tap(x, y), words="double-taps {on}"
    ),
    ActionType.LONG_PRESS: Takes(
        "hold plus or minus for five steps at once; nothing else reacts",
        target=True,
        effect=lambda car, do, x, y: car.long_press(x, y),
        words="holds {on}",
    ),
    ActionType.INPUT_TEXT: Takes(
        "type into a text field",
        target=True,
        required=("text",),
        optional=("clear_text",),
        effect=_typed,
        words="types “{text}” into {on}",
    ),
    ActionType.SCROLL: Takes(
        "scroll the screen or a list in that direction",
        "scroll the screen in that direction",
        required=("direction",),
        optional=("index",),
        effect=lambda car, do, key: car.scroll(key, do.direction or Direction.DOWN),
        words="scrolls {direction}",
    ),
    ActionType.SWIPE: Takes(
        "swipe from that point; a slider is set where the finger is lifted",
        target=True,
        required=("direction",),
        optional=("distance_px",),
        effect=lambda car, do, x, y: car.swipe(x, y, do.direction or Direction.UP, do.distance_px),
        words="swipes {direction}{far} from {on}",
    ),
    ActionType.KEYBOARD_ENTER: Takes("press enter", effect=lambda car, do: car.key_enter()),
    ActionType.NAVIGATE_HOME: Takes("go to the home screen", effect=lambda car, do: car.home(), words="goes home"),
    ActionType.NAVIGATE_BACK: Takes("go back one screen", effect=lambda car, do: car.back(), words="goes back"),
    ActionType.OPEN_APP: Takes(
        "open a screen by its name",
        required=("app_name",),
        effect=lambda car, do: car.open_app(do.app_name or ""),
        words="opens {app_name}",
    ),
    ActionType.WAIT: Takes(
        "let 1 to 10 seconds pass",
        about_bounded="let that many seconds pass, or one; while watching over a drive, until something changes",
        optional=("seconds",),
        words="waits {for_s} s",
    ),
    ActionType.ANSWER: Takes(
        "tell the driver something; it is no warning", required=("text",), words="says “{text}”"
    ),
    ActionType.STATUS: Takes(
        "declare how it ended: complete when it is done; infeasible, after an answer that tells the driver why, "
        "if it must not or cannot be (law, safety, not_possible); not_needed if there is nothing to do "
        "(already_so, none)",
        required=("goal_status",),
        optional=("reason",),
        words="declares {goal_status}{because}",
    ),
    ActionType.SHOW_ALERT: Takes(
        "warn the driver on screen and by voice, who has asked to be warned of danger or limits",
        required=("kind",),
        optional=("severity", "text", "speed_kmh"),
        effect=_alerted,
        words="warns the driver of {kind}",
    ),
    ActionType.HAZARD_LIGHTS: Takes(
        "switch the hazard lights",
        required=("on",),
        effect=lambda car, do: car.hazards(bool(do.on)),
        words="switches the hazard lights {switched}",
    ),
    ActionType.EMERGENCY_CALL: Takes("call the emergency services", effect=lambda car, do: car.emergency_call()),
    ActionType.REQUEST_SLOW_DOWN: Takes(
        "ask for a lower speed", required=("speed_kmh",), effect=_slowed, words="asks for {speed_kmh:g} km/h"
    ),
    ActionType.REQUEST_REROUTE: Takes(
        "ask for another route",
        optional=("destination",),
        effect=lambda car, do: car.ask_road(Reroute(do.destination or "")),
        words="asks for another route{to}",
    ),
    ActionType.PULL_OVER: Takes(
        "ask the driver to stop at the side", effect=lambda car, do: car.ask_road(PullOver())
    ),
    ActionType.QUERY: Takes(
        "ask for facts about the car's position, rules, hazards, weather or traffic",
        required=("text",),
        words="asks “{text}”",
    ),
    ActionType.ESTIMATE_POSITION: Takes(
        'say where the car is, as "LON,LAT" in degrees, while GPS is out',
        required=("text",),
        effect=_estimated,
        words="estimates the position at {text}",
    ),
    ActionType.ASK_DRIVER: Takes(
        "ask the driver, whom it distracts, what you cannot find out otherwise; name all options, and ask before "
        "you change anything",
        required=("text",),
        effect=lambda car, do: car.ask_driver(do.text or ""),
        words="asks the driver “{text}”",
    ),
    ActionType.CALL: Takes(
        "call a function of the car, where functions may be called",
        required=("function",),
        optional=("arguments",),
        effect=lambda car, do: car.call(do.function or "", do.arguments or {}),
        words="calls {function}{given}",
    ),
}

_ENUMS: Mapping[str, type[StrEnum]] = {
    "direction": Direction,
    "goal_status": GoalStatus,
    "reason": Reason,
    "kind": AlertKind,
    "severity": Severity,
}
_TYPES: Mapping[str, type] = {
    "index": int,
    "x": int,
    "y": int,
    "distance_px": int,
    "seconds": int,
    "text": str,
    "app_name": str,
    "destination": str,
    "speed_kmh": float,
    "clear_text": bool,
    "on": bool,
    "function": str,
    "arguments": dict,
}
_JSON_TYPES = {int: "integer", float: "number", str: "string", bool: "boolean", dict: "object"}


_FENCE = re.compile(r"\A\s*```\w*\s*(.*?)\s*```\s*\Z", re.DOTALL)
"""What Markdown puts around code, as models put it around JSON."""


def parse(value: str | Json) -> Action:
    """Reads one action from a JSON object or its text.

    Raises ActionError: not JSON, not an object, an unknown type or value, or a missing, extra or ill-typed
    field."""
    if isinstance(value, str):
        try:
            value = json.loads(_FENCE.sub(r"\1", value))
        except (ValueError, RecursionError) as error:
            raise ActionError(f"the action is not JSON ({error}); send one JSON object") from error
    if not isinstance(value, dict):
        raise ActionError(f"the action is {_kind(value)}; send a JSON object with an action_type")
    given = {str(name): entry for name, entry in value.items() if entry is not None}
    if "action_type" not in given:
        raise ActionError("the action lacks action_type; it is one of " + ", ".join(ActionType))
    action_type = _enum(ActionType, "action_type", given.pop("action_type"))
    required = FIELDS[action_type].required
    said = {name: entry for name, entry in given.items() if name in required or not _is_blank(name, entry)}
    return check(Action(action_type, **{name: _field(name, entry) for name, entry in said.items()}))


def check(action: Action) -> Action:
    """Returns the action if its fields fit its type.

    Raises ActionError: a field is missing, extra or out of range; the message names it."""
    takes = FIELDS[action.action_type]
    given = {name for name, value in _each(action) if value is not None} - {"action_type"}
    name = f"action {action.action_type!s}"
    if takes.target:
        by_index, by_point = "index" in given, {"x", "y"} & given
        if by_index and by_point:
            raise ActionError(f"{name} has both index and x, y; give one of them")
        if not by_index and by_point != {"x", "y"}:
            raise ActionError(f"{name} lacks its target; give index, or x and y")
        given -= {"index", "x", "y"}
    for field in takes.required:
        if field not in given:
            raise ActionError(f"{name} lacks {field}; {takes.about} needs it")
    surplus = given - set(takes.required) - set(takes.optional)
    if surplus:
        allowed = (("index or x, y",) if takes.target else ()) + takes.required + takes.optional
        raise ActionError(
            f"{name} takes no {', '.join(sorted(surplus))}; it takes {', '.join(allowed) or 'no fields'}"
        )
    for field in ("text", "app_name", "destination"):
        said = getattr(action, field) or ""
        if len(said) > TEXT_LIMIT:
            raise ActionError(f"{name}: {field} has {len(said)} characters; at most {TEXT_LIMIT} are allowed")
        if any("\ud800" <= character <= "\udfff" for character in said):
            raise ActionError(f"{name}: {field} holds half a surrogate pair, which is not a character")
    for field, (least, most) in RANGES.items():
        value = getattr(action, field)
        if value is not None and not least <= value <= most:
            came = f"{value:g}" if isinstance(value, float) else shown(value)
            raise ActionError(f"{name}: {field} is {came}; it goes from {least} to {most}")
    if action.action_type is ActionType.CALL:
        called = function_named(action.function or "")
        return replace(action, arguments=called.read(action.arguments or {}))
    return action


def to_json(action: Action) -> Json:
    """The action as a JSON object, without the fields it does not have."""
    return {name: value for name, value in asdict(action).items() if value is not None}


def grammar(kinds: Collection[ActionType] = UNCALLED) -> str:
    """The actions of these kinds, each as one line of JSON with its meaning, for a prompt."""
    return "\n".join(f"- {takes.about}: {_example(kind, takes)}" for kind, takes in FIELDS.items() if kind in kinds)


def signatures(kinds: Collection[ActionType] = UNCALLED, *, by_point: bool = False, is_told: bool = True) -> str:
    """The same in fewer words: each action as a name with its fields, those in brackets optional, and its meaning
    where the name does not say it.

    Args:
        by_point: whether there is no list of elements, so that a target is a point."""
    return "\n".join(
        f"{kind}({', '.join(_signature(takes, by_point))})"
        + (f": {_about(takes, by_point)}" if is_told and takes.words else "")
        for kind, takes in FIELDS.items()
        if kind in kinds
    )


def _about(takes: Takes, by_point: bool) -> str:
    return (by_point and takes.about_by_point) or takes.about


def _signature(takes: Takes, by_point: bool) -> Iterator[str]:
    target = (("x", "y") if by_point else ("index",)) if takes.target else ()
    for name in (*target, *takes.required, *takes.optional):
        if by_point and name == "index":
            continue
        values = f": {'|'.join(_ENUMS[name])}" if name in _ENUMS else ""
        yield f"[{name}{values}]" if name in takes.optional else name + values


def json_schema() -> Json:
    """The actions that ``check`` accepts, as a JSON Schema with one member per type."""
    return {
        "title": "Action",
        "description": "One thing that an agent does.",
        "type": "object",
        "required": ["action_type"],
        "properties": {"action_type": {"enum": [str(kind) for kind in FIELDS]}},
        "oneOf": [_member(kind, takes) for kind, takes in FIELDS.items()],
    }


def schema_of(kinds: Collection[ActionType], indices: Sequence[int] | None, called: Sequence[str] = ()) -> Json:
    """The actions of some kinds as a JSON Schema that servers turn into a grammar: fields in a fixed order, and a
    target given in one way.

    Args:
        indices: those of the elements that can be acted on; None if a target is a point.
        called: names of the functions that can be called; any name, if none is given."""
    members = []
    for kind, takes in FIELDS.items():
        if kind not in kinds or (takes.target and indices is not None and not indices):
            continue
        target = () if not takes.target else ("x", "y") if indices is None else ("index",)
        optional = [name for name in takes.optional if name != "index" or indices]
        schemas = {name: field_schema(name) for name in (*target, *takes.required, *optional)}
        if "index" in schemas:
            schemas["index"] = {"enum": list(indices or ())}
        if "function" in schemas and called:
            schemas["function"] = {"enum": list(called)}
        for axis in {"x", "y"} & schemas.keys():
            schemas[axis] |= {"minimum": 0, "maximum": DISTANCE_LIMIT_PX}
        members.append(
            {
                "type": "object",
                "properties": {"action_type": {"const": str(kind)}} | schemas,
                "required": ["action_type", *target, *takes.required],
                "additionalProperties": False,
            }
        )
    return {"anyOf": members}


def _member(kind: ActionType, takes: Takes) -> Json:
    named = (("index", "x", "y") if takes.target else ()) + takes.required + takes.optional
    schema: Json = {
        "title": str(kind),
        "description": takes.about_bounded or takes.about,
        "properties": {"action_type": {"const": str(kind)}} | {name: field_schema(name) for name in named},
        "required": ["action_type", *takes.required],
        "additionalProperties": False,
    }
    if takes.target:
        has_x, has_y, has_index = ({"required": [name]} for name in ("x", "y", "index"))
        schema["oneOf"] = [
            has_index | {"not": {"anyOf": [has_x, has_y]}},
            {"required": ["x", "y"], "not": has_index},
        ]
    return schema


def field_schema(name: str) -> Json:
    """The values of a field of an action, as a JSON Schema."""
    if name in _ENUMS:
        return {"enum": [str(member) for member in _ENUMS[name]]}
    schema: Json = {"type": _JSON_TYPES[_TYPES[name]]}
    if _TYPES[name] is str:
        schema["maxLength"] = TEXT_LIMIT
    if name in RANGES:
        schema["minimum"], schema["maximum"] = RANGES[name]
    return schema


def position(text: str) -> tuple[float, float] | None:
    """Longitude and latitude in degrees from ``"LON,LAT"``; None if it is not a place on earth."""
    try:
        return lon_lat(text)
    except ValueError:
        return None


def perform(action: Action, cockpit: Cockpit, elements: Sequence[Element]) -> Feedback:
    """Performs an action on the cockpit.

    Args:
        cockpit: the cockpit, which decides what is possible and says why not.
        elements: the list that the agent saw, to which an index refers; empty if it was given none.

    Returns:
        The result. A wrong action changes nothing."""
    if action.index is not None and not elements:
        return Feedback(FeedbackCode.NO_SUCH_ELEMENT, say("there is no list of elements; give x and y"))
    if action.index is not None and not 0 <= action.index < len(elements):
        return Feedback(
            FeedbackCode.NO_SUCH_ELEMENT,
            say(
                "there is no element {index}; the list goes from 0 to {last}",
                index=action.index,
                last=len(elements) - 1,
            ),
        )
    takes = FIELDS[action.action_type]
    if takes.target:
        return takes.effect(cockpit, action, *point(action, elements))
    if "index" in takes.optional:
        return takes.effect(
            cockpit, action, "" if action.index is None else key_of(elements[action.index].resource_id)
        )
    return takes.effect(cockpit, action)


def action_in_words(action: Action | None, elements: Sequence[Element], waited_s: float | None = None) -> str:
    """Describes an action, as a sentence without a subject.

    Args:
        action: None if the agent raised, or its answer could not be read.
        elements: the list the agent saw when it acted.
        waited_s: how long a wait lasted, if something may have ended it."""
    if action is None:
        return "gives no action"
    because = action.reason not in (None, Reason.NONE)
    given = ", ".join(
        f"{name} {json.dumps(value) if isinstance(value, bool) else value}"
        for name, value in (action.arguments or {}).items()
    )
    told = {name: _plain(value) if isinstance(value, StrEnum) else value for name, value in _each(action)} | {
        "on": _target_in_words(action, elements),
        "far": "" if action.distance_px is None else f" by {action.distance_px} px",
        "for_s": action.seconds or 1 if waited_s is None else round(waited_s),
        "because": f" ({_plain(action.reason)})" if because else "",
        "switched": "on" if action.on else "off",
        "to": f" to {action.destination}" if action.destination else "",
        "given": f" with {given}" if given else "",
    }
    return FIELDS[action.action_type].words.format_map(told) or _plain(action.action_type)


def _each(action: Action) -> Iterator[tuple[str, Any]]:
    return ((field.name, getattr(action, field.name)) for field in dataclass_fields(action))


def _plain(name: str | None) -> str:
    return (name or "").replace("_", " ")


def _target_in_words(action: Action, elements: Sequence[Element]) -> str:
    if action.index is None:
        return "the screen" if action.x is None else f"the screen at {action.x}, {action.y}"
    if not 0 <= action.index < len(elements):
        return f"element {action.index}, which does not exist"
    element = elements[action.index]
    name = element.text or element.content_description or element.resource_id or f"element {action.index}"
    return f"“{name}”"


def point(action: Action, elements: Sequence[Element]) -> tuple[int, int]:
    """The pixel that an action with a target touches: the one it gives, or the middle of the element it names."""
    if action.index is None:
        return action.x or 0, action.y or 0
    box = elements[action.index].bbox_pixels
    return (box.x_min + box.x_max) // 2, (box.y_min + box.y_max) // 2


def _example(kind: ActionType, takes: Takes) -> str:
    names = (("index",) if takes.target else ()) + takes.required + takes.optional
    parts = [f'"action_type": "{kind}"']
    for name in names:
        if name in _ENUMS:
            parts.append(f'"{name}": "<{"|".join(_ENUMS[name])}>"')
        else:
            parts.append(f'"{name}": <{_TYPES[name].__name__}>')
    point = ' (or "x", "y" in place of "index")' if takes.target else ""
    left_out = f" ({', '.join(takes.optional)} may be left out)" if takes.optional else ""
    return "{" + ", ".join(parts) + "}" + point + left_out


def _is_blank(name: str, value: Any) -> bool:
    """Whether a field that may be left out says nothing."""
    return is_blank(value, tuple(_ENUMS.get(name, ())))


def _field(name: str, value: Any) -> Any:
    """The value of a field, converted where nothing is lost, as by AndroidWorld's ``JSONAction``: ``"3"`` is 3."""
    if name in _ENUMS:
        return _enum(_ENUMS[name], name, value)
    if name not in _TYPES:
        raise ActionError(str(UnknownNameError("action field", name, [*_TYPES, *_ENUMS])))
    expected = _TYPES[name]
    if type(value) is expected and value == value:
        return value
    if (converted := _CONVERTED[expected](value)) is None:
        raise ActionError(f"{name} is {_kind(value)}; it must be {expected.__name__}")
    return converted


def _words(value: Any) -> str | None:
    return str(value) if isinstance(value, int | float) else None


def _switch(value: Any) -> bool | None:
    return {"true": True, "false": False}.get(value.casefold()) if isinstance(value, str) else None


def _object(value: Any) -> dict[str, Any] | None:
    """A JSON object from its text."""
    try:
        found = json.loads(value) if isinstance(value, str) else None
    except (ValueError, RecursionError):
        return None
    return found if isinstance(found, dict) else None


_CONVERTED: Mapping[type, Callable[[Any], Any]] = {
    int: partial(whole_in, most=LARGEST + 1),
    float: partial(number_in, most=LARGEST + 1),
    str: _words,
    bool: _switch,
    dict: _object,
}
"""A value of another type as one of this type; None where it is none."""


def _enum(kind: type[StrEnum], name: str, value: Any) -> Any:
    if isinstance(value, str) and value.casefold() in set(kind):
        return kind(value.casefold())
    raise ActionError(str(UnknownNameError(name, str(value)[:40], kind)))


def _kind(value: object) -> str:
    text = repr(value)
    return f"{type(value).__name__} {text if len(text) <= 40 else text[:37] + '...'}"
