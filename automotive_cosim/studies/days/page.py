"""The report of a study from day to day."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from statistics import fmean
from typing import TYPE_CHECKING

from automotive_cosim.contracts.plain import counted
from automotive_cosim.report.charts import INK, MARKERS, PALETTE, Chart, Drawing, charted, legend
from automotive_cosim.report.tables import Table, TableRecord
from automotive_cosim.studies.content import ShownStudy
from automotive_cosim.studies.days.days import (
    EQUILIBRIUM,
    NEAR,
    OPTIMUM,
    SETTLED,
    WEEK,
    DaysRow,
    DaysStudy,
    Drivers,
    StudyDay,
)
from automotive_cosim.studies.intervals import LEAST_SEEDS, SeedMean, seed_mean
from automotive_cosim.studies.reroute.tables import NONE, told, told_mean
from automotive_cosim.studies.reroute.warnings import missing_told

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LINES: dict[Drivers, str] = {EQUILIBRIUM: "--", OPTIMUM: ":"}
"""Line styles of plots; shares have solid lines."""

LEAST_SHARE = 0.0005
"""Smaller differences are none in the answer, which has a tenth of a per cent."""


def shown(study: DaysStudy) -> ShownStudy:
    """What the report shows."""
    plan = study.plan
    about = f"{counted(len(plan.seeds), 'seed')}, up to {counted(plan.days, 'day')} of {plan.minutes:g} minutes"
    return ShownStudy("Study from day to day", about, answer(study), warnings(study), tables(study), charts(study))


def named(drivers: Drivers) -> str:
    """What a share or state is called."""
    return drivers if isinstance(drivers, str) else f"{drivers:.0%} advised"


def states(study: DaysStudy) -> list[Drivers]:
    """The shares that were run, then the equilibrium and the optimum."""
    known: tuple[Drivers, ...] = (*study.plan.shares, EQUILIBRIUM, OPTIMUM)
    return [drivers for drivers in known if study.of(drivers)]


def shares(study: DaysStudy) -> list[float]:
    """The shares that were run."""
    return [share for share in study.plan.shares if study.of(share)]


def mean_s(study: DaysStudy, drivers: Drivers) -> SeedMean | None:
    """Mean travel time per trip once it has settled, over the seeds."""
    return over_seeds(study.of(drivers), lambda day: day.mean_s)


def over_seeds(rows: Sequence[DaysRow], of: Callable[[StudyDay], float | None]) -> SeedMean | None:
    """The mean of a figure of the last days over the seeds."""
    found = [(row.seed, row.last(of)) for row in rows]
    return seed_mean((seed, value) for seed, value in found if value is not None)


def answer(study: DaysStudy) -> str:
    """The best share in a sentence, beside nobody advised, the user equilibrium and the system optimum."""
    found = {share: mean for share in shares(study) if (mean := mean_s(study, share))}
    if not found:
        return "No share was driven to its end."
    best = min(found, key=lambda share: found[share].value)
    least_s = found[best].value
    parts = []
    others = {"with nobody advised": found.get(0.0) if best else None}
    searched = (EQUILIBRIUM,) if beaten_by(study) else (EQUILIBRIUM, OPTIMUM)
    others |= {f"in the {state}": mean_s(study, state) for state in searched}
    for what, mean in others.items():
        if mean is not None:
            share = least_s / mean.value - 1
            far = f"{abs(share):.1%} {'less' if share < 0 else 'more'} than"
            parts.append(f"{far if abs(share) >= LEAST_SHARE else 'as long as'} {what}")
    beside = f", {' and '.join(filter(None, [', '.join(parts[:-1]), parts[-1]]))}" if parts else ""
    over = counted(found[best].seeds, "seed")
    advised = f"with {best:.0%} of the drivers advised"
    lead = f"A trip is shortest {advised}: " if len(found) > 1 else f"A trip takes, {advised}, "
    return f"{lead}{least_s:.0f} s{beside}; {_settled(study, best)}, over {over}."


def beaten_by(study: DaysStudy) -> list[Drivers]:
    """With which drivers trips take less than in the optimum that was found, or as long if nobody is advised."""
    optimum = mean_s(study, OPTIMUM)
    if optimum is None:
        return []
    means = {drivers: mean for drivers in states(study) if drivers != OPTIMUM and (mean := mean_s(study, drivers))}
    return [
        drivers
        for drivers, mean in means.items()
        if mean.value < optimum.value or (drivers == 0.0 and mean.value == optimum.value)
    ]


def _settled(study: DaysStudy, share: float) -> str:
    days = [row.settled for row in study.of(share)]
    known = [day for day in days if day is not None]
    if known == [0] * len(days):
        return "nobody takes another route"
    if len(known) == len(days):
        return f"traffic settles by day {max(known)}"
    return f"traffic does not settle in {study.plan.days} days in {len(days) - len(known)} of {len(days)} seeds"


def warnings(study: DaysStudy) -> list[str]:
    """Warnings to read before using the study's figures."""
    found = list(missing_told(len(study.plan.jobs()), len(study.rows), "run"))
    seeds = len(study.plan.seeds)
    if seeds < LEAST_SEEDS:
        found.append(f"{counted(seeds, 'seed')}: no interval of a mean below {LEAST_SEEDS} seeds.")
    gap = over_seeds(study.of(EQUILIBRIUM), lambda day: day.relative_gap)
    if gap is not None and gap.value > NEAR:
        found.append(
            f"The nearest that was found to a user equilibrium has a relative gap of {gap.value:.1%}, more than "
            f"{NEAR:.0%}: differences from it are differences from a guess."
        )
    shorter = beaten_by(study)
    if shorter:
        where = [f"in the {each}" if isinstance(each, str) else f"with {named(each)}" for each in shorter]
        found.append(
            f"The system optimum is not known: trips take no longer {' or '.join(where)} than on the best day that "
            "the search for it found."
        )
    unsettled = [named(share) for share in shares(study) if any(row.settled is None for row in study.of(share))]
    if unsettled:
        found.append(f"Not settled in every seed: {', '.join(unsettled)}; run more --days.")
    late = sum(row.days[-1].unfinished for row in study.rows if row.days)
    if late:
        found.append(f"{counted(late, 'trip')} had not arrived at the end of the last days and count up to then.")
    teleported = sum(row.days[-1].teleports for row in study.rows if row.days)
    if teleported:
        found.append(f"SUMO moved {counted(teleported, 'vehicle')} on that stood too long, on the last days.")
    return found


