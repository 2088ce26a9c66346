"""The cockpit's commands as typed functions, for agents that call instead of touching.

A function is made from what is there: one or more actuators of a group (``signals``), or a small typed factory in
an app's ``functions.py``. Each makes the message that the screen's widget sends, so that a call is restricted,
recorded, judged and replayed as a touch is.

    @offered
    def honk(state: State) -> Message:
        \"\"\"Sound the horn.\"\"\"
        return HONK

    set_hvac_temperature(which="driver", celsius=21.5)
"""

from __future__ import annotations

import inspect
import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from dataclasses import fields as dataclass_fields
from functools import cache, lru_cache, partial
from math import isfinite
from typing import Any, Literal, get_args, get_origin, get_type_hints

from annotated_types import Ge, Le, MultipleOf

from automotive_cosim.cockpit import signals as catalogue
from automotive_cosim.cockpit.commands import Set
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.signals import LeafKind, Signal
from automotive_cosim.cockpit.state import Message, State
from automotive_cosim.cockpit.vehicle import HELD
from automotive_cosim.contracts import Feedback, FeedbackCode, Json
from automotive_cosim.contracts.text import say
from automotive_cosim.errors import ActionError, UnknownNameError
from automotive_cosim.formats.annotations import OneOf
from automotive_cosim.formats.blank import is_blank
from automotive_cosim.formats.words import shown

LONGEST_NUMBER = 40
"""Characters of a number's text; longer ones are no numbers."""


def number_in(value: Any, most: float) -> float | None:
    """A number from an int, a float or its text; None if it is none.

    Args:
        most: what is farther from zero becomes this: a float may not hold it."""
    if isinstance(value, str):
        try:
            value = float(value) if len(value) <= LONGEST_NUMBER else None
        except ValueError:
            return None
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    if isinstance(value, float) and not isfinite(value):
        return None
    return float(min(max(value, -most), most))


def whole_in(value: Any, most: float) -> int | None:
    """The same of a whole number, also from a float that holds one."""
    number = number_in(value, most)
    return int(number) if number is not None and number.is_integer() else None


CallMade = Message | Feedback
"""What a call becomes: the message to perform or, of a reading or a refusal, the answer itself."""
UNITS: Mapping[str, str] = {
    "Celsius": "celsius",
    "km/h": "km_per_h",
    "s": "seconds",
    "dB": "decibels",
    "mm": "millimetres",
}
"""VSS's units, where they are no word."""
DIRECTIONS: Mapping[str, str] = {
    "Window.Position": "0 is shut",
    "Sunroof.Position": "0 is shut",
    "Shade.Position": "0 is open",
    "Side.Position": "0 is foremost",
    "Height": "0 is lowest",
    "Recline": "0 is upright",
    "HeatingCooling": "below 0 ventilates",
    "Pan": "above 0 is to the left",
    "Tilt": "above 0 is up",
    "Balance": "above 0 is right",
    "Fader": "above 0 is front",
    "Volume": "0 is silent",
    "Intensity": "0 is off",
    "Driver.FanSpeed": "0 is off",
}
"""Which way a number counts, by the end of its path."""


@dataclass(frozen=True, slots=True)
class Argument:
    """What a function takes."""

    name: str
    schema: Json
    """Its JSON Schema: type, range, choices, description."""
    required: bool = True

    def is_blank(self, value: Any) -> bool:
        """Whether a value says nothing: null or, of an argument that may be left out, what stands for it."""
        return value is None or (not self.required and is_blank(value, self.schema.get("enum", ())))

    def read(self, function: str, value: Any) -> Any:
        """The value, converted where nothing is lost.

        Raises ActionError: a wrong type, or out of its range or choices."""
        converted = _CONVERTED[self.schema["type"]](value)
        if converted is None:
            wanted = self.schema["type"]
            raise ActionError(f"{function}: {self.name} is {shown(value)}; it must be {_ARTICLE[wanted]}")
        if "enum" in self.schema and converted not in self.schema["enum"]:
            found = {str(each).casefold(): each for each in self.schema["enum"]}.get(str(converted).casefold())
            if found is None:
                wrong = UnknownNameError(
                    f"{self.name} of {function}", str(converted), map(str, self.schema["enum"])
                )
                raise ActionError(str(wrong))
            converted = found
        low, high = self.schema.get("minimum"), self.schema.get("maximum")
        if (low is not None and converted < low) or (high is not None and converted > high):
            raise ActionError(f"{function}: {self.name} is {shown(converted)}; it goes from {low:g} to {high:g}")
        longest, step = self.schema.get("maxLength"), self.schema.get("multipleOf")
        if longest is not None and len(converted) > longest:
            raise ActionError(f"{function}: {self.name} has {len(converted)} characters; at most {longest} fit")
        if step is not None and converted % step:
            raise ActionError(f"{function}: {self.name} is {shown(converted)}; it goes in steps of {step:g}")
        return converted


