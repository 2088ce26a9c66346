"""Reads tasks from TOML: every key is the name of a field of ``Task`` or of its half.

    [hvac_fan_max]
    templates = ["Turn the fan speed to max.", "Fan all the way up, please.", "Full blast.", "Maximum air flow."]
    goal = "HVAC.FAN_SPEED = 100"
    moves = "open climate; tap hvac.fan.max"

``moves``, ``ways`` and ``slips``, ``goal`` and a trigger's condition are in the two languages of ``notation``. A
class is written as a table of its fields, or as a list of them in order. ``default`` is what every task of the file
is like, ``names`` has what several share: where a table or a list is expected a name stands for it, and ``like``
gives a table what a named one has. ``second`` states what differs from the first half. A table with ``each`` is a
family: one task for each of its tables, named after both, which say what differs from the family.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from functools import cache
from typing import Any

from automotive_cosim.cockpit.occupants import company
from automotive_cosim.contracts import GoalStatus
from automotive_cosim.contracts.given import Language
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.formats import bounds
from automotive_cosim.formats.checked import Steps
from automotive_cosim.formats.shipped import shipped_table
from automotive_cosim.formats.toml import Document
from automotive_cosim.tasking import notation
from automotive_cosim.tasking.checks import Check, nothing_done
from automotive_cosim.tasking.decoding import WITH_COLUMN, decoder, entries, joined, keys, mapping, several
from automotive_cosim.tasking.moves import Move
from automotive_cosim.tasking.notation import hints
from automotive_cosim.tasking.parameters import Choices, FromCockpit, Param
from automotive_cosim.tasking.speech import Lexicon, Speech
from automotive_cosim.tasking.task import Basis, Half, Start, Task

DEFAULT, NAMES = "default", "names"
"""Tables of a file that are no tasks."""
OF = "of"
"""Of a parameter's table: the values that are drawn. The other columns are what each of them means."""
IS, LIKE = "is", "like"
"""Of any table: further fields of it, to have several on a line; and the name of what it is like besides."""
EACH = "each"
"""Of a task's table: what its family's members are like, by the ends of their names."""
OCCUPANTS = (1, 2, 3, 4)
INHERITED = ("start", "trigger", "deadline", "basis", "topics", "neutral", "may_write")
"""What a second half takes from the first unless it says otherwise; the rest is what is right, and its own."""
NESTED = frozenset({"start", "second"})
FOREIGN: tuple[Language, ...] = tuple(language for language in Language if language is not Language.ENGLISH)


@dataclass(frozen=True, slots=True)
class Shared:
    """What the tasks of every file may use (``tasks/common.toml``)."""

    names: Mapping[str, Any]
    words: Mapping[Language, Mapping[str, str]]
    """By language, words for values of parameters."""
    lines: Mapping[Language, Mapping[str, str]]
    """By language, what is said in every task."""
    lexicons: Mapping[Language, Lexicon]
    """By language, the same."""


Vet = Callable[[Half], Iterable[tuple[str, UserError]]]


@cache
def shared() -> Shared:
    """What is shipped."""
    table = shipped_table("tasks", "common.toml")
    lines = {language: table[language]["lines"] for language in FOREIGN}
    return Shared(
        table[NAMES],
        {language: table[language]["words"] for language in FOREIGN},
        lines,
        {language: Lexicon.of(told) for language, told in lines.items()},
    )


def moves(text: str) -> tuple[Move, ...]:
    """Moves without placeholders (``notation``). Raises UserError: something is wrong with them."""
    return notation.moves(text, _Reader("", shared().names, shared(), _Cost()).decode)


