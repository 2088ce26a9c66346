"""Checks whether a scenario's traffic flows for an hour or locks up.

The demand of a network is guessed more often than counted, and SUMO locks up for good once a ring of junctions is
blocked. So a scenario is run without the ego, by the plain ``sumo`` program, and its report of every second is
checked against one criterion: after the warm-up, under a quarter of the vehicles are halted in every minute, SUMO
teleports none (who stands for 300 s, or as long as its own experiments state), none collides, and hardly any is
unable to enter the network.
"""

from __future__ import annotations

import re
import signal
import subprocess
import tempfile
import threading
import time
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from pathlib import Path

from automotive_cosim.errors import ScenarioError, TrafficError
from automotive_cosim.formats.scenario import Scenario
from automotive_cosim.traffic.confinement import confined
from automotive_cosim.traffic.options import Copied, Setup, command_line, copied, read_configuration, run_options
from automotive_cosim.traffic.processor_time import processor_s
from automotive_cosim.traffic.sumo_programs import environment, first_error, program

HALTED_SHARE_LIMIT = 0.25
"""Maximum share of halted vehicles (under 0.1 m/s, as in SUMO) among those running, mean of any minute."""

FEW_VEHICLES = 40
"""With fewer vehicles, the share is taken of this many: one red light halts a third of ten cars, which is not a
jam. A real one among few vehicles shows in the teleports."""

LONGEST_WAIT_S = 300.0
"""A vehicle that stands longer without a reason is teleported, SUMO's own default. SUMO's own experiments have what
they state."""

BACKLOG_SHARE_LIMIT = 0.05
"""Maximum share of vehicles still waiting to enter at the end, among all that should have."""

SUMMARY_S = 1
SUMMARY = {"summary-output": "stdout", "summary-output.period": str(SUMMARY_S)}
"""Options by which ``summary`` is told of each second."""

TELEPORT = "time-to-teleport"

TELEPORTS_SHOWN = 3
"""A run that is to be stopped early still shows so many vehicles that stand for good."""

SILENCE_LIMIT_S = 120.0
"""Processor time without a second of traffic after which SUMO counts as hung; a second takes it milliseconds. If a
system does not report processor time, wall time is used."""

LOADING_LIMIT_S = 600.0
"""The same before the first second: reading a country's network takes minutes."""

STANDSTILL_LIMIT_S = 1800.0
"""Wall time without any use of the processor after which it counts as hung: by then, a running program gets some
processor time, however busy the machine, and one that waits forever does not."""

LOOK_EVERY_S = 1.0
"""Wall time between two checks of the program's processor time."""

WINDOW_S = 60.0
"""Averaging time of the halted share, about one signal cycle."""

StabilityProgress = Callable[[float], None]
"""Called with the share of the simulation that is done, 0 to 1."""

StepFigures = dict[str, float]
"""One ``step`` of SUMO's summary output."""


@dataclass(frozen=True, slots=True)
class Stuck:
    """A vehicle that SUMO teleported."""

    vehicle: str
    lane: str
    reason: str
    """SUMO's: ``"wrong lane"``, ``"yield"``, ``"jam"``, ..."""


@dataclass(frozen=True, slots=True)
class Stability:
    """Figures of the traffic after its warm-up."""

    scale: float
    """Factor on the demand."""
    seed: int
    step_length_s: float
    observed_s: float
    """Simulated time covered by the figures; shorter than requested if the run was stopped."""
    halted_share_max: float
    """Highest mean of a minute, taken of at least ``FEW_VEHICLES``, as is the next."""
    halted_share_mean: float
    vehicles_mean: float
    vehicles_max: int
    arrived: int
    teleports: int
    collisions: int
    backlog: int
    """Vehicles waiting to enter the network at the end."""
    backlog_share: float
    """Its share of all departures by then."""
    stuck: tuple[Stuck, ...] = ()
    """The vehicles that were teleported, by SUMO's own account."""
    longest_wait_s: float = LONGEST_WAIT_S
    """How long a vehicle may stand before it is."""

    @property
    def problems(self) -> tuple[str, ...]:
        """Violations of the criterion, in words; empty if there are none."""
        found: list[str] = []
        if self.halted_share_max >= HALTED_SHARE_LIMIT:
            found.append(f"{self.halted_share_max:.0%} of the vehicles halted in the worst minute")
        if self.teleports:
            found.append(
                f"{self.teleports} vehicles stood for over {self.longest_wait_s:g} s or were stuck otherwise"
            )
        if self.collisions:
            found.append(f"{self.collisions} collisions")
        if self.backlog_share > BACKLOG_SHARE_LIMIT:
            found.append(f"{self.backlog} vehicles could not enter the network")
        if not self.vehicles_max:
            found.append("there was no traffic")
        return tuple(found)

    @property
    def stable(self) -> bool:
        """Whether the criterion is met."""
        return not self.problems


