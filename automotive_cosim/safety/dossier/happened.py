"""What happened: events, failures with their minimal cases, and how critical it was."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from statistics import median

import numpy as np

from automotive_cosim.contracts.plain import clock, counted
from automotive_cosim.drives.events import KINDS
from automotive_cosim.drives.faults import faults
from automotive_cosim.drives.judge import EventOutcome
from automotive_cosim.measures.thresholds import DEFAULT_THRESHOLDS
from automotive_cosim.report.stats import CONFIDENCE
from automotive_cosim.report.tables import Table
from automotive_cosim.run.attribution import NOT_MEASURED, culprit, path_of, read_effects
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.safety.dossier.subject import CONFIDENCE_WORDS, Section, Subject, hours_of

MOST_FAILURES = 40
"""Failing trials that are listed; all of them are in the data."""
MOST_FAULTS = 200
"""Single faults that are listed, likewise."""
DRAWS = 2000
"""Bootstrap samples, at which the second digit of a bound is stable."""
LEAST_CLUSTERS = 5
"""Fewer trials give no bootstrap interval."""
NO_RATES = "A search's runs are drawn to failures, so that they are counted and give no rates."


def events(subject: Subject) -> Section:
    """Events of drives by kind, and tasks by module."""
    made = [_kinds(subject, in_space=True), _kinds(subject, in_space=False)] if subject.drives else []
    if subject.episodes:
        made.append(_tasks(subject))
    return Section("events", "Events", tables=tuple(table for table in made if table.rows))


def _kinds(subject: Subject, *, in_space: bool) -> Table:
    """Events of the kinds that count, or of those that a search's space does not name."""
    lines = []
    for kind in KINDS:
        if subject.is_in_space(kind) == in_space:
            events = [event for row in subject.drives for event in row.events if event.kind == kind]
            if not events:
                continue
            real = [event for event in events if event.outcome.counts]
            alike = [event for event in events if event.lookalike]
            tally = Counter(event.outcome for event in events)
            met = sum(event.outcome.is_credited for event in real)
            own = tally[EventOutcome.CAUSED] + tally[EventOutcome.EVADED]
            counts = met, tally[EventOutcome.LATE], tally[EventOutcome.MISSED], own, tally[EventOutcome.VOID]
            left = f"{tally[EventOutcome.AVOIDED]} of {len(alike)}" if alike else "–"
            lines.append((kind, str(len(real)), *subject.share(met, len(real)), *map(str, counts), left))
    share = () if subject.findings else ("Met % (interval)",)
    heads = "Kind", "Due", *share, "Met", "Late", "Missed", "Own doing", "Void", "Look-alikes left"
    note = (
        "Void: nothing had to be done, it passed by itself, or nobody could have met it. Own doing: caused, or "
        "evaded by holding the car back for no reason. "
    )
    note += NO_RATES if subject.findings else "Intervals: Wilson, 95 %, as if events were independent."
    if in_space:
        return Table("events", "Events by kind", heads, tuple(lines), note)
    title = "Events of kinds that the space does not name"
    return Table("events_beside", title, heads, tuple(lines), f"No failure of the search is one of these. {note}")


def _tasks(subject: Subject) -> Table:
    groups: dict[str, list[EpisodeRow]] = {}
    for row in subject.episodes:
        groups.setdefault(str(row.module), []).append(row)
    modules = []
    for module, rows in sorted(groups.items()):
        missing = Counter(part for row in rows for part in row.missing)
        lacks = ", ".join(f"{part.replace('_', ' ')} {count}" for part, count in missing.most_common())
        passed = sum(row.has_succeeded for row in rows)
        modules.append((module, str(len(rows)), str(passed), *subject.share(passed, len(rows)), lacks or "–"))
    share = () if subject.findings else ("Passed % (interval)",)
    columns = "Module", "Episodes", "Passed", *share, "Parts missing"
    return Table("tasks", "Tasks by module", columns, tuple(modules), NO_RATES if subject.findings else "")


def failures(subject: Subject) -> Section:
    """Minimal cases of a search, and every failing trial."""
    made, told = [], []
    if subject.findings is not None:
        cases = tuple(
            (
                str(number),
                each["words"],
                each["why"],
                each.get("act") or NOT_MEASURED,
                each.get("beside") or "no neighbour found",
                f"failures/{number:02d}.toml",
            )
            for number, each in enumerate(subject.findings["failures"], 1)
        )
        heads = "No.", "Fails with", "What is missing", "Act, or missing act", "Beside it", "Replay"
        note = (
            "Each failed three times of three; factors that are not named are nominal. Replay: automotive-cosim "
            "eval --plan with that file, which also has what is beside it: the nearest that does not fail."
        )
        if cases:
            made.append(Table("minimal", "Minimal cases", heads, cases, note, heads=6))
    else:
        told.append(
            "No search was made, so that the conditions which each failure needs are not known. automotive-cosim "
            "search finds them."
        )
    folder = subject.results.folder
    lines = tuple(
        (row.id, subject.missing(row) or "–", culprit(read_effects(path_of(folder, row.id))) or NOT_MEASURED)
        for row in subject.failed[:MOST_FAILURES]
    )
    if lines:
        more = len(subject.failed) - len(lines)
        note = (
            "automotive-cosim replay FOLDER ID runs a run again and says whether every step is the same, bit "
            "for bit; automotive-cosim attribute FOLDER ID finds the act, or the missing act, that made it."
            + (f" {more} more are in the data." if more else "")
        )
        made.append(
            Table(
                "failures",
                "Failing runs",
                ("Run", "What is missing", "Act, or missing act"),
                lines,
                note,
                heads=3,
            )
        )
    elif not made:
        told.append(f"None of {counted(len(subject.due), 'run')} in which something was due failed.")
    made += [listed for in_space in (True, False) if (listed := _faults(subject, in_space=in_space)).rows]
    return Section("failures", "Failures", tuple(told), tuple(made))


