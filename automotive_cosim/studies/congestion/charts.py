"""Plots of a congestion study, as traffic engineers draw them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from statistics import fmean
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from automotive_cosim.contracts import KMH_PER_MPS
from automotive_cosim.report.charts import (
    INK,
    MARKERS,
    NARROW_IN,
    PALETTE,
    WIDE_IN,
    Chart,
    Drawing,
    charted,
    legend,
)
from automotive_cosim.studies.congestion.maps import lost_map
from automotive_cosim.studies.congestion.outputs import JUNCTIONS, OTHER
from automotive_cosim.studies.congestion.plan import EPOCH_S, INTERVAL_S
from automotive_cosim.studies.congestion.results import HOUR_S, CongestionStudy, strongest
from automotive_cosim.studies.congestion.rows import FlowSums
from automotive_cosim.studies.congestion.tables import all_interventions, network_of
from automotive_cosim.traffic.network import Network
from automotive_cosim.traffic.ways import way_through

if TYPE_CHECKING:
    from matplotlib.axes import Axes

DRAWN = 4
"""Most interventions in one plot: more hide each other."""


def charts(study: CongestionStudy) -> dict[str, Chart]:
    """Plots by name. Raises SetupError: matplotlib is not installed."""
    network = network_of(study)
    named = [(number, name) for number, name in all_interventions(study) if number <= DRAWN]
    made: dict[str, tuple[str, Drawing | None]] = {
        "delay": ("Time lost on the road, in the course of time", _lost(study)),
        "map": ("Time lost on the road without an intervention", lost_map(study, network, 0, WIDE_IN)),
    }
    narrow = {"map": lost_map(study, network, 0, NARROW_IN)}
    interventions = sorted(
        (each for each in all_interventions(study) if each[0]), key=lambda each: each[0] != strongest(study)
    )
    shown = interventions[:1]
    for number, name in interventions:
        key = "map_change" if (number, name) in shown else f"map_change_{number}"
        made[key] = f"Change of the time lost with “{name}”", lost_map(study, network, number, WIDE_IN)
        narrow[key] = lost_map(study, network, number, NARROW_IN)
    made["mfd"] = "Macroscopic fundamental diagram of the network", _fundamental(study, network)
    for number, name in (*named[:1], *shown):
        title = f"Time-space diagram of “{study.plan.along.name}”" + (f" with “{name}”" if number else "")
        made["time_space_intervention" if number else "time_space"] = title, _time_space(study, network, number)
    return charted(made, narrow)


def _lost(study: CongestionStudy) -> Drawing | None:
    """Vehicle-hours lost on the road per hour, in five minutes, mean over the seeds."""
    named = [each for each in all_interventions(study) if each[0] <= DRAWN]
    if not any(row.outcomes for row in study.rows):
        return None

    def draw(axes: Axes) -> None:
        for number, name in named:
            outcomes = [outcome for _, outcome in study.outcomes(study.interventions[number])]
            times = np.arange(0, study.plan.duration_s, EPOCH_S)
            values = [
                fmean(sum(cell.flow.lost_s for cell in each.cells if cell.from_s == at_s) for each in outcomes)
                / EPOCH_S
                for at_s in times
            ]
            axes.plot(
                (times + EPOCH_S / 2) / 60,
                values,
                marker=MARKERS[number],
                color=PALETTE[number],
                markersize=5,
                label="without an intervention" if not number else name,
            )
        for number in range(1, len(study.plan.demand)):
            axes.axvline(number * study.plan.period_s / 60, color=INK, alpha=0.4, linewidth=1, linestyle=":")
        axes.set_ylim(bottom=0)
        axes.set_xlim(0, study.plan.minutes)
        axes.grid(axis="y", color=INK, alpha=0.15, linewidth=0.8)
        axes.set_xlabel("minutes after the warm-up")
        axes.set_ylabel("vehicle-hours lost per hour")
        legend(axes)

    return 3.2 + 0.23 * len(named), draw


def _fundamental(study: CongestionStudy, network: Network) -> Drawing | None:
    """Flow against density of the whole network in five minutes (Geroliminis and Daganzo 2008).

    Both by Edie's definitions (1963): total distance, and total time, by the length of all lanes and the time."""
    lanes_m = sum(edge.length_m * len(edge.lane_ids) for edge in network.edges.values())
    named = [each for each in all_interventions(study) if each[0] <= DRAWN]
    if not any(row.outcomes for row in study.rows):
        return None

    def draw(axes: Axes) -> None:
        densest = most = 0.0
        for number, name in named:
            density: list[float] = []
            flows: list[float] = []
            for _, outcome in study.outcomes(study.interventions[number]):
                epochs: dict[float, FlowSums] = {}
                for cell in outcome.cells:
                    if cell.road_class not in (JUNCTIONS, OTHER):
                        epochs[cell.from_s] = epochs.get(cell.from_s, FlowSums()) + cell.flow
                density += [flow.time_s / EPOCH_S / (lanes_m / 1000) for flow in epochs.values()]
                flows += [flow.distance_m / lanes_m / EPOCH_S * HOUR_S for flow in epochs.values()]
            densest, most = max([densest, *density]), max([most, *flows])
            axes.scatter(
                density,
                flows,
                s=20,
                alpha=0.6,
                linewidths=0,
                marker=MARKERS[number],
                color=PALETTE[number],
                label="without an intervention" if not number else name,
            )
        for speed_kmh in (10, 20, 30, 50, 80):
            end = min(1.08 * densest, 1.08 * most / speed_kmh)
            axes.plot([0, end], [0, speed_kmh * end], color=INK, alpha=0.25, linewidth=0.8)
            if end >= 0.3 * densest or speed_kmh * end >= 0.9 * most:
                axes.annotate(
                    f"{speed_kmh} km/h", (end, speed_kmh * end), fontsize=8, alpha=0.7, ha="right", va="bottom"
                )
        axes.set_xlim(0, 1.1 * densest)
        axes.set_ylim(0, 1.15 * most)
        axes.grid(axis="y", color=INK, alpha=0.15, linewidth=0.8)
        axes.set_xlabel("density, vehicles per km of lane")
        axes.set_ylabel("flow, vehicles per h and lane")
        legend(axes)

    return 4.0 + 0.23 * len(named), draw


