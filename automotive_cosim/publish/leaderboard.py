"""A static page that compares the evaluations in a folder of bundles, as far as they can be compared.

Only contestants that were planned to run the same episodes with the same minor version under the same limits share
a table. Every bundle is checked first; one with a problem is left out and listed.
"""

from __future__ import annotations

import hashlib
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.episode.conditions import TABLE
from automotive_cosim.errors import UserError
from automotive_cosim.formats import bounds
from automotive_cosim.formats.limited import read_limited
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.publish import archive
from automotive_cosim.publish.contents import read_contents
from automotive_cosim.publish.verify import verify
from automotive_cosim.report.consistency import pass_hat
from automotive_cosim.report.drives import FIGURES, WITH_INTERVAL, told, whole
from automotive_cosim.report.failures import FailureClass
from automotive_cosim.report.findings import classes
from automotive_cosim.report.results import Contestant, contestant, pairs, read_results
from automotive_cosim.report.stats import Rate, rate
from automotive_cosim.report.summary import DIMENSIONS, NONE, input_of, rate_in_words
from automotive_cosim.report.tables import Table, TableRow
from automotive_cosim.report.templates import render
from automotive_cosim.run.rows import DriveTrialRow, EpisodeRow, TrialRow
from automotive_cosim.run.store import cannot_write
from automotive_cosim.run.versions import minor

COLUMNS = (
    "Agent", "Model", "Input", *(each.words.heading for each in TABLE), *DIMENSIONS.values(),
    "Safety pairs", "All episodes", "Every repeat", "Tokens", "Seconds", "Bundle",
)  # fmt: skip
LOST_COLUMNS = (
    "Agent",
    "Model",
    *(each.words.heading for each in TABLE),
    "What went wrong",
    "Episodes",
    "One of them",
)

DRIVE_COLUMNS = (
    "Agent", "Model", "Input", *(each.words.heading for each in TABLE), "Judged",
    *(name for name, _, _ in FIGURES[:WITH_INTERVAL]), "Bundle",
)  # fmt: skip

DIVIDED = (
    "Per cent of the planned episodes (95 % interval), then successes/planned; what was not run is an error. Every "
    "repeat: pass^k. Tokens to and from the model, and seconds of waiting for it, are means of the judged episodes."
)


@dataclass(frozen=True, slots=True)
class BundleConditions:
    """The conditions that contestants in one table share."""

    version: str
    tasks: str
    scenarios: str
    seeds: str
    repeats: str
    phrasings: str
    limits: str
    episodes: str
    """How many episodes a contestant was planned to run, with a digest of their ids."""

    def differing(self, other: BundleConditions) -> list[str]:
        """The conditions in which another differs, in words."""
        return [
            f"{name}: {getattr(self, name)} instead of {getattr(other, name)}"
            for name in self.__slots__
            if getattr(self, name) != getattr(other, name)
        ]


BoardTable = tuple[Table, BundleConditions, list[str]]
"""A table, the conditions that its rows share, and how they differ from those of the first table."""


@dataclass(frozen=True, slots=True)
class BoardPage:
    """What a page of bundles shows."""

    tables: list[BoardTable]
    """Of tasks."""
    lost: Table
    drives: list[Table]
    left_out: list[str]
    """The bundles that were left out, and why."""


@dataclass(frozen=True, slots=True)
class BoardEntry:
    """One contestant of one bundle."""

    bundle: str
    sha256: str
    version: str
    """Of the package that ran it."""
    contestant: Contestant
    conditions: BundleConditions
    rates: tuple[Rate, ...]
    """By dimension, over first halves; of the safety pairs; of all episodes."""
    beside: tuple[str, str, str]
    """pass^k, tokens and seconds of an episode."""
    lost: tuple[tuple[str, str, str], ...]
    """Of each class of failures that occurs: its name, how many episodes of how many judged, and one of them."""

    @property
    def conditions_in_words(self) -> tuple[str, ...]:
        return tuple(line.told(line.of(self.contestant.conditions)) for line in TABLE)

    @property
    def order(self) -> tuple[float, float, str, str]:
        """The best pair success first, then the best success, then by name."""
        *_, joined, whole = (rate.value or 0.0 for rate in self.rates)
        return -joined, -whole, self.contestant.label, self.bundle


