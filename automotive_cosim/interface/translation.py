"""What was commanded by touch, as calls: for each command the function, and the arguments, that make the same one.

Nothing is listed: of every function, the arguments are tried that occur in the command, until the message that it
makes is the command itself.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from functools import cache
from itertools import product
from math import prod
from typing import Any

from automotive_cosim.cockpit.apps.phone.commands import CALL_EMERGENCY
from automotive_cosim.cockpit.apps.safety.commands import ASK_PULL_OVER, ASK_SLOW_DOWN, WarnDriver
from automotive_cosim.cockpit.apps.safety.state import AlertDraft
from automotive_cosim.cockpit.calls import functions
from automotive_cosim.cockpit.commands import Put, Set, SetAll
from automotive_cosim.cockpit.functions import Argument, CarFunction
from automotive_cosim.cockpit.signals import ADAS, Signal
from automotive_cosim.cockpit.state import Command, Message, State
from automotive_cosim.contracts import Action, ActionType, Alert
from automotive_cosim.errors import ActionError
from automotive_cosim.interface.functions import action_of


def actions_of(command: Command, state: State) -> tuple[Action, ...] | None:
    """The calls that do what a command does.

    Returns:
        The actions, several for a command of several signals, none for a draft; None if no function does it.
    """
    if command.prepares or not command.aims(state):
        return ()
    match command:
        case Set(signal, value):
            return (_set(signal, value),)
        case WarnDriver(alert):
            draft = state.of(AlertDraft)
            given = alert or (
                None if draft.kind is None else Alert(draft.kind, draft.severity, "", draft.speed_kmh)
            )
            if given is None:
                return None
            text = given.text or None
            return (
                Action(
                    ActionType.SHOW_ALERT,
                    kind=given.kind,
                    severity=given.severity,
                    text=text,
                    speed_kmh=given.speed_kmh,
                ),
            )
        case _ if command == ASK_SLOW_DOWN:
            speed_kmh = state.of(AlertDraft).speed_kmh or state.signals[ADAS.LIMIT_SIGN]
            return None if speed_kmh is None else (Action(ActionType.REQUEST_SLOW_DOWN, speed_kmh=speed_kmh),)
        case _ if command == ASK_PULL_OVER:
            return (Action(ActionType.PULL_OVER),)
        case _ if command == CALL_EMERGENCY:
            return (Action(ActionType.EMERGENCY_CALL),)
    found = _tried(command, state)
    if found is not None:
        return (found,)
    if isinstance(command, SetAll):
        return tuple(_set(signal, value) for signal, value in command.values)
    return None


def _set(signal: Signal[Any], value: Any) -> Action:
    function, which, name = _by_path()[signal.path]
    return action_of(function, ({"which": which} if which else {}) | {name: value})


@cache
def _by_path() -> Mapping[str, tuple[str, str, str]]:
    """By the path of an actuator, the function that sets it, as which of several, and the name of the value."""
    found: dict[str, tuple[str, str, str]] = {}
    for function in (each for each in functions().values() if each.signals):
        *which, value = function.parameters
        names = which[0].schema["enum"] if which else [""]
        found |= {
            path: (function.name, name, value.name) for path, name in zip(function.signals, names, strict=True)
        }
    return found


def _tried(command: Command, state: State) -> Action | None:
    words, numbers = _values(command, state)
    app = _folder(command.data if isinstance(command, Put) else command)
    of_apps = (each for each in functions().values() if not each.signals and not each.reads)
    for function in of_apps:
        if "apps" in app and function.make.__module__.rpartition(".")[0] != app:
            continue  # what an app has, its own functions command
        for given in _arguments(function, words, numbers):
            try:
                made = function.make(state, **function.read(given))
            except (ActionError, LookupError, ValueError):
                continue
            if isinstance(made, Message) and _same(made, command):
                return action_of(function.name, given)
    return None


def _folder(value: object) -> str:
    """The package of what it is: an app's, for its commands and its data."""
    return type(value).__module__.rpartition(".")[0]


def _same(one: Message, other: Message) -> bool:
    """Whether they command the same, whatever is said of it."""
    if isinstance(one, Put) and isinstance(other, Put):
        return one.data == other.data
    if isinstance(one, SetAll) and isinstance(other, SetAll):
        return one.values == other.values
    return one == other


def _arguments(function: CarFunction, words: Sequence[str], numbers: Sequence[float]) -> Iterator[dict[str, Any]]:
    """Arguments that a function may take, of the values of a command."""
    options = [_options(each, words, numbers) for each in function.parameters]
    for values in product(*options) if prod(map(len, options)) <= TRIES else ():
        pairs = zip(function.parameters, values, strict=True)
        yield {each.name: value for each, value in pairs if value is not None}


def _options(parameter: Argument, words: Sequence[str], numbers: Sequence[float]) -> Sequence[Any]:
    schema = parameter.schema
    left_out = ("",) if parameter.required and schema["type"] == "string" else () if parameter.required else (None,)
    if "enum" in schema:
        return (*schema["enum"], *left_out)
    match schema["type"]:
        case "boolean":
            return (True, False, *left_out)
        case "string":
            return (*words, *left_out)
        case _:
            low, high = schema.get("minimum", 0), schema.get("maximum", 0)
            return (*(range(low, high + 1) if high - low < FEW else numbers), *left_out)


FEW = 10
"""A range of so many numbers is tried as a whole."""


def _values(command: Command, state: State) -> tuple[tuple[str, ...], tuple[float, ...]]:
    """The texts and numbers of a command: of its fields or, where it replaces app data, of what changes."""
    parts: list[Any] = [command]
    if isinstance(command, Put):
        before, changes = state.of(type(command.data)), command.changes(state)
        was, now = before.commands(), command.data.commands()
        parts = [part for name, new in changes.items() for part in _differing(getattr(before, name), new)]
        parts += [part for key in now if now[key] != was[key] for part in _differing(was[key], now[key])]
    leaves = tuple(dict.fromkeys(leaf for part in parts for leaf in _leaves(part)))
    texts = [str(leaf) for leaf in leaves if isinstance(leaf, str)]
    figures = [figure for text in texts for figure in re.findall(r"\d[\d:.]*\d|\d", text)]
    numbers = tuple(leaf for leaf in leaves if isinstance(leaf, int | float) and not isinstance(leaf, bool))
    return tuple(dict.fromkeys((*texts, *figures)))[:MANY], numbers[:MANY]


MANY = 60
TRIES = 5000
"""Values of a command, and arguments of one function, that are tried: a command with more is not one of its."""


def _differing(before: Any, after: Any) -> Iterator[Any]:
    """What is in one of two values alone: of two lists, the entries."""
    if isinstance(before, list | tuple) and isinstance(after, list | tuple):
        yield from (each for each in after if each not in before)
        yield from (each for each in before if each not in after)
    else:
        yield from (after, before)


def _leaves(value: Any) -> Iterator[Any]:
    if isinstance(value, str | int | float):
        yield value
    elif is_dataclass(value):
        name = getattr(value, "name", "")
        if isinstance(name, str) and name:
            yield name
        for each in fields(value):
            yield from _leaves(getattr(value, each.name))
    elif isinstance(value, Mapping):
        yield from _leaves(tuple(value.values()))
    elif isinstance(value, Iterable):
        for each in value:
            yield from _leaves(each)
