"""The tracker: folds the moments of a drive into events."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.events.base import EventKind, Sighting

CLOSE_S = 3.0
"""Out of sight for longer, an event has ended: a flickering reading is one event."""
REOPEN_S = 30.0
"""The same subject again within this time is the same event."""
SELF_ENDED_S = 1.5
"""An event that was over earlier than this before its deadline had passed by itself: a tick and a half."""


@dataclass(slots=True)
class DriveEvent:
    """One event of a drive; all times are simulation times. It grows while it lasts."""

    kind: str
    subject: str
    words: str
    lookalike: bool
    weight: float
    observable_s: float
    last_s: float
    """The last instant at which it was there."""
    value: float | None = None
    due_since_s: float | None = None
    """Since when something is due without interruption; None while nothing is."""
    due_until_s: float | None = None
    """The last instant at which something was due; of an event that had passed by itself before its deadline, and
    came again, the last one before."""
    obliged_s: float | None = None
    deadline_s: float | None = None
    done_s: float | None = None
    """Since when what was asked for is done, of a kind that is judged by the state."""
    eased_s: float | None = None
    """Since when it only looks like one, e.g. a limit that the car keeps by now; None while it does not."""
    ended: bool = False
    severities: list[tuple[float, float]] = field(default_factory=list)
    """Instants at which it became worse, and how bad."""

    @property
    def ended_early(self) -> bool:
        """Whether nothing was due any more well before the deadline."""
        return self.deadline_s is not None and (self.due_until_s or 0.0) < self.deadline_s - SELF_ENDED_S

    def severity_at(self, time_s: float) -> float:
        """How bad it had been at the worst, up to that time."""
        return max((severity for at_s, severity in self.severities if at_s <= time_s), default=0.0)


class Tracker:
    """Finds the events of one drive as it goes."""

    def __init__(self, kinds: Mapping[str, EventKind]) -> None:
        self._latest: list[tuple[EventKind, dict[tuple[str, bool], DriveEvent]]] = [
            (kind, {}) for kind in kinds.values()
        ]
        """Of each kind, by subject and whether it only looks like one."""
        self.events: list[DriveEvent] = []
        """All events so far, by the instant at which they became observable."""

    def see(self, drive: Sequence[Moment]) -> tuple[DriveEvent, ...]:
        """Takes the last moment of a drive, and returns the events that became observable at it."""
        now_s = drive[-1].time_s
        opened = []
        for kind, latest in self._latest:
            sights = tuple(kind.sight(drive))
            if not latest and not sights:
                continue
            seen = {(sighting.subject, sighting.lookalike): sighting for sighting in sights}
            for key, sighting in seen.items():
                event = latest.get(key)
                if event is None or (event.ended and now_s - event.last_s > REOPEN_S):
                    event = latest[key] = self._open(kind, sighting, now_s)
                    opened.append(event)
                self._update(event, kind, sighting, now_s)
            for key, event in latest.items():
                if not event.ended and key not in seen:
                    event.due_since_s = None
                    if (key[0], True) in seen:
                        event.eased_s = now_s
                    event.ended = now_s - event.last_s > CLOSE_S
        return tuple(opened)

    def _open(self, kind: EventKind, sighting: Sighting, now_s: float) -> DriveEvent:
        event = DriveEvent(
            kind=kind.name,
            subject=sighting.subject,
            words=sighting.words,
            lookalike=sighting.lookalike,
            weight=kind.weight,
            observable_s=now_s,
            last_s=now_s,
            value=sighting.value,
        )
        self.events.append(event)
        return event

    def _update(self, event: DriveEvent, kind: EventKind, sighting: Sighting, now_s: float) -> None:
        event.last_s, event.ended, event.eased_s = now_s, False, None
        if sighting.severity > event.severity_at(now_s):
            event.severities.append((now_s, sighting.severity))
        if event.done_s is None:
            event.done_s = sighting.done_s
        if not sighting.due or sighting.lookalike or event.done_s is not None:
            event.due_since_s = None
            return
        if event.deadline_s is None or now_s <= event.deadline_s or not event.ended_early:
            event.due_until_s = now_s
        event.due_since_s = now_s if event.due_since_s is None else event.due_since_s
        if event.obliged_s is None and now_s - event.due_since_s >= sighting.hold_s:
            event.obliged_s = now_s
            event.deadline_s = now_s + (kind.grace_s if sighting.left_s is None else max(0.0, sighting.left_s))
            event.words = sighting.words
