"""What went wrong on a judged drive, one by one: what was missed, late, of the agent's own making, or needless."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from automotive_cosim.contracts.plain import clock
from automotive_cosim.drives.events import KINDS
from automotive_cosim.drives.judge import EARLY_S, EventOutcome, JudgedAct, JudgedEvent, Worth

ACTS = {
    Worth.FALSE: "false alarm",
    Worth.WRONG: "false alarm while something else was due",
    Worth.LOOKALIKE: "look-alike taken for an event",
    Worth.REPEAT: "needless repeat",
}
"""What a charged act was, in words."""
NEAR_S = 120.0
"""An alert this long before a warning would hold, or after the end, was still meant for what it tells of: two
minutes, which is our choice."""


@dataclass(frozen=True, slots=True)
class Fault:
    """Something that cost points."""

    time_s: float
    """When something became due, or when the agent acted: seconds since departure."""
    what: str
    """``missed``, ``late``, ``caused``, ``evaded``, or what a needless act was."""
    about: str
    """The kind of event, or the act, in words."""
    why: str
    """The fact, from when to when something was due, and what came; or what speaks against the act."""
    kind: str = ""
    """The kind of event; empty for an act."""

    @property
    def line(self) -> str:
        return f"{clock(self.time_s)} {self.what}: {self.about}" + (f" ({self.why})" if self.why else "")


def faults(events: Iterable[JudgedEvent], acts: Iterable[JudgedAct]) -> list[Fault]:
    """All of a drive, in order of time.

    Args:
        events: its events, with times since departure.
    """
    events, acts = tuple(events), tuple(acts)
    found = [_of_event(event, acts) for event in events if _is_lost(event)]
    found += [
        Fault(act.time_s, ACTS[act.worth], act.words, _joined(act.reason, *beside(act, events)))
        for act in acts
        if act.worth.is_nuisance
    ]
    return sorted(found, key=lambda fault: (fault.time_s, fault.about))


OUTCOMES = {
    EventOutcome.HIT: "met in time",
    EventOutcome.PREPARED: "met ahead of time",
    EventOutcome.LATE: "too late",
    EventOutcome.CAUSED: "missed: its own doing",
    EventOutcome.EVADED: "missed: the car was held back",
    EventOutcome.VOID: "nothing was due",
    EventOutcome.AVOIDED: "rightly left alone",
    EventOutcome.TAKEN: "false alarm",
}
"""Outcomes in plain words; the others say it by their name."""
WHY_VOID = "it needed no act, passed by itself, or came too suddenly for anybody"
"""Why nothing was due."""


def key_of(events: Sequence[JudgedEvent]) -> str:
    """What the outcomes of these events mean: ``late, too late; avoided, rightly left alone``."""
    found = {event.outcome for event in events}
    told = OUTCOMES | {EventOutcome.VOID: f"{OUTCOMES[EventOutcome.VOID]} ({WHY_VOID})"}
    return "; ".join(f"{one}, {words}" for one, words in told.items() if one in found)


def became(event: JudgedEvent, acts: Sequence[JudgedAct]) -> str:
    """What became of an event, in words; of one that was lost also when something was due, and what came when.

    Args:
        event: the event, with times since departure.
        acts: the acts of its drive, likewise.
    """
    return _joined(str(event.outcome), *times(event, acts))


def was(act: JudgedAct, events: Sequence[JudgedEvent]) -> str:
    """What an act was, in words; of a needless one also what speaks against it, and what was near.

    Args:
        act: the act, with its time since departure.
        events: the events of its drive, likewise.
    """
    reasons = _joined(act.reason, *beside(act, events))
    return f"{act.worth}: {reasons}" if reasons else str(act.worth)


def _is_lost(event: JudgedEvent) -> bool:
    return event.outcome.counts and not event.outcome.is_credited


def _joined(*parts: str) -> str:
    return "; ".join(filter(None, parts))


def _of_event(event: JudgedEvent, acts: Sequence[JudgedAct]) -> Fault:
    told = [event.words, f"to be known from {clock(event.observable_s)}", *times(event, acts)]
    kind = KINDS.get(event.kind)
    if event.outcome is EventOutcome.MISSED and kind is not None and kind.alerts:
        *others, last = (alert.replace("_", " ") for alert in sorted(kind.alerts))
        told.append(f"right: an alert of {', '.join(others)}{' or ' if others else ''}{last}")
    return Fault(_due_s(event), str(event.outcome), event.kind.replace("_", " "), _joined(*told), event.kind)


def _due_s(event: JudgedEvent) -> float:
    return event.observable_s if event.obliged_s is None else event.obliged_s


def times(event: JudgedEvent, acts: Sequence[JudgedAct]) -> list[str]:
    """Of an event that was lost: from when to when something was due, and what came too early or too late, or did
    away with it; nothing of others. Arguments as of ``became``."""
    if not _is_lost(event):
        return []
    due_s, deadline_s = _due_s(event), event.deadline_s
    told = [f"due from {clock(due_s)}" + ("" if deadline_s is None else f" to {clock(deadline_s)}")]
    if event.outcome is EventOutcome.CAUSED:
        told.append("the agent had brought it about with its own switch")
    elif event.outcome is EventOutcome.EVADED:
        told.append("it did not arise because the agent held the car back for no reason")
    elif event.acted_s is not None and deadline_s is not None:
        told.append(f"acted at {clock(event.acted_s)}, {event.acted_s - deadline_s:.0f} s too late")
    else:
        told.append(_warned(event, acts))
    return told


def _warned(event: JudgedEvent, acts: Sequence[JudgedAct]) -> str:
    """Which warning of its kind came nearest, before it was due or after its deadline."""
    due_s, deadline_s, kind = _due_s(event), event.deadline_s, KINDS.get(event.kind)
    lasts_s = 0.0 if kind is None else kind.lasts_s
    from_s, to_s = due_s - lasts_s - NEAR_S, event.ends_s + NEAR_S
    warned_s = [act.time_s for act in acts if event.kind in _meant(act) and from_s <= act.time_s <= to_s]
    before_s = max((time_s for time_s in warned_s if time_s < due_s), default=None)
    if before_s is not None:
        unseen = before_s < event.observable_s - EARLY_S
        why = "before it could be known" if unseen else f"a warning holds for {lasts_s:.0f} s"
        return f"warned {due_s - before_s:.0f} s before, too early ({why})"
    after_s = min((time_s for time_s in warned_s if deadline_s is not None and time_s > deadline_s), default=None)
    if after_s is not None and deadline_s is not None:
        return f"warned {after_s - deadline_s:.0f} s after the deadline"
    return "nothing came"


def beside(act: JudgedAct, events: Sequence[JudgedEvent]) -> list[str]:
    """Of a false alarm: what it would have been right for, and how long before or after; and what was due instead.

    Args:
        act: the act, with its time since departure.
        events: the events of its drive, likewise.
    """
    if act.worth not in (Worth.FALSE, Worth.WRONG):
        return []
    told = []
    real = [event for event in events if not event.lookalike]
    meant = [event for event in real if event.kind in _meant(act)]
    nearest = min(meant, key=lambda event: _away_s(act.time_s, event), default=None)
    if nearest is not None and 0 < (away_s := _away_s(act.time_s, nearest)) <= NEAR_S:
        name = nearest.kind.replace("_", " ")
        if act.time_s < nearest.observable_s:
            told.append(f"{away_s:.0f} s before {name} could be known, at {clock(nearest.observable_s)}")
        else:
            told.append(f"{away_s:.0f} s after the end of {name}, at {clock(nearest.ends_s)}")
    if act.worth is Worth.WRONG:
        due = [event for event in real if event.obliged_s is not None and event.kind not in _meant(act)]
        now = [event for event in due if _due_s(event) <= act.time_s <= event.ends_s and event.outcome.counts]
        told += [f"due was {event.kind.replace('_', ' ')}, from {clock(_due_s(event))}" for event in now[:1]]
    return told


def _away_s(time_s: float, event: JudgedEvent) -> float:
    """How far a time lies outside of an event."""
    return max(event.observable_s - time_s, time_s - event.ends_s, 0.0)


def _meant(act: JudgedAct) -> set[str]:
    """The kinds of events that an act tells of: those that its alert settles, and the one that it was about."""
    alert = re.match(r"alert (\w+)", act.words)
    kinds = {name for name, kind in KINDS.items() if alert is not None and alert[1] in kind.alerts}
    return kinds | ({act.about} if act.about else set())