@dataclass(frozen=True, slots=True)
class DrivenEntry:
    """One contestant's drives in one bundle."""

    bundle: str
    sha256: str
    version: str
    """Of the package that ran them."""
    minor: str
    """Its minor version, within which drives can be compared."""
    contestant: Contestant
    rows: tuple[DriveTrialRow, ...]
    drives: str
    """How many drives a contestant was planned to run, with a digest of which."""

    @property
    def value(self) -> float:
        """The score of all judged drives; below any other without one."""
        return whole(self.rows).value if any(row.score for row in self.rows) else float("-inf")

    @property
    def row(self) -> TableRow:
        """Its line in the table."""
        each, judged = self.contestant, [row for row in self.rows if row.score is not None]
        figures = FIGURES[:WITH_INTERVAL]
        return (
            each.method,
            each.base_model,
            input_of(Contestant(each.agent, each.model)),
            *(line.told(line.of(each.conditions)) for line in TABLE),
            f"{len(judged)} of {len(self.rows)}",
            *(told(judged, figure, form) if judged else NONE for _, figure, form in figures),
            f"{self.bundle} ({self.version}), {self.sha256[:12]}",
        )


def write_leaderboard(folder: Path, out: Path, *, workers: int = 1, mixed: bool = False) -> list[str]:
    """Writes the page; see ``board``.

    Returns:
        The bundles that were left out, and why."""
    return board(folder, out, workers=workers, mixed=mixed).left_out


def board(folder: Path, out: Path, *, workers: int = 1, mixed: bool = False) -> BoardPage:
    """Checks every bundle and writes the page.

    Args:
        mixed: put evaluations of several versions of the package into one table, and say so.

    Raises UserError: there is no bundle without a problem, or the page cannot be written."""
    if not folder.is_dir():
        raise UserError(
            f"{folder} is not a folder; give one with bundles, which `automotive-cosim publish bundle` makes"
        )
    entries: list[BoardEntry] = []
    driven: list[DrivenEntry] = []
    left_out: list[str] = []
    for path in sorted(path for path in folder.iterdir() if path.is_file() and path.resolve() != out.resolve()):
        try:
            problems = verify(path, workers=workers).problems
            if problems:
                left_out.append(f"{path.name}: {counted(len(problems), 'problem')}, such as {problems[0]}")
            else:
                read = read_limited(_contestants, path, bounds.BUNDLE, UserError)
                entries += read[0]
                driven += read[1]
        except UserError as error:
            left_out.append(str(error).replace(str(path), path.name))
    if not entries and not driven:
        raise UserError(f"{folder} has no valid bundle{''.join(f'; {each}' for each in left_out[:3])}")
    if mixed:
        version = ", ".join(
            sorted({*(entry.conditions.version for entry in entries), *(each.minor for each in driven)})
        )
        driven = [replace(each, minor=version) for each in driven]
        entries = [replace(entry, conditions=replace(entry.conditions, version=version)) for entry in entries]
    made = BoardPage(tables(entries), lost_table(entries), drives_tables(driven), left_out)
    page = render(
        "publish/leaderboard.html",
        tables=made.tables,
        lost=made.lost,
        drives=made.drives,
        left_out=left_out,
        rates=DIVIDED,
    )
    try:
        write_whole(out, page)
    except OSError as error:
        raise cannot_write(out.parent, error) from error
    return made


def _contestants(bundle: Path) -> tuple[list[BoardEntry], list[DrivenEntry]]:
    """Runs in a process with limits."""
    return read_entries(bundle), read_driven(bundle)


def read_entries(bundle: Path) -> list[BoardEntry]:
    """The contestants of a bundle. Raises UserError: it cannot be read."""
    with archive.unpacked(bundle) as folder:
        contents, results = read_contents(folder), read_results(folder)
        failed = classes(results)
    made = []
    for each in results.contestants:
        rows = results.planned_of(each)
        firsts = [row for row in rows if row.half == "first"]
        by_dimension = [_rate(row for row in firsts if row.dimension == name) for name in DIMENSIONS]
        rates = (*by_dimension, _rate(pair for pair, _ in pairs(rows)), _rate(rows))
        conditions = _conditions(minor(contents.suite), results.manifest["plan"], rows)
        beside = _beside(rows, int(results.manifest["plan"]["repeats"]))
        lost = _lost(
            [row for row in rows if row.id in failed], failed, sum(row.outcome is not None for row in rows)
        )
        made.append(BoardEntry(bundle.name, contents.sha256, contents.suite, each, conditions, rates, beside, lost))
    return made


def _beside(rows: Sequence[EpisodeRow], repeats: int) -> tuple[str, str, str]:
    judged = [row for row in rows if row.outcome is not None]
    if not any(row.model_seconds for row in judged):
        return pass_hat(judged, repeats), NONE, NONE
    tokens = sum(row.tokens_in + row.tokens_out for row in judged) / len(judged)
    return (
        pass_hat(judged, repeats),
        f"{tokens:,.0f}",
        f"{sum(row.model_seconds for row in judged) / len(judged):.1f}",
    )


