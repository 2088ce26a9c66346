"""The trace of an episode, step by step, in canonical bytes.

A line of ``steps.jsonl`` is one step. The hash covers each step's traffic, signals, elements and action, and
nothing that differs between machines, folders or runs: no wall time, no path, no version.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields, is_dataclass
from functools import cache, lru_cache
from typing import Any, NamedTuple

from automotive_cosim.cockpit.actions import to_json
from automotive_cosim.contracts import Action, BoundingBox, Element, Feedback, Json
from automotive_cosim.contracts.plain import RARE, UNTRACED
from automotive_cosim.cosim.moment import Moment

STATES = ("traffic", "signals", "elements")
HASHED = (*STATES, "action")
SAID = "said"
"""Also in the hash, of a step in which the driver said something."""
SELDOM = (SAID, "awareness", "heard", "cabin_db")
"""Fields of a step that it has only where there is something to say."""


@dataclass(frozen=True, slots=True)
class Step:
    """One step: the state that followed an action. The first has no action: it is the hand-over."""

    number: int
    moment: Moment
    elements: Sequence[Element]
    action: Action | None
    feedback: Feedback
    thought_s: float = 0.0
    """Simulated seconds that the agent took to answer, before the action."""
    said: tuple[str, ...] = ()
    """What the driver said meanwhile."""
    heard: tuple[str, ...] | None = None
    """What of it reached the agent, the wish included; None where words are text."""
    cabin_db: float | None = None
    """How loud the cabin is, dB(A); None as above."""

    @property
    def state(self) -> Json:
        """What followed, as far as the hash covers it."""
        return {
            "traffic": plain(self.moment.driving),
            "signals": dict(self.moment.signals),
            "elements": [plain(element) for element in self.elements],
        }

    def as_json(self) -> Json:
        """The step as a JSON object, for ``steps.jsonl``."""
        moment = self.moment
        return {
            "step": self.number,
            "time_s": moment.time_s,
            "local_time": moment.local_time.isoformat(),
            **self.state,
            "action": None if self.action is None else to_json(self.action),
            "feedback": plain(self.feedback),
            "thought_s": self.thought_s,
            "weather": plain(moment.weather),
            "gps": plain(moment.gps),
            "connectivity": plain(moment.connectivity),
            "context": moment.context.text(),
            "events": [plain(event) for event in moment.events],
        } | {
            name: value
            for name, value in zip(
                SELDOM, (list(self.said), moment.awareness, list(self.heard or ()), self.cabin_db), strict=True
            )
            if value not in ([], None)
        }


def digests(step: Json) -> Json:
    """A short hash of each part of a step's state, so that a replay can say what differs."""
    return {name: hashlib.sha256(canonical(step[name])).hexdigest()[:16] for name in STATES}


def element(entry: Json) -> Element:
    """An element from its form in a trace."""
    given: dict[str, Any] = entry | {"bbox_pixels": BoundingBox(**entry["bbox_pixels"])}
    return Element(**given)


class Hash:
    """The trace's hash, updated step by step, so the end of a long episode need not wait for it."""

    def __init__(self, steps: Iterable[Step] = ()) -> None:
        self._digest = hashlib.sha256()
        self.count = 0
        """Number of steps taken in so far."""
        for step in steps:
            self.add(step)

    def add(self, step: Step) -> None:
        texts = {
            "traffic": _text(plain(step.moment.driving)),
            "signals": _text(dict(step.moment.signals)),
            "elements": f"[{','.join(map(_element, step.elements))}]",
            "action": _text(None if step.action is None else to_json(step.action)),
        }
        if step.said:
            texts[SAID] = _text(list(step.said))
        whole = ",".join(f'"{name}":{texts[name]}' for name in sorted(texts))
        self._digest.update(f"{{{whole}}}\n".encode())
        self.count += 1

    @property
    def hex(self) -> str:
        """Of the steps so far; what ``sha256`` gives for their JSON."""
        return self._digest.hexdigest()

    def copy(self) -> Hash:
        twin = Hash()
        twin._digest, twin.count = self._digest.copy(), self.count
        return twin


_LEAVES = frozenset((str, int, float, bool, type(None)))


def plain(value: Any) -> Any:
    """Frozen data as JSON. Like ``dataclasses.asdict``, which is ten times slower because it copies leaves."""
    kind: type = type(value)
    if kind in _LEAVES:
        return value
    names = _names(kind)
    if names is not None:
        made = {name: plain(getattr(value, name)) for name in names.every}
        for name in names.rare:
            if made[name] is None:
                del made[name]
        return made
    if isinstance(value, tuple | list):
        return [plain(entry) for entry in value]
    return value


class _Names(NamedTuple):
    every: tuple[str, ...]
    rare: tuple[str, ...]


@cache
def _names(kind: type) -> _Names | None:
    """The fields of a dataclass; None of any other class."""
    if not is_dataclass(kind):
        return None
    rare = tuple(field.name for field in fields(kind) if field.metadata == RARE)
    return _Names(tuple(field.name for field in fields(kind) if field.metadata != UNTRACED), rare)


_ENCODER = json.JSONEncoder(sort_keys=True, separators=(",", ":"), ensure_ascii=False, allow_nan=False)


def _text(value: Any) -> str:
    return _ENCODER.encode(value)


@lru_cache(maxsize=4096)
def _element(element: Element) -> str:
    """An element as JSON, cached: most of a screen is the same from step to step and episode to episode."""
    return _text(plain(element))


def canonical(value: Any) -> bytes:
    """JSON with sorted keys, without spaces, in UTF-8; NaN and infinity are refused."""
    return _text(value).encode()


def sha256(steps: list[Json]) -> str:
    """The trace's hash over the parts in ``HASHED`` of every step, and ``SAID``, as a hexadecimal string."""
    digest = hashlib.sha256()
    for step in steps:
        digest.update(canonical({name: step[name] for name in (*HASHED, SAID) if name in step}))
        digest.update(b"\n")
    return digest.hexdigest()
