"""Instances: tasks with their phrasing and parameters drawn, in the language of the driver."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

from automotive_cosim.cockpit.language import Language, said, word
from automotive_cosim.cockpit.make import HOME, Make
from automotive_cosim.cockpit.occupants import Seat
from automotive_cosim.cockpit.tree import make_named
from automotive_cosim.contracts.given import CarMake
from automotive_cosim.contracts.text import Quantity
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.tasking.dialogue import AS_SEEN, LOOK_FIRST, Says, Topic
from automotive_cosim.tasking.draws import Draws, Purpose
from automotive_cosim.tasking.moves import Consult, Hear, Inform, Move, Tap, TapUntil
from automotive_cosim.tasking.parameters import KEEP, Choices, FromCockpit, Parameter, bind, rebuilt
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.speech import Speech
from automotive_cosim.tasking.task import Half, Task
from automotive_cosim.tasking.ways import in_make, units_in


@dataclass(frozen=True)
class Instance:
    """A task with its phrasing and parameters drawn."""

    task: Task
    half_name: str
    goal: str
    parameters: Mapping[str, Parameter]
    held_out: bool = False
    """Whether its phrasing is the task's last, which is held out from the rule model."""
    rule: str = ""
    """The sign or law that it rests on in another network than its own (``binding``); empty in its own."""
    language: Language = Language.ENGLISH
    """What the driver speaks, and the car shows."""
    make: CarMake = CarMake.HOME
    """Whose cockpit the car has."""

    @cached_property
    def half(self) -> Half:
        """The half, with the parameters filled in."""
        half, make = bind(self.task.half(self.half_name), self.parameters), make_named(self.make)
        half = replace(half, rule=self.rule) if self.rule else half
        if make is not HOME:
            half = replace(half, moves=in_make(half.moves, make, units_in(make, self.task)))
        if make is not HOME or self.language is not Language.ENGLISH:
            half = _as_shown(half, self.language, make)
        return half if self.language is Language.ENGLISH else _in_language(half, speech(self.task, self.language))

    @property
    def moves(self) -> tuple[Move, ...]:
        """The reference solution, with the parameters filled in."""
        return self.half.moves

    @property
    def spoken(self) -> tuple[str, ...]:
        """Everything that may be said: the wish, remarks and answers."""
        half = self.half
        replies = (*(topic.reply for topic in half.topics), half.neutral)
        return (self.goal, *(each.text for each in half.says), *replies)


