"""The estimated time left, over whole plans played through on a clock that is set by hand."""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import pytest

from automotive_cosim.cli.batches import time_left
from automotive_cosim.run import batch
from automotive_cosim.run.batch import Progress, run_jobs
from automotive_cosim.run.budget import Spent
from automotive_cosim.run.executor import JobPhase
from automotive_cosim.run.job_row import JobRow
from automotive_cosim.run.settings import Budget
from automotive_cosim.run.trial import WARM_UP_S, WARM_UPS_S

OUT_OF_REACH = "TriggerNotReachedError"

MEASURED = {
    "alpine_pass": (17, 1.0, 1.05), "autobahn": (29, 2.0, 3.8), "beauce": (19, 0.6, 0.57),
    "border": (12, 0.5, 1.78), "grid": (2, 0.5, 0.9), "gulf": (9, 2.0, 1.0), "london": (14, 1.5, 1.27),
    "new_york": (4, 4.0, 0.4), "nordic": (14, 0.6, 1.1), "paris_centre": (161, 4.5, 0.66),
    "peripherique": (7, 6.0, 2.2), "sydney": (18, 1.0, 1.6), "tokyo": (9, 2.5, 2.7),
}  # fmt: skip
"""Of the shipped catalogue by scenario: halves of tasks, seconds of the warm-up, mean seconds of an episode."""
MODELS_S = {"rules": 0.3, "slow": 30.0, "slower": 60.0, "none": 0.0}
"""What a model takes of an episode, in all."""


@dataclass(frozen=True)
class Planned:
    """A job that takes a time known beforehand."""

    id: str
    simulation: tuple[str, int]
    kind: str
    situation: str
    own_s: float
    warm_up_s: float
    is_out_of_reach: bool = False
    wall_s: float = 1e9
    warm_up_weight: float = 1.0

    @property
    def row_ids(self) -> tuple[str, ...]:
        return (self.id,)

    def planned(self) -> JobRow:
        return JobRow(id=self.id)

    def row(self) -> JobRow:
        error = OUT_OF_REACH if self.is_out_of_reach else None
        return JobRow(id=self.id, error=error, error_kind=error, wall_seconds=self.own_s)


class _Clocked:
    """An executor, its workers' clock, and the store of what they did."""

    def __init__(self, count: int, done: Sequence[JobRow] = (), *, tells: bool = False) -> None:
        self.count, self.now_s, self.tells = count, 0.0, tells
        self.rows = {row.id: row for row in done}
        self.folder = Path()

    def monotonic(self) -> float:
        return self.now_s

    def append(self, row: JobRow) -> None:
        self.rows[row.id] = row

    def start(self, opener: object, folder: Path) -> _ClockedWorker:
        return _ClockedWorker(self)

    def wait(self, handles: Sequence[_ClockedWorker], timeout_s: float) -> list[_ClockedWorker]:
        first = min((worker for worker in handles if worker.job), key=lambda worker: worker.ends_s)
        if self.tells and first.ends_s > self.now_s + TOLD_EVERY_S:
            self.now_s += TOLD_EVERY_S
            return [worker for worker in handles if worker.job]
        self.now_s = first.ends_s
        return [first]


class _ClockedWorker:
    is_ready = True

    def __init__(self, clock: _Clocked) -> None:
        self.clock = clock
        self.job: Planned | None = None
        self.warm: tuple[str, int] | None = None
        self.begun_s = self.warmed_s = self.ends_s = 0.0

    @property
    def phase(self) -> JobPhase:
        now_s = self.clock.now_s
        if not self.clock.tells or self.job is None:
            return JobPhase()
        if now_s < self.warmed_s:
            return JobPhase("warming up", True, (now_s - self.begun_s) / (self.warmed_s - self.begun_s))
        return JobPhase("at work", False, (now_s - self.warmed_s) / (self.ends_s - self.warmed_s))

    @property
    def handles(self) -> list[_ClockedWorker]:
        return [self]

    def give(self, job: Planned) -> None:
        warm_up_s = 0.0 if job.simulation == self.warm else job.warm_up_s
        self.job, self.warm = job, job.simulation
        self.begun_s, self.warmed_s = self.clock.now_s, self.clock.now_s + warm_up_s
        self.ends_s = self.warmed_s + job.own_s

    def answer(self) -> JobRow | None:
        assert self.job is not None
        if self.clock.now_s < self.ends_s:
            return None
        row, self.job = self.job.row(), None
        return row

    def end(self, *, at_once: bool) -> None:
        pass


TOLD_EVERY_S = 5.0

Told = list[tuple[float, float | None, int]]
"""At each report: the time, the estimate, and how many jobs were not done."""


