"""Compares two evaluations of the same instances, before and after a change."""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from xml.etree import ElementTree

from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import UserError
from automotive_cosim.formats.plain import markup
from automotive_cosim.report.drives import ScoreChange, score_change
from automotive_cosim.report.results import Contestant, Results, contestant, pair_instance, pairs, read_results
from automotive_cosim.report.stats import LEAST_CLUSTERS, Comparison, Rate, bracketed, compare
from automotive_cosim.report.summary import rate_of
from automotive_cosim.report.tables import Table
from automotive_cosim.run.rows import DriveTrialRow, EpisodeRow, TrialRow
from automotive_cosim.run.versions import minor

MOST_LISTED = 30
"""How many instances of one kind a summary lists; the JUnit file has all of them."""


@dataclass(frozen=True, slots=True)
class ComparedInstance:
    """One instance in both evaluations."""

    name: str
    before: TrialRow
    after: TrialRow | None
    """None if the later evaluation has no such episode."""

    @property
    def kind(self) -> str:
        """``lost``, ``won``, ``solved``, ``not solved`` (both times), or ``error``: judged before and not now.

        A drive is lost if its score fell and won if it rose."""
        now = None if self.after is None else self.after.outcome
        if now is None:
            return "error"
        if self.scores is not None and self.scores[0] != self.scores[1]:
            return "lost" if self.scores[1] < self.scores[0] else "won"
        if self.scores is not None:
            return "solved" if now else "not solved"
        if self.before.outcome:
            return "solved" if now else "lost"
        return "won" if now else "not solved"

    @property
    def scores(self) -> tuple[float, float] | None:
        """A drive's before and after, in points; None for an episode, or if it is not judged now."""
        rows = self.before, self.after
        before, after = (row.score if isinstance(row, DriveTrialRow) else None for row in rows)
        return None if before is None or after is None else (before.value, after.value)

    @property
    def agent_broke(self) -> bool:
        """Whether it is not solved now because the agent failed, or gave no action in any step."""
        now = self.after
        if now is None or now.outcome is not False:
            return False
        return now.agent_error is not None or 0 < now.steps <= (now.malformed or 0)

    @property
    def why(self) -> str:
        """What is missing now."""
        if self.after is None:
            return "it was not planned"
        if not self.after.has_run:
            return "it has not been run"
        if self.after.outcome is None:
            why = self.after.error
            return f"{self.after.error_kind}: {why}" if why else "one half is not judged"
        missing = [part.replace("_", " ") for part in self.after.missing]
        told = [] if self.scores is None else [_points(self.scores)]
        told += [f"missing: {', '.join(missing)}"] if missing else []
        if self.after.agent_error is not None:
            told.append(f"the agent failed: {self.after.agent_error}")
        if self.after.malformed and missing:
            told.append(
                f"no action in {counted(self.after.malformed, 'step')}, at first: {self.after.malformed_why}"
            )
        return "; ".join(told)


@dataclass(frozen=True, slots=True)
class SuccessChange:
    """One contestant's success before and after."""

    contestant: Contestant
    unit: str
    """``episodes``, ``pairs`` or ``drives``."""
    cases: tuple[ComparedInstance, ...]
    found: Comparison | ScoreChange | None
    """After compared with before, of drives by their score; None if nothing was judged both times."""
    rates: tuple[Rate, Rate]
    """Before and after, each over what both planned."""
    planned: tuple[Rate, Rate]
    """The same over everything that was planned then."""
    problems: tuple[str, ...] = ()
    """Why it is not known what was planned."""
    versions: tuple[str, str] = ("", "")
    """Of the package, before and after."""

    def count(self, kind: str) -> int:
        """The cases of one kind."""
        return sum(case.kind == kind for case in self.cases)

    @property
    def judged(self) -> int:
        """The cases that were judged both times."""
        return len(self.cases) - self.count("error")

    @property
    def levels(self) -> tuple[str, str]:
        """Before and after, of what was judged both times: successes out of it, or the score of drives."""
        if isinstance(self.found, ScoreChange):
            before, after = (f"{score:.0f}".replace("-", "−") for score in (self.found.before, self.found.after))
            return before, after
        stayed = self.count("solved")
        return f"{stayed + self.count('lost')}/{self.judged}", f"{stayed + self.count('won')}/{self.judged}"

    def is_worse(self, allowed: float) -> bool:
        """Whether success, or the score of drives, fell by more than ``allowed`` (a share, 0 to 1), or something
        judged before is not judged now."""
        fell = self.found is not None and -self.found.difference > allowed + 1e-9
        return fell or self.count("error") > 0

    @property
    def is_incomplete(self) -> bool:
        """Whether either evaluation has not run everything that was planned, or nothing was judged both times."""
        return self.found is None or bool(self.problems) or any(each.not_run for each in self.planned)

    def passes(self, allowed: float) -> bool:
        """Whether it is known to be no worse."""
        return not self.is_worse(allowed) and not self.is_incomplete

    def outcome(self, allowed: float) -> str:
        """``worse`` or ``incomplete``, which do not pass; else ``unchanged`` if the rates are the same, ``better``
        or ``within threshold`` if the interval leaves out zero, and ``not distinguishable`` if it does not, or if
        too few drives give none."""
        if self.is_worse(allowed):
            return "worse"
        if self.found is None or self.is_incomplete:
            return "incomplete"
        if not self.found.difference:
            return "unchanged"
        interval = self.found.interval
        if interval is None or interval.low <= 0 <= interval.high:
            return "not distinguishable"
        return "better" if interval.low > 0 else "within threshold"


