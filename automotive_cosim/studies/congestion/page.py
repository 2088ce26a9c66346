"""``report.html`` of a congestion study, with its tables, plots and data as files."""

from __future__ import annotations

from collections.abc import Iterator

from automotive_cosim.contracts.plain import counted
from automotive_cosim.formats.incidents import Jam
from automotive_cosim.studies.congestion.charts import charts
from automotive_cosim.studies.congestion.plan import EPOCH_S, intervention_in
from automotive_cosim.studies.congestion.results import (
    WHOLE,
    CongestionStudy,
    change,
    delay_h,
    flow_in,
    indices,
    strongest,
)
from automotive_cosim.studies.congestion.rows import FlowState
from automotive_cosim.studies.congestion.tables import mean, tables
from automotive_cosim.studies.congestion.words import name_of
from automotive_cosim.studies.content import ShownStudy
from automotive_cosim.studies.intervals import LEAST_SEEDS, PUBLISHED_SEEDS, SeedMean
from automotive_cosim.studies.reroute.tables import told
from automotive_cosim.studies.reroute.warnings import missing_told, steps_told

LEAST_DEPARTING = 0.1
"""Below this share of the mean rate, hardly anybody departs any more."""


def shown(study: CongestionStudy) -> ShownStudy:
    """What the report shows."""
    about = (
        f"{counted(len(study.rows), 'seed')}, {study.plan.minutes:g} minutes each; every intervention begins in a "
        "copy of the same traffic"
    )
    return ShownStudy("Congestion study", about, answer(study), warnings(study), tables(study), charts(study))


def answer(study: CongestionStudy) -> str:
    """What the study found, in at most 40 words: the delay, what the strongest intervention does to it, and how
    much more or less is driven, which is not netted: a gridlock that lets nobody drive saves nothing."""
    plan = study.plan
    seeds = len(list(study.outcomes("")))
    found = indices(plan, (outcome for _, outcome in study.outcomes("")))
    if found is None:
        return "No seed was driven to its end."
    before_h = mean(study, "", lambda each: delay_h(plan, each))
    too_few = f", too few for an interval ({LEAST_SEEDS})"
    over = f"over {counted(seeds, 'seed')}{too_few if seeds < LEAST_SEEDS else ''}"
    if not plan.interventions:
        return (
            f"{plan.opened.name} has a delay of {before_h:.1f} vehicle-hours an hour; a trip takes "
            f"{found.travel_time:.2f} times its time on empty roads, and {found.planning_time:.2f} times in the "
            f"worst twentieth of the time, {over}."
        )
    best = study.interventions[strongest(study)]
    added = change(study, best)
    assert added is not None, "so there are seeds"
    share = f" ({told(added.value / before_h, '+.0%')})" if before_h else ""
    of = f", of {len(plan.interventions)} interventions the strongest," if len(plan.interventions) > 1 else ""
    away = _kept_away(study, best)
    without_km, with_km = (mean(study, each, lambda made: flow_in(plan, made).distance_m) for each in ("", best))
    driven = with_km / without_km - 1.0 if without_km else 0.0
    kilometres = f"; {abs(driven):.1%} {'more' if driven > 0 else 'fewer'} kilometres are driven"
    if f"{abs(driven):.1%}" == "0.0%":
        kilometres = "; as many kilometres are driven"
    return (
        f"“{name_of(best)}”{of} {_told(added, 'saves' if not away else 'leaves out')} of delay{share}{kilometres}, "
        f"against no intervention, {over}{f'; {away}' if away else ''}."
    )


def _kept_away(study: CongestionStudy, intervention: str) -> str:
    """Who could not drive with an intervention, in words; empty if everybody could."""
    outcomes = [outcome for _, outcome in study.outcomes(intervention)]
    cut, kept = sum(each.cut_short for each in outcomes), sum(each.kept_in for each in outcomes)
    if not cut and not kept:
        return ""
    kept_in = f"{counted(kept, 'vehicle')} that start there did not drive"
    return f"{counted(cut, 'trip')} ended before the closed road and {kept_in}"


