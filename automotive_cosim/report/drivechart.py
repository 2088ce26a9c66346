"""The timeline of one drive: events as bars, acts as marks, and below the speed, with and without the agent."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from automotive_cosim.contracts import Json
from automotive_cosim.drives.judge import EventOutcome, JudgedEvent, Worth
from automotive_cosim.report.charts import INK, NARROW_IN, PALETTE, WIDE_IN, Drawing, drawn
from automotive_cosim.run.drive_row import DriveTrialRow

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BLUE, RED, GREEN, PURPLE, ORANGE, SKY, _, GREY = PALETTE
COLOURS = {
    EventOutcome.HIT: GREEN,
    EventOutcome.PREPARED: GREEN,
    EventOutcome.PREVENTED: SKY,
    EventOutcome.LATE: ORANGE,
    EventOutcome.MISSED: RED,
    EventOutcome.CAUSED: PURPLE,
    EventOutcome.VOID: GREY,
    EventOutcome.AVOIDED: GREY,
    EventOutcome.TAKEN: RED,
}
"""Colour of a bar by the outcome of the event."""
MARKS = {
    "right": ("o", GREEN),
    "late": ("o", ORANGE),
    "neutral": ("o", GREY),
    "repeat": ("s", ORANGE),
    "false": ("X", RED),
}
"""Marker of an act by how it was judged; acts on bait and wrong acts count as false."""
LEAST_S = 6.0
"""Shortest bar that can be seen."""
ROW_IN, SPEED_IN = 0.24, 1.7


def timeline_chart(row: DriveTrialRow, timeline: Json) -> tuple[str, str]:
    """The timeline as SVG, for a wide page and a narrow one.

    Args:
        row: the drive.
        timeline: its file, see ``run.watch``.

    Raises:
        SetupError: matplotlib is not installed.
    """
    drawing = _drawing(row, timeline)
    return drawn(f"{row.id}", drawing, WIDE_IN), drawn(f"{row.id}", drawing, NARROW_IN)


def _drawing(row: DriveTrialRow, timeline: Json) -> Drawing:
    kinds = _kinds(row.events)
    height_in = 0.9 + ROW_IN * (len(kinds) + 1) + SPEED_IN

    def draw(axes: Axes) -> None:
        share = SPEED_IN / (height_in - 0.6)
        speeds = axes.inset_axes((0.0, 0.0, 1.0, share))
        _speeds(speeds, timeline)
        for side in ("top", "right", "left"):
            speeds.spines[side].set_visible(False)
        speeds.tick_params(length=0)
        speeds.grid(axis="both", color=INK, alpha=0.15, linewidth=0.8)
        rows = len(kinds) + 1
        hidden = rows * share / (1 - share)
        axes.set_ylim(rows + hidden - 0.3, -0.7)
        axes.set_yticks(range(rows), ["acts", *(kind.replace("_", " ") for kind in kinds)])
        _events(axes, row.events, kinds)
        _acts(axes, row)
        end_s = timeline["time_s"][-1]
        for each in (axes, speeds):
            each.set_xlim(0, end_s)
            ticks = range(0, int(end_s) + 1, 300 if end_s > 900 else 120)
            each.set_xticks(list(ticks), [f"{tick // 60}" for tick in ticks])
        axes.tick_params(labelbottom=False)
        axes.spines["bottom"].set_visible(False)
        speeds.set_xlabel("minutes since departure")

    return height_in, draw


def _kinds(events: Sequence[JudgedEvent]) -> list[str]:
    """Kinds with an event that required an act, or with a look-alike that was acted on, in order of time."""
    shown = [event for event in events if event.outcome.counts or event.outcome is EventOutcome.TAKEN]
    return list(dict.fromkeys(event.kind for event in shown))


def _events(axes: Axes, events: Sequence[JudgedEvent], kinds: Sequence[str]) -> None:
    for event in events:
        if event.kind not in kinds:
            continue
        place = kinds.index(event.kind) + 1
        colour = COLOURS[event.outcome]
        length_s = max(LEAST_S, event.ends_s - event.observable_s)
        axes.barh(
            place,
            length_s,
            left=event.observable_s,
            height=0.62,
            color="none" if event.bait else colour,
            edgecolor=colour,
            hatch="////" if event.bait else None,
            alpha=0.45 if event.outcome in (EventOutcome.VOID, EventOutcome.AVOIDED) else 0.75,
            linewidth=0.8,
        )
        if event.outcome.counts:
            for time_s, mark in ((event.obliged_s, "|"), (event.deadline_s, ">")):
                if time_s is not None:
                    axes.plot(time_s, place, mark, color=INK, markersize=7 if mark == "|" else 4, clip_on=False)
            if event.acted_s is not None:
                axes.plot(event.acted_s, place, "o", color=INK, markersize=3.5)


def _acts(axes: Axes, row: DriveTrialRow) -> None:
    for act in row.acts:
        name = "false" if act.worth.is_false else act.worth.value
        mark, colour = MARKS[name]
        size = 4 if act.worth is Worth.NEUTRAL else 6
        axes.plot(act.time_s, 0, mark, color=colour, markersize=size, clip_on=False)


def _speeds(axes: Axes, timeline: Json) -> None:
    times_s, speeds = timeline["time_s"], timeline["speed_kmh"]
    nobodys = timeline["baseline_kmh"][: len(times_s)]
    limits = [float("nan") if limit is None else limit for limit in timeline["limit_kmh"]]
    axes.plot(times_s, limits, color=RED, linewidth=1.0, drawstyle="steps-post", alpha=0.8)
    axes.plot(times_s[: len(nobodys)], nobodys, color=GREY, linewidth=1.0, linestyle=(0, (3, 2)))
    axes.plot(times_s, speeds, color=BLUE, linewidth=1.3)
    known = [limit for limit in timeline["limit_kmh"] if limit is not None]
    axes.set_ylim(0, 1.08 * max([1.0, *speeds, *nobodys, *known]))
    axes.set_ylabel("km/h")
