"""The two small languages in which tasks say what is done and what must hold.

Moves, separated by semicolons, are public actions:

    open climate; tap hvac.fan.max x2; tap "Home"; tap hvac.degrees.increase until hvac.degrees reads "21.5 °C"
    slide window.rear_left to {percent}; slide sound.treble to 0 of -10 to 10; type "{street}" into map.search enter
    warn speed; warn speed critical; warn speed 50 km/h; ask "Left or right?"; answer "It is shut."
    hear "the other one"; wait 25; request_reroute destination "Main road 1"
    first 2; tap seat.store.1; last 1         of a way or a slip: the beginning and the end of the solution

Conditions are joined by ``and``, ``or``, ``not`` and brackets:

    HVAC.FAN_SPEED = 50 | 100 and navigation.destination = "{place}"      a signal, or an entry of the apps' data
    CABIN.SUNROOF_SHADE in 90 to 100                                      of goals alone
    GLASS.WINDSHIELD_FOG > 0.3 and driving and not in_tunnel              of triggers alone
    alert_given(speed, 50) and entered(messages.sent, {to: "Bea", text: "Yes"})

Every other condition is the name of its function, in ``triggers`` or, of goals, in ``checks``, ``history`` or
``effects``, with its values in brackets, in order or by name.
``{name}`` stands for a drawn value, ``{name.column}`` for what it means (``reading``); texts are in double quotes.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, dataclass, fields
from functools import cache
from typing import Any, get_type_hints

from automotive_cosim.cockpit import signals
from automotive_cosim.cockpit.signals import Signal
from automotive_cosim.contracts import Action, ActionType, PullOver, Reroute, SlowDown
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.tasking import checks, effects, history, triggers
from automotive_cosim.tasking.checks import AllOf, AnyOf, AppDataIs, Check, SignalIs, SignalWithin
from automotive_cosim.tasking.moves import (
    Consult,
    Do,
    Hear,
    Inform,
    Move,
    Open,
    Slide,
    Tap,
    TapUntil,
    TypeText,
    Warn,
)
from automotive_cosim.tasking.named import ROWS
from automotive_cosim.tasking.parameters import Param
from automotive_cosim.tasking.triggers import All, Not, Situation, signal_above, signal_below, signal_has

LONGEST_WAIT_S = 10
"""The longest wait of one action; longer ones are several."""
MOST_MOVES = 1000
"""Of one way, waits counted as the actions that they are."""


@dataclass(frozen=True, slots=True)
class Placeholder:
    """``{name}`` or ``{name.column}``, where a value is expected."""

    name: str
    column: str = ""


class Word(str):
    """A name without quotes: of a key, a signal, a kind."""

    __slots__ = ()


class Quoted(str):
    """A text in quotes, which is no name."""

    __slots__ = ()


Decode = Callable[[Any, Any], Any]
"""Turns what is written into a value of a type."""

PLACEHOLDER = re.compile(r"\{([a-z_]\w*)(?:\.(\w+))?\}")
_TOKEN = re.compile(
    r"""\s*(?:"(?P<text>(?:[^"\\]|\\.)*)"
    |(?P<number>-?\d+(?:\.\d+)?(?:e-?\d+)?)(?![\w.])
    |(?P<held>\{[a-z_]\w*(?:\.\w+)?\})(?![\w.])
    |(?P<word>(?:[^\W\d]|\{[\w.]+\}(?=[\w.]))(?:[\w.]|\{[^{}\s]*\})*)
    |(?P<sign>[()\[\]{},;:=|<>]))""",
    re.VERBOSE,
)
_CASE = re.compile(r"(?<=[a-z])(?=[A-Z])")


@cache
def signals_by_name() -> Mapping[str, Signal[Any]]:
    """Every signal by its path and by its short name, such as ``HVAC.FAN_SPEED``."""
    short = {
        f"{group}.{name}": signal
        for group, held in vars(signals).items()
        if inspect.isclass(held) and group.isupper()
        for name, signal in vars(held).items()
        if isinstance(signal, Signal)
    }
    return signals.CATALOGUE | short


def signal_named(name: str) -> Signal[Any]:
    """The signal of a path or a short name. Raises UnknownNameError: there is none."""
    known = signals_by_name()
    if name not in known:
        raise UnknownNameError("signal", name, known, "automotive-cosim show signals")
    return known[name]


def checked(signal: Any, value: Any) -> Any:
    """A value as the signal has it; placeholders are taken as they are. Raises SignalError: it cannot have it."""
    if not isinstance(signal, Signal) or isinstance(value, Param) or (isinstance(value, str) and "{" in value):
        return value
    return signal.check(str(value) if isinstance(value, str) else value)


class _Reader:
    """What is written, token by token: ``kind`` and ``text`` of the present one."""

    def __init__(self, written: str, decode: Decode) -> None:
        self._tokens = _lexed(written)
        self._at = 0
        self.decode = decode
        self.kind, self.text = self._tokens[0]

    @property
    def done(self) -> bool:
        return self.kind == "end"

    def next_is_equal(self) -> bool:
        """Whether the token after the present one is an equal sign."""
        return not self.done and self._tokens[self._at + 1] == ("sign", "=")

    def next(self, *kinds: str) -> str:
        """The text of the present token, which is then read. Raises UserError: it is of no such kind."""
        if self.done or self.kind not in kinds:
            wanted = " or ".join(KINDS[kind] for kind in kinds)
            raise UserError(f"expected {wanted}, found {'the end' if self.done else repr(self.text)}")
        text = self.text
        self._at += 1
        self.kind, self.text = self._tokens[self._at]
        return text

    def takes(self, text: str, kind: str = "word") -> bool:
        """Whether the present token is that one, which is then read."""
        if self.text != text or self.kind != kind:
            return False
        self._at += 1
        self.kind, self.text = self._tokens[self._at]
        return True

    def needs(self, text: str, kind: str = "word") -> None:
        """Reads that token. Raises UserError: it is another."""
        if not self.takes(text, kind):
            raise UserError(f"expected {text!r}, found {'the end' if self.done else repr(self.text)}")

    def a(self, hint: Any) -> Any:
        """A value of a type."""
        return self.decode(self.value(), hint)

    def value(self) -> Any:
        """A value as it is written."""
        kind, text = self.kind, self.next(*KINDS)
        match kind, text:
            case "text", _:
                return Quoted(text)
            case "number", _:
                return float(text) if re.search("[.e]", text) else int(text)
            case "held", _:
                return _placeholder(text)
            case "word", _:
                return {"true": True, "false": False, "none": None}.get(text, Word(text))
            case "sign", "[":
                return self._list("]", self.value)
            case "sign", "{":
                return dict(self._list("}", self._pair))
        raise UserError(f"expected a value, found {text!r}")

    def _pair(self) -> tuple[str, Any]:
        name = self.next("word", "text")
        self.needs(":", "sign")
        return name, self.value()

    def _list(self, end: str, read: Callable[[], Any]) -> list[Any]:
        found = list[Any]()
        while not self.takes(end, "sign"):
            if found:
                self.needs(",", "sign")
            found.append(read())
        return found


KINDS = {
    "text": "a text in double quotes",
    "number": "a number",
    "held": "a placeholder",
    "word": "a name",
    "sign": "a sign",
}


def _lexed(written: str) -> list[tuple[str, str]]:
    """Kind and text of every token, and the end."""
    if not isinstance(written, str):
        raise UserError(f"is {written!r}; it must be a text")
    text = " ".join(filter(None, map(str.strip, written.split("\n"))))
    tokens, at, end, match = list[tuple[str, str]](), 0, len(text), _TOKEN.match
    while at < end:
        found = match(text, at)
        if found is None:
            raise UserError(f"{text[at:].strip()[:40]!r} is neither a name, a number, a quoted text nor a sign")
        kind = str(found.lastgroup)
        told = found[kind]
        tokens.append((kind, re.sub(r"\\(.)", r"\1", told) if kind == "text" and "\\" in told else told))
        at = found.end()
    tokens.append(("end", ""))
    return tokens


def _placeholder(text: str) -> Placeholder:
    return Placeholder(*text[1:-1].split("."))


# --- moves ----------------------------------------------------------------------------------------------------


def moves(text: str, decode: Decode, solution: Sequence[Move] = ()) -> tuple[Move, ...]:
    """Moves as they are written.

    Args:
        decode: turns a written value into one of a type.
        solution: what ``first`` and ``last`` are of.

    Raises UserError: an unknown verb, or something is wrong behind it."""
    reader, found = _Reader(text, decode), list[Move]()
    while not reader.done:
        verb = reader.next("word")
        read = _VERBS.get(verb)
        if read is not None:
            found += read(reader)
        elif verb in ("first", "last"):
            count = int(reader.next("number"))
            if not 0 <= count <= len(solution):
                raise UserError(f"{verb} {count}: the solution has {len(solution)} moves")
            found += solution[:count] if verb == "first" else solution[len(solution) - count :]
        elif verb in _ACTIONS:
            found.append(_action(reader, verb))
        else:
            raise UnknownNameError("move", verb, (*_VERBS, *_ACTIONS, "first", "last"))
        if len(found) > MOST_MOVES:
            raise UserError(f"has more than {MOST_MOVES:,} moves")
        if not reader.done:
            reader.needs(";", "sign")
    return tuple(found)


def _open(reader: _Reader) -> tuple[Move, ...]:
    return (Open(reader.next("word", "text")),)


def _tap(reader: _Reader) -> tuple[Move, ...]:
    if reader.takes("text") or reader.kind == "text":
        return (Tap(text=reader.a(str)),)
    key = reader.a(str)
    if reader.takes("until"):
        shown = reader.a(str)
        reader.needs("reads")
        text = reader.a(str)
        return (TapUntil(key, shown, text, *((reader.a(int),) if reader.takes("at_most") else ())),)
    if reader.kind == "word" and _TIMES.fullmatch(reader.text):
        return (Tap(key, int(reader.next("word")[1:])),)
    return (Tap(key, reader.a(int) if reader.takes("x") else 1),)


_TIMES = re.compile(r"x\d+")


def _slide(reader: _Reader) -> tuple[Move, ...]:
    key = reader.a(str)
    reader.needs("to")
    value = reader.a(float)
    if not reader.takes("of"):
        return (Slide(key, value),)
    low = reader.a(float)
    reader.needs("to")
    return (Slide(key, value, low, reader.a(float)),)


def _type(reader: _Reader) -> tuple[Move, ...]:
    text = reader.a(str)
    reader.needs("into")
    return (TypeText(reader.next("word"), text, reader.takes("enter")),)


def _warn(reader: _Reader) -> tuple[Move, ...]:
    known = hints(Warn)
    given = {"kind": reader.a(known["kind"])}
    if reader.kind == "word":
        given["severity"] = reader.a(known["severity"])
    if reader.kind in ("number", "held"):
        given["speed_kmh"] = reader.a(float)
    return (Warn(**given),)


def _said(kind: type[Any]) -> Callable[[_Reader], tuple[Move, ...]]:
    return lambda reader: (kind(reader.a(str)),)


def _wait(reader: _Reader) -> tuple[Move, ...]:
    seconds = int(reader.next("number"))
    if not 0 < seconds <= MOST_MOVES * LONGEST_WAIT_S:
        raise UserError(f"wait {seconds}: from 1 to {MOST_MOVES * LONGEST_WAIT_S:,} s")
    return tuple(
        Do(Action(ActionType.WAIT, seconds=min(LONGEST_WAIT_S, seconds - past)))
        for past in range(0, seconds, LONGEST_WAIT_S)
    )


def _action(reader: _Reader, verb: str) -> Move:
    known, given = hints(Action), dict[str, Any]()
    while reader.kind == "word":
        name = reader.next("word")
        if name not in known:
            raise UnknownNameError(f"field of {verb}", name, known)
        given[name] = reader.a(known[name])
    return Do(Action(_ACTIONS[verb], **given))


_VERBS: Mapping[str, Any] = {
    "open": _open,
    "tap": _tap,
    "slide": _slide,
    "type": _type,
    "warn": _warn,
    "ask": _said(Consult),
    "answer": _said(Inform),
    "hear": _said(Hear),
    "wait": _wait,
}
_ACTIONS = {str(kind): kind for kind in ActionType}


# --- conditions -----------------------------------------------------------------------------------------------


def goal(text: str, decode: Decode) -> Any:
    """A check as it is written. Raises UserError: an unknown condition, signal or field, or something is wrong."""
    return _whole(_Goals(text, decode))


def condition(text: str, decode: Decode) -> Any:
    """A condition of a trigger as it is written. Raises UserError: as in ``goal``."""
    return _whole(_Conditions(text, decode))


def values_of_signals(text: str, decode: Decode) -> dict[str, Any]:
    """What signals have, by their paths: ``HVAC.FAN_SPEED = 100 and HVAC.AUTO = true``.

    Raises UserError: as in ``goal``."""
    reader, found = _Reader(text, decode), dict[str, Any]()
    while not reader.done:
        if found:
            reader.needs("and")
        signal = signal_named(reader.next("word"))
        reader.needs("=", "sign")
        found[signal.path] = of_signal(signal, reader.value(), decode)
    return found


def of_signal(signal: Any, value: Any, decode: Decode) -> Any:
    """A value of a signal; of several that are drawn from, what fits one fits all."""
    sample = signal if isinstance(signal, Signal) else next(iter(signal.means.values()))
    if isinstance(value, Placeholder):
        return decode(value, sample)
    return checked(sample, str(value) if isinstance(value, str) else value)


def _whole(reader: _Goals) -> Any:
    found = reader.either()
    if not reader.done:
        raise UserError(f"expected 'and' or 'or', found {reader.text!r}")
    return found


class _Goals(_Reader):
    """Reads goals."""

    every: type[Any] = AllOf
    some: type[Any] | None = AnyOf
    denied: type[Any] | None = None

    def either(self) -> Any:
        """Parts joined by ``or``."""
        return self._joined("or", self.some, lambda: self._joined("and", self.every, self._part))

    def _joined(self, word: str, kind: type[Any] | None, read: Callable[[], Any]) -> Any:
        parts = [read()]
        while self.takes(word):
            if kind is None:
                raise UserError(f"{word!r} has no meaning here")
            parts.append(read())
        return parts[0] if len(parts) == 1 or kind is None else kind(tuple(parts))

    def _part(self) -> Any:
        if self.takes("(", "sign"):
            inner = self.either()
            self.needs(")", "sign")
            return inner
        if self.takes("not"):
            if self.denied is None:
                raise UserError("'not' has no meaning here: a goal says what holds")
            return self.denied(self._part())
        kind, name = self.kind, self.next("word", "held")
        if self.takes("in"):
            low = self.a(float)
            self.needs("to")
            return SignalWithin(self._subject(kind, name), low, self.a(float))
        if self.kind == "sign" and self.text in "=<>":
            sign = self.next("sign")
            return self._compared(self._subject(kind, name), sign)
        kinds = conditions_by_name(of_trigger=isinstance(self, _Conditions))
        if name not in kinds:
            raise UnknownNameError("condition", name, kinds)
        return self._made(kinds[name])

    def _subject(self, kind: str, name: str) -> Any:
        """What is compared: a signal, a key of the apps' data, or a placeholder of a signal."""
        if kind == "held":
            return self.decode(_placeholder(name), Signal)
        return signal_named(name) if name[0].isupper() else name

    def _compared(self, subject: Any, sign: str) -> Any:
        if sign != "=":
            raise UserError(f"{sign!r} has no meaning in a goal; write 'in LOW to HIGH'")
        values = [self.value()]
        while self.takes("|", "sign"):
            values.append(self.value())
        if isinstance(subject, str):
            return AppDataIs(subject, tuple(self.decode(value, Any) for value in values))
        return SignalIs(subject, tuple(of_signal(subject, value, self.decode) for value in values))

    def _made(self, kind: Callable[..., Any]) -> Any:
        """A condition with its fields in brackets."""
        known, given = hints(kind), dict[str, Any]()
        if self.takes("(", "sign"):
            names = list(known)
            while not self.takes(")", "sign"):
                if given:
                    self.needs(",", "sign")
                if self.text in known and self.next_is_equal():
                    name = self.next("word")
                    self.needs("=", "sign")
                elif len(given) < len(names):
                    name = names[len(given)]
                else:
                    raise UserError(f"{named_as(kind)} has {len(names)} fields: {', '.join(names)}")
                given[name] = self._field(known[name])
        lacking = [each for each in needed(kind) if each not in given]
        if lacking:
            raise UserError(f"{named_as(kind)} lacks {', '.join(lacking)}")
        return kind(**given)

    def _field(self, hint: Any) -> Any:
        if hint is Check:
            return self.either()
        if self.kind == "word" and self.text in REQUESTS:
            kind = REQUESTS[self.next("word")]
            return self._made(kind) if (self.kind, self.text) == ("sign", "(") else kind
        return self.a(hint)