def changes(before: Path, after: Path, *, mixed: bool = False) -> tuple[SuccessChange, ...]:
    """Compares two evaluations' folders on what was judged in the first.

    Args:
        before: the earlier evaluation's folder.
        after: the later one's.
        mixed: compare even if two minor versions of the package ran them.

    Raises UserError: one folder is not an evaluation's, two minor versions ran them, or no contestant is in
    both."""
    old, new = read_results(before), read_results(after)
    versions = old.version, new.version
    if minor(old.version) != minor(new.version) and not mixed:
        raise UserError(
            f"{before} was run with automotive-cosim {old.version} and {after} with {new.version}, whose tasks or "
            "verdicts differ; rerun one of them, or compare them anyway with --mixed-versions"
        )
    problems = tuple(f"{each.folder}: {each.coverage}" for each in (old, new) if each.coverage.problem)
    found: list[SuccessChange] = []
    for each in old.contestants:
        if each in new.contestants:
            before_rows, after_rows = old.planned_of(each), new.planned_of(each)
            found.append(_change(each, "episodes", before_rows, after_rows, problems, versions))
            before_pairs, after_pairs = ([pair for pair, _ in pairs(rows)] for rows in (before_rows, after_rows))
            if before_pairs:
                found.append(_change(each, "pairs", before_pairs, after_pairs, problems, versions))
    for each in dict.fromkeys(map(contestant, (*old.drives, *old.drives_not_run))):
        before_drives, after_drives = (
            [row for row in (*side.drives, *side.drives_not_run) if contestant(row) == each] for side in (old, new)
        )
        if after_drives:
            found.append(_change(each, "drives", before_drives, after_drives, problems, versions))
    if not found:
        labels = (_labels(results) for results in (old, new))
        named = " and ".join(f"{folder} ({label})" for folder, label in zip((before, after), labels, strict=True))
        raise UserError(
            f"{named} have no agent in common; compare the same agent, model and geo control before and after "
            "a change. To compare two agents, or people and an agent, use Compare in `automotive-cosim serve`"
        )
    return tuple(found)


def _labels(results: Results) -> str:
    drivers = map(contestant, (*results.drives, *results.drives_not_run))
    return "; ".join(each.label for each in dict.fromkeys((*results.contestants, *drivers))) or "nobody"


def _change(
    each: Contestant,
    unit: str,
    old: Sequence[TrialRow],
    new: Sequence[TrialRow],
    problems: tuple[str, ...],
    versions: tuple[str, str],
) -> SuccessChange:
    def key(row: TrialRow) -> tuple[object, ...]:
        return pair_instance(row) if unit == "pairs" and isinstance(row, EpisodeRow) else row.instance

    olds, news = ({key(row): row for row in rows} for rows in (old, new))
    cases = tuple(
        ComparedInstance(_name(row, unit), row, news.get(key(row))) for row in old if row.outcome is not None
    )
    judged = {case.name: case for case in cases if case.kind != "error"}
    found: Comparison | ScoreChange | None
    if unit == "drives":
        rows = [(case.before, case.after) for case in judged.values()]
        found = score_change(
            [
                (before, after)
                for before, after in rows
                if isinstance(before, DriveTrialRow) and isinstance(after, DriveTrialRow)
            ]
        )
    else:
        clusters: dict[Hashable, Hashable] = {name: case.before.subject for name, case in judged.items()}
        found = compare(
            {name: bool(case.after.outcome) for name, case in judged.items() if case.after},
            {name: bool(case.before.outcome) for name, case in judged.items()},
            clusters,
        )
    before, after = (
        rate_of([row for row in old if key(row) in news]),
        rate_of([row for row in new if key(row) in olds]),
    )
    return SuccessChange(
        each, unit, cases, found, (before, after), (rate_of(old), rate_of(new)), problems, versions
    )


