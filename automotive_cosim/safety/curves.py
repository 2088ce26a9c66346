"""Response curves: how the margin of the samples goes with each number that a search varies."""

from __future__ import annotations

from typing import TYPE_CHECKING

from automotive_cosim.report.charts import PALETTE, Chart, Drawing, charted, is_installed, legend
from automotive_cosim.safety.findings import judged
from automotive_cosim.safety.hunt import Hunt
from automotive_cosim.safety.space import FactorRange, label_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

HEIGHT_IN = 2.6
MOST_PARTS, POINTS_A_PART = 12, 4
"""Parts of a range whose means are drawn at most, and samples for each."""


def curves(found: Hunt) -> dict[str, Chart]:
    """A plot for each ordered number; none without matplotlib."""
    if not is_installed():
        return {}
    ordered = [each for each in found.space.factors if isinstance(each, FactorRange) and each.is_ordered]
    return charted(
        {f"curve-{each.name}": (f"Margin by {label_of(each.name)[0]}", _curve(found, each)) for each in ordered}
        if judged(found.samples)
        else {}
    )


def means(found: Hunt, factor: FactorRange) -> list[tuple[float, float]]:
    """The middle of each part of a range that has samples, as a coordinate, and their mean margin."""
    samples = judged(found.samples)
    parts = max(2, min(MOST_PARTS, len(samples) // POINTS_A_PART))
    groups: dict[int, list[float]] = {}
    for each in samples:
        unit = factor.unit(each.point[factor.name])
        groups.setdefault(min(parts - 1, int(unit * parts)), []).append(each.outcome.margin or 0.0)
    return [((part + 0.5) / parts, sum(group) / len(group)) for part, group in sorted(groups.items())]


def _curve(found: Hunt, factor: FactorRange) -> Drawing:
    samples = judged(found.samples)

    def draw(axes: Axes) -> None:
        for is_failed, colour, label in ((False, PALETTE[0], "passed"), (True, PALETTE[1], "failed")):
            mine = [each for each in samples if each.outcome.failed is is_failed]
            if mine:
                places = [float(each.point[factor.name]) for each in mine]
                axes.plot(
                    places, [each.outcome.margin or 0.0 for each in mine], "o", color=colour, label=label, alpha=0.6
                )
        line = means(found, factor)
        axes.plot(
            [float(factor.at(unit)) for unit, _ in line], [mean for _, mean in line], color=PALETTE[2], label="mean"
        )
        axes.axhline(0, color=PALETTE[7], linewidth=0.8)
        if factor.logarithmic:
            axes.set_xscale("log")
        axes.set_xlabel(", ".join(filter(None, label_of(factor.name))))
        axes.set_ylabel("margin")
        legend(axes)

    return HEIGHT_IN, draw