@dataclass(frozen=True, slots=True)
class CarFunction:
    """A function of the car."""

    name: str
    about: str
    """What it does, for the agent."""
    parameters: tuple[Argument, ...]
    make: Callable[..., CallMade] = field(repr=False)
    """From the state and the arguments by name."""
    reads: bool = False
    """Whether it only tells something, so that its answer is what was asked for."""
    signals: tuple[str, ...] = ()
    """VSS paths that it commands; empty of a function of an app."""

    @property
    def schema(self) -> Json:
        """JSON Schema of its arguments."""
        return {
            "type": "object",
            "properties": {each.name: each.schema for each in self.parameters},
            "required": [each.name for each in self.parameters if each.required],
            "additionalProperties": False,
        }

    def read(self, arguments: Mapping[str, Any]) -> dict[str, Any]:
        """The arguments, checked against the schema and converted where nothing is lost.

        Raises ActionError: one is missing, unknown, of another type or out of its range."""
        known = {each.name: each for each in self.parameters}
        given = {
            str(name): value
            for name, value in arguments.items()
            if not (known[name].is_blank(value) if name in known else is_blank(value))
        }
        for name in given:
            if name not in known:
                raise ActionError(str(UnknownNameError(f"argument of {self.name}", name, known)))
        for each in self.parameters:
            if each.required and each.name not in given:
                raise ActionError(f"{self.name} lacks {each.name}; it takes {', '.join(known)}")
        return {name: known[name].read(self.name, value) for name, value in given.items()}


# --- from a typed factory ---------------------------------------------------------------------------------


def offered(make: Callable[..., CallMade]) -> CarFunction:
    """The function that a factory defines: its name, the first paragraph of its docstring, its typed arguments.

    The first argument is the state. Of ``Annotated`` ones, a string is the description, ``Ge``, ``Le`` and
    ``MultipleOf`` are bounds, ``OneOf`` and ``Literal`` list the choices."""
    return _from_factory(make, reads=False)


def reading(make: Callable[..., Feedback]) -> CarFunction:
    """The same for a factory that only tells something."""
    return _from_factory(make, reads=True)


def _from_factory(make: Callable[..., CallMade], *, reads: bool) -> CarFunction:
    hints = get_type_hints(make, include_extras=True)
    _, *given = inspect.signature(make).parameters.values()
    about = " ".join((inspect.getdoc(make) or "").partition("\n\n")[0].split())
    parameters = tuple(
        Argument(each.name, _schema(hints[each.name]), each.default is inspect.Parameter.empty) for each in given
    )
    return CarFunction(make.__name__, about, parameters, make, reads)


_TYPES: Mapping[Any, str] = {str: "string", bool: "boolean", int: "integer", float: "number"}
LONGEST_TEXT = 120
"""Characters of a text, as of every text of an action."""


def _schema(hint: Any) -> Json:
    kind, *marks = get_args(hint) if hasattr(hint, "__metadata__") else (hint,)
    if get_origin(kind) is Literal:
        schema: Json = {"type": "string", "enum": list(get_args(kind))}
    else:
        schema = {"type": _TYPES[kind]} | ({"maxLength": LONGEST_TEXT} if kind is str else {})
    for mark in marks:
        match mark:
            case str():
                schema["description"] = mark
            case OneOf(names=names):
                schema = {"type": _TYPES[kind], "enum": [kind(name) for name in names]}
            case Ge(ge=low):
                schema["minimum"] = low
            case Le(le=high):
                schema["maximum"] = high
            case MultipleOf(multiple_of=step):
                schema["multipleOf"] = step
    return schema


# --- from the actuators -----------------------------------------------------------------------------------


@cache
def of_signals() -> tuple[CarFunction, ...]:
    """A function for the switches of each group, one for its choices, and one for each of its numbers; those of one
    kind, such as the windows, are one function with ``which``."""
    return tuple(function for name, group in _groups() for function in _of_group(name, group))


@cache
def groups() -> Mapping[str, tuple[str, ...]]:
    """The paths of each group of the catalogue, by its name in lower case."""
    found = {
        name.lower(): tuple(_leaves(vars(group).values()))
        for name, group in vars(catalogue).items()
        if inspect.isclass(group) and group.__module__ == catalogue.__name__
    }
    return {name: paths for name, paths in found.items() if paths}