def _name(row: TrialRow, unit: str) -> str:
    """An instance in words."""
    repeat = f", repeat {row.repeat + 1}" if row.repeat else ""
    if isinstance(row, EpisodeRow):
        where = "" if unit == "pairs" else f"{f', {row.half} half' if row.pair else ''}, {row.scenario}"
        return f"{row.task}{where}, seed {row.seed}{repeat}"
    assert isinstance(row, DriveTrialRow)
    words = (row.name, row.scenario, row.settings.words, f"seed {row.seed}")
    return ", ".join(filter(None, words)) + repeat


def _points(scores: tuple[float, float]) -> str:
    before, after = (f"{score:.0f}".replace("-", "−") for score in scores)
    return f"score {before} before, {after} after"


WHEN = "before", "after"


def markdown(found: Sequence[SuccessChange], allowed: float) -> str:
    """A summary for a pull request."""
    rows = []
    for each in found:
        rows.append(
            {
                "": each.outcome(allowed),
                "Contestant": each.contestant.label,
                "Of": each.unit,
                **{
                    f"Judged {when}": f"{rate.judged} of {rate.planned}"
                    for when, rate in zip(WHEN, each.rates, strict=True)
                },
                **{when.capitalize(): level for when, level in zip(WHEN, each.levels, strict=True)},
                "Difference": _difference(each.found),
                "Lost": str(each.count("lost")),
                "Won": str(each.count("won")),
                "Not judged now": str(each.count("error")),
            }
        )
    table = Table.of(
        "compare",
        "Success before and after",
        rows,
        "On the episodes that were judged before, in percentage points or points of score, with 95 % intervals "
        f"over tasks or drives, from {LEAST_CLUSTERS} of them on. Drives are compared by the score of all of them "
        "together, and a drive is lost if "
        f"its score fell. Worse: success or score fell by more than {100 * allowed:g} points, or something is no "
        "longer judged. Not distinguishable: the interval contains zero, or there is none. "
        "Incomplete: it did not fall, but "
        "something planned was not run, or it is not known what was planned. Judged: out of what was planned.",
        heads=3,
    )
    mixed = mixed_versions(found)
    unknown = f"\n{mixed}\n" if mixed else ""
    unknown += "".join(
        f"\n{problem}\n" for problem in dict.fromkeys(each for one in found for each in one.problems)
    )
    return (
        f"**{sentence(found, allowed)}**\n\n"
        + table.markdown()
        + unknown
        + "".join(
            f"\n**{told.capitalize()}, {title}**\n\n" + "".join(f"- {name}\n" for name in names)
            for each in found
            for kind, told in _KINDS.items()
            for title, names in _listing(each, kind)
        )
    )


def plain(found: Sequence[SuccessChange], allowed: float) -> str:
    """The same summary for a terminal, in lines."""
    lines = [sentence(found, allowed)]
    for each in found:
        before, after = each.levels
        counts = ", ".join(f"{each.count(kind)} {told}" for kind, told in _KINDS.items())
        lines += [
            f"  {each.contestant.label}, {each.unit}: {each.outcome(allowed)}",
            f"    {before} before, {after} after: {_difference(each.found)}",
            f"    {counts}",
        ]
    lines += filter(None, [mixed_versions(found)])
    lines += dict.fromkeys(problem for each in found for problem in each.problems)
    for each in found:
        for kind, told in _KINDS.items():
            for title, names in _listing(each, kind):
                lines += [f"{told.capitalize()}, {title}", *(f"  {name}" for name in names)]
    return "\n".join(lines) + "\n"


_KINDS = {"lost": "lost", "error": "not judged now", "won": "won"}
"""The kinds of cases that are listed, with their words."""


def _difference(found: Comparison | ScoreChange | None) -> str:
    """With its interval, in percentage points of success or points of score."""
    if found is None:
        return "–"
    digits = 0 if isinstance(found, ScoreChange) else 1
    return f"{100 * found.difference:+.{digits}f} points{bracketed(found.interval, '+.0f', 100)}"


def sentence(found: Sequence[SuccessChange], allowed: float) -> str:
    """The result in a sentence: each contestant that is worse or incomplete, by how much, or that none is."""
    told = [
        f"{each.contestant.label} is {each.outcome(allowed)}: {_before_and_after(each)}"
        for each in found
        if not each.passes(allowed)
    ]
    by_success = [each for each in found if not isinstance(each.found, ScoreChange)]
    if not told and by_success == list(found) and not any(rate.value for each in found for rate in each.rates):
        return f"No agent succeeds, neither before nor after: {_before_and_after(found[-1])}."
    return "; ".join(told or [f"No agent is worse: {_before_and_after(found[-1])}"]) + "."