def _time_space(study: CongestionStudy, network: Network, number: int) -> Drawing | None:
    """Mean speed along the corridor, minute by minute, over all seeds."""
    trip = study.plan.along
    route = way_through(network, (trip.from_edge, *trip.via, trip.to_edge))
    if not route or not any(row.outcomes for row in study.rows):
        return None
    ends_m = np.cumsum([0.0, *(network.edges[edge].length_m for edge in route)])
    minutes = np.arange(0, study.plan.duration_s + INTERVAL_S, INTERVAL_S)
    speeds = np.full((len(route), len(minutes) - 1), np.nan)
    for place, edge in enumerate(route):
        for column, at_s in enumerate(minutes[:-1]):
            flow = study.edges.get((number, edge, float(at_s)))
            if flow is not None and flow.time_s > 0:
                speeds[place, column] = KMH_PER_MPS * flow.distance_m / flow.time_s
    fastest = max(network.edges[edge].speed_mps for edge in route) * KMH_PER_MPS

    def draw(axes: Axes) -> None:
        mesh = axes.pcolormesh(
            minutes / 60, ends_m / 1000, speeds, cmap="RdYlBu", vmin=0, vmax=fastest, rasterized=True
        )
        bar = axes.figure.colorbar(mesh, ax=axes, pad=0.02)
        bar.set_label("mean speed, km/h")
        bar.outline.set_visible(False)
        for at_m, text in _crossed(route, ends_m, network):
            axes.axhline(at_m / 1000, color=INK, alpha=0.35, linewidth=0.7)
            axes.annotate(text, (0.3, at_m / 1000), fontsize=8, va="bottom", color=INK)
        axes.set_xlabel("minutes after the warm-up (white: nobody drove there)")
        axes.set_ylabel(f"km from {trip.from_edge} to {trip.to_edge}")
        axes.grid(visible=False)

    return 3.6, draw


def _crossed(route: Sequence[str], ends_m: NDArray[np.float64], network: Network) -> list[tuple[float, str]]:
    """Where the corridor changes its street, and the name of the one that begins there."""
    names = [network.edges[edge].name for edge in route]
    found = [(0.0, names[0])]
    found += [
        (float(at_m), after)
        for at_m, (before, after) in zip(ends_m[1:], pairwise(names), strict=False)
        if before != after
    ]
    return [(at_m, name) for at_m, name in found if name]
