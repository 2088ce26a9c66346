"""The tables of a study."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from automotive_cosim.report.tables import Table, TableRecord, TableRow
from automotive_cosim.run.job_row import JobRow, remedy
from automotive_cosim.studies.calls.chance import Fresh
from automotive_cosim.studies.intervals import LEAST_SEEDS, SeedMean, seed_mean
from automotive_cosim.studies.reroute.policies import PolicyRule, parse_policy
from automotive_cosim.studies.reroute.results import NOISE, Noise, Study
from automotive_cosim.studies.reroute.rows import PolicyChoice
from automotive_cosim.traffic.chance import JITTER

NONE = "–"
BINS = ((1.0, 1.25), (1.25, 1.5), (1.5, 2.0), (2.0, float("inf")))
"""Classes of the time index (expected over free travel time) of decisions."""

HINDSIGHT = "best"
STAYING = ("never",)


def tables(study: Study) -> list[Table]:
    """All tables that apply, the most important first."""
    made = [
        policies(study),
        parts(study),
        costs(study),
        by_congestion(study),
        by_age(study),
        by_compliance(study),
        by_share(study),
        noise_floor(study),
        excluded(study),
        errors(study),
    ]
    return [table for table in made if table.rows]


def groups(study: Study) -> list[tuple[float, str, float, list[PolicyChoice]]]:
    """The choices by share of rerouting cars, policy and, if it matters, age of the news."""
    found: dict[tuple[float, str, float], list[PolicyChoice]] = {}
    first_s = study.plan.ages_s[0]
    for each in study.choices:
        if goes_by_news(each.policy) or each.age_s == first_s:
            found.setdefault((each.share, each.policy, each.age_s), []).append(each)
    return [(*key, rows) for key, rows in found.items()]


def goes_by_news(policy: str) -> bool:
    """Whether a policy decides by the plan's traffic news; others know the present, the future or nothing."""
    return parse_policy(policy).rule in (PolicyRule.ALWAYS, PolicyRule.DELAY, PolicyRule.WORTHWHILE)


def policies(study: Study) -> Table:
    """What each policy gained for the ego."""
    floor = study.noise()
    rows: list[TableRecord] = []
    for share, policy, age_s, chosen in groups(study):
        outcome = " / ".join(f"{count:.0f}" for count in outcomes(chosen, floor))
        if study.plan.replicates == 1 and floor.placebos and not floor.is_known:
            outcome = NONE  # nothing tells a win from chance
        rows.append(
            {
                "Share rerouting": f"{share:.0%}",
                "Policy": policy,
                "News age, s": f"{age_s:g}" if goes_by_news(policy) else NONE,
                "Decisions": str(len(chosen)),
                "Seeds": str(len({each.seed for each in chosen})),
                "Rerouted": per_cent(each.rerouted for each in chosen),
                "Time saved, s": mean_cell(chosen, time_saved_s),
                "Resampled, s": resampled_cell(chosen, time_saved_s),
                "Won / tied / lost": outcome,
                "Chose the better route": share_of(_chose_better(each, floor) for each in chosen),
                "Regret, s": mean_cell(chosen, lambda each: each.regret_s),
            }
        )
    note = (
        "Over all decisions that count; where the policy keeps the route, the gain is 0. In brackets: 95 % t "
        f"intervals with a standard error over seeds, from {LEAST_SEEDS} seeds; resampled: from resampling "
        f"whole seeds. {_how_judged(study, floor)} Where the difference is chance, both routes count as the better "
        "one, so shares of two policies may add up to more than 100 %."
    )
    return Table.of("policies", "What each policy saved the ego", rows, note, heads=3)


def _how_judged(study: Study, floor: Noise) -> str:
    """What won, lost, better, best and regret mean, in words."""
    if study.plan.replicates == 1:
        return (
            f"Won and lost exclude differences within the noise floor of {floor.time_s:.1f} s. Regret: time lost "
            "compared with the best route. Each route was driven once, so best and regret include luck: add "
            "--replicates."
        )
    draws = [point.decision.draws for point in study.decisions]
    times = " to ".join(map(str, sorted({min(draws, default=0), max(draws, default=0)})))
    fixed = 1 + study.plan.draws.start
    added = f" Means are over the first {fixed}." if study.plan.replicates == "auto" else ""
    return (
        f"Each route was driven {times} times.{added} Best, better and "
        "regret are cross-fitted: the other draws choose and each draw scores, so regret may be negative. A draw "
        "is won or lost if the mean of the others has the same sign; the counts are sums of such shares."
    )