def _faults(subject: Subject, *, in_space: bool) -> Table:
    """What was missed, late or needless in each drive, one by one, and why: what counts as a failure, or what a
    search's space does not count, which are other kinds of events, and needless acts if it names kinds."""
    drives = subject.drives
    every = [
        (row, fault)
        for row in drives
        for fault in faults(row.events, row.acts)
        if subject.is_in_space(fault.kind) == in_space
    ]
    several = len({(row.repeat, row.settings, row.conditions) for row in drives}) > 1
    lines = tuple(
        (
            row.id if several else f"{row.name}, seed {row.seed}",
            clock(fault.time_s),
            fault.what,
            fault.about,
            fault.why,
        )
        for row, fault in every[:MOST_FAULTS]
    )
    more = len(every) - len(lines)
    note = (
        "When: minutes and seconds since departure at which something was due, or the agent acted. Why: what was "
        "there, from when to when something was due, and what came; of a needless act, what speaks against it of "
        "what could be known, and when it would have been right."
        + (f" {more} more are in the runs of the data." if more else "")
    )
    heads = "Drive", "When", "What", "Event or act", "Why"
    if in_space:
        return Table("faults", "Missed, late and needless", heads, lines, note, heads=5)
    title = "Missed, late and needless in what the space does not count"
    return Table("faults_beside", title, heads, lines, note, heads=5)


MEASURES: tuple[tuple[str, str, bool, float | None], ...] = (
    ("Min TTC ahead, s", "min_ttc_s", True, DEFAULT_THRESHOLDS.ttc_s),
    ("Min TTC behind, s", "min_ttc_behind_s", True, DEFAULT_THRESHOLDS.ttc_s),
    ("Min gap time, s", "min_gap_time_s", True, None),
    ("Max DRAC, m/s²", "max_drac_mps2", False, DEFAULT_THRESHOLDS.drac_mps2),
    ("Max MDRAC, m/s²", "max_mdrac_mps2", False, DEFAULT_THRESHOLDS.mdrac_mps2),
)
"""Name, field, whether low is critical, and threshold."""


def measured(subject: Subject) -> Section:
    """How close vehicles came."""
    found = [(row, row.measures) for row in subject.judged if row.measures is not None]
    lines: list[tuple[str, ...]] = []
    for name, attribute, low, threshold in MEASURES:
        values = [value for _, each in found if (value := getattr(each, attribute)) is not None]
        if not values:
            continue
        worst = min(values) if low else max(values)
        critical = "–"
        if threshold is not None:
            beyond = sum(value <= threshold if low else value >= threshold for value in values)
            sign = "≤" if low else "≥"
            shares = (f"{share} %" for share in subject.share(beyond, len(values)))
            critical = ", ".join((f"{sign} {threshold:g}: {beyond} of {len(values)}", *shares))
        lines.append((name, f"{worst:.2f}", f"{median(values):.2f}", critical))
    for name, attribute in (
        ("TET ahead, s/h", "tet_s"),
        ("TIT ahead, s²/h", "tit_s2"),
        ("TET behind, s/h", "tet_behind_s"),
    ):
        value, bounds = _per_hour([(getattr(each, attribute), hours_of([row])) for row, each in found])
        if value is not None:
            lines.append((name, "–", f"{value:.2f}", bounds))
    note = (
        "Worst and median of the runs; then how many of them were critical"
        + (f". {NO_RATES} " if subject.findings else f", with Wilson's interval ({CONFIDENCE_WORDS}). ")
        + "TET and TIT: per hour driven, with the interval from resampling whole runs. Definitions, with "
        "sources: docs/reference/failures.md. SUMO's drivers avoid collisions by construction: compare runs with "
        "each other."
    )
    heads = "Measure", "Worst", "Median or rate", "Critical runs, or interval"
    return Section(
        "measures",
        "Surrogate measures",
        tables=(Table("measures", "Surrogate measures", heads, tuple(lines), note),),
    )


def _per_hour(pairs: Sequence[tuple[float, float]]) -> tuple[float | None, str]:
    """A rate per hour and its bootstrap interval in words."""
    table = np.asarray(pairs, dtype=float)
    if not len(table) or table[:, 1].sum() == 0:
        return None, ""
    value = float(table[:, 0].sum() / table[:, 1].sum())
    if len(table) < LEAST_CLUSTERS:
        return value, f"too few runs for an interval ({len(table)})"
    rng = np.random.default_rng(0)
    drawn = table[rng.integers(len(table), size=(DRAWS, len(table)))].sum(axis=1)
    low, high = np.percentile(drawn[:, 0] / drawn[:, 1], [50 * (1 - CONFIDENCE), 50 * (1 + CONFIDENCE)])
    return value, f"{low:.2f} to {high:.2f}"
