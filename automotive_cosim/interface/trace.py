"""The trace: what an episode was, step by step, in canonical bytes.

A line of ``steps.jsonl`` is one step. The hash covers each step's traffic, signals, elements and action, and
nothing that differs between machines, folders or runs: no wall time, no path, no version.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass, fields, is_dataclass
from functools import cache
from typing import Any

from automotive_cosim.cockpit.actions import to_json
from automotive_cosim.contracts import Action, Element, Feedback, Json
from automotive_cosim.cosim.moment import Moment

HASHED = ("traffic", "signals", "elements", "action")


@dataclass(frozen=True, slots=True)
class Step:
    """One step: the state that followed an action. The first has no action: it is the hand-over."""

    number: int
    moment: Moment
    elements: tuple[Element, ...]
    action: Action | None
    feedback: Feedback

    def as_json(self) -> Json:
        """The step as a JSON object, for ``steps.jsonl``."""
        moment = self.moment
        return {
            "step": self.number,
            "time_s": moment.time_s,
            "local_time": moment.local_time.isoformat(),
            "traffic": plain(moment.driving),
            "signals": dict(moment.signals),
            "elements": [plain(element) for element in self.elements],
            "action": None if self.action is None else to_json(self.action),
            "feedback": plain(self.feedback),
            "weather": plain(moment.weather),
            "gps": plain(moment.gps),
            "connectivity": plain(moment.connectivity),
            "context": moment.context.text(),
            "events": [plain(event) for event in moment.events],
        }


def plain(value: Any) -> Any:
    """Frozen data as JSON has it. As ``dataclasses.asdict``, which is ten times slower because it copies leaves."""
    if is_dataclass(value) and not isinstance(value, type):
        names = _names(type(value))
        return {name: plain(getattr(value, name)) for name in names}
    if isinstance(value, tuple | list):
        return [plain(entry) for entry in value]
    return value


@cache
def _names(kind: type) -> tuple[str, ...]:
    return tuple(field.name for field in fields(kind))


def canonical(value: Any) -> bytes:
    """JSON with sorted keys, no blanks, UTF-8; NaN and infinity are refused."""
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    return text.encode()


def sha256(steps: list[Json]) -> str:
    """The trace's hash over what ``HASHED`` names of every step, as a hexadecimal string."""
    digest = hashlib.sha256()
    for step in steps:
        digest.update(canonical({name: step[name] for name in HASHED}))
        digest.update(b"\n")
    return digest.hexdigest()