def _told(total: SeedMean, saves: str) -> str:
    """What an intervention costs, if that can be told, or what it saves."""
    value, bounds = total.value, total.interval
    if bounds and bounds.low < 0 < bounds.high:
        low, high = told(bounds.low, "+.1f"), told(bounds.high, "+.1f")
        return f"changes {told(value, '+.1f')} vehicle-hours an hour, which cannot be told from 0 ({low} to {high})"
    low_h, high_h = sorted((abs(bounds.low), abs(bounds.high))) if bounds else (0.0, 0.0)
    sure = f" ({low_h:.1f} to {high_h:.1f})" if bounds else ""
    return f"{'costs' if value >= 0 else saves} {abs(value):.1f}{sure} vehicle-hours an hour"


def warnings(study: CongestionStudy) -> list[str]:
    """Warnings to read before using the study's figures."""
    return [*missing_told(len(study.plan.seeds), len(study.rows), "seed"), *_found(study)]


def _dry_from_s(study: CongestionStudy) -> float | None:
    """When departures without an intervention fell for good below a tenth of their mean rate; None if they did not.

    At least five minutes must be left, as figures are told in five minutes."""
    outcomes = [outcome.states for _, outcome in study.outcomes("")]
    if not outcomes:
        return None
    together: Iterator[tuple[FlowState, ...]] = zip(*outcomes, strict=False)
    departed = [(states[0].at_s, sum(each.departed for each in states)) for states in together]
    (first_s, before), (last_s, total) = departed[0], departed[-1]
    for at_s, so_far in departed:
        rate, rest = (so_far - before) / max(1.0, at_s - first_s), last_s - at_s
        if at_s > first_s and rest >= EPOCH_S and total - so_far < LEAST_DEPARTING * rate * rest:
            return at_s
    return None


def _found(study: CongestionStudy) -> Iterator[str]:
    plan = study.plan
    seeds = len(list(study.outcomes("")))
    if seeds < LEAST_SEEDS:
        yield f"{counted(seeds, 'seed')}: no interval of a mean below {LEAST_SEEDS} seeds."
    elif seeds < PUBLISHED_SEEDS:
        yield f"{seeds} seeds: run {PUBLISHED_SEEDS} before publishing."
    for intervention in study.interventions:
        where = f"With “{name_of(intervention)}”" if intervention else "Without an intervention"
        jams = [outcome.gridlock for _, outcome in study.outcomes(intervention) if outcome.gridlock]
        if jams:
            yield (
                f"{where}, the traffic of {len(jams)} of {seeds} seeds is gridlocked at the end (for example: "
                f"{jams[0]}); delays in a gridlock depend on how long it is watched."
            )
        teleported = [outcome.states[-1].teleported for _, outcome in study.outcomes(intervention)]
        if sum(teleported):
            yield f"{where}, SUMO moved {counted(sum(teleported), 'vehicle')} on that stood too long."
        if collided := sum(outcome.states[-1].collided for _, outcome in study.outcomes(intervention)):
            yield f"{where}, {counted(collided, 'vehicle')} collided and left the road without arriving."
        if away := _kept_away(study, intervention):
            yield f"{where}, {away}."
        if intervention and isinstance(intervention_in(intervention, "--intervention"), Jam):
            yield f"“{name_of(intervention)}” brings cars of its own, whose delay is counted."
        pairs = [(dict(study.outcomes(""))[seed], outcome) for seed, outcome in study.outcomes(intervention)]
        if (
            intervention
            and pairs
            and all(one.states == two.states and one.cells == two.cells for one, two in pairs)
        ):
            yield f"“{name_of(intervention)}” changes nothing in any seed."
    yield from steps_told(plan.opened, plan.driven_step_s(plan.opened))
    if dry_s := _dry_from_s(study):
        yield (
            f"Hardly anybody departs after {dry_s / 60:.0f} of {plan.minutes:g} min: the demand ends before the "
            f"study does, and all figures include an emptying network; take --minutes {dry_s / 60:.0f} or less."
        )
    if all(mean(study, each, lambda one: delay_h(plan, one, WHOLE)) == 0 for each in study.interventions):
        yield "Nobody loses any time: there is no congestion to measure."
