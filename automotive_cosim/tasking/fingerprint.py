"""Tells whether a half of a task is still the one that something on record is about."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from enum import Enum
from hashlib import blake2b
from typing import Any

from automotive_cosim.tasking.task import Task


def fingerprint(task: Task, half: str) -> str:
    """A short digest of a half of a task: what is said, where, and what is right; not how it is solved.

    Whoever keeps a result keeps it beside, so that it can be told later whether the half is still the same.
    """
    tried = task.half(half)
    parts = (
        task.templates,
        task.parameters,
        *(getattr(tried, name) for name in ("start", "trigger", "goal", "declares", "may_write", "topics")),
        tried.deadline.seconds,
        tried.tells,
        tried.says,
    )
    return blake2b(repr(_plain(parts)).encode(), digest_size=8).hexdigest()


def _plain(value: Any) -> Any:
    """The same, in an order and a form that do not change from run to run."""
    if isinstance(value, Enum | str | int | float | None):
        return str(value)
    if isinstance(value, type):
        return value.__name__
    if is_dataclass(value):
        own = [(each.name, _plain(getattr(value, each.name))) for each in fields(value) if each.compare]
        return [type(value).__name__, *own]
    if isinstance(value, Mapping):
        return sorted((str(key), _plain(each)) for key, each in value.items())
    if isinstance(value, frozenset | set):
        return sorted(map(str, map(_plain, value)))
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    raise TypeError(f"{value!r} has no plain form")
