"""``automotive-cosim report``, ``replay`` and ``attribute``: commands on a folder of results."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from automotive_cosim.cli.options import print_json, reads_results, tells_json
from automotive_cosim.contracts.plain import clock, counted
from automotive_cosim.errors import install_hint

if TYPE_CHECKING:
    from automotive_cosim.run.effect import ActEffect
    from automotive_cosim.run.trial import TrialObserver, TrialSetup

Folder = Annotated[Path, typer.Argument(help="Results folder of `eval` or `study`.", show_default=False)]


@reads_results
def report(
    folder: Folder,
    safety: Annotated[
        bool,
        typer.Option("--safety", help="Write a safety report to file: safety/ with a page, a PDF and its data."),
    ] = False,
    agent: Annotated[
        str | None,
        typer.Option(help="Agent of the safety report or the protocol, if there are several.", show_default=False),
    ] = None,
    protocol: Annotated[
        str | None, typer.Option(help="Protocol whose rows the runs speak for: euroncap-2026.", show_default=False)
    ] = None,
) -> None:
    """Write report.html, tables and plots into the folder of an evaluation or a study."""
    if protocol is not None:
        from automotive_cosim.safety.protocol.page import write_protocol

        page, unscored = write_protocol(folder, protocol, agent or "")
        typer.echo(f"{page} written" + (f"; {unscored}" if unscored else ""))
        return
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
    typer.echo(f"{pdf} written" if pdf else f"no PDF: it needs the extra safety, {install_hint('safety')}")


TrialFolder = Annotated[
    Path, typer.Argument(help="Results folder of `run`, `eval`, `search` or `study`.", show_default=False)
]
TrialId = Annotated[
    str,
    typer.Argument(
        help="In a folder of `eval`: id of the episode or drive, or the beginning of it.", show_default=False
    ),
]


@tells_json
@reads_results
def attribute(folder: TrialFolder, episode: TrialId = "", as_json: bool = False) -> None:
    """Measure what each act of a stored run changed, by leaving it out, and add that to its page.

    Acts that change nothing alone are also left out in pairs. Of a rerouting study, it tells of each decision."""
    from automotive_cosim.formats.layout import PAGE
    from automotive_cosim.report.page import write_page
    from automotive_cosim.run.attribution import attribute as measured
    from automotive_cosim.run.extensions import kind_of
    from automotive_cosim.run.store import read_manifest
    from automotive_cosim.run.trial_folder import is_trial

    kind = None if is_trial(folder) else kind_of(read_manifest(folder)["plan"])
    effects = measured(folder, episode) if kind is None else kind.effects(folder, episode)
    if (folder / PAGE).is_file():
        write_page(folder)
    _tell_effects(effects, as_json=as_json)


def _tell_effects(effects: Sequence[ActEffect], *, as_json: bool) -> None:
    if as_json:
        print_json({"acts": [asdict(each) | {"effect": each.effect} for each in effects]})
        return
    from automotive_cosim.run.attribution import sentence

    typer.echo(sentence(effects))
    for each in effects:
        step = f"step {' and '.join(map(str, each.steps))}, " if each.steps else ""
        typer.echo(f"{step}{clock(each.at_s)}  {each.act}")
        if each.came:
            typer.echo(f"    driver: {each.came}")
        typer.echo(f"    effect: {each.effect}")


@tells_json
@reads_results
def replay(
    folder: TrialFolder,
    episode: TrialId = "",
    without: Annotated[
        list[int] | None,
        typer.Option(help="Leave out what this step commanded, and say what that changes; may be repeated."),
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="New folder for what is replayed, with its pictures.", show_default=False)
    ] = None,
    as_json: bool = False,
) -> None:
    """Replay the actions of a stored run and compare the traces.

    A car of a fleet is replayed with all cars of it. Exit code 1 if the traces differ."""
    from automotive_cosim.report.page import write_page
    from automotive_cosim.run.record import check_folder
    from automotive_cosim.run.rerun import rerun
    from automotive_cosim.run.trial_folder import read_trial

    if without:
        from automotive_cosim.run.attribution import attribute as measured

        _tell_effects(measured(folder, episode, without), as_json=as_json)
        return
    if out is not None:
        check_folder(out, force=False)
    compared = rerun(folder, episode, partial(_keeping, out))
    if out is not None and "task" in read_trial(out)["row"]:
        write_page(out)
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


def _keeping(out: Path | None, job: TrialSetup) -> Sequence[TrialObserver]:
    """What records a trial that is replayed as `run` does, in a folder; nothing without one."""
    from automotive_cosim.report.film import Film
    from automotive_cosim.run.episode import EpisodeSetup
    from automotive_cosim.run.record import Recorder
    from automotive_cosim.run.road_recorder import RoadRecorder

    if out is None:
        return ()
    is_task = isinstance(job, EpisodeSetup)
    kept = Recorder(job, out, {"out": str(out)}, whole=is_task), RoadRecorder(out, job.about)
    return (*kept, Film(out)) if is_task else kept
