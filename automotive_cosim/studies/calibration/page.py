"""``calibration.html``: counted, fitted and simulated flows on one self-contained page, with their map."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

from automotive_cosim.formats.writing import drafted
from automotive_cosim.report.charts import INK, PALETTE, Chart, Drawing, charted, legend
from automotive_cosim.report.files import write_files
from automotive_cosim.report.tables import Table
from automotive_cosim.report.templates import render
from automotive_cosim.run.store import cannot_write
from automotive_cosim.scenarios.opening import network_of, open_scenario
from automotive_cosim.studies.calibration.counts import GOOD_GEH
from automotive_cosim.studies.calibration.result import Calibration, Met, read_calibration
from automotive_cosim.traffic.network import Network

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.transforms import Bbox

UNFITTED, CALIBRATED, HELD_OUT = PALETTE[7], PALETTE[0], PALETTE[1]

PAGE = "calibration.html"

MANY_HOURS = 3
"""With more hours, a table of every site and hour is too long to read in a terminal."""

FEW_SITES = 20
"""With fewer sites, many demands match the counts, and the true one cannot be identified."""


def write_page(folder: Path) -> Path:
    """Writes ``calibration.html``, ``tables/`` and ``plots/`` into a scenario's folder; returns the page.

    Raises:
        ScenarioError: the folder has no ``calibration.json``.
        UserError: it cannot be written.
        SetupError: matplotlib is not installed."""
    found = read_calibration(folder)
    several = [by_hour(found)] if len(found.hours) > 1 else []
    tables = [*several, table(found), rounds(found), *([times(found)] if found.times else [])]
    plots = charts(found, network_of(open_scenario(folder)))
    text = render(
        "studies/calibration/calibration.html",
        found=found,
        sentence=sentence(found),
        met=found.met(held_out=False),
        findings=list(findings(found)),
        tables=tables,
        plots=plots,
    )
    page = folder / PAGE
    try:
        with drafted(page) as file:
            write_files(folder, tables, plots.values())
            file.write(text.encode())
    except OSError as error:
        raise cannot_write(folder, error) from error
    return page


def sentence(found: Calibration) -> str:
    """What the calibration came to, in a sentence."""
    told = []
    for name, held_out in (("calibrated", False), ("held out", True)):
        before, after = (found.met(held_out=held_out, unfitted=unfitted) for unfitted in (True, False))
        if after.count:
            told.append(f"{after.good} of {after.count} {name} hourly counts (before: {before.good})")
    return f"The calibrated demand of {found.source} meets {' and '.join(told)}, within a GEH of {GOOD_GEH:g}."


def findings(found: Calibration) -> Iterator[str]:
    """The results in sentences, including the bad ones."""
    sites = {row.site for row in found.rows if not row.held_out}
    yield f"calibrated: {found.met(held_out=False)}"
    yield f"calibrated, before the fit: {found.met(held_out=False, unfitted=True)}"
    if any(row.held_out for row in found.rows):
        yield f"held out: {found.met(held_out=True)}"
        yield f"held out, before the fit: {found.met(held_out=True, unfitted=True)}"
        if found.is_worse_elsewhere:
            was, now = (found.met(held_out=True, unfitted=unfitted) for unfitted in (True, False))
            yield (
                "warning: the fit made traffic worse where nothing was calibrated: held-out counts within the "
                f"limit (GEH below {GOOD_GEH:g}): {was.good} before, {now.good} after, of {now.count}"
            )
    else:
        yield "held out: none, so nothing is known about uncounted roads"
    carried = found.carried
    yield (
        f"{carried.vehicles} vehicles on {carried.routes} routes ({found.given.vehicles} on {found.given.routes}"
        f" before); {carried.teleports} teleports, {carried.backlog} vehicles waiting to enter at the end,"
        f" {carried.halted_share:.0%} halted in the last half hour"
    )
    yield f"round {found.kept + 1} of {len(found.tries)} kept, seed {found.seed}"
    yield f"calibrated, with seed {found.seed + 1}: {found.again}"
    if found.times:
        near = sum(row.is_met for row in found.times)
        yield f"travel times: {near} of {len(found.times)} within 15 % or a minute"
    if len(sites) < FEW_SITES:
        yield f"{len(sites)} sites do not determine the demand: many other demands match these counts as well"
    for site, why in found.unmapped.items():
        yield f"left out: {site}: {why}"
    for doubt in found.doubts:
        yield f"warning: {doubt}"


def table(found: Calibration) -> Table:
    """One row for each site and hour."""
    rows = tuple(
        (
            row.site,
            row.edge,
            "held out" if row.held_out else "",
            f"{row.hour} h",
            f"{row.counted:.0f}",
            f"{row.unfitted:.0f}",
            "–" if row.fitted is None else f"{row.fitted:.0f}",
            f"{row.simulated:.0f}",
            f"{row.geh_unfitted:.1f}",
            f"{row.geh:.1f}",
        )
        for row in found.rows
    )
    columns = ("site", "edge", "", "hour", "counted", "unfitted", "fitted", "simulated", "GEH unfitted", "GEH")
    note = (
        "Vehicles per hour that leave the counted edge. Unfitted: simulated with the scenario's own demand."
        " Fitted: computed by the fit, not simulated. GEH: of the simulated flows."
    )
    return Table("sites", "Site by site", columns, rows, note, heads=4)


def by_hour(found: Calibration) -> Table:
    """One row for each hour and kind of site."""
    rows = []
    for hour in found.hours:
        for held_out in (False, True):
            here = [row for row in found.rows if (row.hour, row.held_out) == (hour, held_out)]
            if here:
                met = Met.of([(row.simulated, row.counted) for row in here])
                sums = (sum(getattr(row, name) for row in here) for name in ("counted", "unfitted", "simulated"))
                rows.append(
                    (
                        f"{hour} h",
                        "held out" if held_out else "",
                        *(f"{each:.0f}" for each in sums),
                        f"{met.good} of {met.count}",
                        f"{met.mean_geh:.1f}",
                    )
                )
    columns = ("hour", "", "counted", "unfitted", "simulated", f"GEH < {GOOD_GEH:g}", "mean GEH")
    note = "Sums over the sites that were counted in the hour. Unfitted: the scenario's own demand."
    return Table("hours", "Hour by hour", columns, tuple(rows), note, heads=2)


def rounds(found: Calibration) -> Table:
    """One row for each round of fit and simulation."""
    rows = tuple(
        {
            "round": f"{number}{' (kept)' if number == found.kept + 1 else ''}",
            f"GEH < {GOOD_GEH:g}": f"{each.calibrated.good} of {each.calibrated.count}",
            "mean GEH": f"{each.calibrated.mean_geh:.1f}",
            "total": f"{each.calibrated.total:.1%}",
            "vehicles": str(each.carried.vehicles),
            "routes": str(each.carried.routes),
            "teleports": str(each.carried.teleports),
            "waiting": str(each.carried.backlog),
            "standing": f"{each.carried.halted_share:.0%}",
        }
        for number, each in enumerate(found.tries, start=1)
    )
    return Table.of("rounds", "Rounds of fit and simulation, calibrated sites", rows)


def times(found: Calibration) -> Table:
    """One row for each measured travel time."""
    rows = tuple(
        (
            f"{row.from_edge} to {row.to_edge}",
            f"{row.hour} h",
            f"{row.measured_s:.0f}",
            *("–" if value is None else f"{value:.0f}" for value in (row.unfitted_s, row.simulated_s)),
            "yes" if row.is_met else "no",
        )
        for row in found.times
    )
    columns = ("route", "hour", "measured, s", "unfitted, s", "simulated, s", "met")
    note = "Met: within 15 % or a minute. The fit does not use travel times."
    return Table("times", "Travel times", columns, rows, note, heads=2)


def charts(found: Calibration, network: Network) -> dict[str, Chart]:
    """Plots by name. Raises SetupError: matplotlib is not installed."""
    return charted(
        {
            "flows": ("Counted and simulated", _flows(found)),
            "day": ("The calibrated sites over the day", _day(found) if len(found.hours) > MANY_HOURS else None),
            "map": ("Where the sites are", _map(found, network)),
        }
    )


def _flows(found: Calibration) -> Drawing:
    def draw(axes: Axes) -> None:
        most = max((max(row.counted, row.simulated) for row in found.rows), default=1.0)
        axes.plot([0, most], [0, most], color=INK, alpha=0.4, linewidth=1)
        unfitted = [(row.counted, row.unfitted) for row in found.rows]
        axes.plot(*zip(*unfitted, strict=True), "x", color=UNFITTED, label="before the fit", markersize=5)
        for held_out, colour, label in ((False, CALIBRATED, "calibrated"), (True, HELD_OUT, "held out")):
            points = [(row.counted, row.simulated) for row in found.rows if row.held_out == held_out]
            if points:
                axes.plot(*zip(*points, strict=True), "o", color=colour, label=label, markersize=5)
        axes.grid(color=INK, alpha=0.15, linewidth=0.8)
        axes.set_axisbelow(True)
        axes.set_xlabel("counted, vehicles per hour")
        axes.set_ylabel("simulated, vehicles per hour")
        legend(axes)

    return 4.2, draw


def _day(found: Calibration) -> Drawing:
    def draw(axes: Axes) -> None:
        lines = (("counted", INK, "-"), ("unfitted", UNFITTED, ":"), ("simulated", CALIBRATED, "o"))
        for name, colour, style in lines:
            sums = [
                sum(getattr(row, name) for row in found.rows if (row.hour, row.held_out) == (hour, False))
                for hour in found.hours
            ]
            axes.plot(found.hours, sums, style, color=colour, label=name, markersize=5)
        axes.set_ylim(bottom=0)
        axes.grid(color=INK, alpha=0.15, linewidth=0.8)
        axes.set_xlabel("local hour")
        axes.set_ylabel("vehicles per hour, all sites")
        legend(axes)

    return 3.4, draw


ASIDE_PT = (4, 10, 18, 28, 40)
"""Distances from its place at which a label may stand."""
SIDES = ((1, 0), (-1, 0), (0, 1), (0, -1), (1, 1), (-1, 1), (1, -1), (-1, -1))
"""Right, left, above, below, and the corners."""


def label_places(axes: Axes, marked: Sequence[tuple[str, tuple[float, float], str]]) -> None:
    """Names places, each label as near as it overlaps no earlier one; one that has to stand far has a line."""
    from matplotlib.figure import Figure
    from matplotlib.text import Text

    figure = axes.get_figure()
    assert isinstance(figure, Figure)
    figure.draw_without_rendering()  # settles the scale
    taken: list[Bbox] = []
    for text, place, colour in sorted(marked):
        for aside_pt, (x, y) in product(ASIDE_PT, SIDES):
            label = axes.annotate(
                text,
                place,
                (x * aside_pt, y * aside_pt),
                textcoords="offset points",
                fontsize=6,
                color=colour,
                ha=("right", "center", "left")[x + 1],
                va=("top", "center", "bottom")[y + 1],
                arrowprops={"arrowstyle": "-", "color": colour, "linewidth": 0.4}
                if aside_pt > ASIDE_PT[1]
                else None,
            )
            label.get_window_extent()  # brings it to its place
            box = Text.get_window_extent(label)  # without the line
            if aside_pt == ASIDE_PT[-1] or not any(box.overlaps(other) for other in taken):
                taken.append(box)
                break
            label.remove()


def _map(found: Calibration, network: Network) -> Drawing:
    def draw(axes: Axes) -> None:
        from matplotlib.collections import LineCollection

        lines = [*(edge.shape_m for edge in network.edges.values()), *network.joints_m]
        axes.add_collection(LineCollection(lines, colors=INK, alpha=0.25, linewidths=0.6))
        labels = {row.edge: row.site for row in found.rows}
        marked: list[tuple[str, tuple[float, float], str]] = []
        for held_out, colour, label in ((False, CALIBRATED, "calibrated"), (True, HELD_OUT, "held out")):
            edges = [
                network.edges[edge]
                for edge in sorted({row.edge for row in found.rows if row.held_out == held_out})
                if edge in network.edges
            ]
            if edges:
                shapes = [edge.shape_m for edge in edges]
                axes.add_collection(LineCollection(shapes, colors=colour, linewidths=2.4, label=label))
            marked += [(labels[edge.edge_id], edge.shape_m[len(edge.shape_m) // 2], colour) for edge in edges]
        axes.autoscale()
        axes.set_aspect("equal")
        axes.set_axis_off()
        legend(axes)
        label_places(axes, marked)

    return 6.0, draw