def tasks_in(document: Document, shared: Shared, check: Vet | None = None) -> Iterator[Task]:
    """The tasks of a file, in order.

    Args:
        check: finds in a half what is wrong with it, and in which field.

    Raises UserError: file, line and reason."""
    table, cost = document.table, _Cost()
    own = table.get(NAMES, {})
    if not isinstance(own, Mapping):
        raise document.refused((NAMES,), f"is {own!r}; it must be a table")
    if check is not None and (steps := next(_too_long(table), None)) is not None:
        raise document.refused(steps, f"is longer than {bounds.TASK_TEXT:,} characters")
    names = {**shared.names, **own}
    for home, family, entry in _members(table):
        task_id = "_".join(map(str, (home[0], *home[2:])))
        reader = _Reader(task_id, names, shared, cost, check)
        try:
            cost.add(bounds.TASK_COST // MOST_TASKS)
            cost.add_all(common := table.get(DEFAULT, {}))
            cost.add_all(family)
            yield reader.task(entry, reader.table(family, reader.table(common, {})))
        except UserError as error:
            raise document.refused(_found(table, home, (*reader.steps, *reader.below)), str(error)) from error
        except (TypeError, ValueError, AttributeError, LookupError, ArithmeticError, RecursionError) as error:
            why = "nested too deeply, or like itself" if isinstance(error, RecursionError) else str(error)
            if isinstance(error, TypeError | AttributeError):
                why = f"another kind of value is expected there ({why})"
            raise document.refused(_found(table, home, reader.steps), f"cannot be read: {why}") from error


def _members(table: Mapping[str, Any]) -> Iterator[tuple[Steps, Mapping[str, Any], Any]]:
    """Where every task stands, what its family is like, and its own table."""
    for name, entry in table.items():
        if name in (DEFAULT, NAMES):
            continue
        if isinstance(entry, Mapping) and isinstance(entry.get(EACH), Mapping):
            family = {key: value for key, value in entry.items() if key != EACH}
            yield from (((name, EACH, end), family, own) for end, own in entry[EACH].items())
        else:
            yield (name,), {}, entry


MOST_HOLES = 3
"""In a sentence of a lexicon: what varies is found by trying, which takes the length to that power."""
MOST_TASKS = 5000
"""In a file, whatever they say."""


class _Cost:
    """What is made of a file, in values and characters: what a name stands for counts wherever it is named."""

    def __init__(self) -> None:
        self._left = bounds.TASK_COST
        self._sizes: dict[int, tuple[int, object]] = {}

    def add(self, amount: int) -> None:
        """Counts what is about to be made. Raises UserError: that is too much."""
        self._left -= amount
        if self._left < 0:
            raise UserError(f"makes more than {bounds.TASK_COST:,} values and characters of this file")

    def add_all(self, value: object) -> None:
        """Counts a value with all that is in it."""
        if id(value) not in self._sizes:
            size = sum(len(part) if isinstance(part, str) else 1 for _, part in _parts(value))
            self._sizes[id(value)] = size, value
        self.add(self._sizes[id(value)][0])


def _parts(value: object) -> Iterator[tuple[Steps, object]]:
    """A value and everything in it, with the steps that lead there."""
    parts: list[tuple[Steps, object]] = [((), value)]
    while parts:
        steps, part = parts.pop()
        yield steps, part
        if isinstance(part, Mapping):
            parts += (((*steps, name), each) for name, each in part.items())
        elif isinstance(part, list):
            parts += (((*steps, number), each) for number, each in enumerate(part))


def _too_long(table: Mapping[str, Any]) -> Iterator[Steps]:
    """Where a text is longer than anybody writes."""
    return (steps for steps, part in _parts(table) if isinstance(part, str) and len(part) > bounds.TASK_TEXT)


def _found(table: Mapping[str, Any], home: Steps, steps: Steps) -> Steps:
    """Where a field of a task stands: in its table, in ``is``, in its first half or its family, or in what every
    task is like."""
    shorter = (steps, steps[1:]) if steps[:1] == ("second",) else (steps,)
    for place in (home, home[:1], (DEFAULT,)):
        holder: Any = table
        for step in place:
            holder = holder.get(step, {}) if isinstance(holder, Mapping) else {}
        for each in shorter:
            if each and (found := _within(holder, each)):
                return (*place, *found)
    return (*home, *steps)


def _within(holder: Any, steps: Steps) -> Steps:
    if not steps or not isinstance(holder, Mapping):
        return steps
    if steps[0] in holder:
        inner = _within(holder[steps[0]], steps[1:])
        return (steps[0], *inner) if inner or len(steps) == 1 else ()
    return (IS, *inner) if IS in holder and (inner := _within(holder[IS], steps)) else ()


class _Reader:
    """Reads one task; ``steps`` leads to what is being read."""

    def __init__(
        self, task_id: str, names: Mapping[str, Any], shared: Shared, cost: _Cost, check: Vet | None = None
    ) -> None:
        self._id = task_id
        self._cost = cost
        self._names = names
        self._shared = shared
        self._check = check
        self._parameters: dict[str, Choices] = {}
        self._means: dict[str, Mapping[str, Sequence[Any]]] = {}
        self._topics: tuple[Any, ...] = ()
        self.steps: Steps = ()
        self.below: list[str] = []
        """What leads on from there, once something has been refused."""

    def task(self, entry: Any, default: Mapping[str, Any]) -> Task:
        if not isinstance(entry, Mapping):
            raise UserError("is no table of a task")
        given = self.table(entry, default)
        for name in given:
            if name not in _KNOWN:
                self.steps = (name,)
                raise UnknownNameError("field of a task", name, _KNOWN)
        known = hints(Task)
        for name, choices in mapping(given.get("parameters", {})).items():
            self.steps = ("parameters", name)
            self._declare(name, choices)
        made = {name: self._at(name, given[name], known[name]) for name in _OF_TASK if name in given}
        if "templates" in given:
            made["templates"] = several(given["templates"])
        first = self._half({name: value for name, value in given.items() if name in _OF_HALF})
        second = None
        if "second" in given:
            taken = {name: given[name] for name in INHERITED if name in given}
            second = self._half(self.table(given["second"], taken), first)
        spoken = {language: self._speech(language, given[language]) for language in FOREIGN if language in given}
        self.steps = ()
        return Task(self._id, first=first, second=second, parameters=self._parameters, spoken=spoken, **made)

    def _declare(self, name: str, choices: Any) -> None:
        """Enters a parameter: a list of values, the name of one, a kind of the cockpit's content, or a table."""
        if isinstance(choices, str):
            if choices not in self._names:
                self._parameters[name] = FromCockpit(choices)
                return
            choices = self.named(choices)
        columns = self.table(choices, {}) if isinstance(choices, Mapping) else {OF: choices}
        if OF not in columns:
            raise UserError(f"lacks {OF!r}, the values that are drawn")
        self._parameters[name] = tuple(entries(columns[OF]))
        self._means[name] = columns
        for column, values in columns.items():
            if len(entries(values)) != len(columns[OF]):
                raise UserError(f"has {len(columns[OF])} values and {len(values)} of {column!r}")

    def _column(self, name: str, column: str) -> Sequence[Any]:
        """What the values of a parameter mean."""
        self._choices(name)
        columns = self._means.get(name, {})
        if column not in columns:
            raise UnknownNameError(f"column of the parameter {name}", column, columns)
        self._cost.add_all(columns[column])
        return columns[column]

    def _choices(self, name: str) -> tuple[Any, ...]:
        if name not in self._parameters:
            raise UnknownNameError("parameter", name, self._parameters)
        choices = self._parameters[name]
        self._cost.add(1 if isinstance(choices, FromCockpit) else len(choices))
        return (choices.kind,) if isinstance(choices, FromCockpit) else choices

    def _half(self, given: Mapping[str, Any], first: Half | None = None) -> Half:
        steps = () if first is None else ("second",)
        self.steps = steps
        for name in given:
            if name not in _OF_HALF:
                raise UnknownNameError("field of a half", name, _OF_HALF)
        for name in ("start", "trigger", "deadline"):
            if name not in given:
                raise UserError(f"lacks {name!r}")
        known = hints(Half)
        made = {
            name: self._at(name, given[name], known[name], *steps)
            for name in ("topics", "trigger", "deadline", "tells", "most_words", "says", "neutral")
            if name in given
        }
        if "may_write" in given:
            self.steps = (*steps, "may_write")
            made["may_write"] = keys(self, given["may_write"])
        self._topics = made.get("topics", ())
        self.steps = (*steps, "start")
        made["start"] = self.decode(self.table(given["start"], {}), Start)
        made["goal"] = self._at("goal", given["goal"], Check, *steps) if "goal" in given else nothing_done()
        self.steps = (*steps, "moves")
        moves = notation.moves(given.get("moves", ""), self.decode, () if first is None else first.moves)
        for name in ("ways", "slips"):
            if name in given:
                self.steps = (*steps, name)
                made[name] = tuple([self._way(each, moves) for each in several(given[name])])
        self.steps = (*steps, "basis")
        basis, rule = _parted(given.get("basis", "wish"))
        self.steps = (*steps, "declares")
        declares, reasons = _parted(given.get("declares", "complete"))
        if reasons:
            made["reasons"] = self.decode(reasons.split(", "), known["reasons"])
        half = Half(
            moves=moves,
            basis=self.decode(basis, Basis),
            rule=rule,
            declares=self.decode(declares, GoalStatus),
            **made,
        )
        for name, error in () if self._check is None else self._check(half):
            self.steps = (*steps, name)
            raise error
        return half

    def _way(self, told: str, solution: Sequence[Move]) -> tuple[Move, ...]:
        found = notation.moves(told, self.decode, solution)
        self._cost.add(len(found))
        return found

    def _speech(self, language: Language, given: Any) -> Speech:
        self.steps = (language,)
        own = given if isinstance(given, Mapping) else {"templates": given}
        if "templates" not in own:
            raise UserError("lacks 'templates'")
        return Speech(
            language,
            several(own["templates"]),
            self._lexicon(language, own.get("lines", {})),
            {**self._shared.words[language], **own.get("words", {})},
            {word: tuple(others) for word, others in own.get("asked", {}).items()},
        )

    def _lexicon(self, language: Language, own: Mapping[str, str]) -> Lexicon:
        if not own:
            return self._shared.lexicons[language]
        for told, said in own.items():
            holes = told.count("{}")
            if holes > MOST_HOLES or said.count("{}") > holes or re.search(r"\{[^}]|[^{]\}", said):
                raise UserError(
                    f"says {said[:60]!r} for {told[:60]!r}; expected {{}} up to {MOST_HOLES} times in both"
                )
        return Lexicon.of({**self._shared.lines[language], **{told: joined(said) for told, said in own.items()}})

    # --- values -------------------------------------------------------------------------------------------

    def _at(self, name: str, value: Any, hint: Any, *steps: str) -> Any:
        self.steps = (*steps, name)
        return self.decode(value, hint)

    def decode(self, value: Any, hint: Any) -> Any:
        """A value of a type, from what is written."""
        return decoder(hint)(self, value)

    def named(self, value: Any) -> Any:
        """What a name stands for; anything else is itself."""
        if not isinstance(value, str):
            return value
        if value not in self._names:
            raise UnknownNameError("shared value", value, self._names)
        self._cost.add_all(self._names[value])
        return self._names[value]

    def table(self, value: Any, base: Mapping[str, Any]) -> dict[str, Any]:
        """A table with what it is like, over what it adds to."""
        if isinstance(value, str):
            value = self.named(value)
        if not isinstance(value, Mapping):
            raise UserError(f"is {value!r}; it must be a table or the name of one")
        own = value
        if IS in value:
            own = self._merged(value[IS], {name: each for name, each in value.items() if name != IS})
        if LIKE in own:
            base = self._merged(base, self.table(own[LIKE], {}))
            own = {name: each for name, each in own.items() if name != LIKE}
        return self._merged(base, own)

    def _merged(self, base: Mapping[str, Any], own: Mapping[str, Any]) -> dict[str, Any]:
        """One table over another; ``start`` and ``second`` add to what is there field by field."""
        found = {**base, **own}
        for name in NESTED & base.keys() & own.keys():
            if isinstance(base[name], Mapping) or isinstance(own[name], Mapping):
                found[name] = self.table(own[name], self.table(base[name], {}))
        return found

    def parameter(self, name: str, column: str, hint: Any) -> Param:
        """A placeholder, with what its values mean here."""
        choices = self._choices(name)
        if not column:
            return Param(name)
        decoded = [(value, self.decode(value, hint)) for value in self._column(name, column)]
        taken = (value if isinstance(value, int | float) else made for value, made in decoded)
        return Param(name, dict(zip(choices, taken, strict=True)))

    def text(self, told: str, name: str) -> Param:
        """A text with what a drawn value means in it."""
        made = {choice: self._put(told, name, choice) for choice in self._choices(name)}
        for column in {found[2] for found in WITH_COLUMN.finditer(told) if found[1] == name}:
            for choice, value in zip(made, self._column(name, column), strict=True):
                made[choice] = self._put(made[choice], f"{name}.{column}", value)
        return Param(name, made)

    def _put(self, told: str, name: str, value: Any) -> str:
        """A text with a value in the place of a name."""
        held, said = f"{{{name}}}", str(value)
        self._cost.add(len(told) + told.count(held) * len(said))
        return told.replace(held, said)

    def company(self) -> Param:
        """One to four adults, drawn."""
        self._parameters.setdefault("occupants", OCCUPANTS)
        return Param("occupants", {people: company(people) for people in OCCUPANTS})

    def topic(self, name: str) -> Any:
        known = {topic.name: topic for topic in self._topics}
        if name not in known:
            raise UnknownNameError("topic", name, known)
        return known[name]


_OF_HALF = (*(each.name for each in fields(Half) if each.name not in ("rule", "reasons")),)
_OF_TASK = tuple(
    each.name
    for each in fields(Task)
    if each.name not in ("id", "first", "second", "parameters", "spoken", "templates")
)
_KNOWN = ("templates", "parameters", "second", *_OF_TASK, *_OF_HALF, *FOREIGN)
"""The keys of a task's table."""


def _parted(told: str) -> tuple[str, str]:
    """``law: FR.rear_fog``: what it is, and the rest."""
    kind, _, rest = joined(told).partition(": ")
    return kind, rest