def draw(
    task: Task,
    half_name: str,
    number: int,
    content: Mapping[str, tuple[str, ...]] | None = None,
    *,
    held_out: bool = False,
    language: Language = Language.ENGLISH,
    make: CarMake = CarMake.HOME,
    redrawn: int = 0,
) -> Instance:
    """Draws phrasing and parameters, the same for both halves of a task.

    Each task goes through its phrasings, and through the values of its parameters, in a random order of its own, so
    that one number takes every phrasing equally often over the tasks, and consecutive numbers are different
    instances until the task has no more.

    Args:
        half_name: ``first`` or ``second``.
        content: the cockpit's content (``Cockpit.content``); without it, a parameter that comes from there is its
            kind in angle brackets.
        held_out: whether to use the held-out phrasing, whatever is drawn; the parameters stay the same.
        language: what the driver speaks; the draw is the same in each.
        make: whose cockpit the car has; so is it there.
        redrawn: how many phrasings further in the task's order, with the same parameters.

    Raises:
        UnknownNameError: the task has no such half, or the cockpit has nothing of that kind.
        UserError: the driver has no words for it in that language."""
    phrasings, ways = len(task.templates), drawn(task)
    order = Draws(task.id, 0)
    phrasing = int(order.rng(Purpose.PHRASING).permutation(phrasings)[(number + redrawn) % phrasings])
    # Once both orders have come round together, the parameters go on by one.
    way = int(
        order.rng(Purpose.PARAMETERS).permutation(ways)[(number + number // math.lcm(phrasings, ways)) % ways]
    )
    parameters: dict[str, Parameter] = {}
    for name, choices in task.parameters.items():
        way, pick = divmod(way, _count(choices))
        parameters[name] = _choose(choices, pick, content)
    if held_out:
        phrasing = phrasings - 1
    goal = phrased(task, half_name, parameters, language)[phrasing]
    return Instance(
        task, half_name, goal, parameters, held_out=phrasing == phrasings - 1, language=language, make=make
    )


def phrased(
    task: Task, half_name: str, parameters: Mapping[str, Parameter], language: Language = Language.ENGLISH
) -> tuple[str, ...]:
    """Every phrasing with the parameters filled in, and with the seat that it comes from unless it is the driver's.

    Raises UserError: the driver has no words for it in that language."""
    voice = task.half(half_name).start.voice
    prefix = "" if voice is Seat.DRIVER else f"From the {voice.words} seat: "
    suffix = {Suite.CLARIFY: f" {LOOK_FIRST}", Suite.CAMERA: f" {AS_SEEN}"}.get(task.suite, "")
    if language is Language.ENGLISH:
        return tuple(prefix + template.format_map(parameters) + suffix for template in task.templates)
    own = speech(task, language)
    return tuple(own.lines.said(prefix + own.phrased(template, parameters)) for template in own.templates)


def speech(task: Task, language: Language) -> Speech:
    """How the driver says a task in a language other than English. Raises UserError: he has no words for it."""
    if language not in task.languages:
        why = f": {task.only_english}" if task.only_english else ""
        raise UserError(
            f"task {task.id!r} has no phrasings in {language.words}{why}; choose another task, such as one of the "
            "hard suite, or --language en"
        )
    return task.spoken[language]


def _as_shown(half: Half, language: Language, make: Make) -> Half:
    """The half with what a finger looks for on the screens in that language and the make's words."""

    def told(text: str) -> str:
        """A message, or a name and a value."""
        return ": ".join(word(each, language, make) for each in text.split(": "))

    def change(part: Any) -> Any:
        match part:
            case Tap(text=text):
                return replace(part, text=told(text))
            case TapUntil(text=text):
                shown = told(text)
                return replace(part, text=shown if shown != text else said(Quantity(text), language))
        return KEEP

    shown: Half = rebuilt(half, change)
    return shown


def _in_language(half: Half, own: Speech) -> Half:
    """The half with what is said in that language."""
    heard = (*(says.text for says in half.says), *(topic.reply for topic in half.topics))

    def change(part: Any) -> Any:
        match part:
            case Says(text) | Consult(text) | Inform(text):
                return replace(part, text=own.lines.said(text))
            case Hear(text):
                return replace(part, text=next(own.lines.said(line) for line in heard if text in line))
            case Topic():
                return own.topic(part)
        return KEEP

    changed: Half = rebuilt(half, change)
    return replace(changed, neutral=own.lines.said(half.neutral))


def _choose(choices: Choices, pick: int, content: Mapping[str, tuple[str, ...]] | None) -> Parameter:
    if not isinstance(choices, FromCockpit):
        return choices[pick]
    if content is None:
        return f"<{choices.kind}>"
    held = content.get(choices.kind, ())
    if not held:
        raise UnknownNameError("content of the cockpit", choices.kind, content)
    return held[pick % len(held)]


HELD = {
    "contacts": 21,
    "favourite_contacts": 6,
    "threads": 8,
    "places": 80,
    "favourite_places": 8,
    "playlists": 8,
    "tracks": 140,
    "podcasts": 8,
    "fm": 20,
    "dab": 20,
}
"""Minimum number of each kind in a cockpit (``Cockpit.content``)."""


def instances(task: Task) -> int:
    """Number of distinct phrasings, parameters and scenarios; other variation by seed is not counted."""
    return len(task.templates) * drawn(task) * len(task.runs_in)


def drawn(task: Task) -> int:
    """Number of distinct sets of parameters that can be drawn."""
    return math.prod(map(_count, task.parameters.values()))


def _count(choices: Choices) -> int:
    return HELD.get(choices.kind, 1) if isinstance(choices, FromCockpit) else len(choices)
