"""Decoders of values by type: what a cell of a task's table means where a field of that type is expected.

``decoder`` makes one for a type, from the type alone: numbers with limits, members of enumerations, classes as
tables or lists of their fields, signals and conditions in their written languages (``notation``). What a name, a
placeholder or a topic stands for is known to the ``Meanings``, the reader of the task's table.
"""

from __future__ import annotations

import inspect
import operator
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import is_dataclass
from datetime import date, time
from enum import Enum
from functools import cache
from itertools import chain, pairwise
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Protocol, TypeAlias, Union, get_args, get_origin

from automotive_cosim.cockpit.cabin import CabinStart
from automotive_cosim.cockpit.signals import Signal
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.tasking import notation
from automotive_cosim.tasking.checks import Check
from automotive_cosim.tasking.notation import PLACEHOLDER, Placeholder, Quoted, Word, checked, hints, signal_named
from automotive_cosim.tasking.parameters import Param
from automotive_cosim.tasking.task import Start
from automotive_cosim.tasking.triggers import TriggerCondition

COMPANY = "company"
"""Written for ``aboard``: one to four adults, the driver among them, drawn as the parameter ``occupants``."""


class Meanings(Protocol):
    """What a decoder asks of whoever reads the table."""

    below: list[str]
    """Where within the value something was refused, outermost first."""

    def decode(self, value: Any, hint: Any) -> Any:
        """A value of a type, from what is written."""
        ...

    def named(self, value: Any) -> Any:
        """What a name stands for; anything else is itself."""
        ...

    def table(self, value: Any, base: Mapping[str, Any]) -> dict[str, Any]:
        """A table with what it is like, over what it adds to."""
        ...

    def parameter(self, name: str, column: str, hint: Any) -> Param:
        """A placeholder, with what its values mean here."""
        ...

    def text(self, told: str, name: str) -> Param:
        """A text with what a drawn value means in it."""
        ...

    def topic(self, name: str) -> Any:
        """One of the topics of the half."""
        ...

    def company(self) -> Param:
        """One to four adults, drawn."""
        ...


Decoder: TypeAlias = Callable[[Meanings, Any], Any]
_TEXTS = (str, Quoted, Word)
WITH_COLUMN = re.compile(r"\{([a-z_]\w*)\.(\w+)\}")


def several(told: Any) -> tuple[str, ...]:
    """Several texts, as a list or parted by ``SEPARATOR`` in one that may go on over lines."""
    return tuple(joined(told).split(SEPARATOR) if isinstance(told, str) else map(str, entries(told)))


SEPARATOR = " / "


def joined(told: str) -> str:
    """A text without ends of lines: a space for each, but between Japanese characters none."""
    if "\n" not in told:
        return told
    lines = [*filter(None, map(str.strip, told.split("\n")))]
    ends = ("" if one[-1] > _WIDE and other[0] > _WIDE else " " for one, other in pairwise(lines))
    return "".join(chain.from_iterable(zip(lines, chain(ends, ("",)), strict=False)))


_WIDE = "\u3000"
"""The first of the characters that are written without spaces."""


@cache
def decoder(hint: Any) -> Decoder:
    """What reads values of a type; placeholders everywhere, names where no text is expected."""
    read = hint if inspect.isfunction(hint) else _reads(hint)
    is_text = hint is str or (get_origin(hint) is Annotated and get_args(hint)[0] is str)

    def decode(source: Meanings, value: Any) -> Any:
        kind = type(value)
        if kind is hint and kind is not str:
            return value
        if kind in _TEXTS and "{" in value:
            found = PLACEHOLDER.fullmatch(value) if kind is str else None
            if found is not None and (found[2] or not is_text):
                return source.parameter(found[1], found[2] or "", hint)
            if (is_text or hint is Any) and (found := WITH_COLUMN.search(value)) is not None:
                return source.text(value, found[1])
        elif kind is Placeholder:
            return source.parameter(value.name, value.column, hint)
        elif kind is dict and value.keys() == {"param"}:
            return source.parameter(value["param"], "", hint)
        return read(source, value)

    return decode