def _before_and_after(each: SuccessChange) -> str:
    """The figures of the comparison itself, so that they never say other than its outcome."""
    unit, (old, new) = each.unit.removesuffix("s"), each.planned
    common = each.rates[1].planned
    if isinstance(each.found, ScoreChange):
        told = _points((each.found.before, each.found.after))
    elif each.found is None:
        told = "nothing was judged both times"
    else:
        before, after = (
            (each.found.both + only) / each.found.count for only in (each.found.only_second, each.found.only_first)
        )
        told = f"success {before:.0%} before, {after:.0%} after"
    told += f", of {counted(common, unit)}"
    if lost := each.count("error"):
        told += f", of which {lost:,} {'is' if lost == 1 else 'are'} no longer judged"
    if (old.planned, new.planned) != (common, common):
        told += f" that both planned ({old.planned:,} before, {new.planned:,} after)"
    for when, rate in (("before", old), ("after", new)):
        told += f"; stopped early {when}, {rate.not_run:,} of {rate.planned:,} not run" if rate.not_run else ""
    return told


def mixed_versions(found: Sequence[SuccessChange]) -> str:
    """A sentence if two minor versions of the package are compared; else empty."""
    old, new = found[0].versions
    if minor(old) == minor(new):
        return ""
    return (
        f"Before is automotive-cosim {old}, after is {new}: their tasks or verdicts differ, so a difference may "
        "not be due to the agent."
    )


def _listing(each: SuccessChange, kind: str) -> Iterator[tuple[str, list[str]]]:
    """The contestant's name and its cases of a kind with what is missing, if there are any to list."""
    cases = [case for case in each.cases if case.kind == kind]
    if not cases or each.unit == "pairs":
        return
    lines = [case.name + (f": {case.why}" if case.why else "") for case in cases[:MOST_LISTED]]
    if len(cases) > MOST_LISTED:
        lines.append(f"and {len(cases) - MOST_LISTED} more")
    yield each.contestant.label, lines


def as_json(found: Sequence[SuccessChange], allowed: float) -> Json:
    """What ``markdown`` says, as a JSON object with every instance."""
    contestants = [
        {
            "contestant": each.contestant.label,
            "of": each.unit,
            "outcome": each.outcome(allowed),
            "before": asdict(each.rates[0]) | {"planned": each.rates[0].planned},
            "after": asdict(each.rates[1]) | {"planned": each.rates[1].planned},
            "difference": None if each.found is None else each.found.difference,
            "interval": None if each.found is None or each.found.interval is None else asdict(each.found.interval),
            "score": [each.found.before, each.found.after] if isinstance(each.found, ScoreChange) else None,
            "problems": list(each.problems),
            "instances": [{"name": case.name, "kind": case.kind, "why": case.why} for case in each.cases],
        }
        for each in found
    ]
    return {
        "ok": all(each.passes(allowed) for each in found),
        "answer": sentence(found, allowed),
        "versions": list(found[0].versions),
        "mixed_versions": bool(mixed_versions(found)),
        "contestants": contestants,
    }


def junit(found: Sequence[SuccessChange]) -> str:
    """JUnit XML, one suite per contestant, one case per instance.

    Lost ones fail. Errors are those not judged now, and those in which the agent failed or never gave an action,
    before the change too. What else was not solved before passes: the change made nothing worse."""
    root = ElementTree.Element("testsuites", name="automotive-cosim compare")
    for each in found:
        verdicts = [
            "error" if case.agent_broke else {"lost": "failure", "error": "error"}.get(case.kind, "")
            for case in each.cases
        ]
        suite = ElementTree.SubElement(
            root,
            "testsuite",
            name=f"{each.contestant.label}: {each.unit}",
            tests=str(len(each.cases)),
            failures=str(verdicts.count("failure")),
            errors=str(verdicts.count("error")),
        )
        for case, verdict in zip(each.cases, verdicts, strict=True):
            entry = ElementTree.SubElement(suite, "testcase", name=case.name, classname=case.before.subject)
            if verdict:
                told = ElementTree.SubElement(entry, verdict, message=case.why or "not solved now")
                if case.after is not None and case.after.has_run:
                    told.text = f"run {case.after.id}: `automotive-cosim serve` with its folder shows each step"
    ElementTree.indent(root)
    return markup(ElementTree.tostring(root, encoding="unicode", xml_declaration=True)) + "\n"
