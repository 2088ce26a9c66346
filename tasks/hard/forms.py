"""The forms of the hard suite: what is there to be read, and halves with the mistakes that are usually made."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.apps.phone.state import EARLIER, Contact, Thread
from automotive_cosim.cockpit.belongings import Belongings
from automotive_cosim.contracts import Action, ActionType
from automotive_cosim.tasking.checks import Check, Entered
from automotive_cosim.tasking.moves import Do, Move, Open, Tap
from automotive_cosim.tasking.parameters import Choices
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasking.task import Ability, Basis, Deadline, Dimension, Half, Module, Start, Task
from automotive_cosim.tasking.triggers import Driving, Trigger
from automotive_cosim.tasks.forms import AT_REST, NO_PARAMETERS

PARKED = Start("paris_centre", "centre", parked=True)
ON_THE_ROAD = Start("paris_centre", "centre")
UNDER_WAY = Trigger(Driving(), for_s=3.0, within_s=60.0)
Moves = tuple[Move, ...]
READ = frozenset({"messages.read"})
"""What opening a message writes."""
BEFORE_LEAVING = Deadline(
    90.0, "at 2.5 s a tap (Card, Moran and Newell 1983) a person is through; then he drives off"
)
AS_A_PASSENGER = Deadline(
    100.0, "a passenger would have looked, and done it, in a minute and a half; then the next turn needs him"
)
A_RED_LIGHT = Deadline(60.0, "a phase of the lights: who has to move on by then has it done within a minute")
THE_OTHER_WAITS = Deadline(75.0, "who waits for an answer on the phone gives it a minute and a quarter")
ISLA, MALIK, WANDA, OSKAR = "Isla Brook", "Malik Osei", "Wanda Reyes", "Oskar Lindt"
PRIYA, THEO, BEA, YUSUF = "Priya Nair", "Theo Vance", "Bea Whitby", "Yusuf Demir"
SCHOOL = "School Office"
NUMBERS = {
    ISLA: "555 31 40",
    MALIK: "555 62 18",
    WANDA: "555 07 93",
    OSKAR: "555 84 26",
    PRIYA: "555 45 71",
    THEO: "555 90 52",
    BEA: "555 16 67",
    YUSUF: "555 28 09",
    SCHOOL: "555 11 20",
}
"""People whom the drawn phone books never hold."""


def knowing(*names: str) -> tuple[Contact, ...]:
    """These people in the phone book, and first among the favourites."""
    return tuple(Contact(name, NUMBERS[name]) for name in names)


def wrote(who: str, *lines: Any) -> Thread:
    """An unread thread; a line may be a parameter."""
    return Thread(who, EARLIER, lines, unread=True)


def with_papers(start: Start, **papers: Any) -> Start:
    """The start with these belongings (``Belongings``)."""
    return replace(start, belongings=replace(start.belongings, **papers))


def with_letter(start: Start, who: str, *lines: Any, **papers: Any) -> Start:
    """The start with somebody known who has written."""
    contacts = papers.pop("contacts", knowing(who))
    return replace(start, belongings=Belongings(contacts, (wrote(who, *lines),), **papers))


def answer(who: str, text: Any) -> Moves:
    """Sends a reply to a favourite."""
    return (*write_to(who), Tap(text=text))


def told(to: str, text: Any) -> Entered:
    """That one message was sent."""
    return Entered("messages.sent", {"to": to, "text": text})


def wait(seconds: int) -> Moves:
    """Waits, at most ten seconds at a time."""
    return tuple(Do(Action(ActionType.WAIT, seconds=min(10, seconds - past))) for past in range(0, seconds, 10))


def letter(who: str) -> Moves:
    """Opens what somebody has written; while driving it is read out."""
    return (Open("phone"), Tap("phone.tab.messages"), Tap(text=who), Tap("thread.read"))


def write_to(who: str) -> Moves:
    """Opens the thread of a favourite."""
    return (Open("phone"), Tap("phone.tab.favourites"), Tap(text=who), Tap("contact.message"))


def figure(who: str, sentence: str, *taps: Move) -> Moves:
    """Sends a message with a figure that these taps set."""
    return (*write_to(who), Tap("thread.figure"), Tap(f"figure.say.{sentence}"), *taps, Tap("figure.send"))


def done(
    start: Start,
    goal: Check,
    moves: Moves,
    *,
    slips: tuple[Moves, ...] = (),
    ways: tuple[Moves, ...] = (),
    may_write: frozenset[str] = READ,
    deadline: Deadline = BEFORE_LEAVING,
    trigger: Trigger | None = None,
) -> Half:
    """A half in which the wish is carried out."""
    trigger = trigger or (AT_REST if start.parked else UNDER_WAY)
    return Half(start, trigger, goal, moves, deadline, Basis.WISH, may_write=may_write, ways=ways, slips=slips)


def hard(
    task_id: str,
    module: Module,
    says: tuple[str, ...],
    first: Half,
    second: Half | None = None,
    difference: str = "",
    *,
    parameters: Mapping[str, Choices] = NO_PARAMETERS,
    tags: frozenset[str] = frozenset(),
    dimension: Dimension = Dimension.EXPLICIT_CONTROL,
    only_english: str = "",
    ability: Ability,
    guess_loses: str,
) -> Task:
    """A task of the hard suite: what it is hard by, and why a guess loses, come last."""
    return Task(
        task_id,
        module,
        dimension,
        says,
        first,
        second,
        difference,
        parameters=parameters,
        tags=tags,
        suite=Suite.HARD,
        only_english=only_english,
        ability=ability,
        guess_loses=guess_loses,
    )
