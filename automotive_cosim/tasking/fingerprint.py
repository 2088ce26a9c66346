"""Short digests by which it is known whether something on record is still about the same half of a task.

They are made of what a half says, and leave out what stands at its default: they outlast a change of code.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, Field, fields, is_dataclass
from enum import Enum
from hashlib import blake2b
from typing import Any

from automotive_cosim.tasking.task import Half, Task

WORDED = frozenset({"condition", "goal"})
"""Fields whose classes say in words what they ask for."""


def fingerprint(task: Task, half: str) -> str:
    """Digest of a half: what is said, where, and what is right; not how it is solved, nor why."""
    tried = task.half(half)
    asked = ("declares", "may_write", "topics", "tells", "most_words", "says")
    right = [str(tried.goal), tried.deadline.seconds, *(getattr(tried, name) for name in asked)]
    return _digest([task.templates, task.parameters, tried.start, tried.trigger, right])


def situation(half: Half) -> str:
    """Digest of where a half begins, and of its trigger."""
    return _digest([half.start, half.trigger])


def _digest(value: Any) -> str:
    return blake2b(repr(_plain(value)).encode(), digest_size=8).hexdigest()


def _plain(value: Any) -> Any:
    """The same, in an order and a form that do not change from run to run."""
    if isinstance(value, Enum | str | bool | None):
        return str(value)
    if isinstance(value, int | float):
        return f"{value:.12g}"
    if is_dataclass(value):
        own = [(each.name, getattr(value, each.name)) for each in fields(value) if each.compare]
        defaults = {each.name: _default(each) for each in fields(value)}
        told = [(name, each) for name, each in own if each != defaults[name]]
        return [(name, str(each) if name in WORDED else _plain(each)) for name, each in told]
    if isinstance(value, Mapping):
        return sorted((str(key), _plain(each)) for key, each in value.items())
    if isinstance(value, frozenset | set):
        return sorted(map(str, map(_plain, value)))
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    raise TypeError(f"{value!r} has no plain form")


def _default(field: Field[Any]) -> Any:
    return field.default_factory() if field.default_factory is not MISSING else field.default
