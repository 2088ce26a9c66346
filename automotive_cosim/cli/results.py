"""``automotive-cosim report``, ``replay`` and ``regrade``: commands on an evaluation's folder."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from automotive_cosim.cli.options import AsJson, TasksFrom, print_json, reads_results
from automotive_cosim.contracts.plain import counted

Folder = Annotated[Path, typer.Argument(help="Results folder of `eval`.", show_default=False)]


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
    tasks_from: TasksFrom = None,
) -> None:
    """Write report.html, tables and plots into the folder of an evaluation, of tasks or drives, or a study."""
    if safety:
        _safety(folder, agent or "")
        return
    from automotive_cosim.report.evaluation import write_report
    from automotive_cosim.report.results import read_results
    from automotive_cosim.run.store import read_manifest
    from automotive_cosim.studies.page import write_study

    plan = read_manifest(folder)["plan"]
    if "study" in plan:
        page = write_study(folder)
    else:
        page = write_report(folder)
        typer.echo(str(read_results(folder).coverage))
    typer.echo(f"{page} written; tables in {folder / 'tables'}, plots in {folder / 'plots'}")


def _safety(folder: Path, agent: str) -> None:
    from automotive_cosim.safety.dossier.filing import write_dossier

    page, pdf = write_dossier(folder, agent)
    typer.echo(f"{page} written; its data in {page.parent / 'data'}")
    typer.echo(f"{pdf} written" if pdf else "no PDF: pip install 'automotive-cosim[pdf]'")


@reads_results
def replay(
    folder: Annotated[Path, typer.Argument(help="Results folder of `run`, `drive` or `eval`.", show_default=False)],
    episode: Annotated[
        str,
        typer.Argument(
            help="In a folder of `eval`: id of the episode or drive, or the beginning of it.", show_default=False
        ),
    ] = "",
    tasks_from: TasksFrom = None,
    as_json: AsJson = False,
) -> None:
    """Replay the actions of a stored episode or drive and compare the traces; exit code 1 if they differ."""
    from automotive_cosim.run.rerun import rerun

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


@reads_results
def regrade(folder: Folder, tasks_from: TasksFrom = None, as_json: AsJson = False) -> None:
    """Judge the stored trials again by the current checks and print what changes; nothing is written."""
    from automotive_cosim.run.coverage import coverage
    from automotive_cosim.run.regrade import regrade as judged_again
    from automotive_cosim.run.rows import read_trials
    from automotive_cosim.run.store import read_evaluation

    found = coverage(read_evaluation(folder), read_trials(folder))
    if as_json:
        judged = list(judged_again(folder))
        print_json(
            {
                "planned": found.planned,
                "not_run": len(found.not_run),
                "changed": sum(each.differs for each in judged),
                "not_judged": sum(bool(each.problem) for each in judged),
                "episodes": [asdict(each) for each in judged],
            }
        )
        return
    words = {True: "solved", False: "not solved", None: "not judged"}
    count = differing = missing = 0
    for each in judged_again(folder):
        count += 1
        if each.problem:
            missing += 1
            typer.echo(f"{each.episode}: cannot be judged: {each.problem}")
        elif each.differs:
            differing += 1
            typer.echo(f"{each.episode}: {words[each.before]} before, {words[each.now]} now")
            for change in each.changes:
                typer.echo(f"    {change.part.replace('_', ' ')} {'yes' if change.now else 'no'}: {change.why}")
    told = f", {missing} could not be judged" if missing else ""
    typer.echo(f"{differing} of {count} verdicts change{told}; {found}")