def tables(study: DaysStudy) -> list[Table]:
    """All tables."""
    rows: list[TableRecord] = []
    nobody, best, least = (
        {row.seed: row.last(lambda day: day.mean_s) or 0.0 for row in study.of(drivers)}
        for drivers in (0.0, EQUILIBRIUM, OPTIMUM)
    )
    for drivers in states(study):
        here = study.of(drivers)
        own = {row.seed: row.last(lambda day: day.mean_s) or 0.0 for row in here}
        against = [
            told_mean(seed_mean((seed, own[seed] - other[seed]) for seed in own.keys() & other.keys()), "+.1f")
            for other in (nobody, best, least)
        ]
        settled = [row.settled for row in here]
        is_searched = isinstance(drivers, str)
        rows.append(
            {
                "Drivers": named(drivers),
                "Seeds": str(len(here)),
                "Settled on day": NONE
                if is_searched or None in settled
                else f"{fmean(day for day in settled if day is not None):.0f}",
                "Trip, s": told_mean(mean_s(study, drivers), ".1f"),
                "Advised, s": told_mean(over_seeds(here, lambda day: day.advised_s), ".1f"),
                "Others, s": told_mean(over_seeds(here, lambda day: day.others_s), ".1f"),
                "Against nobody, s": NONE if drivers == 0 else against[0],
                "Against equilibrium, s": NONE if drivers == EQUILIBRIUM else against[1],
                "Against optimum, s": NONE if drivers == OPTIMUM else against[2],
                "Relative gap": _per_cent(over_seeds(here, lambda day: day.relative_gap)),
            }
        )
    note = (
        f"Means of the last {min(WEEK, study.plan.days + 1)} days, from the planned departure to the arrival. "
        f"Settled: the mean of {WEEK} days differs by less than {SETTLED:.0%} from that of the {WEEK} days before. "
        "User equilibrium: the day with the smallest gap. System optimum: the day with the least time, which may "
        "not be the least there is. Differences: seed by seed. Relative gap: what all drivers lost against the "
        "routes that were quickest that day; 0 is a user equilibrium."
    )
    return [Table.of("shares", "Travel time by the share of advised drivers", rows, note)]