def _leaves(values: Iterable[Any]) -> Iterator[str]:
    """The paths of signals, and of those of a seat."""
    for value in values:
        if isinstance(value, Signal):
            yield value.path
        elif isinstance(value, catalogue.Seated):
            yield from (getattr(value, each.name).path for each in dataclass_fields(value))


def _groups() -> Iterator[tuple[str, Mapping[str, Signal[Any]]]]:
    """By its name in lower case, the actuators of each group of the catalogue, by theirs. A text is no switch."""
    for name, group in vars(catalogue).items():
        if inspect.isclass(group) and group.__module__ == catalogue.__name__:
            found = {
                constant.lower(): signal
                for constant, signal in vars(group).items()
                if isinstance(signal, Signal) and signal.kind is LeafKind.ACTUATOR and signal.default != ""
            }
            if found:
                yield name.lower(), found


def _of_group(group: str, every: Mapping[str, Signal[Any]]) -> Iterator[CarFunction]:
    switches = {name: signal for name, signal in every.items() if isinstance(signal.default, bool)}
    choices = {name: signal for name, signal in every.items() if signal.allowed}
    numbers = {name: signal for name, signal in every.items() if isinstance(signal.default, float)}
    if switches:
        yield _one("switch", group, "", "on", switches)
    if choices:
        yield _one("choose", group, "", "value", choices)
    for what, ones in _kinds(numbers):
        unit = next(iter(ones.values())).unit
        yield _one("set", group, what or unit.lower(), UNITS.get(unit, unit), ones)


def _kinds(numbers: Mapping[str, Signal[Any]]) -> Iterator[tuple[str, Mapping[str, Signal[Any]]]]:
    """Numbers of one kind: with the same last word and unit, as ``driver_window`` and ``rear_left_window``; of the
    others, those with the same unit and range. The kind's name comes with them, empty if it has no other than its
    unit."""
    left = dict(numbers)
    while left:
        name, signal = next(iter(left.items()))
        last = name.rpartition("_")[2]
        alike = {
            each: other
            for each, other in left.items()
            if each.rpartition("_")[2] == last and other.unit == signal.unit
        }
        if len(alike) > 1:
            yield last, {each.removesuffix(f"_{last}"): other for each, other in alike.items()}
        else:
            kind = (signal.unit, signal.minimum, signal.maximum, signal.step)
            words = [each.rpartition("_")[2] for each in numbers]
            alike = {
                each: other
                for each, other in left.items()
                if (other.unit, other.minimum, other.maximum, other.step) == kind
                and words.count(each.rpartition("_")[2]) == 1
            }
            yield ("" if len(alike) > 1 else name), alike
        for each in [each for each, other in left.items() if other in alike.values()]:
            del left[each]


def _one(verb: str, group: str, what: str, value: str, ones: Mapping[str, Signal[Any]]) -> CarFunction:
    """A function that commands one of some actuators; ``which`` says which, unless there is only one."""
    signals = tuple(ones.values())
    schema = _value_schema(ones)
    if len(ones) == 1:
        (only,) = ones
        name = f"{verb}_{group}_{what or only}"
        about = f"{_TOLD[verb]}: {only.replace('_', ' ')}. {_leaf(signals[0])}"
        return CarFunction(
            name, about, (Argument(value, schema),), partial(_set, ones, value), signals=_paths(ones)
        )
    title = (what or ("switches" if verb == "switch" else "settings")).replace("_", " ")
    about = f"{_TOLD[verb]}: {group} {title}. " + " ".join(
        f"{name}: {_leaf(signal)}" for name, signal in ones.items()
    )
    which = Argument("which", {"type": "string", "enum": list(ones), "description": "Which of them."})
    return CarFunction(
        f"{verb}_{group}" + (f"_{what}" if what else ""),
        about,
        (which, Argument(value, schema)),
        partial(_set, ones, value),
        signals=_paths(ones),
    )


_TOLD = {"switch": "Switch on or off", "choose": "Choose", "set": "Set"}


def _paths(ones: Mapping[str, Signal[Any]]) -> tuple[str, ...]:
    return tuple(signal.path for signal in ones.values())


def _leaf(signal: Signal[Any]) -> str:
    """Path, values and restriction of an actuator, in a sentence."""
    held = f", not while driving ({HELD[signal.path]})" if signal.path in HELD else ""
    values = "" if isinstance(signal.default, bool) else f", {signal.range}"
    return f"{signal.path}{values}{held}."


