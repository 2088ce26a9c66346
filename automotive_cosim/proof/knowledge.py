"""What can be known when it is used: whether anything observed tells what was drawn, before an act depends on it.

A situation tells a drawn value wherever its texts, settings and remarks have it: in the driver's words, a
message, a memo, an appointment, a signal that a screen shows. Each is looked for in what the reference solution has
seen and heard so far, and rules out the other values that could have been drawn, unless they would read the same
there. Where a value that is left would ask for another act, the act is a guess.

A text that is seen with another value in the same place tells nothing: a menu has "Zone B" and "Zone C".
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from functools import lru_cache
from typing import Any

from automotive_cosim.cockpit.apps.climate import SEAT_LEVELS
from automotive_cosim.cockpit.apps.phone.person import PHOTO
from automotive_cosim.cockpit.occupants import Seat, seated_by, told
from automotive_cosim.cockpit.photos import Photo
from automotive_cosim.contracts.ids import key_of, resource_id
from automotive_cosim.interface.trace import Step
from automotive_cosim.tasking.dialogue import Topic, topic_of
from automotive_cosim.tasking.moves import Consult, Move, TypeText
from automotive_cosim.tasking.parameters import Param, Parameter, bind
from automotive_cosim.tasking.task import Half, Start

SCALES = (1.0, 1e-3, 100.0, 60.0, 1 / 60.0, 1 / 3600.0)
"""Between a signal's unit and the one that a screen shows it in."""
TWELVE_HOURS = re.compile(r"\b(1[0-2]|[1-9])(?::([0-5]\d))?\s*([ap])\.?m\b\.?")
NUMBER = re.compile(r"-?\d+(?:[.,]\d+)?")
WORDS = "zero one two three four five six seven eight nine ten eleven twelve"
FIGURES = {word: str(figure) for figure, word in enumerate(WORDS.split())}


@dataclass(frozen=True, slots=True)
class DrawnValues:
    """The parameters of an instance."""

    parameters: Mapping[str, Parameter]
    choices: Mapping[str, tuple[Parameter, ...]]
    """What each could have been."""

    def others(self, name: str) -> Iterator[tuple[Parameter, Mapping[str, Parameter]]]:
        """Each other value of a parameter, with the parameters as they would be then."""
        for value in self.choices[name]:
            if value != self.parameters[name]:
                yield value, {**self.parameters, name: value}


@dataclass(frozen=True, slots=True)
class _Setting:
    """A signal's value before departure."""

    value: Any


@dataclass(frozen=True, slots=True)
class _Entry:
    """What a mapping has for a name that was drawn, to be seen together."""

    name: Any
    value: Any


@dataclass(frozen=True, slots=True)
class _Pictured:
    """What a photo shows."""

    value: Any