def _reads(hint: Any) -> Decoder:
    origin, inner = get_origin(hint), get_args(hint)
    if origin is Annotated:
        return _limited(inner[0], inner[1:])
    if isinstance(hint, Signal):
        return lambda source, value: checked(hint, value)
    if hint is Signal or origin is Signal:
        return lambda source, value: signal_named(value)
    if hint is Check:
        return lambda source, value: notation.goal(value, source.decode)
    if hint is TriggerCondition:
        return lambda source, value: notation.condition(value, source.decode)
    if origin in (Union, UnionType):
        return _either([each for each in inner if each is not NoneType], NoneType in inner)
    if origin is Literal:
        return _one_of(inner)
    if origin is tuple:
        return _listed(inner)
    if origin is frozenset:
        item = decoder(inner[0])
        return lambda source, value: frozenset(item(source, each) for each in entries(source.named(value)))
    if hint is Any:
        return lambda source, value: _plain(source, value)
    if isinstance(hint, type) and issubclass(hint, Enum):
        return _member(hint)
    if isinstance(hint, type) and is_dataclass(hint):
        return _class(hint)
    if origin is not None and issubclass(origin, Mapping):
        item = decoder(inner[1])
        return lambda source, value: {
            name: item(source, each) for name, each in mapping(source.named(value), pairs=True).items()
        }
    return _scalar(hint)


def _scalar(kind: type[Any]) -> Decoder:
    def read(source: Meanings, value: Any) -> Any:
        if type(value) is kind:
            return joined(value) if kind is str else value
        if kind is float and type(value) is int:
            return float(value)
        if kind is str and isinstance(value, str):
            return joined(str(value))
        if kind is str and isinstance(value, date | time):
            return value.isoformat()
        raise UserError(f"is {value!r}; it must be {_WORDS.get(kind, kind.__name__)}")

    return read


_WORDS = {str: "a text", float: "a number", int: "a whole number", bool: "true or false"}


def _limited(kind: Any, limits: Sequence[Any]) -> Decoder:
    """Of a type with limits (``annotated_types``), or with the signals for names."""
    read = decoder(kind)
    if any(getattr(each, "what", "") == "signal" for each in limits):
        return lambda source, value: _key(value)

    def decode(source: Meanings, value: Any) -> Any:
        found = read(source, value)
        for each in limits:
            for name, (told, holds) in _LIMITS.items():
                bound = getattr(each, name, None)
                if bound is not None and not isinstance(found, Param) and not holds(found, bound):
                    raise UserError(f"is {value!r}; it must be {told} {bound:g}")
        return found

    return decode


_LIMITS: Mapping[str, tuple[str, Callable[[Any, Any], bool]]] = {
    "gt": ("above", operator.gt),
    "ge": ("at least", operator.ge),
    "lt": ("below", operator.lt),
    "le": ("at most", operator.le),
}


def _either(kinds: Sequence[Any], may_lack: bool) -> Decoder:
    readers = [decoder(kind) for kind in kinds]

    def read(source: Meanings, value: Any) -> Any:
        if may_lack and (value is None or value == "none"):
            return None
        for number, each in enumerate(readers, 1):
            try:
                return each(source, value)
            except (UserError, TypeError):
                if number == len(readers):
                    raise
                source.below.clear()
        return None

    return read if len(readers) > 1 or may_lack else readers[0]


def _one_of(values: Sequence[Any]) -> Decoder:
    def read(source: Meanings, value: Any) -> Any:
        if value not in values:
            raise UnknownNameError("value", str(value), map(str, values))
        return str(value) if isinstance(value, str) else value

    return read


def _member(kind: type[Enum]) -> Decoder:
    members = {str(member.value): member for member in kind}

    def read(source: Meanings, value: Any) -> Any:
        if value not in members:
            raise UnknownNameError(kind.__name__.lower(), str(value), members)
        return members[value]

    return read


def _listed(inner: Sequence[Any]) -> Decoder:
    if len(inner) != 2 or inner[1] is not Ellipsis:
        items = [decoder(each) for each in inner]

        def read(source: Meanings, value: Any) -> Any:
            found = entries(value)
            if len(found) != len(items):
                raise UserError(f"has {len(found)} entries; it must have {len(items)}")
            return tuple(item(source, each) for item, each in zip(items, found, strict=True))

        return read
    item = decoder(inner[0])
    return lambda source, value: tuple([item(source, each) for each in entries(source.named(value))])