def parts(study: Study) -> Table:
    """What the time saved consists of."""
    rows: list[TableRecord] = []
    for share, policy, age_s, chosen in groups(study):
        if policy in STAYING or any(each.gain.lost_s is None or each.lost_ahead_s is None for each in chosen):
            continue
        rows.append(
            {
                "Share rerouting": f"{share:.0%}",
                "Policy": policy,
                "News age, s": f"{age_s:g}" if goes_by_news(policy) else NONE,
                "Time saved, s": mean_cell(chosen, time_saved_s),
                "Congestion avoided, s": mean_cell(chosen, lambda each: each.gain.lost_s or 0.0),
                "Way saved, s": mean_cell(chosen, lambda each: each.gain.way_s or 0.0),
                "Delay ahead, s": mean_cell(chosen, lambda each: each.delay_s, signed=False),
                "Lost on the kept route, s": mean_cell(chosen, lambda each: each.lost_ahead_s or 0.0, signed=False),
                "Trips": str(len({each.trip for each in chosen})),
            }
        )
    note = (
        "Time saved = congestion avoided + way saved, decision by decision. Congestion avoided: SUMO's time loss "
        "on the kept route less that on the other, signals included. Way saved: the time that each takes on an "
        "empty road, as fast as limits and driver allow. Delay ahead: expected at the decision, at present speeds; "
        "lost: what the kept route really lost from there on."
    )
    return Table.of("parts", "What the time saved consists of", rows, note, heads=3)


def costs(study: Study) -> Table:
    """Other effects, on the ego and on all other vehicles."""
    rows: list[TableRecord] = []
    for share, policy, age_s, chosen in groups(study):
        if policy in STAYING:
            continue
        rows.append(
            {
                "Share rerouting": f"{share:.0%}",
                "Policy": policy,
                "News age, s": f"{age_s:g}" if goes_by_news(policy) else NONE,
                "Distance saved, m": mean_cell(chosen, lambda each: each.gain.distance_m, 0),
                "Stops saved": mean_cell(chosen, lambda each: each.gain.stops, 2),
                "CO2 saved, g": mean_cell(chosen, lambda each: each.gain.co2_g),
                "Fuel saved, g": mean_cell(chosen, lambda each: each.gain.fuel_g),
                "Others save, s": mean_cell(chosen, others_save_s),
                "Unfinished": f"{sum(each.unfinished_stay for each in chosen):.0f} / "
                f"{sum(each.unfinished for each in chosen):.0f}",
            }
        )
    note = (
        "Means over decisions; negative values are costs. CO2 and fuel by SUMO's emission model. Others: "
        "the sum over every vehicle on the road or due at the decision, departure delay included, until the "
        f"ego and {study.plan.arrived:.0%} of them had arrived with one of the two routes; the rest counts up to "
        "that instant. Unfinished: the number of the latter, if the ego keeps its route / as the policy chooses."
    )
    return Table.of("costs", "Other effects", rows, note, heads=3)


def by_congestion(study: Study) -> Table:
    """Time saved by how congested the road ahead was."""
    first_s = study.plan.ages_s[0]
    chosen = [each for each in study.choices if each.age_s == first_s and each.policy not in STAYING]
    named = list(dict.fromkeys(each.policy for each in chosen))
    rows: list[TableRow] = []
    for low, high in BINS:
        here = [each for each in chosen if low <= each.time_index < high]
        if here:
            cells = [mean_cell((each for each in here if each.policy == name), time_saved_s) for name in named]
            rows.append((bin_name(low, high), str(len({each.id for each in here})), *cells))
    note = (
        "Seconds saved, by the expected travel time to the destination divided by that at free flow, at the "
        "decision, with the newest news of the plan."
    )
    return Table(
        "by_congestion", "Time saved by congestion", ("Time index", "Decisions", *named), tuple(rows), note
    )


def by_age(study: Study) -> Table:
    """Time saved by the age of the news, at the same decisions."""
    rows: list[TableRow] = []
    if len(study.plan.ages_s) > 1:
        named = [name for name in study.plan.policies if goes_by_news(name)]
        for age_s in study.plan.ages_s:
            here = [each for each in study.choices if each.age_s == age_s]
            cells = [mean_cell((each for each in here if each.policy == name), time_saved_s) for name in named]
            rows.append((f"{age_s:g}", *cells))
        columns: tuple[str, ...] = ("News age, s", *named)
    else:
        columns = ("News age, s",)
    note = "Seconds saved at the same decisions when the alternative route is selected by news of that age."
    return Table("by_age", "Time saved by the age of the news", columns, tuple(rows), note)


