"""The timeline of one drive, for somebody who asks what happened when.

From above: events as bars, acts as numbered marks, what woke; speed with and without the agent, and advice in
force; time to collision and time gap; visibility and grip; lamps; and what each act said and what came of it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from textwrap import wrap
from typing import TYPE_CHECKING

from automotive_cosim.contracts import Json
from automotive_cosim.contracts.plain import clock
from automotive_cosim.drives.faults import WHY_VOID, beside, faults
from automotive_cosim.drives.followed import followed
from automotive_cosim.drives.judge import EventOutcome, JudgedAct, JudgedEvent, Worth
from automotive_cosim.report.charts import INK, NARROW_IN, PALETTE, WIDE_IN, Chart, Drawing
from automotive_cosim.run.rows import DriveTrialRow

if TYPE_CHECKING:
    from matplotlib.axes import Axes

BLUE, VERMILION, GREEN, PURPLE, AMBER, SKY, _, GREY = PALETTE
RED = "#b5121b"
"""What was missed, or wrong: darker than the others, and no orange, which is what is late."""
COLOURS = {
    EventOutcome.HIT: GREEN,
    EventOutcome.PREPARED: GREEN,
    EventOutcome.PREVENTED: SKY,
    EventOutcome.LATE: AMBER,
    EventOutcome.MISSED: RED,
    EventOutcome.CAUSED: PURPLE,
    EventOutcome.EVADED: PURPLE,
    EventOutcome.VOID: GREY,
    EventOutcome.AVOIDED: GREY,
    EventOutcome.TAKEN: RED,
}
"""Colour of a bar by the outcome of the event."""
MARKS = {
    Worth.RIGHT: ("o", GREEN),
    Worth.LATE: ("o", AMBER),
    Worth.NEUTRAL: ("o", GREY),
    Worth.REPEAT: ("s", AMBER),
    Worth.FALSE: ("X", RED),
    Worth.WRONG: ("P", RED),
    Worth.LOOKALIKE: ("D", RED),
}
"""Marker of an act by how it was judged."""
LEAST_S = 6.0
"""Shortest bar that can be seen."""
ROW_IN, SPEED_IN, PANEL_IN, LAMPS_IN, LINE_IN, GAP_IN = 0.24, 1.5, 0.9, 0.55, 0.132, 0.28
AXIS_IN = 0.5
"""For the minutes below the panels."""
NUMBER_IN = 0.14
"""Numbers of acts that are nearer to each other take turns above and below the marks."""
LAMPS = ("dipped", "high", "front_fog", "rear_fog", "hazard")
MOST_ACTS = 40
"""Acts of which the chart says what came; all of them are in the results."""
NEAR_S = 3.0
"""Time to collision below which a driver is exposed; marked by a line."""


def timeline_chart(row: DriveTrialRow, timeline: Json, title: str = "") -> Chart:
    """The timeline.

    Args:
        timeline: its file, see ``drives.timeline``.

    Raises SetupError: matplotlib is not installed."""
    return Chart.of(row.id, title, *(_drawing(row, timeline, width_in) for width_in in (WIDE_IN, NARROW_IN)))


def _drawing(row: DriveTrialRow, timeline: Json, width_in: float) -> Drawing:
    kinds = _kinds(row.events, row.acts)
    came = followed(row.acts, timeline)
    told = [
        _told(number, act, row.events, each.words)
        for number, (act, each) in enumerate(zip(row.acts[:MOST_ACTS], came, strict=False), 1)
    ]
    room = round((width_in - LABELS_IN) * CHARACTERS_AN_INCH)
    lost = [fault.line for fault in faults(row.events, row.acts) if fault.kind][:MOST_ACTS]
    lines = [
        part
        for line in (*KEY, "", *told, *(["", *lost] if lost else ()))
        for part in wrap(line, room, subsequent_indent="    ") or [""]
    ]
    panels: list[tuple[float, Callable[[Axes], None]]] = [
        (SPEED_IN, lambda axes: _speeds(axes, timeline)),
        (PANEL_IN, lambda axes: _gaps(axes, timeline)),
        *([(LAMPS_IN, lambda axes: _awareness(axes, timeline))] if "awareness" in timeline else []),
        (PANEL_IN, lambda axes: _sky(axes, timeline)),
        (LAMPS_IN, lambda axes: _lamps(axes, timeline)),
    ]
    rows_in = ROW_IN * (len(kinds) + 3)
    below_in = sum(height + GAP_IN for height, _ in panels) + AXIS_IN + LINE_IN * len(lines)
    height_in = rows_in + below_in

    def draw(axes: Axes) -> None:
        end_s = timeline["time_s"][-1]
        ticks = range(0, int(end_s) + 1, 300 if end_s > 900 else 120)
        rows = len(kinds) + 2
        axes.set_ylim(rows - 0.3 + below_in / ROW_IN, -0.7)
        axes.set_yticks(range(rows), ["acts", "wakes", *(kind.replace("_", " ") for kind in kinds)])
        _events(axes, row, kinds, end_s)
        _acts(axes, row, end_s * NUMBER_IN / width_in)
        _say_unwatched(axes, timeline, rows)
        for time_s, _ in timeline.get("wakes", ()):
            axes.plot(time_s, 1, "|", color=GREY, markersize=6, alpha=0.6)
        top = below_in / height_in
        for panel_in, fill in panels:
            top -= GAP_IN / height_in
            panel = axes.inset_axes((0.0, top - panel_in / height_in, 1.0, panel_in / height_in))
            fill(panel)
            panel.spines[["top", "right", "left"]].set_visible(False)
            is_last = fill is panels[-1][1]
            panel.tick_params(length=0, labelbottom=is_last)
            panel.set_xlabel("minutes since departure" if is_last else "")
            panel.grid(axis="both", color=INK, alpha=0.15, linewidth=0.8)
            panel.set_xlim(0, end_s)
            panel.set_xticks(list(ticks), [f"{tick // 60}" for tick in ticks])
            _unwatched(panel, timeline)
            top -= panel_in / height_in
        axes.set_xlim(0, end_s)
        axes.set_xticks(list(ticks), [])
        axes.spines["bottom"].set_visible(False)
        words = axes.text(
            0.0,
            max(0.0, top - AXIS_IN / height_in),
            "\n".join(lines),
            transform=axes.transAxes,
            va="top",
            fontsize=7.5,
            linespacing=1.25,
        )
        words.set_in_layout(False)

    return height_in, draw


def _unwatched(axes: Axes, timeline: Json) -> None:
    """Shades the time in which nobody watched."""
    from_s = timeline.get("watched_until_s")
    if from_s is not None:
        axes.axvspan(from_s, timeline["time_s"][-1], color=GREY, alpha=0.2, linewidth=0)


def _say_unwatched(axes: Axes, timeline: Json, rows: int) -> None:
    """The same for the rows of acts, wakes and events, in words too; these end left of the end if they have to."""
    from_s, end_s = timeline.get("watched_until_s"), timeline["time_s"][-1]
    if from_s is None:
        return
    axes.fill_betweenx((-0.7, rows - 0.4), from_s, end_s, color=GREY, alpha=0.2, linewidth=0)
    words = f"nobody watches from {clock(from_s)} on"
    left = from_s > 0.6 * end_s
    axes.annotate(
        words,
        (from_s, 0),
        (-8 if left else 8, 0),
        textcoords="offset points",
        ha="right" if left else "left",
        va="center",
        fontsize=7.5,
        annotation_clip=False,
    )


def _told(number: int, act: JudgedAct, events: Sequence[JudgedEvent], came: str) -> str:
    """What an act said, what it was, and what became of it."""
    what = f"{act.worth}" + (f": {act.about.replace('_', ' ')}" if act.about else "")
    reasons = "; ".join(filter(None, (act.reason, *beside(act, events))))
    what += f" ({reasons})" if reasons else ""
    if act.worth is Worth.RIGHT and _came_to_nothing(act, events):
        what += ", which was never due: no point"
    return f"{number}. {clock(act.time_s)} {act.words}: {what}" + (f"; {came}" if came else "")


def _came_to_nothing(act: JudgedAct, events: Sequence[JudgedEvent]) -> bool:
    """Whether what an act told of required nothing in the end."""
    settled = [event for event in events if event.acted_s == act.time_s and not event.lookalike]
    return bool(settled) and not any(event.outcome.counts for event in settled)


KEY = (
    "Bars: green met, light blue prevented, amber late, red missed (or a look-alike taken), purple caused or "
    "evaded, grey nothing was due, hatched look-alike; | when due, > deadline, dot the act.",
    f"Nothing was due: {WHY_VOID}.",
    "Acts: green dot right, amber dot late, grey dot neither, X false alarm, + false alarm while something else "
    "was due, diamond look-alike, amber square repeat.",
)
LABELS_IN, CHARACTERS_AN_INCH = 1.3, 19.0
"""The room left of the plot, and the characters of the list of acts, so that its lines end within the plot."""


def _kinds(events: Sequence[JudgedEvent], acts: Sequence[JudgedAct]) -> list[str]:
    """Kinds with an event that required an act or was acted on, or with a look-alike that was, in order of time."""
    told = {act.about for act in acts if act.worth is Worth.RIGHT}
    shown = [
        event
        for event in events
        if event.outcome.counts or event.outcome is EventOutcome.TAKEN or (event.kind in told and event.acted_s)
    ]
    return list(dict.fromkeys(event.kind for event in shown))


NAMED = frozenset(
    {EventOutcome.LATE, EventOutcome.MISSED, EventOutcome.CAUSED, EventOutcome.EVADED, EventOutcome.TAKEN}
)
"""Outcomes that stand beside their bars, in words."""
ROOM = 0.08
"""What such a word takes of the drive's length; left out where another bar of its kind is in the way."""


