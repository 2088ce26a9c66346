"""The page: what the cases show for each row, what they do not, and the points that the calculator gives."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from automotive_cosim.contracts.plain import counted, rounded
from automotive_cosim.errors import SetupError
from automotive_cosim.formats.writing import drafted, make_folder, write_whole
from automotive_cosim.report.tables import Table
from automotive_cosim.report.templates import render
from automotive_cosim.run.store import cannot_write
from automotive_cosim.safety.dossier.subject import read_subject, share_told
from automotive_cosim.safety.protocol.calculator import Scores, points
from automotive_cosim.safety.protocol.evidence import PARTS, Evidence, LimitTold, evidence, limits_told, protocol

FOLDER = "protocol"
NO_RATING = "This is evidence about an agent, from cases in simulation. It is never a rating of a car."
COUNTS = (
    "A case is an episode of a task, or an event of a drive in which something was due or looked as if it were. "
    "A row holds if all its cases succeeded; in brackets, the 95 % interval of their share (Wilson), which takes "
    "cases as independent."
)
BRACKET = (
    "The calculator is run twice: with what no case showed taken as failed, and as passed. General requirements "
    "are taken as met in both. In a limit's row, a country holds if all its cases succeeded. Hazards count as "
    "heard by one channel, the cloud's."
)


def write_protocol(folder: Path, name: str, agent: str = "") -> tuple[Path, str]:
    """Writes the page of an agent, and its tables, into ``protocol/`` of a run's folder.

    Args:
        folder: of ``eval`` or ``search``.
        agent: whose cases; empty if there is only one.

    Returns:
        The page, and why there are no points; empty if there are.

    Raises UserError: there is no such protocol, or no judged case, or the folder cannot be written."""
    made, subject = protocol(name), read_subject(folder, agent)
    drives, asked = limits_told(subject)
    found = evidence(made, subject, drives)
    scores: tuple[Scores, Scores] = ({}, {})
    unscored = ""
    try:
        scores = points(made, found)
    except SetupError as error:
        unscored = str(error)
    tables = [_part(part, found, scores) for part in PARTS]
    cases = Table(
        "trials",
        "Cases",
        ("Row", "Country", "Case", "Outcome"),
        tuple(
            (each.row.scored or each.row.name, trial.country or "?", trial.id, "success" if trial.ok else "failure")
            for each in found
            for trial in each.trials
        ),
        heads=4,
    )
    told = _told([*(each for drive in drives for each in drive.limits), *asked])
    target = folder / FOLDER
    try:
        with drafted(make_folder(folder, FOLDER) / f"{name}.html") as page:
            for table in (*tables, told, cases):
                write_whole(target / f"{table.name}.csv", table.csv())
            tried = sum(bool(each.trials) for each in found)
            sentence = f"{subject.label}: cases for {tried} of {counted(len(found), 'row')}"
            page.write(
                render(
                    "safety/protocol/protocol.html",
                    name=name,
                    about=(NO_RATING, f"{sentence}."),
                    calculator=f"{made.package} {made.version}, sha256 {made.sha256}",
                    notes=(COUNTS, unscored or BRACKET),
                    tables=tables,
                    told=told if told.rows else None,
                    shares=[(each.trial, f"{each.share:.0%}") for each in drives],
                    cases=cases,
                ).encode()
            )
    except OSError as error:
        raise cannot_write(target, error) from error
    return target / f"{name}.html", unscored


def _part(part: str, found: Sequence[Evidence], scores: tuple[Scores, Scores]) -> Table:
    title, categories = PARTS[part]
    mine = [each for each in found if each.row.part == part]
    sharing = Counter(each.row.scored for each in mine)
    rows = []
    for each in mine:
        count, ok = len(each.trials), each.succeeded
        countries = (f"{name or '?'} {one.succeeded}/{len(one.trials)}" for name, one in each.by_country.items())
        tried_by = f" ({each.row.tried_by})" if each.row.tried_by else ""
        lacks = each.row.lacks if count else f"not tried{tried_by}: {each.row.lacks}".removesuffix(": ")
        told = _points([each.row.points_of], scores) or "not scored"
        if each.row.scored and sharing[each.row.scored] > 1:
            told += f" for {sharing[each.row.scored]} rows"
        runs = len({trial.id for trial in each.trials})
        figures = map(str, (runs, count, ok))
        rows.append((each.row.name, lacks, ", ".join(countries), *figures, share_told(ok, count), told))
    columns = ("Row", "Not shown", "By country", "Runs", "Cases", "Succeeded", "% (95 %)", "Points")
    together = _points(categories, scores)
    return Table(part, title, columns, tuple(rows), f"Together {together} points." if together else "", heads=3)


def _points(names: Sequence[str], scores: tuple[Scores, Scores]) -> str:
    """Least to most points of some rows or categories, of all there are; empty if they were not scored."""
    if not names or not all(name in score for name in names for score in scores):
        return ""
    least, most = (sum(score[name][0] for name in names) for score in scores)
    told = rounded(least, 2) if least == most else f"{rounded(least, 2)} to {rounded(most, 2)}"
    return f"{told} of {rounded(sum(scores[0][name][1] for name in names), 2)}"


def _told(limits: Sequence[LimitTold]) -> Table:
    """Each limit that began to hold, and what was told of it."""

    def figure(value: float | None, digits: int = 0) -> str:
        return "–" if value is None else f"{value:.{digits}f}"

    rows = (
        (
            each.trial,
            each.country or "?",
            figure(each.at_s),
            figure(each.limit_kmh),
            figure(each.told_kmh),
            figure(each.off_kmh),
            figure(each.after_s, 1),
            figure(each.after_m),
        )
        for each in limits
    )
    columns = ("Case", "Country", "At s", "Limit km/h", "Told km/h", "Off km/h", "After s", "After m")
    note = (
        "On a drive, from where a limit begins to hold, by sign or verified law; on a task, from the hand-over. "
        "Told is the first speed then; the last two columns are those of the first right one."
    )
    return Table("told", "Limits told", columns, tuple(rows), note, heads=2)
