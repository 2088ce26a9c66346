"""Maps of time lost: every road in the colour of what it costs or what an intervention changes, with a scale."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from automotive_cosim.contracts.plain import rounded
from automotive_cosim.report.charts import INK, PALETTE, WIDE_IN, Drawing, legend
from automotive_cosim.scenarios.wording import KINDS
from automotive_cosim.studies.congestion.plan import intervention_in
from automotive_cosim.studies.congestion.results import CongestionStudy
from automotive_cosim.studies.congestion.tables import lost_on_edges
from automotive_cosim.studies.congestion.words import name_of
from automotive_cosim.traffic.network import Network

if TYPE_CHECKING:
    from matplotlib.axes import Axes

GROWS = ("#ffd27f", "#fd8d3c", "#e31a1c", "#800026")
"""Colours of the classes of time lost, from little to much."""
SHRINKS = ("#9ecae1", "#4292c6", "#2171b5", "#08306b")
"""The same for less than without the intervention."""
LITTLE = "#d0d5dd"
"""Colour of what is below the first class."""

SHARES = (0.02, 0.1, 0.25, 0.5)
"""Lower bounds of the classes, as shares of the greatest value; they are rounded to one digit."""

NAMES = 12
"""Most streets that are named."""

MANY = 3_000
"""Roads above which they are drawn as a picture inside the SVG."""


def lost_map(study: CongestionStudy, network: Network, number: int, width_in: float) -> Drawing | None:
    """The time lost per kilometre of road without an intervention (0), or what that intervention changes."""
    before = lost_on_edges(study, 0)
    if not before:
        return None
    delays = before
    if number:
        after = lost_on_edges(study, number)
        delays = {edge: after.get(edge, 0.0) - before.get(edge, 0.0) for edge in {*before, *after}}
    per_km = {
        edge: 1000 * value / network.edges[edge].length_m for edge, value in delays.items() if edge in network.edges
    }
    most = max(map(abs, per_km.values()), default=0.0)
    bounds = [float(f"{share * most:.0e}") for share in SHARES]
    west, south, east, north = network.map.bounds_m
    is_narrow = width_in < WIDE_IN
    height_in = min(9.0, width_in * max(1 / 3, 0.9 * (north - south) / max(1.0, east - west)))

    def draw(axes: Axes) -> None:
        from matplotlib.collections import LineCollection

        is_large = len(network.edges) > MANY
        shapes = {name: edge.shape_m for name, edge in network.edges.items()}
        axes.add_collection(
            LineCollection(
                [*shapes.values(), *network.joints_m], colors=INK, alpha=0.22, linewidths=0.9, rasterized=is_large
            )
        )
        for colours, sign in ((GROWS, 1), *(((SHRINKS, -1),) if number else ())):
            for place, (colour, low, high) in enumerate(zip(colours, bounds, (*bounds[1:], math.inf), strict=True)):
                lines = [
                    _aside(shapes[edge], 4.0)
                    for edge, value in per_km.items()
                    if most and low <= sign * value < high
                ]
                axes.add_collection(
                    LineCollection(
                        lines, colors=colour, linewidths=1.6 + place, capstyle="round", rasterized=is_large
                    )
                )
        if most:
            _classes(axes, [*bounds, most], is_change=bool(number), is_narrow=is_narrow)
        _places(axes, study, network, number)
        if not is_narrow:  # names would hide it
            _name_streets(axes, network, per_km)
        _scale(axes, network)
        axes.set_xlim(west - 20, east + 20)
        axes.set_ylim(south - 0.09 * (north - south) - 20, north + 20)
        axes.set_aspect("equal")
        axes.set_axis_off()
        legend(axes, ncols=1 if is_narrow else 2, fontsize=8)

    return height_in + 1.3, draw


def _classes(axes: Axes, bounds: Sequence[float], *, is_change: bool, is_narrow: bool) -> None:
    """The colours of the classes, with their bounds."""
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import BoundaryNorm, ListedColormap

    colours = [LITTLE, *GROWS]
    if is_change:
        bounds, colours = [*(-bound for bound in reversed(bounds)), *bounds], [*reversed(SHRINKS), *colours]
    else:
        bounds = [0.0, *bounds]
    scale = ScalarMappable(BoundaryNorm(bounds, len(colours)), ListedColormap(colours))
    bar = axes.figure.colorbar(
        scale,
        ax=axes,
        location="bottom",
        spacing="uniform",
        shrink=1.0 if is_narrow else 0.7,
        aspect=40,
        pad=0.02,
        ticks=bounds,
    )
    told = [rounded(abs(bound), 2) for bound in bounds]
    signs = ("−" if bound < 0 else "+" if is_change else "" for bound in bounds)
    bar.set_ticklabels([sign + text for sign, text in zip(signs, told, strict=True)])
    bar.set_label(f"{'more or less ' if is_change else ''}vehicle-hours lost on the road per hour and km")
    bar.outline.set_visible(False)
    bar.ax.tick_params(length=0, labelsize=6 if is_narrow else 8)


def _aside(shape: tuple[tuple[float, float], ...], by_m: float) -> list[tuple[float, float]]:
    """A line a little to its right, so that the two directions of a road lie beside each other."""
    moved = []
    for place, (x, y) in enumerate(shape):
        (x1, y1), (x2, y2) = shape[max(0, place - 1)], shape[min(len(shape) - 1, place + 1)]
        length = math.hypot(x2 - x1, y2 - y1) or 1.0
        moved.append((x + by_m * (y2 - y1) / length, y - by_m * (x2 - x1) / length))
    return moved


def _places(axes: Axes, study: CongestionStudy, network: Network, number: int) -> None:
    """Marks the corridor's ends and where incidents and the intervention are."""
    trip = study.plan.along
    start, goal = network.edges[trip.from_edge].shape_m[0], network.edges[trip.to_edge].shape_m[-1]
    axes.plot(*start, "o", color=INK, markersize=7, fillstyle="none", label=f"start of “{trip.name}”")
    axes.plot(*goal, "*", color=INK, markersize=11, label=f"destination of “{trip.name}”")
    texts = [*study.plan.incidents, *study.plan.interventions[number - 1 : number if number else 0]]
    for text in texts:
        if text.split()[0] in KINDS:
            found = intervention_in(text, "--intervention")
            edges = getattr(found, "edges", ()) or filter(None, (getattr(found, "edge", ""),))
            places = [network.edges[edge].shape_m for edge in edges if edge in network.edges]
            if places:
                x, y = ((one + two) / 2 for one, two in zip(places[-1][0], places[-1][-1], strict=True))
                axes.plot(
                    [x],
                    [y],
                    "X",
                    color=PALETTE[3],
                    markersize=10,
                    markeredgecolor="white",
                    label=name_of(text),
                    linestyle="",
                )


