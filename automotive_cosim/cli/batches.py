"""Options and progress shared by the commands that run for a long time."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Generic, TypeVar

import typer
from annotated_types import Ge, Le

from automotive_cosim.contracts.plain import clock, counted
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.formats.annotations import Option

if TYPE_CHECKING:
    from automotive_cosim.cli.console import Console
    from automotive_cosim.run.batch import Progress
    from automotive_cosim.run.executor import Executor
    from automotive_cosim.run.forecast import CostForecast, Range
    from automotive_cosim.run.job_row import JobRow
    from automotive_cosim.run.settings import Budget
    from automotive_cosim.scenarios import Scenario

R = TypeVar("R", bound="JobRow")

EXECUTORS = ("processes", "ray", "ray:FOLDER")
WHERE = "Where to run"


@dataclass(frozen=True, slots=True)
class ExecutorSettings:
    """Where to run."""

    workers: Annotated[
        int | None, Ge(1), Le(4096), Option(default="1; with ray, the CPUs of the cluster", panel=WHERE)
    ] = None
    """How many run in parallel."""
    executor: Annotated[str, Option(panel=WHERE)] = EXECUTORS[0]
    """Where to run: processes of this machine, or ray for the cluster at RAY_ADDRESS, else a new one here. With
    ray:FOLDER, every node gets a copy of a folder of your own agents, tasks or scenarios, and runs in it."""

    @property
    def processes(self) -> int:
        """How many run in parallel on this machine."""
        return self.workers or 1

    def opened(self) -> Executor:
        """The executor that they select.

        Raises:
            UnknownNameError: there is no such executor.
            SetupError: ray is not installed."""
        from automotive_cosim.run.processes import Processes

        if self.executor == "processes":
            return Processes(self.processes)
        name, colon, folder = self.executor.partition(":")
        if name != "ray" or bool(colon) != bool(folder):
            raise UnknownNameError("executor", self.executor, EXECUTORS)
        from automotive_cosim.run.on_ray import OnRay

        return OnRay(os.environ.get("RAY_ADDRESS"), self.workers, Path(folder) if folder else None)


class ProgressView(Generic[R]):
    """Shows the progress of a run: a bar in a terminal, else occasional lines."""

    EVERY_S, UNCHANGED_S = 15.0, 120.0
    """A line at most as often, and one that says nothing new."""
    OVERDUE_S = 5.0

    def __init__(
        self, console: Console, what: str, said: Callable[[Progress[R]], str], expected: Range | None = None
    ) -> None:
        """Nothing has been told yet.

        Args:
            what: is being run, in the plural.
            said: gives the text next to its count.
            expected: seconds that it was said to take before it started; None if it was not."""
        from rich.progress import BarColumn, MofNCompleteColumn, TextColumn
        from rich.progress import Progress as Bar

        self._console = console
        self._what = what
        self._words = said
        self._expected = expected
        columns = (BarColumn(), MofNCompleteColumn(), TextColumn("{task.fields[said]}", markup=False))
        self._bar = Bar(*columns, console=console) if console.is_terminal else None
        self._task = self._bar.add_task("", total=None, said="") if self._bar else None
        self._said_s = -self.EVERY_S
        self._said = ""
        self._known = -1, 0.0
        """How many runs had ended when the time left was first told, and when it would have been up."""

    def __enter__(self) -> ProgressView[R]:
        if self._bar:
            self._bar.start()
        return self

    def __exit__(self, *error: object) -> None:
        if self._bar:
            self._bar.stop()

    def tell(self, progress: Progress[R]) -> None:
        progress, overdue = self._overdue(progress)
        time_told = time_left(progress) or self._time_so_far(progress)
        told = ", ".join(filter(None, (self._words(progress), time_told, progress.budget)))
        said = "; ".join(filter(None, (told, overdue or _doing(progress))))
        if self._bar and self._task is not None:
            self._bar.update(self._task, total=progress.planned, completed=progress.done, said=said)
            return
        line = f"{progress.done} of {progress.planned} {self._what}{said and f'; {said}'}"
        every_s = self.UNCHANGED_S if line == self._said else self.EVERY_S
        if progress.seconds - self._said_s >= every_s or progress.done == progress.planned:
            self._said_s, self._said = progress.seconds, line
            self._console.print(line, soft_wrap=True)

    def _time_so_far(self, progress: Progress[R]) -> str:
        """The time that has passed of what was expected, while nothing has been measured."""
        if self._expected is None or progress.left_s is not None or progress.ran or not progress.doing:
            return ""
        return f"{clock(progress.seconds)} of {minutes_in_words(self._expected)}"

    def _overdue(self, progress: Progress[R]) -> tuple[Progress[R], str]:
        """Without the time left, and words instead, while a run takes longer than was expected of it: each second
        would otherwise add one to the estimate."""
        if progress.left_s is None:
            return progress, ""
        up_s, (done, was_s) = progress.seconds + progress.left_s, self._known
        if progress.done == done and up_s > was_s + max(self.OVERDUE_S, progress.left_s / 2):
            return replace(progress, left_s=None), "it takes longer than expected"
        self._known = progress.done, up_s if progress.done != done else min(up_s, was_s)
        return progress, ""


def check_prices(models: Iterable[str], budget: Budget) -> None:
    """Refuses a budget in dollars for models without a price. Raises UserError: a model at an endpoint has none."""
    if budget.usd is None:
        return
    for name in models:
        if not name.startswith(("rules", "replay/")) and "usd_per_million_" not in name:
            raise UserError(
                f"a budget in dollars needs the price of {name}; add "
                "?usd_per_million_in=...&usd_per_million_out=... to it"
            )


def forecast_in_words(told: CostForecast, workers: int, budget: Budget | None = None) -> Iterator[str]:
    """Lines on what a plan will take, and whether its budget will last."""
    slow = ", plus the time that the models take to answer" if told.asks_models else ""
    yield f"time: {minutes_in_words(told.wall_s)} with {counted(workers, 'worker')} on an idle machine{slow}"
    if told.asks_models:
        yield f"tokens: {told.tokens.low / 1e6:,.2f} to {told.tokens.high / 1e6:,.2f} million"
        if told.usd.high:
            yield f"cost: ${told.usd.low:,.2f} to ${told.usd.high:,.2f}"
        else:
            yield "cost: unknown; a model's name takes ?usd_per_million_in=...&usd_per_million_out=..."
    if budget is not None and (beyond := told.beyond(budget)):
        yield beyond


def minutes_in_words(seconds: Range) -> str:
    """A span of time to a minute."""
    low, high = seconds.low / 60, seconds.high / 60
    if high < 1:
        return "less than a minute"
    return f"{f'{low:.0f} to' if low >= 1 else 'up to'} {counted(round(high), 'minute')}"


def tell_stopped(end: Progress[Any]) -> None:
    """Ends a command whose budget did not last. Raises UserError: something was not run because of the budget."""
    if end.stopped:
        left = counted(end.planned - end.done, "run")
        raise UserError(f"{end.stopped}; {left} left: rerun with a larger budget to continue")


def tell_notes(scenarios: Iterable[Scenario], *, runs: bool = True) -> None:
    """Prints what is assumed, set or left out in other people's scenarios, to standard error; if they are to run,
    also how much of SUMO's traffic that changes."""
    from automotive_cosim.scenarios.difference import notes_of

    for scenario in scenarios:
        for note in notes_of(scenario) if runs else scenario.notes:
            typer.echo(f"note: {note}", err=True)