def _value_schema(ones: Mapping[str, Signal[Any]]) -> Json:
    """The values that any of the actuators can have; which has less is told in the description of the function."""
    signals = tuple(ones.values())
    first = signals[0]
    if isinstance(first.default, bool):
        return {"type": "boolean", "description": "Whether it is to be on."}
    if first.allowed:
        values = list(dict.fromkeys(each for one in signals for each in one.allowed))
        return {"type": "string", "enum": values, "description": "What it is to be; each has its own values."}
    ways = {name: way for name, one in ones.items() for end, way in DIRECTIONS.items() if one.path.endswith(end)}
    same = len(ways) == len(ones) and len({*ways.values()}) == 1
    told = [*dict.fromkeys(ways.values())] if same else [f"{name}: {way}" for name, way in ways.items()]
    return {
        "type": "number",
        "minimum": min(one.low for one in signals),
        "maximum": max(one.high for one in signals),
        "description": "; ".join([f"In {first.unit}", *told, f"the car's own steps are of {first.step:g}."]),
    }


def _set(ones: Mapping[str, Signal[Any]], name: str, state: State, **given: Any) -> CallMade:
    which = given.get("which") or next(iter(ones))
    signal, value = ones[which], given[name]
    if held := state.vehicle.held(signal):
        return Feedback(FeedbackCode.RESTRICTED, held)
    if isinstance(signal.default, float):
        value = float(value)
        if not signal.low <= value <= signal.high:
            return Feedback(
                FeedbackCode.REFUSED, say("{signal} goes from {range}", signal=signal.path, range=signal.range)
            )
    elif signal.allowed and value not in signal.allowed:
        return Feedback(FeedbackCode.REFUSED, say("{signal} is {range}", signal=signal.path, range=signal.range))
    return Set(signal, value)


# --- what factories share ---------------------------------------------------------------------------------


def locked(state: State, restriction: Restriction) -> Feedback | None:
    """The refusal of what is locked now, as on the screen; None if it is not."""
    why = state.locked(restriction)
    return Feedback(FeedbackCode.RESTRICTED, why) if why else None


def disabled(why: str) -> Feedback:
    """The refusal of what cannot be used now."""
    return Feedback(FeedbackCode.DISABLED, why)


def unknown(what: str, name: str, known: Iterable[str]) -> Feedback:
    """The refusal of a name that is not there, with the nearest one."""
    return _unknown(what, name, tuple(known))


@lru_cache(maxsize=256)
def _unknown(what: str, name: str, known: tuple[str, ...]) -> Feedback:
    return Feedback(FeedbackCode.NO_SUCH_ELEMENT, str(UnknownNameError(what, name, known)))


def named(name: str, known: Iterable[str]) -> str | None:
    """The name as it is spelled, whatever the case, or the only one that has all its words; None if there is none.

    As who speaks may leave out a surname or a street's kind, so may a call, where one thing alone can be meant."""
    names = list(dict.fromkeys(known))
    if name in names:
        return name
    wanted = name.casefold().split()
    whole = next((each for each in names if each.casefold().split() == wanted), None)
    if whole is not None or not wanted:
        return whole
    found = [each for each in names if set(wanted) <= set(_WORD.findall(each.casefold()))]
    return found[0] if len(found) == 1 else None


_WORD = re.compile(r"\w+")


CLOCK = "Time of day, as HH:MM."


def minute_of(time: str) -> int | Feedback:
    """Minute of the day of a time as HH:MM; a refusal of anything else."""
    hours, colon, minutes = time.strip().partition(":")
    if colon and hours.isdecimal() and minutes.isdecimal() and int(hours) < 24 and int(minutes) < 60:
        return 60 * int(hours) + int(minutes)
    return Feedback(
        FeedbackCode.REFUSED, say("“{time}” is not a time of day; give HH:MM, such as 07:30", time=time)
    )


def as_told(value: Any) -> Feedback:
    """A reading's answer: a text, or a value as JSON."""
    words = value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)
    return Feedback(FeedbackCode.OK, words or say("Nothing here"))


def _switch(value: Any) -> bool | None:
    if isinstance(value, str):
        return {"true": True, "false": False, "on": True, "off": False}.get(value.casefold())
    return value if isinstance(value, bool) else None


def _words(value: Any) -> str | None:
    if isinstance(value, bool):
        return None
    text = str(value) if isinstance(value, str | int | float) else None
    return None if text is None or any("\ud800" <= letter <= "\udfff" for letter in text) else text


_CONVERTED: Mapping[str, Callable[[Any], Any]] = {
    "integer": partial(whole_in, most=1e9),
    "number": partial(number_in, most=1e9),
    "boolean": _switch,
    "string": _words,
}
_ARTICLE = {"integer": "a whole number", "number": "a number", "boolean": "true or false", "string": "text"}
