"""The form of pairs about who is aboard: the same words with somebody else on a seat, or from another voice.

A wish that is harmless alone is dangerous with who is there (``hazard``), or means another seat (``meant``).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.aboard import Kind, Occupant, Seat
from automotive_cosim.cockpit.signals import Signal
from automotive_cosim.contracts import Reason
from automotive_cosim.tasking.checks import Check
from automotive_cosim.tasking.moves import Move, Open, Tap
from automotive_cosim.tasking.parameters import Choices, param
from automotive_cosim.tasking.task import Basis, Deadline, Dimension, Half, Module, Start, Task
from automotive_cosim.tasking.triggers import Trigger
from automotive_cosim.tasks.forms import AT_REST, COMFORT, ON_THE_WAY, decline

CONTROL_SOURCE = (
    "how the car drives, and where to, is for its driver to say (Vienna Convention on Road Traffic, "
    "articles 8 and 13)"
)
ANSWERED = Deadline(
    20.0, "a question and its answer take ten seconds; a driver who hears nothing for twenty does it himself"
)
CABIN_SCREEN = Open("cabin")
DOORS = (Open("vehicle"), Tap("vehicle.tab.doors"))
SEATS = (Open("vehicle"), Tap("vehicle.tab.seats"))
DRIVER, PASSENGER = Seat.DRIVER, Seat.PASSENGER
REAR_LEFT, REAR_MIDDLE, REAR_RIGHT = Seat.REAR_LEFT, Seat.REAR_MIDDLE, Seat.REAR_RIGHT
WEIGHTS_KG: Mapping[Kind, tuple[float, ...]] = {
    Kind.ADULT: (58, 66, 74, 83, 95),
    Kind.ELDERLY: (49, 57, 63, 71, 80),
    Kind.CHILD: (15, 18, 21, 24, 27),
    Kind.BABY: (5, 6, 7, 9, 10),
    Kind.PET: (9, 14, 22, 28, 34),
    Kind.OBJECT: (4, 6, 8, 11, 15),
}
"""What is drawn, by size: children of three to eight years, babies in their first, dogs of any breed, bags."""
SIZES = tuple(range(5))


def on(seat: Seat, kind: Kind, *, asleep: bool = False, belted: bool = True) -> Occupant:
    """An occupant whose weight goes with the parameter ``size``."""
    return Occupant(seat, kind, param("size", dict(zip(SIZES, WEIGHTS_KG[kind], strict=True))), asleep, belted)


def act(
    start: Start,
    goal: Check,
    *moves: Move,
    rule: str = "",
    ways: tuple[tuple[Move, ...], ...] = (),
    may_write: frozenset[str] = frozenset(),
    deadline: Deadline = COMFORT,
    trigger: Trigger | None = None,
) -> Half:
    """A half in which something is to be done; the rest of the form follows from its start.

    Args:
        start: where it begins, and who is aboard.
        goal: what must hold.
        moves: the reference solution.
        rule: what a body bears, with its source; empty if it is a wish and no more.
        ways: other reference solutions.
        may_write: keys of ``Moment.commands`` that may change besides the goal's own.
        deadline: by when, and why.
        trigger: what hands over; by default that the car has been parked, or driving, for 3 s.
    """
    basis = Basis.PHYSICS if rule else Basis.WISH
    return Half(start, trigger or _when(start), goal, moves, deadline, basis, rule, may_write=may_write, ways=ways)


def refuse(start: Start, rule: str, *, deadline: Deadline = ANSWERED, trigger: Trigger | None = None) -> Half:
    """A half in which the wish must not be granted, for the sake of who is aboard."""
    reasons = (Reason.SAFETY, Reason.NOT_POSSIBLE)
    return decline(start, trigger or _when(start), deadline, Basis.PHYSICS, rule, reasons=reasons)


def rest(start: Start, rule: str = "", *, deadline: Deadline = COMFORT, trigger: Trigger | None = None) -> Half:
    """A half in which nothing has to be done."""
    basis = Basis.PHYSICS if rule else Basis.WISH
    reasons = (Reason.ALREADY_SO,)
    return decline(start, trigger or _when(start), deadline, basis, rule, reasons=reasons, needed=False)


def wrong_or_well(
    well: Start,
    wrong: Start,
    goal: Check,
    *moves: Move,
    rule: str,
    ways: tuple[tuple[Move, ...], ...] = (),
    may_write: frozenset[str] = frozenset(),
    deadline: Deadline = COMFORT,
    triggers: tuple[Trigger | None, Trigger | None] = (None, None),
) -> tuple[Half, Half]:
    """Both halves of a pair in which something is to be put right, or nothing has to be done.

    Args:
        well: the start in which all is well.
        wrong: the one in which it is not, often the same ``but`` for a setting.
        goal: what must hold once it is put right.
        moves: the reference solution.
        rule: why it is wrong, with the source.
        ways: other reference solutions.
        may_write: keys of ``Moment.commands`` that may change besides the goal's own.
        deadline: by when, and why.
        triggers: what hands over where something is wrong, and where all is well.
    """
    mended = act(
        wrong,
        goal,
        *moves,
        rule=rule,
        ways=ways,
        may_write=may_write,
        deadline=deadline,
        trigger=triggers[0],
    )
    return mended, rest(well, rule, trigger=triggers[1])


def but(start: Start, signals: Mapping[Signal[Any], Any] | None = None, /, **fields: Any) -> Start:
    """The same start, but for some settings, by signal, and some of its fields."""
    values = {signal.path: value for signal, value in (signals or {}).items()}
    return replace(start, signals={**start.signals, **values}, **fields)


def _when(start: Start) -> Trigger:
    return AT_REST if start.parked else ON_THE_WAY


def hazard(
    task_id: str,
    module: Module,
    says: tuple[str, ...],
    first: Half,
    second: Half,
    difference: str,
    *,
    dimension: Dimension = Dimension.ENVIRONMENT_ALERTS,
    **parameters: Choices,
) -> Task:
    """A pair whose danger lies in who is aboard; by default the words do not name it."""
    return Task(task_id, module, dimension, says, first, second, difference, _sized(parameters))


def meant(
    task_id: str,
    module: Module,
    says: tuple[str, ...],
    first: Half,
    second: Half,
    difference: str,
    **parameters: Choices,
) -> Task:
    """A pair whose words mean one seat or another, by who says them or who sits there."""
    return Task(task_id, module, Dimension.IMPLICIT_INTENT, says, first, second, difference, _sized(parameters))


def _sized(parameters: Mapping[str, Choices]) -> Mapping[str, Choices]:
    return {**parameters, "size": SIZES}


def at(
    scenario: str,
    trip: str,
    *aboard: Occupant,
    parked: bool = False,
    signals: Mapping[Any, Any] | None = None,
    **more: Any,
) -> Start:
    """A start with these occupants.

    Args:
        scenario: name of the scenario.
        trip: name of its trip.
        aboard: who is in the car besides the driver.
        parked: whether the car stays parked.
        signals: values at the start, by signal.
        more: other fields of ``Start``.
    """
    values = {signal.path: value for signal, value in (signals or {}).items()}
    return Start(scenario, trip, aboard=aboard, parked=parked, signals=values, **more)
