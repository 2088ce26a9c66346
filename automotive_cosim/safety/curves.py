"""Response curves: how the margin of the samples goes with each number that a search varies."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING

from automotive_cosim.errors import SetupError
from automotive_cosim.report.charts import NARROW_IN, PALETTE, WIDE_IN, drawn, legend
from automotive_cosim.safety.findings import judged
from automotive_cosim.safety.hunt import Hunt
from automotive_cosim.safety.space import FactorRange

if TYPE_CHECKING:
    from matplotlib.axes import Axes

HEIGHT_IN = 2.6
MOST_PARTS, POINTS_A_PART = 12, 4
"""Parts of a range whose means are drawn at most, and samples for each."""


def curves(found: Hunt) -> dict[str, tuple[str, str, str]]:
    """A plot for each ordered number: title, SVG for a wide page, SVG for a narrow one; none without matplotlib."""
    made: dict[str, tuple[str, str, str]] = {}
    with suppress(SetupError):
        for factor in found.space.factors:
            if isinstance(factor, FactorRange) and factor.is_ordered and judged(found.samples):
                wide, narrow = (_curve(found, factor, width_in) for width_in in (WIDE_IN, NARROW_IN))
                made[factor.name] = f"Margin by {factor.name}", wide, narrow
    return made


def means(found: Hunt, factor: FactorRange) -> list[tuple[float, float]]:
    """The middle of each part of a range that has samples, as a coordinate, and their mean margin."""
    samples = judged(found.samples)
    parts = max(2, min(MOST_PARTS, len(samples) // POINTS_A_PART))
    groups: dict[int, list[float]] = {}
    for each in samples:
        unit = factor.unit(each.point[factor.name])
        groups.setdefault(min(parts - 1, int(unit * parts)), []).append(each.outcome.margin or 0.0)
    return [((part + 0.5) / parts, sum(group) / len(group)) for part, group in sorted(groups.items())]


def _curve(found: Hunt, factor: FactorRange, width_in: float) -> str:
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
        axes.set_xlabel(factor.name)
        axes.set_ylabel("margin")
        legend(axes)

    return drawn(f"curve-{factor.name}", (HEIGHT_IN, draw), width_in)
