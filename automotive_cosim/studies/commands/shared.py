"""What the commands of ``automotive-cosim study`` share: options, and how they tell what they do."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from automotive_cosim.cli.batches import ProgressView
from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import InfrastructureError

if TYPE_CHECKING:
    from automotive_cosim.cli.console import Console
    from automotive_cosim.run.batch import Progress
    from automotive_cosim.run.job_row import JobRow
    from automotive_cosim.studies.settings import TrafficSettings

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
def driven(
    console: Console, units: str, folder: Path, said: Callable[[Progress[Any]], str] = errors_so_far
) -> Iterator[Callable[[Progress[Any]], None]]:
    """Shows how far a study is, and says at Ctrl-C where it is; gives what is to be told of its progress."""
    try:
        with ProgressView(console, units, said) as view:
            yield view.tell
    except KeyboardInterrupt:
        typer.echo(f"finished {units} are in {folder}; rerun the command to resume", err=True)
        raise


def tell_reading(scenario: str) -> None:
    """Says at once what is read: a city takes a while on a busy machine."""
    typer.echo(f"reading {scenario}", err=True)


def raise_errors(errors: Sequence[JobRow], count: int, unit: str) -> None:
    """Raises an ``InfrastructureError`` that tells the first of the errors, if there are any."""
    if errors:
        from automotive_cosim.run.job_row import remedy

        first = errors[0]
        raise InfrastructureError(
            f"{len(errors)} of {counted(count, unit)} ended in an error, the first one {first.id}: "
            f"{first.error_kind}: {first.error}; {remedy(errors)}"
        )


def folder_of(plan: TrafficSettings) -> Path:
    """The results folder of a plan that was given none; the same plan resumes there."""
    from automotive_cosim.interface.trace import canonical

    return Path("runs") / f"study-{hashlib.sha256(canonical(plan.as_json())).hexdigest()[:8]}"
