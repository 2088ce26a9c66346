"""Runs the drives of a study, in parallel and resumable, until all are done or the interval is narrow enough."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import closing, contextmanager
from pathlib import Path

from automotive_cosim.formats.layout import LIVE, WATCHED
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.run.batch import BatchKind
from automotive_cosim.run.executor import Runner, doing, tried, warming_up
from automotive_cosim.run.store import Store
from automotive_cosim.studies.calls.accounts import TrafficSummary
from automotive_cosim.studies.calls.chance import fresh_of
from automotive_cosim.studies.calls.ledger import keep_ledger, run_on
from automotive_cosim.studies.gridlock import MEASURED_EVERY_S
from automotive_cosim.studies.intervals import LEAST_SEEDS, seed_mean
from automotive_cosim.studies.reroute.plan import StudyJob, StudyPlan
from automotive_cosim.studies.reroute.policies import PolicyRule
from automotive_cosim.studies.reroute.results import choices
from automotive_cosim.studies.reroute.rows import TripRow
from automotive_cosim.studies.reroute.tracks import TRACKS
from automotive_cosim.studies.reroute.trip import run_drive
from automotive_cosim.traffic.fork import Forked

STRIDE = 5
"""Seeds added at a time once there are enough for an interval."""


def rounds(plan: StudyPlan, store: Store[TripRow]) -> Iterator[Sequence[StudyJob]]:
    """The drives of all seeds; with a stopping rule, of some more until the interval is narrow enough."""
    if not (watched := store.folder / LIVE / WATCHED).exists():  # it stays what the pages have locked
        write_whole(watched, b"")
    for count in _counts(plan):
        yield [job for job in plan.jobs() if job.seed in plan.seeds[:count]]
        if _is_narrow(plan, list(store.rows.values())):
            return


def _counts(plan: StudyPlan) -> Iterator[int]:
    """Numbers of seeds after which the interval is checked; all at once without a stopping rule."""
    if plan.half_width_s is not None:
        yield from range(LEAST_SEEDS, len(plan.seeds), STRIDE)
    yield len(plan.seeds)


def _is_narrow(plan: StudyPlan, rows: Sequence[TripRow]) -> bool:
    """Whether the mean gain of ``always`` is known precisely enough."""
    always = choices(rows, (PolicyRule.ALWAYS,), plan.compliance[0])
    found = [each for each in always if each.age_s == plan.ages_s[0]]
    mean = seed_mean((each.seed, each.gain.time_s) for each in found)
    if plan.half_width_s is None or mean is None or mean.interval is None:
        return False
    return (mean.interval.high - mean.interval.low) / 2 <= plan.half_width_s


@contextmanager
def drives() -> Iterator[Runner[StudyJob, TripRow]]:
    """Makes the runner of the drives in a worker."""
    with closing(_Warm()) as warm:
        yield tried(warm.run)


class _Warm:
    """The traffic of one seed and share, which continues from departure to departure."""

    def __init__(self) -> None:
        self._simulation: Forked | None = None
        self._key: tuple[str, int] | None = None
        self._now_s = 0.0
        self._measured: list[TrafficSummary] = []

    def run(self, job: StudyJob, folder: Path) -> TripRow:
        """Runs a drive; tracks, if wanted, and what is watched are also kept."""
        try:
            return run_drive(job, *self._at(job), folder / TRACKS if job.plan.trajectories else None, folder)
        except Exception:
            self.close()  # the next drive begins with fresh traffic
            raise

    def close(self) -> None:
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
                fresh_of(self._simulation)  # here, whichever departures this worker drives
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


REROUTE = BatchKind(TripRow, drives, (LIVE,), rounds=rounds)