class _Evidence:
    """What has been observed so far."""

    def __init__(self) -> None:
        self._lines: dict[str, None] = {}
        self._screens: dict[str, None] = {}
        self._settings: dict[str, None] = {}
        self._numbers: set[str] = set()
        self._words: set[str] = set()
        self._has_photo = False

    def add(self, text: str) -> None:
        """Takes in a text line by line."""
        for line in text.splitlines():
            if (said := normal(line)) not in self._lines:
                self._lines[said] = None
                self._numbers.update(NUMBER.findall(said))
                self._words.add(words(line))

    def look(self, step: Step) -> None:
        """Takes in a step: its screen, who is aboard, the feedback, what the driver said and the context."""
        for element in step.elements:
            if not element.is_visible:
                continue
            self._has_photo |= element.resource_id == resource_id(PHOTO)
            for text in filter(None, (element.text, element.content_description, element.hint_text)):
                self.add(text)
                is_set = element.is_selected or element.is_checked
                self._settings[normal(f"{key_of(element.resource_id)} {text}{' (set)' if is_set else ''}")] = None
        self._screens["\n".join(normal(element.text) for element in step.elements if element.is_visible)] = None
        self._lines[normal(told(seated_by(step.moment.signals)))] = None  # their kilograms tell no other number
        for text in (step.feedback.text, *step.said, step.moment.context.text()):
            self.add(text)

    def names(self, text: str) -> bool:
        """Whether these words have been seen in a row, whatever stands between them."""
        wanted = words(text)
        return any(wanted in seen for seen in self._words)

    def tells(self, said: Any, instead: Any) -> bool:
        """Whether it has been seen that something is so, and not otherwise.

        A text that is seen with the other value in its place as well is no sign: it is one of a menu."""
        match said, instead:
            case (bool() | None | _Setting(bool()), _) | (_, None):
                return True  # a switch: on the screen of what it switches, as is that there is none
            case _Pictured(), _:
                return self._has_photo
            case _Entry(), _Entry():
                return self._together(said) and not self._together(instead)
            case _Setting(int() | float() as level), _Setting():
                known = any(self._has(self._settings, word, "") for word in _as_words(level))
                return known or self._counts(level)
            case _Setting(), _Setting():
                return self._has(self._settings, str(said.value), str(instead.value))
            case ((int() | float()), _):
                return self._counts(said)
            case _:
                return self._has(self._lines, str(said), str(instead))

    def _together(self, entry: _Entry) -> bool:
        """Whether one screen has both."""
        return any(normal(str(entry.name)) in seen and normal(str(entry.value)) in seen for seen in self._screens)

    @staticmethod
    def _has(texts: Mapping[str, None], said: str, instead: str) -> bool:
        wanted, other = normal(said), normal(instead).replace("\\", r"\\")
        pattern = re.compile(rf"(?<!\w){re.escape(wanted)}(?!\w)")
        return bool(wanted) and any(
            pattern.search(seen) and not (other and pattern.sub(other, seen) in texts) for seen in texts
        )

    def _counts(self, number: float) -> bool:
        """Whether a number has been seen, in whichever unit and however rounded."""
        return any(
            f"{number * scale:.{len(shown.partition('.')[2])}f}" == shown
            for shown in self._numbers
            for scale in SCALES
        )


def _as_words(level: float) -> Iterator[str]:
    yield from (shown for share, shown in SEAT_LEVELS if share == level)


def unknown(
    half: Half, template: str, drawn: DrawnValues, steps: Sequence[Step], moves: Sequence[int | None]
) -> Iterator[str]:
    """The acts of a reference solution that depend on what nothing has told.

    Args:
        half: the half, with its parameters open.
        template: the phrasing that the driver used.
        drawn: the parameters of the instance.
        steps: the reference solution's steps, the hand-over first.
        moves: for each action, the number of the move that it belongs to, in the half's order; None for what
            belongs to none."""
    tellings = tuple(_open_in((half.start, half.says, [topic.reply for topic in half.topics], template)))
    seen, guessed = _Evidence(), set[tuple[int, str]]()
    seen.add(template.format_map(drawn.parameters))
    for step, number in zip(steps, moves, strict=False):
        seen.look(step)
        if number is None:
            continue
        move = half.moves[number]
        for name in _needed(move, drawn.parameters):
            left = [value for value in _left(name, tellings, drawn, seen) if _differs(move, name, value, drawn)]
            if left and (number, name) not in guessed:
                guessed.add((number, name))
                yield (
                    f"move {number}, {bind(move, drawn.parameters)}, depends on {name} "
                    f"({drawn.parameters[name]!r}); it could be {' or '.join(map(repr, left[:3]))} just as well"
                )
        if isinstance(move, Consult):
            yield from _unheard(bind(move, drawn.parameters).text, bind(half.topics, drawn.parameters), seen)
        if isinstance(move, TypeText) and not _has_words(seen, bind(move, drawn.parameters).text):
            yield f"move {number} types {bind(move, drawn.parameters).text!r}, which nothing has told"


def _unheard(question: str, topics: Sequence[Topic], seen: _Evidence) -> Iterator[str]:
    topic = topic_of(question, topics)
    for choice in () if topic is None else topic.choices:
        if not any(map(seen.names, choice)):
            yield f"the question {question!r} names {choice[0]!r}, which nothing has told"


