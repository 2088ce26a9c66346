"""``automotive-cosim publish``: packs, checks and compares evaluations for others."""

from __future__ import annotations

import secrets
from contextlib import nullcontext
from dataclasses import asdict
from functools import partial
from pathlib import Path
from typing import Annotated, Any

import typer
from annotated_types import Ge, Le

from automotive_cosim.cli.batches import ExecutorSettings
from automotive_cosim.cli.derived import filled, number_in, takes
from automotive_cosim.cli.options import MOST_SEED, print_json, reads_results, tells_json
from automotive_cosim.contracts.plain import counted

MOST_LISTED = 50
"""How many problems are printed."""


app = typer.Typer(help="Pack, check, judge again and compare evaluations.", no_args_is_help=True)


@app.command()
def bundle(
    folder: Annotated[Path, typer.Argument(help="Results folder of `eval`.", show_default=False)],
    out: Annotated[Path, typer.Option(help="File to write.", show_default=False)],
) -> None:
    """Pack an evaluation into one file for publication, with a hash of everything in it."""
    from automotive_cosim.publish.bundle import write_bundle

    made = write_bundle(folder, out)
    counts = made.counts
    typer.echo(
        f"{out} written: {counted(len(made.files), 'file')}; {counts.judged} of "
        f"{counted(counts.planned, 'planned episode')} judged, {counted(counts.errors, 'error')}, "
        f"{counts.not_run} not run"
    )
    typer.echo(f"sha256 of its bundle.json: {made.sha256}")


@app.command()
@tells_json
@takes(ExecutorSettings, only=["workers"])
def verify(
    path: Annotated[Path, typer.Argument(help="Results folder of `eval`, or a bundle.", show_default=False)],
    replay: Annotated[
        int,
        typer.Option(
            help="How many drives to replay and compare bit for bit.",
            metavar="N",
            parser=partial(number_in, int, (Ge(0), Le(10**6))),
        ),
    ] = 3,
    replay_seed: Annotated[
        int | None,
        typer.Option(
            help="Seed that draws the drives to replay.",
            metavar="N",
            parser=partial(number_in, int, (Ge(0), Le(MOST_SEED))),
            show_default="a new one each time",
        ),
    ] = None,
    key: Annotated[
        Path | None, typer.Option(help="File with the key of a hidden split, to print its published hashes again.")
    ] = None,
    as_json: bool = False,
    **settings: Any,
) -> None:
    """Check an evaluation or a bundle; exit code 1 if something does not match."""
    from automotive_cosim.publish.verify import verify as verified
    from automotive_cosim.run.hidden import read_key

    seed = secrets.randbelow(2**31) if replay_seed is None else replay_seed
    workers = filled(ExecutorSettings, settings).processes
    secret = None if key is None else read_key(key)
    found = verified(path, replays=replay, seed=seed, key=secret, workers=workers)
    if as_json:
        problems = [asdict(problem) for problem in found.problems]
        print_json({"ok": not problems, "facts": found.facts, "problems": problems, "unknown": found.unknown})
        raise typer.Exit(bool(problems))
    for fact in found.facts:
        typer.echo(fact)
    for problem in found.problems[:MOST_LISTED]:
        typer.echo(f"PROBLEM {problem}")
    if len(found.problems) > MOST_LISTED:
        typer.echo(f"and {len(found.problems) - MOST_LISTED} more")
    typer.echo("this check cannot tell:")
    for line in found.unknown:
        typer.echo(f"  {line}")
    if found.problems:
        typer.echo(f"{counted(len(found.problems), 'problem')} found")
        raise typer.Exit(1)
    typer.echo("no problem found")


@app.command()
@tells_json
@reads_results
def regrade(
    path: Annotated[Path, typer.Argument(help="Results folder of `eval`, or a bundle.", show_default=False)],
    as_json: bool = False,
) -> None:
    """Judge the stored runs again by the current checks and print what changes; nothing is written."""
    from automotive_cosim.publish.archive import unpacked

    with unpacked(path) if path.is_file() else nullcontext(path) as folder:
        _regrade(folder, as_json)


def _regrade(folder: Path, as_json: bool) -> None:
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


@app.command()
@takes(ExecutorSettings, only=["workers"])
def leaderboard(
    folder: Annotated[Path, typer.Argument(help="Folder of bundles.", show_default=False)],
    out: Annotated[Path, typer.Option(help="Page to write.", show_default=False)],
    mixed: Annotated[
        bool,
        typer.Option("--mixed-versions", help="Put all minor versions of automotive-cosim into the same tables."),
    ] = False,
    **settings: Any,
) -> None:
    """Check every bundle in a folder and write a page that compares them."""
    from automotive_cosim.publish.leaderboard import write_leaderboard

    left_out = write_leaderboard(folder, out, workers=filled(ExecutorSettings, settings).processes, mixed=mixed)
    for line in left_out:
        typer.echo(f"left out: {line}")
    typer.echo(f"{out} written")