def entries(value: Any) -> Sequence[Any]:
    """Those of a list."""
    if not isinstance(value, list | tuple):
        raise UserError(f"is {value!r}; it must be a list")
    return value


def mapping(value: Any, *, pairs: bool = False) -> Mapping[str, Any]:
    """A table, or with ``pairs`` a list of names with their values, which may go on over lines."""
    if pairs and isinstance(value, list):
        return dict(value)
    if not isinstance(value, Mapping):
        raise UserError(f"is {value!r}; it must be a table")
    return value


def _plain(source: Meanings, value: Any) -> Any:
    """A value of no particular type."""
    if isinstance(value, Quoted | Word):
        return str(value)
    if isinstance(value, list):
        return [source.decode(each, Any) for each in value]
    if isinstance(value, dict):
        return {name: source.decode(each, Any) for name, each in value.items()}
    return value


def _class(kind: type[Any]) -> Decoder:
    decoders: Mapping[str, Decoder] = {
        name: _SPECIAL.get((kind.__name__, name)) or decoder(hint) for name, hint in hints(kind).items()
    }
    needed = notation.needed(kind)

    def read(source: Meanings, value: Any) -> Any:
        value = value if kind.__name__ == "Topic" and isinstance(value, Quoted) else source.named(value)
        if isinstance(value, Quoted):
            return source.topic(value)
        if isinstance(value, list):
            if len(value) > len(decoders):
                raise UserError(f"has {len(value)} entries; {kind.__name__} has {', '.join(decoders)}")
            value = dict(zip(decoders, value, strict=False))
        given = source.table(value, {})
        for name in given:
            if name not in decoders:
                raise UnknownNameError(f"field of {kind.__name__}", name, decoders)
        for name in needed:
            if name not in given:
                raise UserError(f"lacks {name!r}: {kind.__name__} has {', '.join(decoders)}")
        made, name = {}, ""
        try:
            for name, each in given.items():
                made[name] = decoders[name](source, each)
        except UserError:
            source.below.insert(0, name)
            raise
        return kind(**made)

    return read


# --- fields that are more than their type says ----------------------------------------------------------------


def _key(value: Any) -> str:
    """A key of ``Moment.commands``: a signal's name stands for its path."""
    if isinstance(value, str) and value[:1].isupper():
        return signal_named(value).path
    return str(value)


def keys(source: Meanings, value: Any) -> frozenset[str]:
    """Keys of ``Moment.commands``, from a list of them or its name."""
    return frozenset(map(_key, entries(source.named(value))))


def _by_path(source: Meanings, value: Any) -> Any:
    """Values of signals: ``HVAC.FAN_SPEED = 100 and HVAC.AUTO = true``."""
    return notation.values_of_signals(value if "=" in value or not value else source.named(value), source.decode)


def _cabin(source: Meanings, value: Any) -> Any:
    known, made = hints(CabinStart), {}
    for name, each in mapping(source.named(value)).items():
        if name not in known:
            raise UnknownNameError("initial condition of the cabin", name, known)
        made[name] = source.decode(each, known[name])
    return made


def _aboard(source: Meanings, value: Any) -> Any:
    return source.company() if value == COMPANY else decoder(hints(Start)["aboard"])(source, value)


_SPECIAL: dict[tuple[str, str], Decoder] = {
    ("Start", "signals"): lambda source, value: _mapped(source, value, _by_path),
    ("Start", "sensors"): lambda source, value: _mapped(source, value, _by_path),
    ("Start", "cabin"): _cabin,
    ("Start", "aboard"): _aboard,
    ("Says", "changed"): keys,
    ("Says", "unchanged"): keys,
}


def _mapped(source: Meanings, value: Any, read: Decoder) -> Any:
    """Signals that are drawn as a whole, or one by one."""
    if isinstance(value, str) and (found := PLACEHOLDER.fullmatch(value)):
        return source.parameter(found[1], found[2] or "", read)
    return read(source, value)