def play(
    monkeypatch: pytest.MonkeyPatch,
    jobs: Sequence[Planned],
    workers: int,
    share: float = 0.0,
    *,
    tells: bool = False,
) -> Told:
    """Runs a plan of which a share is done already, with workers that may tell how far they are."""
    rng = random.Random(1)
    clock = _Clocked(workers, [job.row() for job in jobs if rng.random() < share], tells=tells)
    monkeypatch.setattr(batch, "time", clock)
    told: Told = []

    def tell(progress: Progress[JobRow]) -> None:
        told.append((clock.now_s, progress.left_s, progress.planned - progress.done))

    end = run_jobs(jobs, clock, nobody, executor=clock, tell=tell)  # type: ignore[arg-type, misc, call-overload]
    assert end.done == end.planned == len(jobs)
    return told


@contextmanager
def nobody() -> Iterator[None]:
    yield


def evaluation(
    models: Sequence[str], seeds: int, scenarios: Sequence[str] = tuple(MEASURED), lost: float = 0.0
) -> list[Planned]:
    """Episodes of the catalogue, each model's own kind; of a share the situation never arises, which takes 20 s."""
    rng = random.Random(0)
    jobs = []
    for scenario in scenarios:
        count, warm_up_s, own_s = MEASURED[scenario]
        for seed in range(seeds):
            out = {task for task in range(count) if rng.random() < lost}
            for model in models:
                for task in range(count):
                    spread = (rng.lognormvariate(-0.18, 0.6) for _ in range(2))
                    takes_s = own_s * next(spread) + MODELS_S[model] * next(spread)
                    name = f"{scenario}-{seed}-{task}"
                    jobs.append(
                        Planned(
                            f"{name}-{model}", (scenario, seed), model, name, 20.0 if task in out else takes_s,
                            warm_up_s, task in out,
                        )
                    )  # fmt: skip
    return jobs


def alike(groups: int, each: int, own_s: float, warm_up_s: float) -> list[Planned]:
    """Jobs of one kind in simulations of their own, as those of a study or of proofs are."""
    rng = random.Random(0)
    return [
        Planned(f"{group}-{number}", (f"s{group % 3}", group), "", f"{group}-{number}", own_s * spread, warm_up_s)
        for group in range(groups)
        for number in range(each)
        for spread in (rng.lognormvariate(-0.18, 0.6),)
    ]


PLANS: dict[str, Callable[[], list[Planned]]] = {
    "one scenario": lambda: evaluation(["rules"], 6, ["paris_centre"]),
    "the catalogue": lambda: evaluation(["none"], 4),
    "a quick agent first": lambda: evaluation(["none", "rules", "slow"], 1),
    "two slow models": lambda: evaluation(["slow", "slower"], 1, ["autobahn", "beauce", "sydney"]),
    "situations out of reach": lambda: evaluation(["none", "rules"], 1, lost=0.3),
    "a simulation for each episode": lambda: alike(200, 1, 1.0, 5.0),
    "long warm-ups": lambda: alike(20, 6, 2.0, 30.0),
    "drives of a study": lambda: alike(12, 8, 30.0, 15.0),
    "proofs": lambda: alike(10, 12, 20.0, 5.0),
}


