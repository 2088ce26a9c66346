"""Conditions: what an agent is given, and at what speed; the same for a task's half and for a drive.

A condition is one field of ``Conditions``: its name, type, default, help and words. Plans, ids, options, rows,
report tables, the leaderboard and the doors loop over ``TABLE``; only what the condition does stands elsewhere.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import MISSING, dataclass, field, fields, make_dataclass, replace
from enum import StrEnum
from itertools import product
from typing import TYPE_CHECKING, Annotated, Any, TypeVar, get_args, get_type_hints

from annotated_types import Ge, Le, MinLen

from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.given import (
    NEEDS_PICTURE,
    NEEDS_ROAD,
    OWN_MAKE,
    OWN_PROMPT,
    CarMake,
    Channel,
    Clock,
    DriverAttention,
    FeedbackDetail,
    GeoInput,
    Hearing,
    Interface,
    Language,
    Order,
    OrFile,
    PromptLength,
    See,
    ToldPolicy,
)
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.formats.annotations import OneOf
from automotive_cosim.formats.docs import field_docs


@dataclass(frozen=True, slots=True)
class Words:
    """How a condition is called where results are read."""

    heading: str
    """Heading of its column."""
    label: str
    """A value in words, as a format."""
    tag: str
    """A value that is not the default, in ids."""
    title: str
    """Title of the report's table of success by it."""
    note: str
    """What its values mean, below that table."""
    is_speed: bool = False
    """Whether it is about how fast the agent answers, and not about what it is given."""