def _events(axes: Axes, row: DriveTrialRow, kinds: Sequence[str], end_s: float) -> None:
    for event in row.events:
        if event.kind not in kinds:
            continue
        place = kinds.index(event.kind) + 2
        colour = COLOURS[event.outcome]
        length_s = max(LEAST_S, event.ends_s - event.observable_s)
        axes.barh(
            place,
            length_s,
            left=event.observable_s,
            height=0.62,
            color="none" if event.lookalike else colour,
            edgecolor=colour,
            hatch="////" if event.lookalike else None,
            alpha=0.45 if event.outcome in (EventOutcome.VOID, EventOutcome.AVOIDED) else 0.75,
            linewidth=0.8,
        )
        if event.outcome.counts:
            for time_s, mark in ((event.obliged_s, "|"), (event.deadline_s, ">")):
                if time_s is not None:
                    axes.plot(time_s, place, mark, color=INK, markersize=7 if mark == "|" else 4, clip_on=False)
            if event.acted_s is not None:
                axes.plot(event.acted_s, place, "o", color=INK, markersize=3.5)
        right = event.observable_s + length_s < 0.85 * end_s
        if event.outcome in NAMED and _is_free(event, right, row.events, end_s):
            at_s = event.observable_s + (length_s if right else 0.0)
            axes.annotate(
                str(event.outcome),
                (at_s, place),
                (5 if right else -5, 0),
                textcoords="offset points",
                fontsize=7.5,
                ha="left" if right else "right",
                va="center",
                annotation_clip=False,
            )


