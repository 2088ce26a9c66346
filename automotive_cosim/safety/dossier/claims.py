"""A tree of claims, each with what this run says about it, in the terms of ISO 34502 and ISO 21448."""

from __future__ import annotations

from automotive_cosim.contracts.plain import counted
from automotive_cosim.drives.judge import EventOutcome
from automotive_cosim.report.stats import rate, rate_upper_bound
from automotive_cosim.safety.dossier.domain import tried
from automotive_cosim.safety.dossier.subject import (
    NOT_COMPLIANT,
    Claim,
    Subject,
    failing,
    number_told,
    sentence,
)
from automotive_cosim.safety.findings import percent

ENOUGH = 0.5
"""A claim is supported only if, at the level of confidence, fewer such units fail: five without a failure."""
CLAIMS = (
    "Each claim is about this run. Supported: the run has evidence for it and none against it, from at least five "
    "independent units in which something was due. Contradicted: "
    "it has evidence against it. Limited: it says something, with the bound that is given. Not examined: it says "
    "nothing. " + NOT_COMPLIANT
)


def claims(subject: Subject) -> Claim:
    """The tree, from the run's facts."""
    parts = (
        _preventable(subject),
        _quiet(subject),
        _known_hazards(subject),
        _unknown(subject),
        _covered(subject),
        _traced(subject),
    )
    statuses = {part.status for part in parts}
    status = "contradicted" if "contradicted" in statuses else "limited"
    return Claim(
        f"In the situations of this run, {subject.agent} does what safety or the law requires, and leaves the "
        "rest as it is.",
        status, sentence(subject), "summary", parts,
    )  # fmt: skip


def _preventable(subject: Subject) -> Claim:
    text = "In reasonably foreseeable and preventable situations, it acts in time (ISO 34502)."
    every = [event for row in subject.drives for event in row.events if subject.is_in_space(event.kind)]
    events = [event for event in every if not event.lookalike]
    real = [event for event in events if event.outcome.counts]
    if not real:
        passed = sum(row.has_succeeded for row in subject.episodes)
        if not subject.episodes:
            return Claim(text, "not examined", "No event required an act.", "events")
        found = rate((row.task, row.success) for row in subject.episodes)
        bounds = (
            ""
            if found.interval is None or subject.findings is not None
            else f", {100 * found.interval.low:.0f} to {100 * found.interval.high:.0f} %"
        )
        status = _status(subject, passed == len(subject.episodes))
        return Claim(
            text, status, f"{passed} of {counted(len(subject.episodes), 'episode')} passed{bounds}.", "events"
        )
    met = sum(event.outcome.is_credited for event in real)
    void = sum(event.outcome is EventOutcome.VOID for event in events)
    evidence = (
        f"{met} of {counted(len(real), 'event')} were met; {void} more were void: nothing had to be done, or "
        "nobody could have."
    )
    careful = [event for row in subject.reference for event in row.events if event.outcome.counts]
    if careful:
        theirs = sum(event.outcome.is_credited for event in careful)
        evidence += f" The rule-perfect watcher of the same run met {theirs} of {len(careful)}."
    return Claim(text, _status(subject, met == len(real)), evidence, "events")


def _status(subject: Subject, every: bool) -> str:
    """What a claim is if every one of the cases is for it, or not; a minimal case of a search is against it."""
    if not every or (subject.findings or {}).get("failures"):
        return "contradicted"
    return "supported" if failing(subject)[2] < ENOUGH else "limited"


def _quiet(subject: Subject) -> Claim:
    text = "It does not disturb the driver without a reason."
    scores = [row.score for row in subject.drives if row.score is not None]
    if not scores:
        return Claim(text, "not examined", "The run has no drives.", "events")
    nuisances, hours = sum(score.nuisances for score in scores), sum(score.driven_s for score in scores) / 3600
    evidence = f"{counted(nuisances, 'nuisance')} in {hours:.2f} h"
    if subject.findings is None:
        evidence += f", at most {number_told(rate_upper_bound(nuisances, hours))} an hour."
    else:
        evidence += "; runs of a search give no rates."
    section = "unseen" if subject.findings is None else "failures"
    return Claim(text, "contradicted" if nuisances else "limited", evidence, section)


def _known_hazards(subject: Subject) -> Claim:
    text = "Known hazardous situations (area 2 of ISO 21448) are few and described by what triggers them."
    failed = counted(len(subject.failed), "failing run")
    if subject.findings is None:
        status = "not examined" if subject.failed else "limited"
        return Claim(text, status, f"{failed}; no search has found what triggers them.", "failures")
    words = "; ".join(each["words"] for each in subject.findings["failures"])
    return Claim(text, "limited", f"{failed}. Triggering conditions: {words or 'none found'}.", "failures")


def _unknown(subject: Subject) -> Claim:
    text = "Unknown hazardous situations (area 3 of ISO 21448) are rare."
    if subject.findings is not None:
        upper = subject.findings["unseen_rate_upper"]
        told = (
            "no bound"
            if upper is None
            else f"at most {percent(upper)} of the space searched, beyond the minimal cases"
        )
        return Claim(text, "limited", f"{told[0].upper()}{told[1:]}.", "unseen")
    bad, total, upper = failing(subject)
    return Claim(
        text, "limited", f"{bad} of {counted(total, 'unit')} failed: at most {percent(upper)} of such.", "unseen"
    )


def _covered(subject: Subject) -> Claim:
    values = [known for each in tried(subject).values() for known in each.values()]
    covered = sum(bool(known) for known in values)
    status = "supported" if covered == len(values) else "limited"
    return Claim(
        "The run covers the operational domain.",
        status,
        f"{covered} of {len(values)} values have a run.",
        "domain",
    )


def _traced(subject: Subject) -> Claim:
    traced = sum(row.trace_sha256 is not None for row in subject.judged)
    total = len(subject.judged)
    have = "has a hash of its" if total == 1 else "have a hash of their"
    return Claim(
        "The evidence can be checked and repeated.", "supported" if traced == total else "limited",
        f"{traced} of {counted(total, 'run')} {have} trace; the files' hashes are listed.",
        "versions",
    )  # fmt: skip