def _has_words(seen: _Evidence, text: str) -> bool:
    return all(seen.names(word) for word in re.findall(r"\w+", text))


def _left(name: str, tellings: Sequence[Any], drawn: DrawnValues, seen: _Evidence) -> list[Parameter]:
    """The other values that nothing seen has ruled out."""
    left = dict(drawn.others(name))
    for telling in tellings:
        if name not in _needed(telling, drawn.parameters):
            continue
        said = list(_leaves(bind(telling, drawn.parameters)))
        for value, then in drawn.others(name):
            other = list(_leaves(bind(telling, then)))
            if len(said) != len(other) or any(
                mine != theirs and seen.tells(mine, theirs) for mine, theirs in zip(said, other, strict=True)
            ):
                left.pop(value, None)
    return list(left)


def _leaves(value: Any) -> Iterator[Any]:
    """The texts and numbers in a value."""
    if isinstance(value, Seat):
        yield value.words
    elif isinstance(value, _Setting | _Pictured):
        yield from map(type(value), _leaves(value.value))
    elif isinstance(value, Mapping):
        for name, entry in value.items():
            yield from (_Entry(name, leaf) for leaf in _leaves(entry))
    elif isinstance(value, tuple | list | frozenset):
        for entry in value:
            yield from _leaves(entry)
    elif is_dataclass(value) and not isinstance(value, _Entry):
        for field in fields(value):
            yield from _leaves(getattr(value, field.name))
    else:
        yield value


def _differs(move: Move, name: str, value: Parameter, drawn: DrawnValues) -> bool:
    return bool(bind(move, {**drawn.parameters, name: value}) != bind(move, drawn.parameters))


def _needed(value: Any, parameters: Mapping[str, Parameter]) -> list[str]:
    """The names of the parameters that a value is filled from, those that only their meanings name included."""

    class _Noting(dict[str, Parameter]):
        def __getitem__(self, name: str) -> Parameter:
            asked[name] = None
            return super().__getitem__(name)

    asked: dict[str, None] = {}
    bind(value, _Noting(parameters))
    return list(asked)


_READ = ("signals", "sensors")
"""Fields of a start whose values the car shows."""


def _open_in(value: Any) -> Iterator[Any]:
    """The placeholders, and texts with placeholders, in a value."""
    if isinstance(value, Param) or (isinstance(value, str) and "{" in value):
        yield value
    elif isinstance(value, Photo):
        yield from map(_Pictured, _open_in((value.value, value.unit)))
    elif isinstance(value, Start):
        for read in (value.signals, value.sensors):
            yield from map(_Setting, _open_in(tuple(read.values()) if isinstance(read, Mapping) else read))
        yield from _open_in([getattr(value, field.name) for field in fields(value) if field.name not in _READ])
    elif isinstance(value, Mapping):
        for name, entry in value.items():
            yield from (_Entry(name, value) for value in _open_in(entry))
            if not any(_open_in(entry)) and any(_open_in(name)):
                yield _Entry(name, entry)
    elif isinstance(value, tuple | list | frozenset):
        for entry in value:
            yield from _open_in(entry)
    elif is_dataclass(value):
        for field in fields(value):
            yield from _open_in(getattr(value, field.name))


@lru_cache(maxsize=4096)
def normal(text: str) -> str:
    """A text in small letters and with single spaces; hours up to 24, numbers in figures and with a point."""
    small = " ".join(text.casefold().split())
    small = TWELVE_HOURS.sub(_up_to_24, small)
    small = re.sub(r"\w+", lambda word: FIGURES.get(word[0], word[0]), small)
    return re.sub(r"(\d),(\d)", r"\1.\2", small)


def words(text: str) -> str:
    """A text as words in small letters between single spaces."""
    found = re.findall(r"[^\W_]+", text.casefold())
    return f" {' '.join(found)} "


def _up_to_24(found: re.Match[str]) -> str:
    return f"{int(found[1]) % 12 + 12 * (found[3] == 'p')}:{found[2] or '00'}"