def by_compliance(study: Study) -> Table:
    """Time saved by how probably the driver follows the advice, at the same decisions."""
    rows: list[TableRow] = []
    named = [name for name in study.plan.policies if needs_driver(name)]
    for compliance in study.plan.compliance if len(study.plan.compliance) > 1 else ():
        chosen = study.at_compliance(compliance)
        here = [each for each in chosen if each.age_s == study.plan.ages_s[0]]
        followed = per_cent({each.id: each.complies for each in here}.values())
        cells = [mean_cell((each for each in here if each.policy == name), time_saved_s) for name in named]
        rows.append((f"{compliance:.0%}", followed, *cells))
    note = (
        "Seconds saved at the same decisions by a driver who follows the advice with that probability. A driver "
        "who follows it at one probability does so at every greater one, so the rows differ only by the compliance."
    )
    columns = ("Compliance", "Followed", *named)
    return Table("by_compliance", "Time saved by the driver's compliance", columns, tuple(rows), note)


def needs_driver(policy: str) -> bool:
    """Whether a policy is advice that the driver may ignore."""
    return parse_policy(policy).rule not in (PolicyRule.NEVER, PolicyRule.BEST)


def by_share(study: Study) -> Table:
    """Time saved by the share of other cars that reroute; each share's traffic was warmed up separately."""
    rows: list[TableRecord] = []
    shares = sorted({each.share for each in study.choices})
    for share in shares if len(shares) > 1 else ():
        here = [each for each in study.choices if (each.share, each.age_s) == (share, study.plan.ages_s[0])]
        never, always, best = ([each for each in here if each.policy == p] for p in ("never", "always", HINDSIGHT))
        rows.append(
            {
                "Share rerouting": f"{share:.0%}",
                "Decisions": str(len({each.id for each in here})),
                "Keeping the route takes, s": mean_cell(never, lambda each: each.stay.time_s, 0, signed=False),
                "Always saves, s": mean_cell(always, time_saved_s),
                "Best saves, s": mean_cell(best, time_saved_s),
                "Others save, s": mean_cell(always, others_save_s),
            }
        )
    return Table.of("by_share", "By the share of cars that reroute", rows, stops_helping(study))


def stops_helping(study: Study) -> str:
    """The share of rerouting cars from which rerouting no longer helps, in words."""
    helps: dict[float, bool] = {}
    for share in sorted({each.share for each in study.choices}):
        mean = seed_mean(
            (each.seed, each.gain.time_s)
            for each in study.choices
            if each.share == share and each.policy == "always" and each.age_s == study.plan.ages_s[0]
        )
        if mean is None or mean.interval is None:
            return f"Too few seeds to say where rerouting stops helping: every share requires {LEAST_SEEDS}."
        helps[share] = mean.interval.low > 0
    never_again = [share for share in helps if not any(helps[other] for other in helps if other >= share)]
    if not never_again:
        return "The policy `always` helps at every share that was run: its interval lies above zero."
    return (
        f"From a share of {never_again[0]:.0%}, the policy `always` no longer helps: its interval does not lie "
        "above zero."
    )


def noise_floor(study: Study) -> Table:
    """Differences between two futures in which the ego keeps its route."""
    floor = study.noise()
    rows: tuple[TableRow, ...] = ()
    if floor.placebos:
        rows = ((_what_is_fresh(study), str(floor.placebos), f"{floor.time_s:.1f}", f"{floor.others_s:.1f}"),)
    note = (
        f"{NOISE:.0%} of the drives in which the ego also keeps its route, with fresh random numbers, differ from "
        "the drive itself by no more than this. Where each route was driven once, a smaller difference of the "
        "ego's time is a tie."
    )
    columns = ("Placebo", "Drives", "Ego's time, s", "Others' time, s")
    return Table("noise", "Noise floor", columns, rows, note)


def _what_is_fresh(study: Study) -> str:
    """How the placebos and replicates differ from the drive itself."""
    said = {
        None: "One other car 0.1 % faster",  # of studies before there were fresh random numbers
        Fresh.SEED: "All random numbers reseeded",
        Fresh.SEED_UNSEEN: "All random numbers reseeded, without a visible effect at the start",
        Fresh.JITTER: f"All other cars' speeds changed by {JITTER:.1%} at random",
    }
    found = dict.fromkeys(row.fresh for row in study.rows if any(each.unchanged for each in row.decisions))
    return "; ".join(said[each] for each in found)