def _name_streets(axes: Axes, network: Network, per_km: dict[str, float]) -> None:
    """Names the streets with the greatest values at their worst edge, and then the longest, without overlaps."""
    worst: dict[str, tuple[float, float, str]] = {}
    for name, edge in network.edges.items():
        if edge.name:
            rank = abs(per_km.get(name, 0.0)), edge.length_m, name
            worst[edge.name] = max(worst.get(edge.name, (-1.0, 0.0, "")), rank)
    west, south, east, north = network.map.bounds_m
    taken: list[tuple[float, float]] = []
    for street, (_, _, name) in sorted(worst.items(), key=lambda item: item[1], reverse=True):
        shape = network.edges[name].shape_m
        (x1, y1), (x2, y2) = shape[0], shape[-1]
        x, y = (x1 + x2) / 2, (y1 + y2) / 2
        if len(taken) == NAMES:
            break
        if any(abs(x - a) < 0.2 * (east - west) and abs(y - b) < 0.07 * (north - south) for a, b in taken):
            continue
        taken.append((x, y))
        angle = math.degrees(math.atan2(y2 - y1, x2 - x1))
        angle = angle - 180 if angle > 90 else angle + 180 if angle < -90 else angle
        axes.annotate(
            street,
            (x, y),
            xytext=(-9 * math.sin(math.radians(angle)), 9 * math.cos(math.radians(angle))),
            textcoords="offset points",
            fontsize=7.5,
            rotation=angle,
            rotation_mode="anchor",
            ha="center",
            color=INK,
        )


def _scale(axes: Axes, network: Network) -> None:
    """A bar of a round length below the map; north is up."""
    west, south, east, north = network.map.bounds_m
    wanted_m = (east - west) / 5
    power = 10 ** math.floor(math.log10(max(1.0, wanted_m)))
    length_m = max(step * power for step in (1, 2, 5) if step * power <= max(1.0, wanted_m))
    y = south - 0.06 * (north - south) - 10
    axes.plot([west, west + length_m], [y, y], color=INK, linewidth=2.5, solid_capstyle="butt")
    told = f"{length_m / 1000:g} km" if length_m >= 1000 else f"{length_m:g} m"
    axes.annotate(
        f"{told}, north is up",
        (west + length_m, y),
        xytext=(6, 0),
        textcoords="offset points",
        fontsize=8,
        va="center",
    )