def _is_free(event: JudgedEvent, right: bool, events: Sequence[JudgedEvent], end_s: float) -> bool:
    """Whether no other bar of its kind stands where the word beside a bar would."""
    length_s = max(LEAST_S, event.ends_s - event.observable_s)
    from_s = event.observable_s + length_s if right else event.observable_s - ROOM * end_s
    return not any(
        other.observable_s < from_s + ROOM * end_s and from_s < max(other.ends_s, other.observable_s + LEAST_S)
        for other in events
        if other is not event and other.kind == event.kind
    )


def _acts(axes: Axes, row: DriveTrialRow, near_s: float) -> None:
    """Marks with numbers; of two numbers less than ``near_s`` apart, one is below the marks."""
    before_s, is_below = -near_s, False
    for number, act in enumerate(row.acts, 1):
        mark, colour = MARKS[act.worth]
        size = 4 if act.worth is Worth.NEUTRAL else 6
        axes.plot(act.time_s, 0, mark, color=colour, markersize=size, clip_on=False)
        if number <= MOST_ACTS:
            is_below = act.time_s - before_s < near_s and not is_below
            before_s = act.time_s
            at = act.time_s, 0.85 if is_below else -0.45
            axes.annotate(f"{number}", at, ha="center", fontsize=6.5, annotation_clip=False)