def measure(
    scenario: Scenario,
    *,
    observe_s: float = 3600.0,
    scale: float | None = None,
    seed: int = 0,
    step_length_s: float = 1.0,
    stop_at: float = 1.0,
    on_progress: StabilityProgress | None = None,
) -> Stability:
    """Runs the scenario's traffic, without the ego, through its warm-up and ``observe_s`` more.

    SUMO is started as for every drive, so nothing is written to the scenario's folder.

    Args:
        observe_s: seconds after the warm-up.
        scale: factor on the demand; None takes the scenario's own.
        seed: SUMO's seed.
        step_length_s: 1 s shows most jams at a fifth of the cost of 0.1 s.
        stop_at: end the run once a minute's halted share reaches this, or more than ``TELEPORTS_SHOWN`` vehicles
            were teleported after the warm-up; 1 runs to the end whatever happens.
        on_progress: called once per simulated minute.

    Raises:
        ScenarioError: SUMO refuses the scenario; the message is SUMO's.
        TrafficError: SUMO hung, was killed, or was stopped before its time.
        SetupError: eclipse-sumo is not installed."""
    sumo = replace(
        scenario.sumo, step_length_s=step_length_s, scale=scenario.sumo.scale if scale is None else scale
    )
    configuration = read_configuration(scenario.config)
    begin_s = configuration.begin_s
    warm_s = begin_s + sumo.warm_up_s
    end_s = warm_s + observe_s
    wait_s = configuration.number(TELEPORT, LONGEST_WAIT_S) if scenario.as_stated else LONGEST_WAIT_S
    tally = _Tally(warm_s, minute_start_s=begin_s, longest_wait_s=wait_s)
    with tempfile.TemporaryDirectory(prefix="automotive-cosim-stability-") as scratch:
        setup = Setup(replace(scenario, sumo=sumo), seed=seed)
        copies = copied(configuration, Path(scratch))
        options = _options(copies, setup, end_s)
        warnings: list[str] = []
        with (
            copies.named_as_given(),
            closing(summary(scenario.config.name, options, Path(scratch), warnings)) as steps,
        ):
            for step in steps:
                minute_is_over = tally.add(step)
                if minute_is_over and on_progress:
                    on_progress(min(1.0, (step["time"] - begin_s) / (end_s - begin_s)))
                if (minute_is_over and tally.broken_beyond(stop_at)) or (
                    scenario.as_stated and step["time"] >= end_s
                ):
                    break
            else:
                last_s = tally.last.get("time", begin_s)
                if not scenario.as_stated and last_s < end_s - 2 * max(step_length_s, SUMMARY_S):
                    told = f"SUMO ended {scenario.config.name} at {last_s:g} s of {end_s:g}"
                    raise TrafficError(f"{told}: it was stopped from outside; start again")
    return replace(tally.result(setup), stuck=tuple(_stuck(warnings)))


_TELEPORTED = re.compile(r"Teleporting vehicle '([^']*)'; waited too long \(([^)]*)\), lane='([^']*)'")


def _stuck(warnings: Sequence[str]) -> Iterator[Stuck]:
    for warning in warnings:
        found = _TELEPORTED.search(warning)
        if found:
            yield Stuck(found[1], found[3], found[2])


def _options(copies: Copied, setup: Setup, end_s: float) -> list[str]:
    ours = {"end": f"{end_s:g}", TELEPORT: f"{LONGEST_WAIT_S:g}"}
    options = run_options(copies, setup) | {
        **({} if setup.scenario.as_stated else ours),  # its flows may be spaced out up to its own end
        **SUMMARY,
        "no-warnings": "false",
        "emergencydecel.warning-threshold": "10",
    }
    return command_line(options)[1:]


_ATTRIBUTE = re.compile(r'(\w+)="(-?[\d.]+)"')


def summary(
    config: str, options: Sequence[str], scratch: Path, warnings: list[str] | None = None
) -> Generator[StepFigures, None, None]:
    """Runs SUMO and yields its summary as it comes. Closing the iterator ends SUMO.

    Args:
        config: the scenario's configuration, for error texts.
        options: SUMO's, with ``SUMMARY`` among them.
        scratch: the folder it runs in.
        warnings: receives what SUMO warned of, once it has ended.

    Raises:
        ScenarioError: SUMO refuses the scenario; the message is SUMO's.
        TrafficError: SUMO hung or was killed.
        SetupError: eclipse-sumo is not installed."""
    with (
        tempfile.TemporaryFile("w+", encoding="utf-8", errors="replace") as complaints,
        subprocess.Popen(
            confined(scratch, [str(program("sumo")), *options]),
            cwd=scratch,
            env=environment(),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=complaints,
            encoding="utf-8",
            errors="replace",
        ) as process,
    ):
        watchdog = _Watchdog(process)
        try:
            for line in process.stdout or ():
                if line.lstrip().startswith("<step "):
                    watchdog.alive()
                    yield {key: float(value) for key, value in _ATTRIBUTE.findall(line)}
            if process.wait():
                complaints.seek(0)
                watchdog.judge(config)
                raise ScenarioError(f"SUMO cannot run {config}: {first_error(complaints.read())}")
        finally:
            watchdog.stop()
            process.kill()
            if warnings is not None:
                process.wait()
                complaints.seek(0)
                warnings += (line for line in complaints if line.startswith("Warning:"))


