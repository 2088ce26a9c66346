"""``automotive-cosim report`` and ``replay``: commands on a folder of results."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any

import typer

from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.cli.options import AsJson, print_json, reads_results
from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import UserError, install_hint
from automotive_cosim.report.settings import PlaybackSettings

Folder = Annotated[Path, typer.Argument(help="Results folder of `eval` or `study`.", show_default=False)]


@reads_results
def report(
    folder: Folder,
    safety: Annotated[
        bool,
        typer.Option("--safety", help="Write a safety report to file: safety/ with a page, a PDF and its data."),
    ] = False,
    agent: Annotated[
        str | None, typer.Option(help="Agent of the safety report, if there are several.", show_default=False)
    ] = None,
) -> None:
    """Write report.html, tables and plots into the folder of an evaluation or a study."""
    if safety:
        _safety(folder, agent or "")
        return
    from automotive_cosim.report.evaluation import write_report
    from automotive_cosim.report.results import read_results
    from automotive_cosim.run.extensions import kind_of
    from automotive_cosim.run.store import read_manifest

    kind = kind_of(read_manifest(folder)["plan"])
    if kind is not None:
        page = kind.write_page(folder)
    else:
        page = write_report(folder)
        typer.echo(str(read_results(folder).coverage))
    typer.echo(f"{page} written; tables in {folder / 'tables'}, plots in {folder / 'plots'}")


def _safety(folder: Path, agent: str) -> None:
    from automotive_cosim.safety.dossier.filing import write_dossier
    from automotive_cosim.safety.dossier.subject import read_subject

    subject = read_subject(folder, agent)
    page, pdf = write_dossier(folder, subject.agent)
    beside = f" (--agent takes one of the others: {', '.join(subject.others)})" if subject.others else ""
    typer.echo(f"{page} written, about {subject.agent}{beside}; its data in {page.parent / 'data'}")
    typer.echo(f"{pdf} written" if pdf else f"no PDF: {install_hint('reports')}")


@reads_results
@takes(PlaybackSettings)
def replay(
    folder: Annotated[Path, typer.Argument(help="Results folder of `run`, `drive` or `eval`.", show_default=False)],
    episode: Annotated[
        str,
        typer.Argument(
            help="In a folder of `eval`: id of the episode or drive, or the beginning of it.", show_default=False
        ),
    ] = "",
    as_json: AsJson = False,
    **settings: Any,
) -> None:
    """Replay the actions of a stored trial and compare the traces, or play back its record.

    Exit code 1 if the traces differ. With --play or --film, show what was recorded; nothing runs again.
    """
    from automotive_cosim.run.rerun import rerun

    shown = filled(PlaybackSettings, settings)
    if shown.play or shown.film is not None:
        if episode or as_json:
            raise UserError("--play and --film show the record of one `run`; omit the episode and --json")
        _show_record(folder, shown.film, shown.speed)
        return
    compared = rerun(folder, episode)
    different = [step for step in compared if step.differs]
    if as_json:
        print_json({"ok": not different, "steps": [asdict(step) for step in compared]})
        raise typer.Exit(bool(different))
    for step in compared:
        differs = f"differs in {', '.join(step.differs)}" if step.differs else "the same"
        typer.echo(f"step {step.number:3d}  {step.sha256[:16]}  {differs}")
    if different:
        typer.echo(
            f"{len(different)} of {counted(len(compared), 'step')} differ, starting with step {different[0].number}"
        )
        raise typer.Exit(1)
    typer.echo("the only step is the same" if len(compared) == 1 else f"all {len(compared)} steps are the same")


def _show_record(folder: Path, film: Path | None, speed: float) -> None:
    """Prints a record step by step, at its pace, or writes its screens as an animation."""
    from time import sleep

    from automotive_cosim.report.playback import frames, write_film

    if film is not None and film.suffix not in (".webp", ".gif"):
        raise UserError(f"{film} is not an animation; give --film a name ending in .webp or .gif")
    shown = list(frames(folder))
    if film is not None:
        write_film(shown, film, speed)
        typer.echo(f"{film} written, {counted(len(shown), 'step')}")
        return
    before_s = 0.0
    for frame in shown:
        sleep((frame.since_s - before_s) / speed)
        before_s = frame.since_s
        typer.echo(frame.words)
        typer.echo(f"     {frame.picture}")