def _gaps(axes: Axes, timeline: Json) -> None:
    """Time to collision, and time gap, up to ten seconds."""
    for key, colour, words in (("gap_s", SKY, "time gap"), ("ttc_s", VERMILION, "time to collision")):
        values = [float("nan") if value is None or value > 10 else value for value in timeline[key]]
        axes.plot(timeline["time_s"], values, color=colour, linewidth=1.0, label=words)
    axes.axhline(NEAR_S, color=INK, linewidth=0.6, linestyle=(0, (1, 2)))
    axes.set_ylim(0, 10)
    axes.set_yticks([0, 3, 10])
    axes.set_ylabel("s")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=2, frameon=False, fontsize=7.5, borderpad=0)


def _awareness(axes: Axes, timeline: Json) -> None:
    """How much of the driver's attention is on the road."""
    axes.fill_between(timeline["time_s"], timeline["awareness"], 1.0, step="pre", color=VERMILION, alpha=0.5)
    axes.set_ylim(0, 1)
    axes.set_yticks([0, 1])
    axes.set_ylabel("aware")


def _sky(axes: Axes, timeline: Json) -> None:
    """Visibility on a logarithmic scale, and grip on a scale of its own."""
    axes.plot(timeline["time_s"], timeline["visibility_m"], color=BLUE, linewidth=1.0, label="visibility")
    axes.set_yscale("log")
    axes.set_ylim(10, 40_000)
    axes.set_yticks([10, 100, 1000, 10_000], ["10 m", "100 m", "1 km", "10 km"])
    axes.minorticks_off()
    grip = axes.twinx()
    axes.plot([], [], color=AMBER, linewidth=1.0, label="grip, from 0 at the bottom to 1 at the top")
    grip.plot(timeline["time_s"], timeline["grip"], color=AMBER, linewidth=1.0)
    grip.set_ylim(0, 1.05)
    grip.axis("off")
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=2, frameon=False, fontsize=7.5, borderpad=0)


def _lamps(axes: Axes, timeline: Json) -> None:
    """A line for each lamp while it is on."""
    for place, lamp in enumerate(LAMPS):
        lit = [place if lamp in on else float("nan") for on in timeline["lamps"]]
        axes.plot(timeline["time_s"], lit, color=AMBER, linewidth=2.5, solid_capstyle="butt")
    axes.set_ylim(len(LAMPS) - 0.4, -0.6)
    axes.set_yticks(range(len(LAMPS)), [lamp.replace("_", " ") for lamp in LAMPS], fontsize=7)


def _speeds(axes: Axes, timeline: Json) -> None:
    times_s, speeds = timeline["time_s"], timeline["speed_kmh"]
    baseline = timeline["baseline_kmh"][: len(times_s)]
    limits = [float("nan") if limit is None else limit for limit in timeline["limit_kmh"]]
    axes.plot(times_s, limits, color=VERMILION, linewidth=1.0, drawstyle="steps-post", alpha=0.8, label="limit")
    alone_s = times_s[: len(baseline)]
    axes.plot(alone_s, baseline, color=GREY, linewidth=1.0, linestyle=(0, (3, 2)), label="without the agent")
    axes.plot(times_s, speeds, color=BLUE, linewidth=1.3, label="speed")
    for number, (from_s, to_s) in enumerate(timeline.get("advice", ())):
        words = "" if number else "advice in force"
        axes.axvspan(from_s, to_s, color=GREEN, alpha=0.15, linewidth=0, label=words)
    axes.legend(loc="lower right", bbox_to_anchor=(1.0, 0.98), ncols=4, frameon=False, fontsize=7.5, borderpad=0)
    known = [limit for limit in timeline["limit_kmh"] if limit is not None]
    axes.set_ylim(0, 1.08 * max([1.0, *speeds, *baseline, *known]))
    axes.set_ylabel("km/h")