class _Watchdog:
    """Kills a process that gives no sign of life in time."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self._process = process
        self._is_told = processor_s(process.pid) is not None
        """Whether processor time is available."""
        self._signs = 0
        """Number of signs of life so far."""
        self._is_over = threading.Event()
        self._has_bitten = False
        self._thread = threading.Thread(target=self._watch, daemon=True)
        self._thread.start()

    def alive(self) -> None:
        """A sign of life. While it is processed, SUMO may have to wait, which takes no processor time."""
        self._signs += 1

    def judge(self, config: str) -> None:
        """Why the process ended, if it was not its own doing. Raises TrafficError: it was killed."""
        if self._has_bitten:
            raise TrafficError(f"SUMO hung in {config} and was stopped; try again, or use a smaller network")
        if self._process.returncode < 0:
            name = signal.Signals(-self._process.returncode).name
            raise TrafficError(f"SUMO was killed by {name} while running {config}; is there enough memory?")

    def stop(self) -> None:
        self._is_over.set()
        self._thread.join()

    def _watch(self) -> None:
        signs, limit_s = 0, LOADING_LIMIT_S
        used_s = at_sign_s = self._used_s()
        moved_at_s = time.monotonic()
        while not self._is_over.wait(LOOK_EVERY_S):
            now_s, before_s, used_s = time.monotonic(), used_s, self._used_s()
            if used_s is None or at_sign_s is None:  # it has ended by itself
                return
            if used_s != before_s:
                moved_at_s = now_s
            if self._signs != signs:
                signs, limit_s, at_sign_s, moved_at_s = self._signs, SILENCE_LIMIT_S, used_s, now_s
            if used_s - at_sign_s >= limit_s or now_s - moved_at_s >= STANDSTILL_LIMIT_S:
                self._has_bitten = True
                self._process.kill()
                return

    def _used_s(self) -> float | None:
        """Processor time that it has used, or the wall clock if unavailable; None once it has ended."""
        return processor_s(self._process.pid) if self._is_told else time.monotonic()


@dataclass(slots=True)
class _Tally:
    """Sums SUMO's summary from the end of the warm-up."""

    warm_s: float
    """Simulation time at which the warm-up ends."""
    before: StepFigures = field(default_factory=dict)
    """The last step of the warm-up: SUMO's counts run from the start."""
    last: StepFigures = field(default_factory=dict)
    minute_start_s: float = 0.0
    longest_wait_s: float = LONGEST_WAIT_S
    running: list[float] = field(default_factory=list)
    """Vehicle-steps of each minute, the last one unfinished; the same for ``halting``."""
    halting: list[float] = field(default_factory=list)
    samples: list[int] = field(default_factory=list)
    """Steps in each minute."""
    steps: int = 0
    vehicles_max: int = 0

    def add(self, step: StepFigures) -> bool:
        """Adds one step; true at the end of every minute, including the warm-up."""
        minute_is_over = step["time"] - self.minute_start_s >= WINDOW_S
        if minute_is_over:
            self.minute_start_s = step["time"]
        self.last = step
        if step["time"] <= self.warm_s:
            self.before = step
        else:
            if minute_is_over or not self.running:
                self.running.append(0.0)
                self.halting.append(0.0)
                self.samples.append(0)
            self.samples[-1] += 1
            self.running[-1] += step["running"]
            self.halting[-1] += step["halting"]
            self.steps += 1
            self.vehicles_max = max(self.vehicles_max, int(step["running"]))
        return minute_is_over

    def broken_beyond(self, halted_share: float) -> bool:
        return halted_share < 1 and (
            self._halted_share_max() >= halted_share or self._since("teleports") > TELEPORTS_SHOWN
        )

    def result(self, setup: Setup) -> Stability:
        backlog = int(self.last.get("waiting", 0))
        return Stability(
            scale=setup.scenario.sumo.scale,
            seed=setup.seed,
            step_length_s=setup.scenario.sumo.step_length_s,
            observed_s=max(0.0, self.last.get("time", 0.0) - self.warm_s),
            halted_share_max=self._halted_share_max(),
            halted_share_mean=sum(self.halting) / max(1.0, sum(self.running), FEW_VEHICLES * self.steps),
            vehicles_mean=sum(self.running) / max(1, self.steps),
            vehicles_max=self.vehicles_max,
            arrived=self._since("arrived"),
            teleports=self._since("teleports"),
            longest_wait_s=self.longest_wait_s,
            collisions=self._since("collisions"),
            backlog=backlog,
            backlog_share=backlog / max(1.0, backlog + self.last.get("inserted", 0.0)),
        )

    def _halted_share_max(self) -> float:
        minutes = zip(self.halting, self.running, self.samples, strict=True)
        return max((halted / max(total, FEW_VEHICLES * count) for halted, total, count in minutes), default=0.0)

    def _since(self, count: str) -> int:
        return int(self.last.get(count, 0.0) - self.before.get(count, 0.0))
