"""The trials that a safety report is about, and what its parts share."""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from automotive_cosim.agents import NOT_RANKED
from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted, rounded
from automotive_cosim.errors import UserError
from automotive_cosim.formats.files import read_json
from automotive_cosim.report.results import Results, contestant, read_results
from automotive_cosim.report.stats import CONFIDENCE, upper_bound, wilson
from automotive_cosim.report.tables import Table
from automotive_cosim.run.coverage import Coverage
from automotive_cosim.run.job_row import from_json
from automotive_cosim.run.rows import DriveTrialRow, EpisodeRow, TrialRow
from automotive_cosim.run.trial_folder import is_trial, read_trial
from automotive_cosim.safety.findings import of_due
from automotive_cosim.safety.hunt import NOMINAL
from automotive_cosim.safety.objective import TriedOutcome, outcome_of
from automotive_cosim.safety.page import FINDINGS
from automotive_cosim.safety.space import FailureRule

CONFIDENCE_WORDS = f"{100 * CONFIDENCE:.0f} %"
NOT_COMPLIANT = (
    "This document states facts of one run in simulation. It makes no claim of compliance with ISO 34502, ISO "
    "21448 or any other standard, and none about safety on public roads."
)


@dataclass(frozen=True, slots=True)
class Claim:
    """A claim, what this run says about it, and the claims that it rests on."""

    text: str
    status: str
    """``supported``, ``contradicted``, ``limited`` or ``not examined``, by this run."""
    evidence: str
    section: str = ""
    """The section with the evidence."""
    parts: tuple[Claim, ...] = ()


@dataclass(frozen=True, slots=True)
class Section:
    """A section."""

    name: str
    title: str
    told: tuple[str, ...] = ()
    """Paragraphs."""
    tables: tuple[Table, ...] = ()
    claims: tuple[Claim, ...] = ()


@dataclass(frozen=True)
class Subject:
    """One agent's trials of a run, and what the run was."""

    results: Results
    label: str
    agent: str
    rows: tuple[TrialRow, ...]
    findings: Json | None
    """Of a search; its trials are drawn to failures, so that they give no rates."""
    reference: tuple[DriveTrialRow, ...] = ()
    """Drives of the rule-perfect watcher in the same run."""

    @property
    def others(self) -> list[str]:
        """The other agents of the run, references and controls too."""
        every = (*self.results.rows, *self.results.drives)
        return [name for name in _agents(map(contestant, every)) if name != self.agent]

    @cached_property
    def judged(self) -> list[TrialRow]:
        """The trials with a judgement; of a search, its samples, as repeats and reductions try a failure again."""
        return [row for row in self.rows if row.outcome is not None and row.id not in self._again]

    @property
    def again(self) -> int:
        """How many trials of a search repeat or reduce a failure; no total counts them."""
        return len(self._again)

    @cached_property
    def _again(self) -> frozenset[str]:
        sampled = (self.findings or {}).get("sampled_trials")
        return frozenset() if sampled is None else frozenset(row.id for row in self.rows) - frozenset(sampled)

    @cached_property
    def rule(self) -> FailureRule | None:
        """What the space of a search counts as a failure; None for other runs, where all that is judged counts."""
        told = (self.findings or {}).get("rule")
        return None if told is None else from_json(FailureRule, told)

    @cached_property
    def outcomes(self) -> dict[str, TriedOutcome]:
        """Of the judged trials of a search, by their ids, what its space's rule says."""
        return {} if self.rule is None else {row.id: outcome_of(row, self.rule) for row in self.judged}

    def has_failed(self, row: TrialRow) -> bool:
        """Whether a judged trial failed, of a search by the rule of its space."""
        return self.outcomes[row.id].failed if self.outcomes else not row.has_succeeded

    def missing(self, row: TrialRow) -> str:
        """What a judged trial that failed lacks, in words."""
        return (self.outcomes[row.id].why if self.outcomes else ", ".join(row.missing)).replace("_", " ")

    def share(self, count: int, total: int) -> tuple[str, ...]:
        """A share of trials or events as a cell of a table; none for a search, whose trials give no rates."""
        return () if self.findings else (share_told(count, total),)

    def is_in_space(self, kind: str) -> bool:
        """Whether events of a kind count, or acts if it is empty: a search's space may name some kinds alone."""
        return self.rule is None or not self.rule.events or kind in self.rule.events

    @property
    def failed(self) -> list[TrialRow]:
        return [row for row in self.judged if self.has_failed(row)]

    @property
    def failed_beside(self) -> list[TrialRow]:
        """Those that failed in something that the search's space does not count, and in nothing that it counts."""
        return [row for row in self.judged if not self.has_failed(row) and not row.has_succeeded]

    @property
    def nothing_due(self) -> list[TrialRow]:
        """Those in which nothing required an act, with nothing done wrong: neither passes nor failures."""
        if self.outcomes:
            return [row for row in self.judged if self.outcomes[row.id].nothing_due]
        return [row for row in self.judged if isinstance(row, DriveTrialRow) and row.has_nothing_due]

    @property
    def due(self) -> list[TrialRow]:
        """The judged trials in which something was due, or done wrong: the denominator of failures."""
        empty = {row.id for row in self.nothing_due}
        return [row for row in self.judged if row.id not in empty]

    @property
    def passed(self) -> list[TrialRow]:
        """Those that did what was due, and nothing needless."""
        return [row for row in self.due if not self.has_failed(row)]

    @property
    def drives(self) -> list[DriveTrialRow]:
        return [row for row in self.judged if isinstance(row, DriveTrialRow)]

    @property
    def episodes(self) -> list[EpisodeRow]:
        """The judged episodes of tasks."""
        return [row for row in self.judged if isinstance(row, EpisodeRow)]

    @property
    def hours(self) -> float:
        return hours_of(self.judged)

    @property
    def clusters(self) -> dict[Hashable, list[TrialRow]]:
        """The independent units in which something was due: drives of one family and seed, and episodes of one
        task, depend on each other."""
        found: dict[Hashable, list[TrialRow]] = {}
        for row in self.due:
            key = (row.subject, row.seed) if isinstance(row, DriveTrialRow) else (row.subject,)
            found.setdefault(key, []).append(row)
        return found


