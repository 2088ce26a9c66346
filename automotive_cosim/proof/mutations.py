"""Wrong end states derived from a right one, which a judge must not accept."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

from automotive_cosim.cockpit.signals import ACTUATORS, Signal, named
from automotive_cosim.contracts import Hazards, PullOver, RoadRequest
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.tasking.checks import Check, NamedCheck
from automotive_cosim.tasking.effects import EFFECTS
from automotive_cosim.tasking.task import Half

SIBLINGS = (("Driver", "Passenger"), ("Front", "Rear"), ("Left", "Right"), ("Row1", "Row2"), ("Low", "High"))
"""Words of signal paths that are swapped: the other seat, window, side, row or beam."""


def undone(first: Moment, moments: Sequence[Moment], half: Half) -> tuple[Moment, ...]:
    """The end state with the goal's own writes reverted."""
    values = {key: first.commands[key] for key in half.goal.writes if key in first.commands}
    return put(moments, values)


def near_misses(first: Moment, moments: Sequence[Moment], half: Half) -> Iterator[tuple[str, tuple[Moment, ...]]]:
    """End states with the goal's change in another place, in the wrong direction, or with another value."""
    end = moments[-1]
    writes = half.goal.writes
    for key in sorted(writes):
        before, after = first.commands.get(key), end.commands.get(key)
        if before == after or key in _by_effect(half.goal):
            continue
        if key in ACTUATORS:
            for sibling in _siblings(key):
                if sibling not in writes:
                    yield f"{sibling} in place of {key}", put(moments, {key: before, sibling: after})
            other = _wrong_way(named(key), before, after)
            if other is not None:
                yield f"{key} {other}", put(moments, {key: other})
        elif isinstance(after, str) and after:
            yield f"{key} something else", put(moments, {key: f"another {after}"})
        elif isinstance(after, list) and after:
            other = _another(after[-1])
            wrong = [*after, after[-1]] if other is None else [*after[:-1], other]
            yield f"{key} something else", put(moments, {key: wrong})


def put(moments: Sequence[Moment], values: Mapping[str, Any]) -> tuple[Moment, ...]:
    """The moments, with other values in the last one."""
    end = moments[-1]
    signals = {path: value for path, value in values.items() if path in end.signals}
    last = replace(end, commands={**end.commands, **values}, signals={**end.signals, **signals})
    return (*moments[:-1], last)


def _by_effect(goal: Check) -> frozenset[str]:
    """The commands of which only the effect counts: another one that has it is no miss."""
    if isinstance(goal, NamedCheck) and goal.name in EFFECTS:
        return goal.writes
    return frozenset().union(*map(_by_effect, getattr(goal, "checks", ())))


def _another(entry: Any) -> Any:
    """A different entry of a list; None if none is known."""
    if isinstance(entry, str):
        return f"another {entry}"
    if isinstance(entry, RoadRequest):
        return Hazards(on=True) if isinstance(entry, PullOver) else PullOver()
    return None


def _siblings(path: str) -> Iterator[str]:
    for one, other in SIBLINGS:
        for word, instead in ((one, other), (other, one)):
            sibling = path.replace(word, instead)
            if sibling != path and sibling in ACTUATORS and _same_kind(named(sibling), named(path)):
                yield sibling


def _same_kind(one: Signal[Any], other: Signal[Any]) -> bool:
    return (type(one.default), one.minimum, one.maximum, one.allowed) == (
        type(other.default),
        other.minimum,
        other.maximum,
        other.allowed,
    )


def _wrong_way(signal: Signal[Any], before: Any, after: Any) -> Any:
    """A number moved in the other direction; None if there is none."""
    if isinstance(before, bool) or not isinstance(before, float):
        return None
    moved = before - signal.step if after > before else before + signal.step
    return moved if signal.low <= moved <= signal.high else None


def another_value(signal: Signal[Any], value: Any) -> Any:
    """Another value that the signal can have."""
    if isinstance(value, bool):
        return not value
    if signal.allowed:
        return next(other for other in signal.allowed if other != value)
    if isinstance(value, str):
        return f"another {value}"
    return value + signal.step if value + signal.step <= signal.high else value - signal.step