REQUESTS = {"reroute": Reroute, "pull_over": PullOver, "slow_down": SlowDown}
"""Requests to the road, of ``road_asked``."""


class _Conditions(_Goals):
    """Reads conditions of triggers."""

    every = All
    some = None
    denied = Not

    def _compared(self, subject: Any, sign: str) -> Any:
        kinds: Mapping[str, Callable[..., Situation]] = {"=": signal_has, ">": signal_above, "<": signal_below}
        if sign not in kinds or isinstance(subject, str):
            raise UserError(f"only a signal is compared here, by =, < or >; found {subject} {sign}")
        return kinds[sign](subject, of_signal(subject, self.value(), self.decode))


SIGNS = ("signal_has", "signal_above", "signal_below")
"""Conditions that are written as =, > and <."""


@cache
def conditions_by_name(*, of_trigger: bool) -> Mapping[str, Callable[..., Any]]:
    """What makes each condition, by its name, without those that have a sign or a word."""
    modules = {each.__name__ for each in ((triggers,) if of_trigger else (checks, effects, history))}
    classes = () if of_trigger else checks.CLASSES
    return {
        name: row.made for name, row in ROWS.items() if row.holds.__module__ in modules and name not in SIGNS
    } | {named_as(each): each for each in classes}


def named_as(kind: Callable[..., Any]) -> str:
    """The name of a class or function in small letters."""
    return _CASE.sub("_", kind.__name__).lower()


def hints(kind: Any) -> Mapping[str, Any]:
    """The types of a class's fields or of a condition's values, by name, in order."""
    return _hints(kind)


@cache
def _hints(kind: Any) -> Mapping[str, Any]:
    every = get_type_hints(kind, include_extras=True)
    row = ROWS.get(kind.__name__)
    names = [each.name for each in fields(kind)] if row is None else row.values
    return {name: every[name] for name in names}


def needed(kind: Any) -> tuple[str, ...]:
    """Those of them that have no default."""
    if kind.__name__ in ROWS:
        return ROWS[kind.__name__].needed
    return tuple(each.name for each in fields(kind) if each.default is MISSING and each.default_factory is MISSING)