def read_subject(folder: Path, agent: str = "") -> Subject:
    """The trials of an agent in a folder of ``eval`` or ``search``, or the one of a recorded drive or task.

    Args:
        agent: whose; empty if there is only one that is neither a reference nor a control.

    Raises UserError: it is none, has no judged trials, or has several agents and none is named."""
    results = _recorded(folder) if is_trial(folder) else read_results(folder)
    every: tuple[TrialRow, ...] = (*results.rows, *results.drives)
    labels = {contestant(row): row for row in every}
    ranked = [each for each in labels if each.agent not in NOT_RANKED] or list(labels)
    chosen = [each for each in labels if each.agent == agent] if agent else ranked
    if not chosen:
        raise UserError(f"{folder} has no run of agent {agent!r}; give one of {', '.join(_agents(labels))}")
    if len({each.agent for each in chosen}) > 1:
        raise UserError(f"{folder} has several agents; give --agent with one of {', '.join(_agents(labels))}")
    mine = tuple(row for row in every if contestant(row) in chosen)
    findings = dict(read_json(folder / FINDINGS)) if (folder / FINDINGS).is_file() else None
    name = chosen[0].agent
    reference = tuple(
        row for row in results.drives if row.agent == "rule-perfect" != name and row.score is not None
    )
    models = ", ".join(sorted({each.base_model for each in chosen} - {"none"}))
    made = Subject(results, f"{name}, {models}" if models else name, name, mine, findings, reference)
    if not made.judged:
        raise UserError(f"{folder} has no judged run of {name} yet; rerun its command to resume")
    return made


def _recorded(folder: Path) -> Results:
    """The folder of a single trial, as results of an evaluation of one."""
    told = read_trial(folder)
    row = told.get("row") or {}
    if not row:
        raise UserError(f"{folder} has a run that is not over; report it once it is")
    drives = (from_json(DriveTrialRow, row),) if "family" in row else ()
    rows = () if drives else (from_json(EpisodeRow, row),)
    return Results(folder, {"starts": [], **(told.get("manifest") or {})}, rows, Coverage(1, 0), drives)


def _agents(labels: Iterable[object]) -> list[str]:
    return sorted({str(getattr(each, "agent", "")) for each in labels})


def hours_of(rows: Iterable[TrialRow]) -> float:
    """Hours driven in trials."""
    return sum(cell.hours for row in rows for cell in row.exposure)


def failing(subject: Subject) -> tuple[int, int, float]:
    """Independent units that failed, all of them, and the upper bound of their share."""
    groups = subject.clusters
    bad = sum(any(map(subject.has_failed, rows)) for rows in groups.values())
    return bad, len(groups), upper_bound(bad, len(groups)) if groups else 1.0


def sentence(subject: Subject) -> str:
    """The result in a sentence."""
    failed, due, empty = len(subject.failed), len(subject.due), len(subject.nothing_due)
    hours = f"{subject.hours:.2f} h driven"
    told = of_due(f"{subject.agent} failed in", failed, due, empty)
    told = f"{told[:-1]} ({hours})."
    if any(each["words"] == NOMINAL for each in (subject.findings or {}).get("failures", ())):
        told = f"{subject.agent} fails with {NOMINAL}. Beside that, {told}"
    if subject.again:
        told += f" Not counted: {counted(subject.again, 'run')} to repeat and reduce failures."
    if subject.rule is not None and subject.drives:
        told += f" The space counts {subject.rule.words}."
    if beside := len(subject.failed_beside):
        told += f" Of the others, {beside} failed in what the space does not count."
    if subject.findings is not None:
        minimal = subject.findings["failures"]
        told += (
            f" The search reduced the failures to {counted(len(minimal), 'minimal failure')}"
            if minimal
            else " The search found no minimal failure"
        )
        if unreduced := len(subject.findings.get("not_reduced", ())):
            told += f" and left {unreduced} as found"
        told += f"; it stopped early: {stopped}." if (stopped := subject.findings.get("stopped")) else "."
    return told


def share_told(count: int, total: int) -> str:
    """A share in per cent, with its interval."""
    if not total:
        return "–"
    bounds = wilson(count, total)
    return f"{100 * count / total:.0f} ({100 * bounds.low:.0f} to {100 * bounds.high:.0f})"


def number_told(value: float) -> str:
    """A rate in words."""
    return f"{value:,.0f}" if value >= 10 else rounded(value, 2)


def fact_table(name: str, title: str, lines: Iterable[tuple[str, str]]) -> Table:
    """A table of facts and their values."""
    return Table(name, title, ("Fact", "Value"), tuple(lines), heads=2)
