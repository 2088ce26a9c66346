"""What went wrong on a judged drive, one by one: what was missed, late, of the agent's own making, or needless."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from automotive_cosim.drives.events import KINDS
from automotive_cosim.drives.judge import EventOutcome, JudgedAct, JudgedEvent, Worth

ACTS = {
    Worth.FALSE: "false alarm",
    Worth.WRONG: "false alarm while something else was due",
    Worth.LOOKALIKE: "look-alike taken for an event",
    Worth.REPEAT: "needless repeat",
}
"""What a charged act was, in words."""


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
    """The fact, and until when there was time; or what speaks against the act."""

    @property
    def line(self) -> str:
        """All in a line."""
        return f"{clock(self.time_s)} {self.what}: {self.about}" + (f" ({self.why})" if self.why else "")


def faults(events: Iterable[JudgedEvent], acts: Iterable[JudgedAct]) -> list[Fault]:
    """All of a drive, in order of time.

    Args:
        events: its events, with times since departure.
        acts: its acts, likewise.
    """
    found = [_of_event(event) for event in events if event.outcome.counts and not event.outcome.is_credited]
    found += [Fault(act.time_s, ACTS[act.worth], act.words, act.reason) for act in acts if act.worth.is_nuisance]
    return sorted(found, key=lambda fault: (fault.time_s, fault.about))


def clock(time_s: float) -> str:
    """Minutes and seconds since departure, as ``3:05``."""
    return f"{int(time_s) // 60}:{int(time_s) % 60:02d}"


def _of_event(event: JudgedEvent) -> Fault:
    due_s = event.observable_s if event.obliged_s is None else event.obliged_s
    told = [event.words, f"to be known from {clock(event.observable_s)}"]
    if event.deadline_s is not None:
        told.append(f"too late after {clock(event.deadline_s)}")
    if event.outcome is EventOutcome.LATE and event.acted_s is not None:
        told.append(f"acted at {clock(event.acted_s)}")
    elif event.outcome is EventOutcome.CAUSED:
        told.append("the agent had brought it about with its own switch")
    elif event.outcome is EventOutcome.EVADED:
        told.append("it did not arise because the agent held the car back for no reason")
    elif (kind := KINDS.get(event.kind)) is not None and kind.alerts:
        *others, last = (alert.replace("_", " ") for alert in sorted(kind.alerts))
        told.append(f"right: an alert of {', '.join(others)}{' or ' if others else ''}{last}")
    return Fault(due_s, str(event.outcome), event.kind.replace("_", " "), "; ".join(told))
