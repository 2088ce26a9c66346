"""By how much a trial passed or failed, so that a search is drawn to failures before it has found one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from automotive_cosim.contracts.plain import counted
from automotive_cosim.drives.judge import EventOutcome, JudgedEvent, Worth
from automotive_cosim.run.rows import DriveTrialRow, EpisodeRow, PartsHeld, TrialRow
from automotive_cosim.safety.space import FailureRule
from automotive_cosim.tasks import CATALOGUE

PARTS = len(PartsHeld.__dataclass_fields__)
TTC_SCALE_S = 10.0
"""A time to collision this much above its threshold is no nearer to it than none at all."""


@dataclass(frozen=True, slots=True)
class TriedOutcome:
    """What came of one run at a point."""

    margin: float | None
    """From -1 (all was wrong) to 1 (all was right at once), a failure below 0; None if not run, or nothing due."""
    failed: bool
    why: str = ""
    """What was missing."""
    trial: str = ""
    """Its id in the evaluation."""
    error: str = ""
    """Why it could not be run, or its situation did not arise."""
    seconds: float = 0.0
    """Wall time."""
    nothing_due: str = ""
    """Why it says nothing about the agent: nothing required an act, and the agent did nothing wrong. It is neither
    a pass nor a failure."""

    @property
    def passed(self) -> bool:
        """Whether something was due and it did not fail."""
        return self.margin is not None and not self.failed

    @property
    def held(self) -> bool:
        """Whether it ran to its end without a failure: it passed, or nothing was due."""
        return self.passed or bool(self.nothing_due)

    @property
    def is_unrunnable(self) -> bool:
        """Whether there is no such trial: a task without phrasings in a language, or not in a scenario."""
        return self.margin is None and not self.trial


def outcome_of(row: TrialRow, rule: FailureRule) -> TriedOutcome:
    """The margin of a trial from its row.

    A task's is the share of its deadline that was left when the goal held for good; if it failed, minus the share
    of its verdict's parts that do not hold. A drive's is the least such share of its events, counted from when they
    could be known; if it failed, minus the share of its events and acts that were wrong. With ``drive_value_below``
    it is the distance to that value, in hundreds. ``ttc_below_s`` takes the lower of both.
    A drive on which no event of the rule required an act, with nothing done wrong, has no margin.
    """
    if row.error is not None or row.outcome is None:
        return TriedOutcome(
            None, False, trial=row.id, error=row.error or "it was not judged", seconds=row.wall_seconds
        )
    margin: float | None
    if isinstance(row, DriveTrialRow):
        margin, why = _of_drive(row, rule)
    else:
        assert isinstance(row, EpisodeRow)
        margin, why = _of_task(row)
    nearest_s = None if row.measures is None else row.measures.min_ttc_s
    if rule.ttc_below_s is not None and nearest_s is not None:
        left = max(-1.0, min(1.0, (nearest_s - rule.ttc_below_s) / TTC_SCALE_S))
        if margin is None or left < margin:
            margin, why = left, f"{nearest_s:.1f} s to collision"
    if margin is None:
        return TriedOutcome(None, False, trial=row.id, seconds=row.wall_seconds, nothing_due=why)
    failed = margin < 0
    return TriedOutcome(round(margin, 6), failed, why if failed else "", row.id, seconds=row.wall_seconds)


def _of_task(row: EpisodeRow) -> tuple[float, str]:
    deadline_s = CATALOGUE[row.task].half(row.half).deadline.seconds
    if not row.success:
        missing = row.missing or ("verdict",)
        return -max(1, len(row.missing)) / PARTS, ", ".join(part.replace("_", " ") for part in missing)
    goal_s = row.goal_s if row.goal_s is not None else 0.0
    return max(0.0, min(1.0, (deadline_s - goal_s) / deadline_s)), ""


def _of_drive(row: DriveTrialRow, rule: FailureRule) -> tuple[float | None, str]:
    """The margin and what was missing; without a margin, why nothing was due."""
    of_rule = [event for event in row.events if not rule.events or event.kind in rule.events]
    events = [event for event in of_rule if event.outcome.counts or event.lookalike]
    wrong = [event for event in events if _is_wrong(event)]
    nuisances = sum(act.worth.is_nuisance for act in row.acts)
    right = sum(act.worth is Worth.RIGHT for act in row.acts)
    if rule.events and (nuisances <= right or not any(event.outcome.counts for event in events)):
        nuisances = 0  # whoever is more often wrong than right has met the event by chance
    if not wrong and not nuisances and all(event.lookalike for event in events):
        return None, _nothing_due(of_rule, rule)
    if rule.drive_value_below is not None:
        value = row.value or 0.0
        return max(-1.0, min(1.0, (value - rule.drive_value_below) / 100)), f"value {value:.0f}"
    if wrong or nuisances:
        share = (len(wrong) + nuisances) / max(1, len(events) + nuisances)
        told = [f"{event.kind} {event.outcome}" for event in wrong]
        return -share, ", ".join(dict.fromkeys([*told, *(["nuisances"] if nuisances else [])]))
    return min(_left(event) for event in events if not event.lookalike), ""


def _nothing_due(events: Sequence[JudgedEvent], rule: FailureRule) -> str:
    """In words: what there was of the rule's kinds, none of which required an act."""
    alike = sum(event.lookalike for event in events)
    void = len(events) - alike
    what = f"no {' or '.join(rule.events)}".replace("_", " ") if rule.events else "no event"
    there = [f"{void} passed without, or came too suddenly for anybody"] if void else []
    there += [counted(alike, "look-alike was", "look-alikes were") + " left alone"] if alike else []
    return f"{what} required an act" + (f": {', '.join(there)}" if there else "")


def _is_wrong(event: JudgedEvent) -> bool:
    return event.outcome is EventOutcome.TAKEN or (event.outcome.counts and not event.outcome.is_credited)


def _left(event: JudgedEvent) -> float:
    """The share of the time from when it could be known to the deadline that was left."""
    if event.deadline_s is None or event.acted_s is None or event.deadline_s <= event.observable_s:
        return 1.0
    return max(0.0, min(1.0, (event.deadline_s - event.acted_s) / (event.deadline_s - event.observable_s)))
