"""Plots of a study, in the colours of the page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from statistics import fmean
from typing import TYPE_CHECKING

from automotive_cosim.report.charts import INK, MARKERS, PALETTE, Chart, Drawing, charted, legend
from automotive_cosim.studies.intervals import seed_mean
from automotive_cosim.studies.reroute.effects import rerouted, together_by_share
from automotive_cosim.studies.reroute.policies import parse_policy
from automotive_cosim.studies.reroute.results import Study
from automotive_cosim.studies.reroute.rows import PolicyChoice, Together
from automotive_cosim.studies.reroute.tables import (
    BINS,
    NONE,
    STAYING,
    bin_name,
    goes_by_news,
    groups,
    mean_of,
    needs_driver,
    time_saved_s,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Series = Sequence[tuple[str, Sequence[Sequence[PolicyChoice]]]]
"""Name of each series, and its choices for each row of the plot."""

SAVED = "seconds saved"


def charts(study: Study) -> dict[str, Chart]:
    """Plots by name. Raises SetupError: matplotlib is not installed."""
    made: dict[str, tuple[str, Drawing | None]] = {
        "policies": ("Time saved by each policy", _policies(study)),
        "everyone": ("Who gains and who loses", _everyone(study)),
        "many": ("When many cars take the other route", _many(study)),
        "promised": ("Predicted and actual savings", _promised(study)),
        "congestion": ("Time saved by congestion at the decision", _congestion(study)),
        "ages": ("Time saved by the age of the news", _ages(study)),
        "compliance": ("Time saved by the driver's compliance", _compliance(study)),
        "shares": ("Time saved by the share of cars that reroute", _shares(study)),
    }
    return charted(made)


def _policies(study: Study) -> Drawing | None:
    found = [(share, policy, rows) for share, policy, age_s, rows in groups(study) if age_s == study.plan.ages_s[0]]
    named = [name for name in dict.fromkeys(policy for _, policy, _ in found) if name not in STAYING]
    shares = list(dict.fromkeys(share for share, _, _ in found))
    series = [
        (
            f"{share:.0%} of the others reroute",
            [[each for s, p, rows in found if (s, p) == (share, name) for each in rows] for name in named],
        )
        for share in shares
    ]
    return _points(study, list(map(_words, named)), series)


def _congestion(study: Study) -> Drawing | None:
    chosen = [each for each in study.choices if each.age_s == study.plan.ages_s[0] and each.policy not in STAYING]
    bins = [(low, high) for low, high in BINS if any(low <= each.time_index < high for each in chosen)]
    series = [
        (
            _words(name),
            [
                [each for each in chosen if each.policy == name and low <= each.time_index < high]
                for low, high in bins
            ],
        )
        for name in dict.fromkeys(each.policy for each in chosen)
    ]
    return _points(study, [f"time index {bin_name(low, high)}" for low, high in bins], series)


def _ages(study: Study) -> Drawing | None:
    ages_s = study.plan.ages_s
    if len(ages_s) < 2:
        return None
    named = [name for name in study.plan.policies if goes_by_news(name)]
    series = [
        (
            _words(name),
            [[each for each in study.choices if (each.policy, each.age_s) == (name, age_s)] for age_s in ages_s],
        )
        for name in named
    ]
    return _points(study, [f"{age_s:g} s old" for age_s in ages_s], series)


def _compliance(study: Study) -> Drawing | None:
    if len(study.plan.compliance) < 2:
        return None
    first_s = study.plan.ages_s[0]
    levels = [[e for e in study.at_compliance(each) if e.age_s == first_s] for each in study.plan.compliance]
    series = [
        (_words(name), [[each for each in level if each.policy == name] for level in levels])
        for name in study.plan.policies
        if needs_driver(name)
    ]
    return _points(study, [f"followed at {each:.0%}" for each in study.plan.compliance], series)


def _shares(study: Study) -> Drawing | None:
    shares = sorted({each.share for each in study.choices})
    if len(shares) < 2:
        return None
    first_s = study.plan.ages_s[0]
    series = [
        (
            _words(name),
            [
                [e for e in study.choices if (e.policy, e.share, e.age_s) == (name, share, first_s)]
                for share in shares
            ],
        )
        for name in study.plan.policies
        if name not in STAYING
    ]
    return _points(study, [f"{share:.0%} reroute" for share in shares], series)


def _promised(study: Study) -> Drawing | None:
    """The predicted and the actual saving of each alternative route that was driven."""
    points = [
        (news.promised_s, point.decision.gains(news.branch).time_s)
        for point in study.decisions
        for news in point.decision.news[:1]
        if news.branch is not None and news.promised_s is not None
    ]
    if not points:
        return None

    def draw(axes: Axes) -> None:
        promised, saved = zip(*points, strict=True)
        ends = [min(*promised, *saved), max(*promised, *saved)]
        axes.plot(ends, ends, color=INK, alpha=0.4, linewidth=1, label="as predicted")
        floor_s = study.noise().time_s
        axes.axhspan(-floor_s, floor_s, color=INK, alpha=0.12, linewidth=0, label="noise floor")
        axes.scatter(promised, saved, s=22, alpha=0.6, color=PALETTE[0], linewidths=0, label="one decision")
        axes.grid(axis="y", color=INK, alpha=0.15, linewidth=0.8)
        axes.set_xlabel("predicted saving, s")
        axes.set_ylabel("seconds saved")
        legend(axes)

    return 4.4, draw


def _many(study: Study) -> Drawing | None:
    """What the ego, the cars that were rerouted with it, and the rest save, by the share of cars rerouted."""
    found = {share: here for (rerouting, share), here in together_by_share(study).items()}
    if len(found) < 2 or len({row.share for row in study.rows}) > 1:
        return None
    series: dict[str, Callable[[Together], float]] = {
        "the ego": lambda each: each.ego_gain_s,
        "the cars rerouted with it": lambda each: each.took_gain_s,
        "the rest": lambda each: each.rest_gain_s,
    }

    def draw(axes: Axes) -> None:
        axes.axhline(0, color=INK, alpha=0.5, linewidth=1)
        for number, (name, of) in enumerate(series.items()):
            means = [
                (share, seed_mean((seed, fmean(map(of, draws))) for seed, draws in here))
                for share, here in found.items()
            ]
            known = [(100 * share, mean) for share, mean in means if mean is not None]
            reach = [0.0 if mean.interval is None else mean.interval.high - mean.value for _, mean in known]
            axes.errorbar(
                [share for share, _ in known],
                [mean.value for _, mean in known],
                yerr=reach,
                marker=MARKERS[number],
                color=PALETTE[number],
                markersize=6,
                elinewidth=1.6,
                label=name,
            )
        axes.set_xlabel("% of the eligible cars rerouted with the ego")
        axes.set_ylabel("seconds saved, sum")
        legend(axes)

    return 4.0, draw


def _everyone(study: Study) -> Drawing | None:
    """What single vehicles save where a policy reroutes: median, central 50 % and central 90 %."""
    first = f"{study.plan.ages_s[0]:g}"
    found = [(heads, rows) for heads, rows in rerouted(study) if heads[2] in (first, NONE)]
    if not found:
        return None
    names = [f"{_words(policy)}, {share} reroute" for (share, policy, _), _ in found]
    spreads = [[spread for _, spread in rows] for _, rows in found]

    def draw(axes: Axes) -> None:
        axes.axvline(0, color=INK, alpha=0.5, linewidth=1)
        for place, here in enumerate(spreads):
            low, lower, median, upper, high = (
                fmean(getattr(each, name) for each in here)
                for name in ("low_s", "lower_s", "median_s", "upper_s", "high_s")
            )
            first = place == 0
            colour = PALETTE[0]
            axes.plot([low, high], [place] * 2, color=colour, linewidth=1.6, label="90 %" if first else None)
            axes.plot([lower, upper], [place] * 2, color=colour, linewidth=6, label="half" if first else None)
            axes.plot(median, place, MARKERS[0], color=INK, markersize=5, label="median" if first else None)
        axes.set_yticks(range(len(names)), names)
        axes.set_ylim(len(names) - 0.5, -0.5)
        axes.set_xlabel("seconds saved by one vehicle")
        legend(axes)

    return 1.4 + 0.35 * len(names), draw


def _words(policy: str) -> str:
    return parse_policy(policy).words


def _points(study: Study, names: Sequence[str], series: Series) -> Drawing | None:
    """One row per name, with a mean and its interval for each series, and the noise floor behind them."""
    if not names or not series:
        return None
    height_in = 1.0 + len(names) * (0.2 + 0.17 * len(series)) + 0.23 * len(series)
    floor_s = study.noise().time_s

    def draw(axes: Axes) -> None:
        axes.axvspan(-floor_s, floor_s, color=INK, alpha=0.12, linewidth=0)
        axes.axvline(0, color=INK, alpha=0.5, linewidth=1)
        for number, (label, cells) in enumerate(series):
            offset = (number - (len(series) - 1) / 2) * 0.8 / len(series)
            found = [(place + offset, mean_of(rows, time_saved_s)) for place, rows in enumerate(cells)]
            means = [(place, mean) for place, mean in found if mean is not None]
            reach = [
                (mean.value - mean.interval.low, mean.interval.high - mean.value) if mean.interval else (0.0, 0.0)
                for _, mean in means
            ]
            axes.errorbar(
                [mean.value for _, mean in means],
                [place for place, _ in means],
                xerr=[[max(0.0, low) for low, _ in reach], [max(0.0, high) for _, high in reach]],
                fmt=MARKERS[number % len(MARKERS)],
                color=PALETTE[number % len(PALETTE)],
                markersize=6,
                elinewidth=1.6,
                capsize=0,
                label=label,
            )
        axes.set_yticks(range(len(names)), names)
        axes.set_ylim(len(names) - 0.5, -0.5)
        axes.set_xlabel(SAVED)
        legend(axes)

    return height_in, draw
