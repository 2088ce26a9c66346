"""What an agent can call, as typed functions: the car's, and its own actions that need no screen.

    offered(conditions)                 the functions of an agent under these conditions
    action_of("set_hvac_temperature", {"which": "driver", "celsius": 21.5})
    as_openai(function) ...             JSON Schemas in the words of each API

A call is an action as any other: it takes the same time as a tap, is restricted, judged, traced and replayed.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from automotive_cosim.cockpit import calls
from automotive_cosim.cockpit.actions import FIELDS, check, field_schema, parse, to_json
from automotive_cosim.contracts import BY_HAND, UNCALLED, Action, ActionType, Json
from automotive_cosim.contracts.given import GeoInput, Interface
from automotive_cosim.errors import ActionError, UnknownNameError
from automotive_cosim.formats.words import shown

LIGHT = ActionType.HAZARD_LIGHTS
"""An action that a function of the car's actuators does too: one way is enough."""
OF_ACTIONS = tuple(kind for kind in UNCALLED if kind not in BY_HAND and kind is not LIGHT)
"""Actions that are functions by their own name: to wait, to speak, to ask, to warn, to end."""


_OWN = frozenset(map(str, OF_ACTIONS))
CAR = "car"
"""The function that stands for all of the car's, where definitions are sent with each question (``grouped``)."""
_FIELDS: Mapping[str, str] = {
    "seconds": "In s.",
    "speed_kmh": "In km/h.",
    "text": "The words, or what is asked for.",
    "kind": "What it is about.",
    "severity": "How urgent it is.",
    "goal_status": "How it ended.",
    "reason": "Why it was not done.",
    "destination": "Name of a place or street; the present one if left out.",
}
"""What the fields of actions say."""


@dataclass(frozen=True, slots=True)
class Function:
    """A function that an agent can call."""

    name: str
    about: str
    """What it does."""
    parameters: Json
    """JSON Schema of its arguments, an object."""


@cache
def functions() -> Mapping[str, Function]:
    """Every function by its name: first the actions', then the readings, the actuators' and the apps'."""
    own = [_of_action(kind) for kind in OF_ACTIONS]
    cars = [Function(each.name, each.about, each.schema) for each in calls.functions().values()]
    found = {function.name: function for function in (*own, *cars)}
    if len(found) < len(own) + len(cars):
        raise ValueError("a function of the car is named as an action; name it anew")
    return found


def offered(interface: Interface = Interface.FUNCTIONS, geo: GeoInput = GeoInput.FULL) -> tuple[Function, ...]:
    """The functions of an agent: of the car, of a finger, or of both, and always to wait, speak, ask, warn and end.

    Args:
        geo: what it is told of its place; who is told nothing has nothing to ask.
    """
    own = {str(kind) for kind in OF_ACTIONS} - (set() if geo.answers else {str(ActionType.QUERY)})
    called = [each for name, each in functions().items() if name in own or (interface.calls and name not in _OWN)]
    return (*called, *map(_of_action, sorted(BY_HAND))) if interface.touches else tuple(called)


def grouped(every: Iterable[Function]) -> tuple[Function, ...]:
    """The same in a quarter of the characters: the car's functions as one, which lists them with what they take.

    Args:
        every: functions that are offered. The actions among them stay as they are.
    """
    own = {*_OWN, *map(str, BY_HAND)}
    kept, cars = list[Function](), list[str]()
    for each in every:
        if each.name in own:
            kept.append(each)
        else:
            is_told = not calls.functions()[each.name].signals
            line = signature(each, is_told=is_told).removeprefix("- ").partition(". ")[0]
            cars.append(re.sub(r": (?:text|true\|false)\b", "", line).removesuffix("."))
    if not cars:
        return tuple(kept)
    listed = "\n".join(cars)
    about = f"Call a function of the car. Brackets may be left out; on and as_stop are true or false.\n{listed}"
    schema: Json = {
        "type": "object",
        "properties": {
            "function": {"type": "string", "description": "Its name."},
            "arguments": {
                "type": "string",
                "description": 'Its arguments as a JSON object, such as {"which": "driver", "celsius": 21.5}.',
            },
        },
        "required": ["function"],
        "additionalProperties": False,
    }
    return (*kept, Function(CAR, about, schema))