@dataclass(frozen=True, slots=True, order=True)
class Conditions:
    """What an agent is given, and at what speed."""

    geo: Annotated[
        GeoInput,
        OneOf(GeoInput, "geo control"),
        Words(
            "Geo", "geo {}", "{}", "Success by geo control", "What the agent is told about the place of the car."
        ),
    ] = GeoInput.FULL
    """What the agent is told about its place."""
    clock: Annotated[
        Clock,
        OneOf(Clock),
        Words(
            "Clock", "{}'s clock", "{}_clock", "Success by clock",
            "Whether the seconds that a model takes to answer pass on the road (model) or not (fixed).",
            is_speed=True,
        ),
    ] = Clock.FIXED  # fmt: skip
    """Whether the seconds that a model takes to answer pass on the road (``model``) or not (``fixed``)."""
    latency_s: Annotated[
        float,
        Ge(0),
        Le(600),
        Words(
            "Latency", "latency {:g} s", "latency{:g}", "Success over think time",
            "Simulated seconds added to every answer before its action.", is_speed=True,
        ),
    ] = 0.0  # fmt: skip
    """Simulated seconds added to each answer, before its action."""
    see: Annotated[
        See,
        OneOf(See, "way to see the screen"),
        Words(
            "Sees", "{0.words}", "see_{}", "Success by how the agent sees the screen",
            "The list of elements, the picture, or both; the picture alone comes without ids and descriptions. "
            "Who calls functions may also see nothing of the screen. With camera, agents that take pictures "
            "also see the road through the windshield.",
        ),
    ] = See.BOTH  # fmt: skip
    """How the agent sees the screen."""
    feedback: Annotated[
        FeedbackDetail,
        OneOf(FeedbackDetail, "kind of feedback"),
        Words(
            "Feedback", "{} feedback", "{}", "Success by feedback",
            "Quiet feedback names the control and says if it worked; verbose also says what changed in the car.",
        ),
    ] = FeedbackDetail.QUIET  # fmt: skip
    """What the agent is told about its last action: the control and whether it worked (``quiet``), or also what
    changed in the car (``verbose``)."""
    screen: Annotated[
        ScreenSize,
        OneOf(ScreenSize, "size of the screen"),
        Words(
            "Screen", "{} screen", "{}", "Success by the size of the screen",
            "1920x720 shows the map and music beside each app; 1080x1920 shows them above it.",
        ),
    ] = ScreenSize.STANDARD  # fmt: skip
    """Size of the car's screen."""
    language: Annotated[
        Language,
        OneOf(Language, "language"),
        Words(
            "Language", "in {0.words}", "{}", "Success by language",
            "The driver's words and the screens are in this language; what other people write stays in English.",
        ),
    ] = Language.ENGLISH  # fmt: skip
    """What the driver speaks, and the car shows."""

    make: Annotated[
        CarMake,
        OneOf(CarMake, "make", OWN_MAKE),
        Words(
            "Make", "make {0.words}", "{0.tag}", "Success by make",
            "Whose cockpit the car has: other places, names, menus, units, icons and colours, the same functions. "
            "A file stands for a make of one's own; its SHA-256 tells one from another.",
        ),
    ] = CarMake.HOME  # fmt: skip
    """Whose cockpit the car has: ``home``, another make, one ``drawn`` by the seed, or a file of your own
    (.toml)."""

    interface: Annotated[
        Interface,
        OneOf(Interface, "interface"),
        Words(
            "Interface", "by {}", "by_{}", "Success by interface",
            "The agent acts on the screen (touch), by typed functions of the car (functions), or by both.",
        ),
    ] = Interface.TOUCH  # fmt: skip
    """How the agent acts: on the screen (``touch``), by typed functions of the car (``functions``), or ``both``."""
    order: Annotated[
        Order,
        OneOf(Order, "order"),
        Words(
            "Order", "{} order", "{}_order", "Success by order",
            "What the driver of a drive asks for: in a sentence (plain), as before a drive (usual), or with every "
            "threshold (full). Where none was told, none is charged for.",
        ),
    ] = Order.PLAIN  # fmt: skip
    """What the driver of a drive asks for: in a sentence (``plain``), as before a drive (``usual``), or with every
    threshold (``full``)."""
    hear: Annotated[
        Hearing,
        OneOf(Hearing, "way to hear"),
        Words(
            "Hears", "hears by {}", "hear_{}", "Success by how the agent hears",
            "What people in the car say reaches the agent as text, or as a recogniser made it out in the noise of "
            "that instant (cabin), or as sound (audio); then speaking takes time, and the driver may mishear.",
        ),
    ] = Hearing.TEXT  # fmt: skip
    """How the driver's words reach the agent: as they are (``text``), as a recogniser makes them out in the
    noise of the cabin (``cabin``), or as sound in it (``audio``)."""

    prompt: Annotated[
        PromptLength,
        OneOf(PromptLength, "prompt", OWN_PROMPT),
        Words(
            "Prompt", "{0.words} prompt", "{0.tag}_prompt", "Success by prompt",
            "How much the prompt of T3A, M3A and ASURADA spells out; short is for small models. A file "
            "stands for its instructions; its SHA-256 tells one from another.",
        ),
    ] = PromptLength.STANDARD  # fmt: skip
    """How much the prompt of T3A, M3A and ASURADA spells out: ``standard``, or ``short`` for
    small models; or a file (.md, .txt) in place of the standard one's instructions."""

    policy: Annotated[
        ToldPolicy,
        OneOf(ToldPolicy, "policy"),
        Words(
            "Policy", "{} policy", "{}_policy", "Success by policy",
            "Whether the agent was told the house rules (house) or not (none); breaches are counted in any case.",
        ),
    ] = ToldPolicy.NONE  # fmt: skip
    """Which rules the agent is told beside the driver's words: none, or those of the ``house``."""

    attention: Annotated[
        DriverAttention,
        OneOf(DriverAttention, "attention"),
        Words(
            "Attention", "attention {}", "attention_{}", "Success by the driver's attention",
            "Whether what the agent shows and says takes the driver's attention off the road (on) or not (off).",
        ),
    ] = DriverAttention.OFF  # fmt: skip
    """Whether what the agent shows and says takes the driver's attention off the road, so that the car brakes later
    and keeps a less even gap (``on``), or not (``off``)."""

    @classmethod
    def named(cls, values: Mapping[str, object]) -> Conditions:
        """Conditions by name, with values as words or numbers.

        Raises UserError: there is no such condition or value."""
        return cls(**{name: condition(name).value(value) for name, value in values.items()})

    def hides(self, tags: Collection[str]) -> str:
        """What an agent does not see of what a task with these tags needs, and what to do; empty if it sees all."""
        if NEEDS_ROAD in tags and self.see is not See.CAMERA:
            return f"the view of the road, which see = {self.see} leaves out; give see = camera"
        if NEEDS_PICTURE not in tags:
            return ""
        touch = "give see = both, interface = touch"
        if not self.interface.touches:
            return f"the picture, which interface = {self.interface} cannot open; {touch}"
        return (
            f"the picture, which see = {self.see} withholds; {touch}"
            if Channel.SCREENSHOT in self.see.withheld
            else ""
        )

    def at(self, seed: int) -> Conditions:
        """The conditions of the episode with a seed."""
        return replace(self, make=self.make.at(seed))

    @property
    def labels(self) -> tuple[str, ...]:
        """Whatever is not the default, in words."""
        return tuple(each.label(self) for each in TABLE if not each.is_default(self))

    @property
    def inputs(self) -> tuple[str, ...]:
        """The same without what is about speed: what the agent is given."""
        return tuple(each.label(self) for each in INPUTS if not each.is_default(self))

    @property
    def tags(self) -> tuple[str, ...]:
        """Whatever is not the default, for ids."""
        return tuple(each.words.tag.format(each.of(self)) for each in TABLE if not each.is_default(self))

    def as_json(self) -> Json:
        """Values by name."""
        return {each.name: each.of(self) for each in TABLE}