def _per_cent(mean: SeedMean | None) -> str:
    return NONE if mean is None else told(mean.value, ".1%")


def charts(study: DaysStudy) -> dict[str, Chart]:
    """Plots by name. Raises SetupError: matplotlib is not installed."""
    made: dict[str, tuple[str, Drawing | None]] = {
        "days": ("Travel time from day to day", _days(study)),
        "shares": ("Travel time by the share of advised drivers", _shares(study)),
    }
    return charted(made)


def _days(study: DaysStudy) -> Drawing | None:
    found = states(study)
    if not found:
        return None

    def draw(axes: Axes) -> None:
        for number, drivers in enumerate(found):
            rows = study.of(drivers)
            shortest = min(len(row.days) for row in rows)
            means_s = [fmean(row.days[day].mean_s for row in rows) for day in range(shortest)]
            axes.plot(
                range(shortest),
                means_s,
                marker=None if isinstance(drivers, str) else MARKERS[number % len(MARKERS)],
                linestyle=LINES.get(drivers, "-"),
                color=INK if isinstance(drivers, str) else PALETTE[number % len(PALETTE)],
                markersize=5,
                label=f"search for the {drivers}" if isinstance(drivers, str) else named(drivers),
            )
        axes.grid(axis="y", color=INK, alpha=0.15, linewidth=0.8)
        axes.locator_params(axis="x", integer=True)
        axes.set_xlabel("day")
        axes.set_ylabel("mean travel time, s")
        legend(axes)

    return 3.4 + 0.23 * len(found), draw


FOUND = {EQUILIBRIUM: "day nearest to the user equilibrium", OPTIMUM: "shortest day found"}
"""What the lines of a plot are: a search has found them, and an equilibrium or optimum it may not have reached."""


def _shares(study: DaysStudy) -> Drawing | None:
    advised = shares(study)
    if len(advised) < 2:
        return None
    lines: dict[str, Callable[[StudyDay], float | None]] = {
        "all": lambda day: day.mean_s,
        "advised": lambda day: day.advised_s,
        "others": lambda day: day.others_s,
    }

    def draw(axes: Axes) -> None:
        for number, (name, of) in enumerate(lines.items()):
            known = [(share, mean) for share in advised if (mean := over_seeds(study.of(share), of)) is not None]
            reach = [0.0 if mean.interval is None else mean.interval.high - mean.value for _, mean in known]
            axes.errorbar(
                [100 * share for share, _ in known],
                [mean.value for _, mean in known],
                yerr=reach,
                marker=MARKERS[number],
                color=PALETTE[number],
                markersize=6,
                label=name,
            )
        for state in (EQUILIBRIUM, OPTIMUM):
            mean = mean_s(study, state)
            if mean is not None:
                axes.axhline(mean.value, color=INK, linestyle=LINES[state], linewidth=1, label=FOUND[state])
        axes.grid(axis="y", color=INK, alpha=0.15, linewidth=0.8)
        axes.set_xlabel("% of the drivers advised")
        axes.set_ylabel("mean travel time of the last days, s")
        legend(axes)

    return 4.4, draw
