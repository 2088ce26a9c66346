"""Judges stored trials again by the current checks."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from pathlib import Path

from automotive_cosim.drives.score import Score
from automotive_cosim.errors import CosimError, UserError
from automotive_cosim.formats.limited import LimitedProcesses
from automotive_cosim.run.drive import JudgedDrive
from automotive_cosim.run.moments import Judged, read_judged
from automotive_cosim.run.rows import DriveTrialRow, EpisodeRow, PartsHeld, read_trials
from automotive_cosim.run.store import read_evaluation
from automotive_cosim.tasking.binding import UnmetNeedError, bound
from automotive_cosim.tasking.instance import Instance
from automotive_cosim.tasking.task import Half
from automotive_cosim.tasking.verdict import Verdict, judge
from automotive_cosim.tasks import CATALOGUE


@dataclass(frozen=True, slots=True)
class Change:
    """The change of one part of a verdict."""

    part: str
    before: bool
    now: bool
    why: str
    """The reason by the current checks."""


@dataclass(frozen=True, slots=True)
class Regraded:
    """One stored trial, judged again."""

    episode: str
    before: bool
    now: bool | None
    """None if it could not be judged."""
    changes: tuple[Change, ...] = ()
    problem: str = ""
    """Why it could not be judged."""

    @property
    def differs(self) -> bool:
        """Whether success or any part of the verdict differs."""
        return self.now is not None and (self.now is not self.before or bool(self.changes))


def regrade(folder: Path) -> Iterator[Regraded]:
    """Judges every trial of an evaluation that has a verdict again; nothing is written.

    Raises UserError: it is not an evaluation's folder, or is damaged."""
    read_evaluation(folder)
    rows = read_trials(folder)
    with LimitedProcesses(folder) as processes:
        for name in sorted(rows):
            try:
                judged = processes.call(_regraded, folder, rows[name])
            except CosimError as error:
                judged = Regraded(name, rows[name].has_succeeded, None, problem=str(error))
            if judged is not None:
                yield judged


def _regraded(folder: Path, row: EpisodeRow | DriveTrialRow) -> Regraded | None:
    """One trial, judged again in a process with limits: its moments may be anybody's. None without a verdict.

    Raises CosimError: it cannot be judged."""
    if isinstance(row, DriveTrialRow) and row.score is not None:
        return Regraded(row.id, row.has_succeeded, *_drive_again(folder, row, row.score))
    if isinstance(row, EpisodeRow) and row.parts is not None:
        return Regraded(row.id, row.has_succeeded, *_again(folder, row, row.parts))
    return None


def judged_again(row: EpisodeRow, stored: Judged) -> Verdict:
    """The verdict on an episode's stored moments by the current checks.

    Raises UserError: the task no longer exists, the commands that it allows have changed, or the place where it was
    handed over has no sign or law on which it rests."""
    counterfactual = stored.counterfactual
    assert counterfactual is not None
    spoken = row.conditions.language
    task = CATALOGUE[row.task]
    rule = _rule_elsewhere(row, task.half(row.half), stored)
    instance = Instance(task, row.half, stored.goal, stored.parameters, rule=rule, language=spoken)
    if stored.allowed_writes != instance.half.allowed_writes:
        raise UserError(f"the commands that {row.task} allows have changed; rerun {row.id}")
    return judge(
        instance,
        stored.trace,
        stored.baseline,
        lambda: counterfactual,
        stored.declared,
        stored.reason,
        row.agent_error,
        stored.said,
    )


def _rule_elsewhere(row: EpisodeRow, half: Half, stored: Judged) -> str:
    """The sign or law on which a half rests where it was handed over; empty in its own scenario."""
    if row.scenario == half.start.scenario:
        return ""
    try:
        return bound(half, stored.trace[0].context)
    except UnmetNeedError as missing:
        raise UserError(f"{row.id} cannot be judged: {missing}") from missing


def _again(folder: Path, row: EpisodeRow, held: PartsHeld) -> tuple[bool, tuple[Change, ...]]:
    """Whether it succeeds now, and what changes."""
    verdict = judged_again(row, read_judged(folder, row.id, Judged))
    changes = tuple(
        Change(name, before, now.ok, now.why)
        for name, before in asdict(held).items()
        if (now := verdict.parts[name]).ok is not before
    )
    return verdict.success, changes


def _drive_again(folder: Path, row: DriveTrialRow, held: Score) -> tuple[bool, tuple[Change, ...]]:
    events, acts, score = read_judged(folder, row.id, JudgedDrive).judgement()
    now = replace(row, events=events, acts=acts, score=score, value=score.value)
    changes = tuple(
        Change(f"{before.kind} at {before.observable_s:.0f} s", before.outcome.counts, after.outcome.counts, why)
        for before, after in zip(row.events, events, strict=False)
        if (why := f"{after.outcome} instead of {before.outcome}") and after.outcome is not before.outcome
    )
    if not changes and (score != held or acts != row.acts or events != row.events):
        changes = (Change("score", True, False, f"{score.value:.1f} instead of {held.value:.1f}"),)
    return now.has_succeeded, changes
