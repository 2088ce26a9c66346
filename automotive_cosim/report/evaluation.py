"""``report.html``: an evaluation on one self-contained page, and its tables and plots as files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from automotive_cosim.agents import NOT_RANKED
from automotive_cosim.contracts import Json
from automotive_cosim.episode.conditions import told
from automotive_cosim.errors import UserError
from automotive_cosim.formats.files import read_bytes
from automotive_cosim.formats.layout import PICTURES
from automotive_cosim.formats.writing import drafted, write_whole
from automotive_cosim.report import drives, findings
from automotive_cosim.report.answer import answer
from automotive_cosim.report.charts import Chart, charts, require_plots
from automotive_cosim.report.consistency import consistency, varied
from automotive_cosim.report.failures import FailureClass
from automotive_cosim.report.files import write_files
from automotive_cosim.report.findings import PLACE
from automotive_cosim.report.house_rules import house_rules
from automotive_cosim.report.interfaces import interfaces
from automotive_cosim.report.page import PARTS, embedded
from automotive_cosim.report.plot import Plot
from automotive_cosim.report.results import Results, contestant, read_results
from automotive_cosim.report.summary import PUBLISHED, errors, outdated, progress, replaced, tables
from automotive_cosim.report.tables import Cell, Table
from automotive_cosim.report.templates import render
from automotive_cosim.run.episode import EpisodeResult
from automotive_cosim.run.job_row import from_json
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.store import cannot_write, megabytes, read_trace, trace_file
from automotive_cosim.run.trial_folder import pictures, shown

CONTROLS = ("none", "irrelevant", "wrong", "gps", "context")
"""Geo controls to compare with full geo-context, the clearest contrast first."""


@dataclass(frozen=True, slots=True)
class Side:
    """One of the two episodes, ready to be shown."""

    row: EpisodeRow
    result: EpisodeResult
    wide: Plot
    narrow: Plot
    steps: tuple[tuple[str, str, str], ...]
    """Seconds since the hand-over, the action, and the thought behind it."""
    picture: str
    """The cockpit at the end, as a data URL; empty if no pictures were kept."""


def contrast(results: Results) -> tuple[Side, Side] | None:
    """An instance that the same agent solved with geo-context and not without; None if there is none.

    Pairs that depend on place come first, then other safety tasks, each in the order of their ids."""
    rows = [row for row in results.rows if row.success is not None and _has_trace(results, row)]
    solved = {_key(row): row for row in rows if row.conditions.geo == "full" and row.success}
    found = [
        (PLACE not in row.tags, not row.pair, CONTROLS.index(row.conditions.geo), row.id, row)
        for row in rows
        if row.conditions.geo in CONTROLS and not row.success and _key(row) in solved
    ]
    if not found:
        return None
    *_, without = min(found, key=lambda each: each[:-1])
    return _side(results.folder, solved[_key(without)]), _side(results.folder, without)


def _key(row: EpisodeRow) -> tuple[object, ...]:
    return row.agent, row.model, *row.instance


def _has_trace(results: Results, row: EpisodeRow) -> bool:
    return trace_file(results.folder, row.id).is_file()


def _side(folder: Path, row: EpisodeRow) -> Side:
    *steps, last = read_trace(folder, row.id)
    result = from_json(EpisodeResult, last["result"])
    screens = pictures(folder / PICTURES / row.id)
    return Side(
        row,
        result,
        Plot(result.path, result.timeline, 480, 260),
        Plot(result.path, result.timeline, 360, 240),
        tuple(_told(steps)),
        embedded(read_bytes(screens[-1]), "image/jpeg") if screens else "",
    )


def _told(steps: Sequence[Json]) -> list[tuple[str, str, str]]:
    return [(f"{before['at_s']:+.1f} s", step["words"], step["thought"]) for before, step in pairwise(shown(steps))]


@dataclass(frozen=True, slots=True)
class Source:
    """The episodes behind one figure."""

    number: int
    title: str
    figure: str
    episodes: tuple[EpisodeRow, ...]


def write_report(folder: Path) -> Path:
    """Writes ``report.html``, ``tables/`` and ``plots/`` into an evaluation's folder; returns the page.

    Raises:
        UserError: the folder is not an evaluation's, has no episodes yet, or cannot be written.
        SetupError: the extra ``reports`` is not installed."""
    require_plots()
    results = read_results(folder)
    if not results.rows and not results.drives:
        raise UserError(f"{folder} has no episodes yet ({results.coverage}); rerun its `eval` command to resume")
    found = findings.classes(results)
    made = all_tables(results, found) if results.rows else []
    plots = charts(results.shared()) if results.rows else {}
    of_drives = drives.tables(results.drives, folder)
    try:
        with drafted(page := folder / "report.html") as file:
            write_files(folder, (*made, *of_drives), plots.values())
            picture, pages = drives.fleets(folder, results.drives)
            for name, text in pages.items():
                write_whole(folder / name, text)
            driven = of_drives, drives.timelines(folder, results.drives), picture
            told = _page(results, made, plots, found, driven) if results.rows else _drives_page(results, *driven)
            file.write(told.encode())
    except OSError as error:
        raise cannot_write(folder, error) from error
    return page


def all_tables(results: Results, found: Mapping[str, FailureClass]) -> list[Table]:
    """Every table of the report, the most important first; on shared instances, but for what was planned and run
    and what ended in an error."""
    shared = results.shared()
    made = [
        consistency(shared),
        progress(results),
        *tables(shared),
        house_rules({each: shared.of(each) for each in shared.contestants}),
        interfaces(shared),
        varied(shared),
        findings.failures(shared, found),
        findings.meanings(found),
        findings.harm(shared),
        findings.act_effects(results.folder, {row.id: row.id for row in results.rows}),
        findings.place_effect(shared),
        *findings.by_condition(shared),
        findings.by_difficulty(shared),
        findings.by_label(
            shared, "ability", "abilities", lambda row: () if row.ability is None else (row.ability,)
        ),
        findings.by_label(shared, "skill", "skills", lambda row: row.skills),
        findings.by_label(shared, "tag", "tags", lambda row: row.tags),
        findings.prompts(shared),
        findings.distribution(shared),
        replaced(results),
        outdated(results),
        errors(results),
    ]
    return [table for table in made if table.rows]


def _page(
    results: Results,
    made: Sequence[Table],
    plots: Mapping[str, Chart],
    found: Mapping[str, FailureClass],
    driven: tuple[Sequence[Table], Mapping[str, Chart], str],
) -> str:
    numbers = {row.id: number for number, row in enumerate(results.rows)}
    sources, linked = _sources(results, made)
    starts = results.manifest["starts"]
    return render(
        "report/evaluation.html",
        results=results,
        answer=answer(results),
        coverage=results.coverage,
        tables=[table for table in linked if table[0].name not in (*PUBLISHED, "errors")],
        published=[table for table in made if table.name in PUBLISHED],
        errors=next((table for table in linked if table[0].name == "errors"), None),
        plots=plots,
        sources=sources,
        numbers=numbers,
        episodes=[_episode(results.folder, row) for row in results.rows],
        case=contrast(results),
        classes={episode: name.replace("_", " ") for episode, name in found.items()},
        failures=[row for row in results.rows if row.success is False],
        labels={row.id: contestant(row).label for row in results.rows},
        parts=PARTS,
        plan=results.manifest["plan"],
        conditions=told(results.manifest["plan"]),
        starts=starts,
        is_mixed=any(start["git"] != starts[0]["git"] for start in starts),
        has_controls=any(row.agent in NOT_RANKED for row in results.rows),
        has_stand_in=any(row.model == "rules" for row in results.rows),
        megabytes=megabytes(results.folder),
        drive_tables=driven[0],
        drive_plots=driven[1],
        picture=driven[2],
    )


def _drives_page(results: Results, made: Sequence[Table], plots: Mapping[str, Chart], picture: str) -> str:
    """The page of an evaluation of drives alone."""
    rows = results.drives
    return render(
        "report/drives.html",
        rows=rows,
        answer=answer(results),
        errors=sum(row.error is not None for row in rows),
        tables=made,
        plots=plots,
        picture=picture,
        plan=results.manifest["plan"],
        starts=results.manifest["starts"],
        stand_in=any(row.model == "rules" for row in rows),
    )


def _sources(
    results: Results, made: Sequence[Table]
) -> tuple[list[Source], list[tuple[Table, list[list[tuple[str, int | None]]]]]]:
    """The episodes behind each figure, numbered, and each table's cells with the numbers they link to."""
    rows = {row.id: row for row in results.rows}
    sources: list[Source] = []
    linked = []
    for table in made:
        cells: list[list[tuple[str, int | None]]] = []
        for row in table.rows:
            told: list[tuple[str, int | None]] = []
            for column, cell in zip(table.columns, row, strict=True):
                number = None
                if isinstance(cell, Cell) and cell.episodes:
                    number = len(sources)
                    # An error is named by its kind; its message is at its episode.
                    named = str(row[1]) if table.name == "errors" else ", ".join(map(str, row[: table.heads]))
                    title = f"{table.title}: {named}" + ("" if table.name == "errors" else f", {column}")
                    sources.append(Source(number, title, cell.text, tuple(rows[name] for name in cell.episodes)))
                told.append((str(cell), number))
            cells.append(told)
        linked.append((table, cells))
    return sources, linked


def _episode(folder: Path, row: EpisodeRow) -> Json:
    """An episode on the page: its line, its result if there is a trace, and its files."""
    has_trace = trace_file(folder, row.id).is_file()
    return {
        "row": row,
        "result": from_json(EpisodeResult, read_trace(folder, row.id)[-1]["result"]) if has_trace else None,
        "trace": trace_file(folder, row.id).relative_to(folder).as_posix() if has_trace else "",
        "pictures": {
            int(path.stem.removeprefix("step_")): path.relative_to(folder).as_posix()
            for path in pictures(folder / PICTURES / row.id)
        },
    }
