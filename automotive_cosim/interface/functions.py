"""What an agent can call, as typed functions: the car's, and its own actions that need no screen.

    offered(conditions)                 the functions of an agent under these conditions
    action_of("set_hvac_temperature", {"which": "driver", "celsius": 21.5})
    as_openai(function) ...             JSON Schemas in the words of each API

A call is an action as any other: it takes the same time as a tap, is restricted, judged, traced and replayed.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
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


def action_of(name: str, arguments: str | Mapping[str, Any] | None = None) -> Action:
    """The action that a call is.

    Args:
        arguments: by name, or the text of a JSON object; None for none.

    Raises:
        ActionError: there is no such function, or the arguments do not fit it.
    """
    if name not in functions() and name not in BY_HAND:
        raise ActionError(str(UnknownNameError("function", name, functions(), "automotive-cosim show functions")))
    given = _object(name, arguments) if isinstance(arguments, str) else dict(arguments or {})
    if "action_type" in given:
        raise ActionError(f"{name} takes no action_type; its name says it")
    return parse(action_json(name, given))


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
    """The call that does what an action does: name and arguments.

    Raises:
        ActionError: it acts on the screen.
    """
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
            name: {"type": "string"} | field_schema(name) for name in (*target, *takes.required, *takes.optional)
        },
        "required": list(takes.required),
        "additionalProperties": False,
    }
    about = takes.about_bounded or takes.about
    return Function(str(kind), f"{about[0].upper()}{about[1:]}.", schema)


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
        return f"{schema['minimum']} to {schema['maximum']}"
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
