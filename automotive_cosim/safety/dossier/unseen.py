"""Bounds on what was not seen, and the four areas of ISO 21448."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from math import log, sqrt

from automotive_cosim.contracts.plain import counted
from automotive_cosim.report.stats import CONFIDENCE, rate_upper_bound
from automotive_cosim.report.tables import Table
from automotive_cosim.safety.dossier.domain import never, tried
from automotive_cosim.safety.dossier.subject import (
    CONFIDENCE_WORDS,
    Section,
    Subject,
    failing,
    hours_of,
    number_told,
)
from automotive_cosim.safety.findings import percent


def missing_mass(counts: Iterable[int]) -> tuple[float, float]:
    """The share of situations of kinds that were not seen: Good and Turing's estimate, and its upper bound.

    Good 1953, Biometrika 40; McAllester and Schapire 2000, COLT: the estimate errs by at most
    (2 √2 + √3) √(ln(3/δ)/n) with probability 1 - δ.
    """
    seen = list(counts)
    total = sum(seen)
    if not total:
        return 1.0, 1.0
    share = sum(count == 1 for count in seen) / total
    return share, min(1.0, share + (2 * sqrt(2) + sqrt(3)) * sqrt(log(3 / (1 - CONFIDENCE)) / total))


def unseen(subject: Subject) -> Section:
    """What the run leaves open: how little was driven, what was never tried, and bounds on what was not seen."""
    lines: list[tuple[str, str, str]] = []
    told = [exposure_told(subject)]
    values = "; ".join(f"{name.lower()} {', '.join(values)}" for name, values in never(subject).items())
    only = ", ".join((*tried(subject)["Place"], *tried(subject)["Language"]))
    told.append(f"Never tried: {values or 'no value that the benchmark knows'}; any place and language but {only}.")
    told.append(residual(subject))
    if subject.findings is not None:
        found = subject.findings
        told.append(
            "Runs of a search are drawn to failures, so that rates of its runs say nothing about the space; "
            "its bounds are over the combinations alone that represent the whole space."
        )
        for name, key in (
            ("Failure rate in the space searched", "failure_rate_upper"),
            ("Rate of failures that no minimal case explains", "unseen_rate_upper"),
        ):
            if found[key] is not None:
                lines.append((name, f"at most {percent(found[key])}", "Clopper and Pearson"))
        for name, part, whole, how in (
            ("Pairs of levels of two factors tried", "pairs_covered", "pairs", "2-wise"),
            ("Triples of levels of three tried", "triples_covered", "triples", "3-wise"),
            ("Minimal failures that a careful watcher prevents", "careful_prevents", "careful_tried", "ISO 34502"),
        ):
            if found.get(whole):
                lines.append((name, f"{found[part]} of {found[whole]}", how))
    else:
        bad, total, upper = failing(subject)
        three = f"; rule of three: {percent(min(1.0, 3 / total))}" if total and not bad else ""
        units = counted(total, "independent unit")
        lines.append(
            (
                f"Share of failing units ({bad} of {units})",
                f"at most {percent(upper)}{three}",
                "Clopper and Pearson",
            )
        )
        lines += _rates(subject)
    kinds = Counter(_kinds(subject))
    share, upper = missing_mass(kinds.values())
    lines.append(
        (
            f"Next situation of a kind not seen ({len(kinds)} kinds in "
            f"{counted(sum(kinds.values()), 'situation')})",
            f"estimate {percent(share)}, "
            + ("no useful bound from so few" if upper >= 1 else f"at most {percent(upper)}"),
            "Good and Turing",
        )
    )
    table = Table(
        "unseen", "Bounds on what was not seen", ("Figure", f"Bound ({CONFIDENCE_WORDS}, one-sided)", "By"),
        tuple(lines),
        "Units: drives of one family and seed, or episodes of one task, count once, if something was due in "
        "them. Kinds: a place with a kind of "
        "event, or a task's half in a place. All bounds are for runs drawn as these were, not for the road.",
        heads=3,
    )  # fmt: skip
    return Section("unseen", "What was not shown", tuple(told), (table,))


def exposure_told(subject: Subject) -> str:
    """How much was driven, and in how much of it something was due."""
    km = sum(cell.kilometres for row in subject.judged for cell in row.exposure)
    driven = f"{subject.hours:.2f} h and {km:.0f} km were driven in {counted(len(subject.judged), 'run')}"
    due = len(subject.due)
    return f"{driven}; something was due in {due or 'none'} of them" + ("." if due else ", so nothing is shown.")


def residual(subject: Subject) -> str:
    """The bound on failures that may remain, in words."""
    bad, total, upper = failing(subject)
    if subject.findings is not None:
        bound = subject.findings["failure_rate_upper"]
        where = "of the space searched, where something is due,"
    else:
        bound, where = (upper if total else None), "of such situations"
    if bound is None or bound >= 1:
        return "No bound on failures follows: too little was due."
    did = "" if subject.findings is not None else f"; {bad} of {counted(total, 'unit')} did"
    return f"Up to {percent(bound)} {where} may fail ({CONFIDENCE_WORDS}){did}."


def _rates(subject: Subject) -> Iterator[tuple[str, str, str]]:
    """Upper bounds of rates per hour of drives."""
    hours = hours_of(subject.drives)
    if not hours:
        return
    lost = sum(
        event.outcome.counts and not event.outcome.is_credited for row in subject.drives for event in row.events
    )
    nuisances = sum(row.score.nuisances for row in subject.drives if row.score is not None)
    collisions = sum(row.harm.collided for row in subject.drives if row.harm is not None)
    for name, count in (("Collisions", collisions), ("Events not met", lost), ("Nuisances", nuisances)):
        three = f"; rule of three: {number_told(3 / hours)}" if not count else ""
        upper = rate_upper_bound(count, hours)
        yield (
            f"{name} per hour ({count} in {hours:.2f} h)",
            f"at most {number_told(upper)}{three}",
            "Poisson, exact",
        )


def _kinds(subject: Subject) -> Iterator[tuple[str, str]]:
    for row in subject.drives:
        yield from ((row.scenario, event.kind) for event in row.events)
    for episode in subject.episodes:
        yield episode.scenario, f"{episode.task} {episode.half}"


def areas(subject: Subject) -> Section:
    """The four areas of ISO 21448, as far as the run fills them."""
    failures, passed, empty = subject.failed, len(subject.passed), len(subject.nothing_due)
    minimal = "" if subject.findings is None else f", {counted(len(subject.findings['failures']), 'minimal case')}"
    _, _, upper = failing(subject)
    bound = (subject.findings or {}).get("failure_rate_upper", upper)
    lines = (
        (
            "1: known, not hazardous",
            f"{counted(passed, 'run')} that passed"
            + (f"; {counted(empty, 'more run')} in which nothing was due" if empty else ""),
            "Events, Operational domain covered",
        ),
        ("2: known, hazardous", f"{counted(len(failures), 'run')} that failed{minimal}", "Failures"),
        (
            "3: unknown, hazardous",
            "not known"
            if bound is None
            else f"at most {percent(bound)} of situations drawn as here, area 2 included",
            "What was not shown",
        ),
        (
            "4: unknown, not hazardous",
            "the rest of the domain",
            "Operational domain covered: values without a run",
        ),
    )
    note = (
        "Areas of ISO 21448 (SOTIF). Hazardous stands for a failed run: harm depends on the driver and the traffic."
    )
    table = Table("areas", "Areas", ("Area", "In this run", "Section"), lines, note, heads=3)
    return Section("areas", "Known and unknown, hazardous and not", tables=(table,))
