"""The live view of a run: a panel that changes in a terminal, plain lines anywhere else."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable
from itertools import groupby

from rich.console import RenderableType
from rich.live import Live as Display
from rich.panel import Panel
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from automotive_cosim.cli.console import Console
from automotive_cosim.cockpit.actions import action_in_words
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import KMH_PER_MPS, ActionType
from automotive_cosim.contracts.plain import clock, counted, megabytes_in_words
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.episode.episode import Episode
from automotive_cosim.geo.breaches import limit_at
from automotive_cosim.geo.text import amount_of_speed
from automotive_cosim.report.frames import why
from automotive_cosim.run.episode import EpisodeResult
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.timeline import is_over, limit_in_words, limit_kmh, road_in_words, speed_in_words
from automotive_cosim.run.trial import Shot, TrialObserver
from automotive_cosim.scenarios import Scenario
from automotive_cosim.scenarios.difference import notes_of
from automotive_cosim.tasking.policy import first_breaches
from automotive_cosim.traffic.options import read_configuration

PLAIN_EVERY_S = 10.0
"""Without a terminal, the drive is reported this often, in simulated seconds."""


WAITING_S = 30.0
"""Without a terminal, this often it is said that an action takes longer: a model may be slow."""


class LongWait:
    """Says every half a minute how long something has been waited for."""

    def __init__(self, tell: Callable[[str], None]) -> None:
        self._tell = tell
        self._has_come = threading.Event()

    def start(self, of: str) -> None:
        self.stop()
        self._has_come = threading.Event()
        threading.Thread(target=self._wait, args=(of, self._has_come), daemon=True).start()

    def stop(self) -> None:
        """It has come, or nobody waits any more."""
        self._has_come.set()

    def _wait(self, of: str, has_come: threading.Event) -> None:
        begun_s = time.monotonic()
        while not has_come.wait(WAITING_S):
            self._tell(f"         waiting for {of}, {clock(time.monotonic() - begun_s)} so far")


class Notes(TrialObserver):
    """Prints only the assumptions about a scenario, and why answers were no actions, to standard error."""

    def __init__(self) -> None:
        self._episode: Episode | None = None

    def loading(self, scenario: Scenario) -> None:
        for note in notes_of(scenario):
            print(f"note: {note}", file=sys.stderr)

    def begun(self, session: Episode, shot: Shot) -> None:
        self._episode = session

    def finished(self, row: EpisodeRow, told: EpisodeResult | None) -> None:
        if lost := _no_action(self._episode):
            print(lost, file=sys.stderr)


class Live(TrialObserver):
    """Shows an episode as it runs and, at the end, the verdict and the timeline."""

    def __init__(self, console: Console | None = None, *, by_hand: bool = False, brief: bool = False) -> None:
        """Starts with nothing shown.

        Args:
            by_hand: a person acts, whose typing no line may interrupt.
            brief: only what was said and done, and the verdict in one line."""
        self._by_hand = by_hand
        self._brief = brief
        self._console = console or Console(highlight=False)
        self._display: Display | None = None
        self._episode: Episode | None = None
        self._title = "starting"
        self._goal = ""
        self._action = ""
        self._is_lost = False
        """Whether the last answer was no action."""
        self._thought = ""
        self._hand_over_s: float | None = None
        self._said_s: float | None = None
        self._begins: Moment | None = None
        """When the next action begins."""
        self._waiting = LongWait(lambda told: self._console.print(told, soft_wrap=True))
        self._held: list[str] = []
        """Lines about the drive since then: the action is known when it ends, and its line comes first."""

    def loading(self, scenario: Scenario) -> None:
        """Shows what is loaded, and the assumptions about it."""
        for note in notes_of(scenario):
            self._console.print(Text(f"note: {note}", style="yellow"), soft_wrap=True)
        size_mb = read_configuration(scenario.config).net.stat().st_size / 1e6
        what = f"loading the network ({megabytes_in_words(size_mb)})"
        if self._console.is_terminal:
            row = Table.grid(padding=(0, 2))
            row.add_row(what, ProgressBar(width=40, pulse=True))
            self._show(Panel(row, title=Text(scenario.title), title_align="left"))
        else:
            self._console.print(f"{scenario.title}: {what}", soft_wrap=True)

    def warming(self, scenario: str, done_s: float, total_s: float) -> None:
        """A bar; without a terminal, a line at the start and at the end."""
        if self._console.is_terminal:
            bar = ProgressBar(total=total_s, completed=done_s, width=40)
            row = Table.grid(padding=(0, 2))
            row.add_row("warming up traffic", bar, f"{done_s:.0f} of {total_s:.0f} s")
            self._show(Panel(row, title=Text(scenario), title_align="left"))
        elif done_s in ((0,) if self._brief else (0, total_s)):
            self._console.print(f"{scenario}: {done_s:.0f} of {total_s:.0f} s of traffic warmed up")

    def moved(self, moment: Moment, cockpit: Cockpit) -> None:
        """Shows the current drive."""
        if self._hand_over_s is None:
            self._title = "drive up to the hand-over"
        if self._console.is_terminal:
            self._show(self._panel(moment))
        elif not self._brief and (self._said_s is None or moment.time_s - self._said_s >= PLAIN_EVERY_S):
            self._said_s = moment.time_s
            self._held.append(f"{self._clock(moment)}  {_drive(moment)}")
            if self._begins is None:
                self._release()

    def begun(self, session: Episode, shot: Shot) -> None:
        """The driver's words."""
        self._episode = session
        self._hand_over_s = shot.step.moment.time_s
        self._begins = shot.step.moment
        self._title = "the agent acts"
        self._goal = session.instance.goal
        if not self._console.is_terminal:
            moment = shot.step.moment
            self._console.print(f"{self._clock(moment)}  hand-over: {_drive(moment)}", soft_wrap=True)
            self._console.print(f"         the driver says: “{self._goal}”", soft_wrap=True)
            self._wait()

    def stepped(self, shot: Shot) -> None:
        """The last action and the agent's reason."""
        step, was_lost = shot.step, self._is_lost
        self._is_lost = step.action is None
        self._waiting.stop()
        self._action = f"{step.number}  {action_in_words(step.action, shot.seen)}"
        self._thought = shot.thought
        self._goal = " ".join([self._goal, *step.said])
        declares = step.action is not None and step.action.action_type is ActionType.STATUS
        if declares:
            self._title = "after the end: the drive continues"
        if self._console.is_terminal:
            self._show(self._panel(step.moment))
        elif was_lost and self._is_lost:
            self._wait()  # the number of such steps is told at the end, with the reason
        else:
            because = f" ({self._thought})" if self._thought else ""
            began = self._begins or step.moment
            self._console.print(f"{self._clock(began)}  step {self._action}{because}", soft_wrap=True)
            for text in step.said:
                self._console.print(f"         the driver says: “{text}”", soft_wrap=True)
            self._release()
            if not declares:
                self._wait()
        self._begins = None if declares else step.moment

    def finished(self, row: EpisodeRow, told: EpisodeResult | None) -> None:
        """The verdict and the timeline."""
        self._waiting.stop()
        if self._display is not None:
            self._display.stop()
        self._release()
        if lost := _no_action(self._episode):
            self._console.print(Text(lost, style="yellow"), soft_wrap=True)
        if told is not None and (row.steps or told.verdict):
            lines = _verdict(row, told)
            if self._brief and told.verdict:
                lines = [Text.assemble(lines[0], (f": {why(row, told)}", "dim"))]
            self._console.print(Text("\n").join(lines), soft_wrap=True)

    def _wait(self) -> None:
        if not self._by_hand:
            self._waiting.start("the agent's action")

    def _release(self) -> None:
        for line in self._held:
            self._console.print(line, soft_wrap=True)
        self._held.clear()

    def _show(self, what: RenderableType) -> None:
        if self._display is None:
            self._display = Display(console=self._console, auto_refresh=False, transient=True)
            self._display.start()
        self._display.update(what, refresh=True)

    def _panel(self, moment: Moment) -> Panel:
        driving = moment.driving
        limit = limit_at(moment.context)
        speed_kmh = driving.speed_mps * KMH_PER_MPS
        unit = moment.context.speed_unit
        rows = Table.grid(padding=(0, 2))
        rows.add_column(style="dim", justify="right")
        rows.add_column()
        rows.add_row("time", f"{moment.local_time:%H:%M:%S}  {self._clock(moment)}")
        rows.add_row("road", road_in_words(driving.road) + (", in a tunnel" if driving.road.in_tunnel else ""))
        style = "bold red" if is_over(speed_kmh, limit_kmh(limit)) else "bold green"
        speed = amount_of_speed(speed_kmh, unit)
        rows.add_row("speed", Text.assemble((speed, style), f"  {limit_in_words(limit, unit)}"))
        rows.add_row("traffic", _traffic(moment))
        if self._goal:
            rows.add_row("driver", Text(f"“{self._goal}”", style="italic"))
        rows.add_row("action", Text(self._action or "none yet"))
        if self._thought:
            rows.add_row("because", Text(self._thought, style="dim"))
        return Panel(rows, title=self._title, title_align="left", width=min(self._console.width, 90))

    def _clock(self, moment: Moment) -> str:
        if self._hand_over_s is None:
            return f"{moment.local_time:%H:%M:%S}"
        return f"{moment.time_s - self._hand_over_s:+7.1f} s"


