"""``day.html``: a day's counted and simulated traffic on one self-contained page, and its table and plots."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from automotive_cosim.osm.counts import GOOD_GEH
from automotive_cosim.osm.day import NO_CALIBRATION, Day, read_day
from automotive_cosim.report.charts import INK, NARROW_IN, PALETTE, WIDE_IN, Drawing, drawn, legend
from automotive_cosim.report.tables import Table
from automotive_cosim.report.templates import render
from automotive_cosim.run.record import write_whole
from automotive_cosim.run.store import cannot_write

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MORNING, EVENING = 8, 18
"""Local hours to compare: the busy ones of most roads."""

COUNTED, SIMULATED = PALETTE[0], PALETTE[1]


def write_day(folder: Path) -> Path:
    """Writes ``day.html``, ``tables/`` and ``plots/`` into a scenario's folder; returns the page.

    Raises:
        ScenarioError: the folder has no ``day.json``.
        UserError: it cannot be written.
        SetupError: matplotlib is not installed.
    """
    day = read_day(folder)
    made, plots = table(day), charts(day)
    text = render(
        "report/day.html", day=day, table=made, plots=plots, findings=findings(day), no_calibration=NO_CALIBRATION
    )
    page = folder / "day.html"
    try:
        for name in ("tables", "plots"):
            (folder / name).mkdir(exist_ok=True)
        for suffix, content in (("md", made.markdown()), ("csv", made.csv()), ("tex", made.latex())):
            write_whole(folder / "tables" / f"{made.name}.{suffix}", content)
        for name, (_, wide, _) in plots.items():
            write_whole(folder / "plots" / f"{name}.svg", wide.replace("currentColor", INK))
        write_whole(page, text)
    except OSError as error:
        raise cannot_write(folder, error) from error
    return page


def require_plots() -> None:
    """Checks for matplotlib before anything long begins.

    Raises:
        SetupError: it is not installed.
    """
    drawn("nothing", (1.0, lambda _: None), NARROW_IN)


def findings(day: Day) -> tuple[str, ...]:
    """The findings of the day in sentences, including what it does not show."""
    worst = max(day.hours, key=lambda each: each.geh)
    early, late = day.hours[MORNING], day.hours[EVENING]
    simulated = _compared(early.simulated_occupancy, late.simulated_occupancy)
    counted = ""
    if early.counted_occupancy is not None and late.counted_occupancy is not None:
        counted = f"; the counted occupancy is {_compared(early.counted_occupancy, late.counted_occupancy)}"
    busiest = max(day.hours, key=lambda each: each.halted_share)
    return (
        f"GEH is below {GOOD_GEH:g} in {day.hours_met} of {len(day.hours)} local hours and {worst.geh:.1f} in the"
        f" worst ({worst.hour} h).",
        f"At {EVENING} h the simulated occupancy is {simulated}{counted}.",
        f"At most {busiest.halted_share:.0%} of the vehicles were halted ({busiest.hour} h, mean of the hour);"
        f" SUMO teleported {sum(each.teleports for each in day.hours)} in total.",
        *((f"{day.minutes:g} minutes of each hour were simulated.",) if day.minutes < 60 else ()),
    )


def _compared(early: float, late: float) -> str:
    word = "above" if late > early else "not above"
    return f"{word} that at {MORNING} h ({late:.1%} and {early:.1%})"


def table(day: Day) -> Table:
    """The table, one row per local hour."""
    rows = tuple(
        (
            f"{each.hour} h",
            f"{each.counted_per_h:.0f}",
            f"{each.simulated_per_h:.0f}",
            f"{each.geh:.1f}",
            "–" if each.counted_occupancy is None else f"{each.counted_occupancy:.1%}",
            f"{each.simulated_occupancy:.1%}",
            str(each.passing),
            str(each.background),
            f"{each.running:.0f}",
            f"{each.halted_share:.0%}",
            str(each.teleports),
        )
        for each in day.hours
    )
    columns = (
        "Local hour",
        "Counted, veh/h",
        "Simulated, veh/h",
        "GEH",
        "Occupancy counted",
        "Occupancy simulated",
        "Trips sent past",
        "Other trips",
        "Vehicles in the network",
        "Standing",
        "Teleports",
    )
    note = (
        "Simulated flow: distance driven on the counted edges, over their length. Simulated occupancy: share of"
        " the lanes that vehicles cover; a detector's share of time is a little higher."
    )
    return Table("hours", "Hour by hour", columns, rows, note)


def charts(day: Day) -> dict[str, tuple[str, str, str]]:
    """Plots by name: title, SVG for a wide page, SVG for a narrow one.

    Raises:
        SetupError: matplotlib is not installed.
    """
    made = {
        "flow": ("Flow", _flow(day)),
        "occupancy": ("Occupancy", _occupancy(day)),
        "geh": ("GEH of each hour", _geh(day)),
    }
    return {
        name: (title, drawn(name, drawing, WIDE_IN), drawn(name, drawing, NARROW_IN))
        for name, (title, drawing) in made.items()
    }


def _flow(day: Day) -> Drawing:
    def draw(axes: Axes) -> None:
        hours = [each.hour for each in day.hours]
        axes.plot(hours, [each.counted_per_h for each in day.hours], "o-", color=COUNTED, label="counted")
        axes.plot(hours, [each.simulated_per_h for each in day.hours], "s--", color=SIMULATED, label="simulated")
        _by_hour(axes, "vehicles per hour")

    return 3.6, draw


def _occupancy(day: Day) -> Drawing:
    def draw(axes: Axes) -> None:
        shares = [(each.hour, each.counted_occupancy) for each in day.hours]
        counted = [(hour, 100 * share) for hour, share in shares if share is not None]
        if counted:
            axes.plot(*zip(*counted, strict=True), "o-", color=COUNTED, label="counted")
        simulated = [100 * each.simulated_occupancy for each in day.hours]
        axes.plot([each.hour for each in day.hours], simulated, "s--", color=SIMULATED, label="simulated")
        _by_hour(axes, "per cent")

    return 3.6, draw


def _geh(day: Day) -> Drawing:
    def draw(axes: Axes) -> None:
        axes.bar(
            [each.hour for each in day.hours],
            [each.geh for each in day.hours],
            width=0.7,
            color=SIMULATED,
            label="simulated against counted flow of each hour",
        )
        axes.axhline(GOOD_GEH, color=INK, alpha=0.6, linewidth=1, linestyle="--", label=f"{GOOD_GEH:g}: met below")
        _by_hour(axes, "GEH")

    return 3.0, draw


def _by_hour(axes: Axes, unit: str) -> None:
    axes.grid(axis="x", visible=False)
    axes.grid(axis="y", color=INK, alpha=0.15, linewidth=0.8)
    axes.set_axisbelow(True)
    axes.set_xticks(range(0, 24, 2))
    axes.set_xlim(-0.6, 23.6)
    axes.set_ylim(bottom=0)
    axes.set_xlabel("local hour")
    axes.set_ylabel(unit)
    legend(axes)
