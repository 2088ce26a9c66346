"""What the commands of ``automotive-cosim study`` share: options, and how they tell what they do."""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from automotive_cosim.cli.batches import words
from automotive_cosim.cli.options import print_json, whole_number
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import InfrastructureError, UserError

if TYPE_CHECKING:
    from automotive_cosim.cli.console import Console
    from automotive_cosim.report.tables import Table
    from automotive_cosim.run.batch import Progress
    from automotive_cosim.run.row import JobRow
    from automotive_cosim.studies.congestion.plan import CongestionPlan
    from automotive_cosim.studies.days import DaysPlan
    from automotive_cosim.studies.plan import StudyPlan

StudySeeds = Annotated[
    str, typer.Option(help="Seeds of the traffic, as in 0-9; at least 10 for an interval, 30 to publish.")
]
DemandScale = Annotated[float | None, typer.Option(help="Factor on the demand.", show_default="scenario's")]
StepLength = Annotated[float, typer.Option(help="SUMO's step length in seconds.")]
RedrawTrips = Annotated[
    bool, typer.Option("--redraw", help="Redraw the trips of the demand for every seed, as on another day.")
]
WithEmissions = Annotated[
    bool, typer.Option("--emissions", help="Measure what every vehicle emits and consumes, by emission class.")
]
LeastDelay = Annotated[float, typer.Option(help="Expected delay, in seconds, from which a decision is due.")]
PerDrive = Annotated[
    int, typer.Option(help="Maximum number of decisions per drive.", metavar="N", parser=whole_number(1, 50))
]
ViaStops = Annotated[
    str,
    typer.Option(
        help="What a trip's via edges are: stops, which every route passes, or route, which other routes may leave."
    ),
]
StudyFolder = Annotated[
    Path | None,
    typer.Option(
        help="Results folder; an existing one is resumed.", show_default="runs/study-<digest of the plan>"
    ),
]


def errors_so_far(progress: Progress[Any]) -> str:
    """What stands beside the number of finished units: how many ended in an error."""
    return counted(progress.errors, "error") if progress.errors else ""


@contextmanager
def resumable(units: str, folder: Path) -> Iterator[None]:
    """Says at Ctrl-C where the study is."""
    try:
        yield
    except KeyboardInterrupt:
        typer.echo(f"finished {units} are in {folder}; rerun the command to resume", err=True)
        raise


def tell_reading(scenario: str) -> None:
    """Says at once what is read: a city takes a while on a busy machine."""
    typer.echo(f"reading {scenario}", err=True)


def show(
    console: Console,
    page: Path,
    answer: str,
    warnings: Sequence[str],
    tables: Sequence[Table],
    *,
    as_json: bool,
) -> None:
    """Prints the result of a study of a whole network."""
    if as_json:
        told: Json = {"answer": answer, "warnings": list(warnings), "out": str(page.parent)}
        for table in tables:
            told[table.name] = [dict(zip(table.columns, map(str, row), strict=True)) for row in table.rows]
        print_json(told)
        return
    for table in tables:
        console.print(table.markdown(), soft_wrap=True)
    for text in (*warnings, answer, f"report written to {page}"):
        console.print(text, soft_wrap=True)


def raise_errors(errors: Sequence[JobRow], count: int, unit: str) -> None:
    """Raises an ``InfrastructureError`` that tells the first of the errors, if there are any."""
    if errors:
        first = errors[0]
        raise InfrastructureError(
            f"{len(errors)} of {counted(count, unit)} ended in an error, the first one {first.id}: "
            f"{first.error_kind}: {first.error}; rerun the command to retry them"
        )


def replicates_of(text: str) -> int | str:
    """A number, or a word that the plan checks."""
    return int(text) if text.isdecimal() else text


def numbers(name: str, text: str) -> list[float]:
    """The numbers of the option ``--name``, separated by commas.

    Raises:
        UserError: one of them is none.
    """
    found = []
    for word in words(name, text):
        try:
            found.append(float(word))
        except ValueError:
            raise UserError(f"--{name} has {word!r}; give numbers separated by commas") from None
    return found


def folder_of(plan: StudyPlan | CongestionPlan | DaysPlan) -> Path:
    """The results folder of a plan that was given none; the same plan resumes there."""
    from automotive_cosim.interface.trace import canonical

    return Path("runs") / f"study-{hashlib.sha256(canonical(plan.as_json())).hexdigest()[:8]}"