@pytest.mark.slow
@pytest.mark.parametrize(("workers", "share"), [(1, 0.0), (2, 0.5), (8, 0.0)])
@pytest.mark.parametrize("name", PLANS)
def test_after_a_minute_the_time_left_is_right_within_a_factor_of_two(name, workers, share, monkeypatch):
    """While a minute or more is left, and more jobs wait than a few: nobody knows the last ones."""
    told = play(monkeypatch, PLANS[name](), workers, share)
    end_s = told[-1][0]
    counted = [(left_s, end_s - now_s) for now_s, left_s, open_ in told if now_s >= 60 and open_ > 2 * workers]
    shown = [(left_s, true_s) for left_s, true_s in counted if left_s is not None and true_s >= 60]
    assert shown
    right = sum(true_s / 2 <= left_s <= 2 * true_s for left_s, true_s in shown)
    assert right >= 0.97 * len(shown), sorted(left_s / true_s for left_s, true_s in shown)[:: len(shown) // 10 or 1]
    assert all(true_s / 3 <= left_s <= 3 * true_s for left_s, true_s in shown)
    assert sum(left_s is None for left_s, _ in counted) <= 0.1 * len(counted), "it is shown soon"


@pytest.mark.parametrize("workers", [1, 2])
@pytest.mark.parametrize(
    ("jobs", "known_by_s"),
    [
        (alike(1, 1, 300.0, 60.0), 120.0),
        (alike(2, 1, 300.0, 60.0), 120.0),
        (alike(10, 2, 20.0, 10.0), 60.0),
        (alike(4, 6, 60.0, 40.0), 80.0),
        (alike(40, 1, 5.0, 3.0), 60.0),
    ],
)
def test_jobs_that_tell_how_far_they_are_are_known_from_the_first_minute(workers, jobs, known_by_s, monkeypatch):
    """The first of them may still be running. Of many, nobody knows how long the very last will take."""
    told = play(monkeypatch, jobs, workers, tells=True)
    end_s, last = told[-1][0], 2 * workers if len(jobs) > 2 else 0
    shown = [
        (left_s, end_s - now_s)
        for now_s, left_s, open_ in told
        if now_s >= known_by_s and end_s - now_s >= 60 and open_ > last
    ]
    assert shown
    right = sum(left_s is not None and true_s / 2 <= left_s <= 2 * true_s for left_s, true_s in shown)
    assert right >= 0.97 * len(shown), shown


class _SpendingMeter:
    """Ten tokens a second."""

    def __init__(self, clock: _Clocked) -> None:
        self.clock = clock

    def spent(self) -> Spent:
        return Spent(tokens=500 + int(10 * self.clock.now_s))

    def refusal(self) -> str:
        return "spent" if self.spent().tokens >= BUDGET.tokens else ""


BUDGET = Budget(tokens=2500)


def test_the_time_left_ends_with_the_budget(monkeypatch):
    """At ten tokens a second, the 2,000 that are left last for 200 s; the jobs would take much longer."""
    clock = _Clocked(1)
    monkeypatch.setattr(batch, "time", clock)
    monkeypatch.setattr(batch._Batch, "_note_spent", lambda batch: None)
    told: list[tuple[float, float | None, str]] = []

    def tell(progress: Progress[JobRow]) -> None:
        told.append((clock.now_s, progress.left_s, progress.budget))

    jobs = alike(1, 100, 10.0, 0.0)
    end = run_jobs(jobs, clock, nobody, executor=clock, limit=_SpendingMeter(clock), budget=BUDGET, tell=tell)  # type: ignore[arg-type, misc, call-overload]
    assert end.stopped == "spent"
    assert told[0] == (0.0, None, "2,000 of 2,500 tokens left")
    known = [(now_s, left_s) for now_s, left_s, _ in told if left_s is not None and now_s > 60]
    assert known
    assert all(left_s == pytest.approx(200 - now_s, abs=1) for now_s, left_s in known if now_s < 200)


def test_nothing_is_said_before_there_is_a_basis(monkeypatch):
    """Not before three jobs of each kind have ended in a warm simulation; the first estimate is then sound."""
    jobs = evaluation(["none", "slow"], 1, ["paris_centre"])
    told = play(monkeypatch, jobs, 1)
    number = next(number for number, (_, left_s, _) in enumerate(told) if left_s is not None)
    assert number == 7, "a cold one, and three of each kind"
    now_s, left_s, _ = told[number]
    assert left_s is not None
    assert 0.4 < left_s / (told[-1][0] - now_s) < 2.5


def test_what_is_known_to_be_out_of_reach_takes_no_time(monkeypatch):
    first = [Planned(f"a{n}", ("grid", 0), "a", f"{n}", 20.0, 1.0, is_out_of_reach=True) for n in range(20)]
    second = [Planned(f"b{n}", ("grid", 0), "b", f"{n}", 20.0, 1.0, is_out_of_reach=True) for n in range(20)]
    told = play(monkeypatch, [*first, *second], 1)
    assert told[-1][0] == pytest.approx(1.0 + 20 * 20.0)
    assert [open_ for *_, open_ in told] == list(range(40, -1, -1))


@pytest.mark.parametrize(
    ("left_s", "done", "said"),
    [(None, 1, ""), (7.9, 1, "0:07 left"), (185.0, 1, "3:05 left"), (3785.0, 1, "1:03:05 left"), (9.0, 2, "")],
)
def test_the_time_left_is_told_in_hours_minutes_and_seconds(left_s, done, said):
    assert time_left(SimpleNamespace(left_s=left_s, done=done, planned=2)) == said


def test_a_small_place_is_not_expected_to_warm_up_as_long_as_a_large_one(monkeypatch):
    """The README's evaluation as it ran: Paris twice, and then a small place twice."""
    places = (
        ("paris_centre", 0, 27.0, 4),
        ("paris_centre", 1, 20.0, 4),
        ("beauce", 0, 6.0, 2),
        ("beauce", 1, 1.5, 2),
    )
    jobs = [
        Planned(f"{place}-{seed}-{n}", (place, seed), "ab"[n % 2], f"{place}-{seed}-{n}", 1.2 + n, warm_up_s,
                warm_up_weight=WARM_UPS_S[place] / WARM_UP_S)
        for place, seed, warm_up_s, count in places for n in range(count)
    ]  # fmt: skip
    told = play(monkeypatch, jobs, 1)
    known = [(now_s, left_s) for now_s, left_s, left in told if left_s and left in (6, 5, 4)]
    assert known
    assert all(0.5 < left_s / (told[-1][0] - now_s) < 2 for now_s, left_s in known), known