def excluded(study: Study) -> Table:
    """Exclusions from the averages."""
    examples: dict[tuple[str, str], str] = {}
    for row in study.rows:
        examples.setdefault(("drive", row.excluded), f"{row.id}: {row.why}")
        for each in row.decisions:
            examples.setdefault(("decision", each.excluded), f"{row.id}: {each.why}")
    rows = tuple(
        (f"{reason} ({what})", str(count), examples[what, reason])
        for (what, reason), count in sorted(study.excluded.items())
    )
    note = "These are counted here but not in any average; gridlocked traffic says nothing about rerouting."
    return Table("excluded", "Excluded from the averages", ("Reason", "Count", "For example"), rows, note, heads=3)


def errors(study: Study) -> Table:
    """Drives that ended in an infrastructure error."""
    return errors_table("Drive", study.errors)


def errors_table(unit: str, failed: Sequence[JobRow]) -> Table:
    """The errors of any kind of study, with what can be done."""
    rows = tuple((row.id, row.error_kind or "", row.error or "") for row in failed)
    note = remedy(failed)
    note = f"{note[0].upper()}{note[1:]}."
    return Table("errors", "Infrastructure errors", (unit, "Kind", "Message"), rows, note, heads=3)


def outcomes(chosen: Sequence[PolicyChoice], floor: Noise) -> tuple[float, float, float]:
    """Numbers of choices that saved time, made no difference, and lost time.

    With several draws they are sums of shares of draws; with one, the noise floor separates them."""
    wins = sum(each.gain.time_s > floor.time_s if each.won is None else each.won for each in chosen)
    losses = sum(each.gain.time_s < -floor.time_s if each.lost is None else each.lost for each in chosen)
    return wins, len(chosen) - wins - losses, losses


def _chose_better(choice: PolicyChoice, floor: Noise) -> float:
    """Share of the draws in which the choice was the best; of a single one, within the noise floor."""
    return float(choice.regret_s <= floor.time_s) if choice.chose_best is None else choice.chose_best


def time_saved_s(choice: PolicyChoice) -> float:
    """Savings of the ego."""
    return choice.gain.time_s


def others_save_s(choice: PolicyChoice) -> float:
    """Savings of all other vehicles."""
    return choice.others_gain_s


def mean_of(chosen: Iterable[PolicyChoice], of: Callable[[PolicyChoice], float]) -> SeedMean | None:
    """The mean of a figure over choices, with its interval over seeds."""
    return seed_mean((each.seed, float(of(each))) for each in chosen)


def mean_cell(
    chosen: Iterable[PolicyChoice], of: Callable[[PolicyChoice], float], digits: int = 1, *, signed: bool = True
) -> str:
    """For example ``+12.3 (+4.0 to +20.1)``."""
    return told_mean(mean_of(chosen, of), f"{'+' if signed else ''}.{digits}f")


def told_mean(mean: SeedMean | None, form: str) -> str:
    """A mean with its interval, each in a format such as ``+.1f``."""
    if mean is None:
        return NONE
    if mean.interval is None:
        return told(mean.value, form)
    return f"{told(mean.value, form)} ({told(mean.interval.low, form)} to {told(mean.interval.high, form)})"


def resampled_cell(chosen: Iterable[PolicyChoice], of: Callable[[PolicyChoice], float]) -> str:
    """The interval from resampling whole seeds, for example ``+4.0 to +20.1``."""
    mean = mean_of(chosen, of)
    if mean is None or mean.resampled is None:
        return NONE
    return f"{told(mean.resampled.low, '+.1f')} to {told(mean.resampled.high, '+.1f')}"


def told(value: float, form: str) -> str:
    """A number with a minus sign, unless it rounds to zero."""
    text = f"{value:{form}}"
    return text.replace("-", "−" if any(digit in text for digit in "123456789") else "")


def per_cent(flags: Iterable[bool]) -> str:
    """Share of true values."""
    return share_of(map(float, flags))


def share_of(shares: Iterable[float]) -> str:
    """The mean of shares, as a percentage."""
    listed = list(shares)
    return f"{sum(listed) / len(listed):.0%}" if listed else NONE


def bin_name(low: float, high: float) -> str:
    """Name of a range of time indices."""
    return f"{low:g} to {high:g}" if high < float("inf") else f"over {low:g}"