def _no_action(episode: Episode | None) -> str:
    """In how many steps the agent gave no action, and the first reason, e.g. its own exception; else empty."""
    why = episode.malformed if episode else ()
    return f"the agent gave no action in {counted(len(why), 'step')}, at first: {why[0]}" if why else ""


def _drive(moment: Moment) -> str:
    driving = moment.driving
    speed = speed_in_words(driving.speed_mps, limit_at(moment.context), moment.context.speed_unit)
    return f"{speed}, {road_in_words(driving.road)}; {_traffic(moment)}"


def _traffic(moment: Moment) -> str:
    """Congestion here and ahead: mean speed over the limit."""
    driving = moment.driving
    here = f"{driving.around.relative_speed:.0%} of free flow here, {driving.ahead.relative_speed:.0%} ahead"
    jam_m = driving.ahead.jam_distance_m
    return (
        here
        + ("" if jam_m is None else f", jam in {jam_m:.0f} m")
        + f", {counted(driving.vehicle_count, 'vehicle')}"
    )


def _verdict(row: EpisodeRow, result: EpisodeResult) -> list[Text]:
    if row.success is None:
        lines = [Text(f"no verdict: {row.end}", style="bold yellow")]
    else:
        word, style = ("success", "bold green") if row.success else ("not solved", "bold red")
        lines = [Text.assemble((word, style), f"  reward {row.reward:g}, {counted(row.steps, 'step')}")]
    for name, part in (result.verdict.parts if result.verdict else {}).items():
        mark = ("yes", "green") if part.ok else ("no ", "red")
        lines.append(Text.assemble(f"  {name.replace('_', ' '):<9} ", mark, "  ", (part.why, "dim")))
    for rule, at_s in (first_breaches(result.breaches) if result.verdict else {}).items():
        lines.append(
            Text.assemble(f"  {'policy':<9} ", ("no ", "red"), "  ", (f"{rule}, after {at_s:.0f} s", "dim"))
        )
    lines.append(Text())
    for text, alike in groupby(result.timeline, key=lambda entry: entry.text):
        first, *more = alike
        times = f", {len(more) + 1} times until {more[-1].at_s:+.1f} s" if more else ""
        lines.append(Text.assemble((f"{first.at_s:+8.1f} s", "dim"), f"  {text}{times}"))
    return lines