def _lost(
    rows: Sequence[EpisodeRow], classes: Mapping[str, FailureClass], judged: int
) -> tuple[tuple[str, str, str], ...]:
    of_class = {name: [row.id for row in rows if classes[row.id] is name] for name in FailureClass}
    return tuple((name.words, f"{len(ids)} of {judged}", min(ids)) for name, ids in of_class.items() if ids)


def _rate(rows: Iterable[TrialRow]) -> Rate:
    """Over what was planned: nobody gains by stopping, so what was not run counts as an error."""
    return rate((row.subject, row.outcome) for row in rows)


def read_driven(bundle: Path) -> list[DrivenEntry]:
    """The contestants of a bundle's drives. Raises UserError: it cannot be read."""
    with archive.unpacked(bundle) as folder:
        contents, results = read_contents(folder), read_results(folder)
    rows = (*results.drives, *results.drives_not_run)
    made = []
    for each in dict.fromkeys(map(contestant, rows)):
        mine = [row for row in rows if contestant(row) == each]
        instances = sorted({row.instance for row in mine})
        digest = hashlib.sha256(repr(instances).encode()).hexdigest()[:8]
        planned = f"{counted(len(instances), 'drive')} of each ({digest})"
        made.append(
            DrivenEntry(
                bundle.name, contents.sha256, contents.suite, minor(contents.suite), each, tuple(mine), planned
            )
        )
    return made


def drives_tables(entries: Sequence[DrivenEntry]) -> list[Table]:
    """A table for each set of drives and version of the package, the largest first."""
    alike: dict[tuple[str, str], list[DrivenEntry]] = defaultdict(list)
    for entry in entries:
        alike[entry.minor, entry.drives].append(entry)
    ordered = sorted(alike.items(), key=lambda each: (-len(each[1]), each[0]))
    return [
        Table(
            f"drives_{number}",
            f"Drives: {drives}, version {version}",
            DRIVE_COLUMNS,
            tuple(entry.row for entry in sorted(found, key=lambda entry: -entry.value)),
            heads=3 + len(TABLE),
        )
        for number, ((version, drives), found) in enumerate(ordered, start=1)
    ]


def tables(entries: Sequence[BoardEntry]) -> list[BoardTable]:
    """A table for each set of conditions, the largest first, and how it differs from the first."""
    alike: dict[BundleConditions, list[BoardEntry]] = defaultdict(list)
    for entry in entries:
        alike[entry.conditions].append(entry)
    ordered = sorted(alike.items(), key=lambda each: (-len(each[1]), str(each[0])))
    first = ordered[0][0] if ordered else None  # drives have tables of their own
    return [
        (_table(number, found), conditions, conditions.differing(first or conditions))
        for number, (conditions, found) in enumerate(ordered, start=1)
    ]


def _table(number: int, entries: Sequence[BoardEntry]) -> Table:
    rows: list[TableRow] = []
    for entry in sorted(entries, key=lambda each: each.order):
        each = entry.contestant
        rows.append(
            (
                each.method,
                each.base_model,
                input_of(Contestant(each.agent, each.model)),
                *entry.conditions_in_words,
                *(rate_in_words(rate) if rate.planned else NONE for rate in entry.rates),
                *entry.beside,
                f"{entry.bundle} ({entry.version}), {entry.sha256[:12]}",
            )
        )
    return Table(f"table_{number}", f"Table {number}", COLUMNS, tuple(rows), heads=3 + len(TABLE))


def lost_table(entries: Sequence[BoardEntry]) -> Table:
    """What went wrong in the episodes that models did not solve, with one of each class to open."""
    rows = tuple(
        (entry.contestant.method, entry.contestant.base_model, *entry.conditions_in_words, *each)
        for entry in sorted(entries, key=lambda entry: entry.order)
        if entry.beside[-1] != NONE
        for each in entry.lost
    )
    note = "Read from the trace by fixed rules. Unpack the bundle, a zip archive in xz, to open it in `serve`."
    return Table("lost", "What went wrong", LOST_COLUMNS, rows, note, heads=len(LOST_COLUMNS))


def _conditions(version: str, plan: Json, rows: Sequence[EpisodeRow]) -> BundleConditions:
    instances = sorted({(row.task, row.half, row.scenario, row.seed, row.repeat) for row in rows})
    digest = hashlib.sha256(repr(instances).encode()).hexdigest()[:8]
    limits = plan["limits"]
    return BundleConditions(
        version=version,
        tasks=counted(len({row.task for row in rows}), "task"),
        scenarios=", ".join(plan["scenarios"]) or "each task's own",
        seeds=", ".join(map(str, sorted({row.seed for row in rows}))),
        repeats=str(plan["repeats"]),
        phrasings="held out" if plan["held_out"] else "any",
        limits=f"{limits['steps']} steps, {limits['sim_s']:g} s simulated, {limits['tokens']:,} tokens",
        episodes=f"{len(instances):,} of each ({digest})",
    )