@dataclass(frozen=True, slots=True)
class Condition:
    """A line of the table."""

    name: str
    kind: Any
    """Type of its values, with the annotations that say which are valid."""
    default: Any
    help: str
    words: Words

    @property
    def choices(self) -> tuple[str, ...]:
        """Its values, if they are words."""
        kind = get_args(self.kind)[0]
        return tuple(map(str, kind)) if issubclass(kind, StrEnum) else ()

    @property
    def bounds(self) -> tuple[float, float]:
        """The least and the greatest value of one that is a number."""
        found = {type(mark): mark for mark in get_args(self.kind)}
        return float(found[Ge].ge), float(found[Le].le)

    @property
    def word(self) -> str:
        """Its name without the unit, as options and older plans have it."""
        return self.name.removesuffix("_s")

    def of(self, conditions: Conditions) -> Any:
        return getattr(conditions, self.name)

    def is_default(self, conditions: Conditions) -> bool:
        """Whether its value is the default."""
        return bool(self.of(conditions) == self.default)

    def label(self, conditions: Conditions) -> str:
        """Its value in words."""
        return self.words.label.format(self.of(conditions))

    def told(self, value: object) -> str:
        """A value as the heading of a column."""
        if isinstance(value, OrFile):
            return value.words
        return str(value) if self.choices else f"{value:g} s"

    def value(self, given: object) -> Any:
        """A value from a word, or from a number. Raises UserError: it has no such value."""
        kind, *annotations = get_args(self.kind)
        if self.name == "make" and isinstance(given, str):
            from automotive_cosim.cockpit.own_make import resolved  # the whole cockpit, for a file of one's own

            given = resolved(given)
        if self.choices:
            is_beside = any(isinstance(each, OneOf) and _fits(each.beside, given) for each in annotations)
            if given not in self.choices and not is_beside:
                what = next((each.what for each in annotations if isinstance(each, OneOf)), "") or self.name
                raise UnknownNameError(what, str(given), self.choices)
            return kind(given)
        least, most = self.bounds
        if not isinstance(given, int | float) or not least <= given <= most:
            raise UserError(f"{self.name} is {given!r}; give a number from {least:g} to {most:g}")
        return kind(given)


def _fits(pattern: str, given: object) -> bool:
    return bool(pattern) and isinstance(given, str) and re.match(pattern, given) is not None


def _table() -> Iterator[Condition]:
    docs, kinds = field_docs(Conditions), get_type_hints(Conditions, include_extras=True)
    for each in fields(Conditions):
        words = next(mark for mark in get_args(kinds[each.name]) if isinstance(mark, Words))
        assert each.default is not MISSING
        yield Condition(each.name, kinds[each.name], each.default, docs[each.name], words)


TABLE = tuple(_table())
"""Every condition, in the order of the fields."""
INPUTS = tuple(each for each in TABLE if not each.words.is_speed)
"""Those that say what an agent is given; whoever paces an agent from outside has no others."""


def condition(name: str) -> Condition:
    """A line of the table. Raises UnknownNameError: there is none of that name."""
    found = next((each for each in TABLE if each.name == name), None)
    if found is None:
        raise UnknownNameError("condition", name, [each.name for each in TABLE])
    return found


# --- lists of values, of which a plan combines each with every other --------------------------------------

if TYPE_CHECKING:

    @dataclass(frozen=True, slots=True)
    class ConditionLists:
        """Values of each condition."""

else:
    ConditionLists = make_dataclass(
        "ConditionLists",
        [
            (each.name, Annotated[tuple[each.kind, ...], MinLen(1)], field(default=(each.default,)))
            for each in TABLE
        ],
        frozen=True,
        slots=True,
        kw_only=True,
        namespace={
            "__doc__": "Values of each condition.",
            "__module__": __name__,
            "__field_docs__": {each.name: each.help for each in TABLE},
        },
    )


def lists_of(values: ConditionLists) -> dict[str, Sequence[Any]]:
    """The values of each condition, by its name."""
    return {each.name: getattr(values, each.name) for each in TABLE}


L = TypeVar("L", bound=ConditionLists)


def with_conditions(lists: L, conditions: Conditions) -> L:
    """Lists with these conditions alone."""
    only: dict[str, Any] = {name: (value,) for name, value in conditions.as_json().items()}
    return replace(lists, **only)


def told(plan: Json) -> str:
    """The conditions of a plan's JSON in words: ``geo full, none; language en``."""
    lists = ((each, plan.get(each.name, [each.default])) for each in TABLE)
    return "; ".join(f"{each.words.heading.lower()} {', '.join(map(each.told, values))}" for each, values in lists)


def combined(values: ConditionLists) -> tuple[Conditions, ...]:
    """Every combination of the values, without those that leave an agent at the screen nothing to see."""
    lists = lists_of(values)
    every = (Conditions(**dict(zip(lists, each, strict=True))) for each in product(*lists.values()))
    return tuple(each for each in every if each.interface.calls or each.see is not See.NOTHING)