def words(name: str, text: str) -> list[str]:
    """The words between commas. Raises UserError: there are none."""
    found = [word.strip() for word in text.split(",") if word.strip()]
    if not found:
        raise UserError(f"--{name} is empty; omit it to use the default")
    return found


def whole_numbers_in(name: str, text: str) -> list[int]:
    """Whole numbers and ranges in the option ``--name``, separated by commas.

    Raises UserError: the text contains anything else."""
    found: list[int] = []
    for word in words(name, text):
        first, dash, last = word.partition("-")
        if not first.isdigit() or (dash and not (last.isdigit() and int(first) <= int(last) < int(first) + 10**6)):
            raise UserError(f"--{name} has {word!r}; give numbers and rising ranges, as in 0-4 or 0,3,7")
        found += range(int(first), int(last or first) + 1)
    return found


def numbers_in(name: str, text: str) -> list[float]:
    """The numbers in the option ``--name``, separated by commas. Raises UserError: one of them is none."""
    found = []
    for word in words(name, text):
        try:
            found.append(float(word))
        except ValueError:
            raise UserError(f"--{name} has {word!r}; give numbers separated by commas") from None
    return found


def _doing(progress: Progress[Any]) -> str:
    """What the workers do, while there is no estimate yet."""
    is_known = progress.left_s is not None or progress.done == progress.planned
    return "" if is_known else ", ".join(filter(None, progress.doing))


def time_left(progress: Progress[Any]) -> str:
    """For example ``3:05 left`` or ``1:03:05 left``; empty if unknown or if nothing is left."""
    left_s = progress.left_s
    if left_s is None or progress.done == progress.planned:
        return ""
    return f"{clock(left_s)} left"