def action_of(name: str, arguments: str | Mapping[str, Any] | None = None) -> Action:
    """The action that a call is.

    Args:
        arguments: by name, or the text of a JSON object; None for none.

    Raises ActionError: there is no such function, or the arguments do not fit it."""
    if name == CAR:
        given = _object(name, arguments) if isinstance(arguments, str) else dict(arguments or {})
        return action_of(str(given.get("function", "")), _inner(given.get("arguments")))
    if name not in functions() and name not in BY_HAND:
        raise ActionError(str(UnknownNameError("function", name, functions(), "automotive-cosim show functions")))
    given = _object(name, arguments) if isinstance(arguments, str) else dict(arguments or {})
    if "action_type" in given:
        raise ActionError(f"{name} takes no action_type; its name says it")
    return parse(action_json(name, given))


def _inner(arguments: Any) -> str | Mapping[str, Any] | None:
    if arguments is None or isinstance(arguments, str | Mapping):
        return arguments
    return json.dumps(arguments)


def action_json(name: str, arguments: Mapping[str, Any]) -> Json:
    """The JSON of the action that a call is, not checked yet."""
    if name in _OWN or name in BY_HAND:
        return {**arguments, "action_type": name}
    return {"action_type": str(ActionType.CALL), "function": name, "arguments": dict(arguments)}


def _object(name: str, text: str) -> dict[str, Any]:
    try:
        found = json.loads(text or "{}")
    except (ValueError, RecursionError) as error:
        raise ActionError(f"the arguments of {name} are not JSON ({error}); send one JSON object") from error
    if not isinstance(found, dict):
        raise ActionError(f"the arguments of {name} are {shown(found)}; send one JSON object")
    return found


def call_of(action: Action) -> tuple[str, Json]:
    """The call that does what an action does: name and arguments. Raises ActionError: it acts on the screen."""
    if action.action_type in BY_HAND:
        raise ActionError(f"{action.action_type} acts on the screen; no function does that")
    if action.action_type is ActionType.CALL:
        return action.function or "", dict(action.arguments or {})
    if action.action_type is LIGHT:
        return "switch_lights", {"which": "hazard", "on": bool(action.on)}
    fields = to_json(check(action))
    return str(fields.pop("action_type")), fields


def _of_action(kind: ActionType) -> Function:
    takes = FIELDS[kind]
    target = ("index", "x", "y") if takes.target else ()
    schema = {
        "type": "object",
        "properties": {
            name: {"type": "string"} | field_schema(name) | _told(name)
            for name in (*target, *takes.required, *takes.optional)
        },
        "required": list(takes.required),
        "additionalProperties": False,
    }
    about = takes.about_bounded or takes.about
    return Function(str(kind), f"{about[0].upper()}{about[1:]}.", schema)


def _told(field: str) -> Json:
    return {"description": _FIELDS[field]} if field in _FIELDS else {}


def signature(function: Function, *, is_told: bool = True) -> str:
    """A function in few words: its name with its arguments and their values, those in brackets optional."""
    required = function.parameters["required"]
    told = ((name, f"{name}: {_values(schema)}") for name, schema in function.parameters["properties"].items())
    arguments = ", ".join(words if name in required else f"[{words}]" for name, words in told)
    return f"- {function.name}({arguments})" + (f": {function.about}" if is_told else "")


def _values(schema: Json) -> str:
    choices = schema.get("enum")
    if isinstance(choices, list):
        return "|".join(map(str, choices))
    if "minimum" in schema:
        counts = str(schema.get("description", "")).split("; ")[1:-1]
        return ", ".join([f"{schema['minimum']:g} to {schema['maximum']:g}", *counts])
    return {"string": "text", "boolean": "true|false"}.get(str(schema["type"]), str(schema["type"]))


# --- in the words of each API -----------------------------------------------------------------------------


def as_json(function: Function) -> Json:
    """Name, description, and the JSON Schema of the arguments."""
    return {"name": function.name, "description": function.about, "parameters": function.parameters}


def as_openai(function: Function) -> Json:
    """A tool of OpenAI's chat completions, which most servers read."""
    return {"type": "function", "function": as_json(function)}


def as_anthropic(function: Function) -> Json:
    """A tool of Anthropic's messages."""
    return {"name": function.name, "description": function.about, "input_schema": function.parameters}


def as_mcp(function: Function) -> Json:
    """A tool of the Model Context Protocol."""
    return {"name": function.name, "description": function.about, "inputSchema": function.parameters}
