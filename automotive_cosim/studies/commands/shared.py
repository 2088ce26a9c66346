"""What the commands of ``automotive-cosim study`` share: options, and how they tell what they do."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import typer

from automotive_cosim.cli.batches import ExecutorSettings, ProgressView
from automotive_cosim.cli.derived import filled
from automotive_cosim.cli.options import print_json
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import InfrastructureError

if TYPE_CHECKING:
    from automotive_cosim.cli.console import Console
    from automotive_cosim.run.batch import BatchKind, Progress
    from automotive_cosim.run.row import JobRow
    from automotive_cosim.studies.content import StudyContent
    from automotive_cosim.studies.settings import TrafficSettings
    from automotive_cosim.studies.shown import ShownStudy

S = TypeVar("S", bound="StudyContent[Any, Any]")

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


def run_whole(
    plan: TrafficSettings,
    kind: BatchKind[Any, Any, Any],
    study_of: type[S],
    shown_of: Callable[[S], ShownStudy],
    units: str,
    out: Path | None,
    settings: Mapping[str, Any],
    *,
    as_json: bool,
    about: str = "",
) -> None:
    """Runs what is left of a study of a whole network, and prints its result, if anything of it ran.

    Args:
        plan: what to run.
        kind: kind of batch.
        study_of: reads its folder.
        shown_of: what its report shows; the first table is printed.
        units: what it runs, in words.
        out: its folder; None for the one of its plan.
        settings: where to run, as the command was given it.
        as_json: print an object alone.
        about: what is said of it before it runs.

    Raises:
        InfrastructureError: parts of it ended in an error.
    """
    from automotive_cosim.cli.console import Console
    from automotive_cosim.studies.shown import write_shown

    folder = out or folder_of(plan)
    where = filled(ExecutorSettings, settings).opened()
    console = Console(stderr=as_json, highlight=False)
    if about:
        console.print(f"{about}, into {folder}", soft_wrap=True)
    with where, driven(console, units, folder) as tell:
        kind.run(plan, folder, executor=where, tell=tell)
    study = study_of.read(folder)
    if len(study.errors) < len(study.rows):
        shown = shown_of(study)
        page = write_shown(study, shown)
        tables = shown.tables[:1]
        if as_json:
            told: Json = {"answer": shown.answer, "warnings": list(shown.warnings), "out": str(folder)}
            print_json(told | {table.name: table.records() for table in tables})
        else:
            for text in (*(table.markdown() for table in tables), *shown.warnings, shown.answer):
                console.print(text, soft_wrap=True)
            console.print(f"report written to {page}", soft_wrap=True)
    raise_errors(study.errors, len(study.rows), "run")


def raise_errors(errors: Sequence[JobRow], count: int, unit: str) -> None:
    """Raises an ``InfrastructureError`` that tells the first of the errors, if there are any."""
    if errors:
        from automotive_cosim.run.row import remedy

        first = errors[0]
        raise InfrastructureError(
            f"{len(errors)} of {counted(count, unit)} ended in an error, the first one {first.id}: "
            f"{first.error_kind}: {first.error}; {remedy(errors)}"
        )


def folder_of(plan: TrafficSettings) -> Path:
    """The results folder of a plan that was given none; the same plan resumes there."""
    from automotive_cosim.interface.trace import canonical

    return Path("runs") / f"study-{hashlib.sha256(canonical(plan.as_json())).hexdigest()[:8]}"
