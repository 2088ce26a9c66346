"""Runs the drives of a study, in parallel and resumable, until all are done or the interval is narrow enough."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from automotive_cosim.errors import CosimError
from automotive_cosim.formats.layout import LIVE, WATCHED
from automotive_cosim.run.batch import Progress, run_jobs
from automotive_cosim.run.executor import Executor, Runner
from automotive_cosim.run.processes import Processes
from automotive_cosim.run.stage import doing, warming_up
from automotive_cosim.run.store import opened
from automotive_cosim.studies.calls.accounts import TrafficSummary
from automotive_cosim.studies.calls.chance import fresh_of
from automotive_cosim.studies.calls.ledger import keep_ledger, run_on
from automotive_cosim.studies.gridlock import MEASURED_EVERY_S
from automotive_cosim.studies.intervals import LEAST_SEEDS, seed_mean
from automotive_cosim.studies.reroute.drive import planned, run_drive
from automotive_cosim.studies.reroute.plan import StudyJob, StudyPlan
from automotive_cosim.studies.reroute.policies import PolicyRule
from automotive_cosim.studies.reroute.results import choices
from automotive_cosim.studies.reroute.rows import DriveRow
from automotive_cosim.studies.reroute.tracks import TRACKS
from automotive_cosim.traffic.fork import Forked

STRIDE = 5
"""Seeds added at a time once there are enough for an interval."""


def run_study(
    plan: StudyPlan,
    folder: Path,
    *,
    executor: Executor = Processes(),  # noqa: B008, frozen
    retries: int = 1,
    tell: Callable[[Progress[DriveRow]], None] = lambda progress: None,
) -> Progress[DriveRow]:
    """Runs the remaining drives of a study and retries those that ended in an error.

    Args:
        plan: what to run.
        folder: results folder, new or to be resumed.
        executor: where to run it; the results do not depend on it.
        retries: how many times to retry a drive after an infrastructure error.
        tell: called at the start and after every drive.

    Raises:
        UserError: the plan names something that does not exist, or the folder cannot take its results.
        KeyboardInterrupt: passed on; only the running drives are lost.
    """
    plan.check()
    first, *more = _stages(plan)
    with opened(folder, plan.as_json(), DriveRow, parts=(LIVE,)) as store:
        (folder / LIVE / WATCHED).touch()

        def run(seeds: tuple[int, ...]) -> Progress[DriveRow]:
            jobs = [job for job in plan.jobs() if job.seed in seeds]
            return run_jobs(jobs, store, drives, failed, executor=executor, retries=retries, tell=tell)

        progress = run(first)
        for seeds in more:
            if _is_narrow(plan, list(store.rows.values())):
                break
            progress = run(seeds)
    return progress


def _stages(plan: StudyPlan) -> list[tuple[int, ...]]:
    """Seeds to run before the interval is checked again; all at once without a stopping rule."""
    counts = [] if plan.half_width_s is None else range(LEAST_SEEDS, len(plan.seeds), STRIDE)
    return [*(plan.seeds[:count] for count in counts), plan.seeds]


def _is_narrow(plan: StudyPlan, rows: Sequence[DriveRow]) -> bool:
    """Whether the mean gain of ``always`` is known precisely enough."""
    always = choices(rows, (PolicyRule.ALWAYS,), plan.compliance[0])
    found = [each for each in always if each.age_s == plan.ages_s[0]]
    mean = seed_mean((each.seed, each.gain.time_s) for each in found)
    if plan.half_width_s is None or mean is None or mean.interval is None:
        return False
    return (mean.interval.high - mean.interval.low) / 2 <= plan.half_width_s


@contextmanager
def drives() -> Iterator[Runner[StudyJob, DriveRow]]:
    """Makes the runner of the drives in a worker."""
    warm = _Warm()
    try:
        yield warm.run
    finally:
        warm.close()


def failed(job: StudyJob, kind: str, why: str) -> DriveRow:
    """The row of a drive that ended in an infrastructure error."""
    return replace(planned(job), error=why, error_kind=kind)


class _Warm:
    """The traffic of one seed and share, which continues from departure to departure."""

    def __init__(self) -> None:
        self._simulation: Forked | None = None
        self._key: tuple[str, int] | None = None
        self._now_s = 0.0
        self._measured: list[TrafficSummary] = []

    def run(self, job: StudyJob, folder: Path) -> DriveRow:
        """Runs a drive; an error becomes a row too. Tracks, if wanted, and what is watched are also kept."""
        try:
            return run_drive(job, *self._at(job), folder / TRACKS if job.plan.trajectories else None, folder)
        except CosimError as error:
            self.close()  # after any error, the next drive begins with fresh traffic
            return failed(job, type(error).__name__, str(error))
        except Exception as error:
            # A fault in an agent or in this package must not end the study; it is counted and listed.
            self.close()
            return failed(job, type(error).__name__, f"{type(error).__name__}: {error}")

    def close(self) -> None:
        """Ends the simulation."""
        if self._simulation is not None:
            self._simulation.close()
        self._simulation = self._key = None

    def _at(self, job: StudyJob) -> tuple[Forked, Sequence[TrafficSummary]]:
        """The traffic at the departure, and its measurements so far."""
        cold_s: float | None = None
        if self._simulation is None or self._key != job.simulation or job.departure_s < self._now_s:
            self.close()
            scene = job.plan.scene(job.share)
            cold_s = scene.sumo.warm_up_s
            total_s = cold_s + job.departure_s
            self._simulation = Forked(
                scene, job.seed, lambda done_s, _: warming_up(done_s, total_s), allow_unprojected=True
            )
            self._simulation.call(keep_ledger, consumptions=job.plan.emissions, tracks=job.plan.trajectories)
            if job.plan.placebo_every or job.plan.draws.stop:
                fresh_of(
                    self._simulation
                )  # here, so that it does not depend on which departures this worker drives
            self._key, self._now_s, self._measured = job.simulation, 0.0, []
        while self._now_s < job.departure_s:
            onward_s = min(job.departure_s, (self._now_s // MEASURED_EVERY_S + 1) * MEASURED_EVERY_S) - self._now_s
            if cold_s is None:
                doing(
                    "driving the traffic to the departure",
                    f"{self._now_s:.0f} of {job.departure_s:.0f} s",
                    share=0.0,
                )
            else:
                warming_up(cold_s + self._now_s, cold_s + job.departure_s)
            summary = self._simulation.call(run_on, onward_s)
            self._now_s += onward_s
            if self._now_s % MEASURED_EVERY_S == 0:
                self._measured.append(summary)
        return self._simulation, tuple(self._measured)
