"""How far a run of somebody else's scenario is from SUMO's own, where something of it cannot be kept.

Both drive the first ten minutes without an ego, and are compared in the last five of them.
"""

from __future__ import annotations

import sys
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from statistics import fmean
from typing import TYPE_CHECKING

from automotive_cosim.contracts import KMH_PER_MPS
from automotive_cosim.errors import CosimError
from automotive_cosim.formats.scenario import Scenario
from automotive_cosim.scenarios.foreign import DIFFERS
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.options import (
    INTERNAL,
    Setup,
    command_line,
    copied,
    read_configuration,
    run_options,
    stated_and_set,
)
from automotive_cosim.traffic.stability import SUMMARY, summary

if TYPE_CHECKING:
    from automotive_cosim.traffic.running import Running

HALF_S = 300.0
"""Time for the traffic to build up, and time in which it is compared."""

Means = tuple[float, float]
"""Means of the vehicles on the road, and of their speed in m/s."""


def notes_of(scenario: Scenario) -> Iterator[str]:
    """The notes about a scenario, each difference from SUMO with its size on this network."""
    for note in scenario.notes:
        yield note
        if DIFFERS in note:
            print("measuring how much they differ ...", file=sys.stderr, flush=True)
            try:
                yield _size(scenario)
            except CosimError as error:
                yield f"the difference could not be measured: {error}"


def driven(running: Running) -> Means:
    """Lets the traffic run, and tells of it; called in its process."""
    steps = round(HALF_S / running.world.step_s)
    return _means(_now(running) for _ in range(steps))


def _now(running: Running) -> Means:
    running.step()
    sumo = running.sumo
    speeds = [sumo.speed(vehicle) for vehicle in sumo.vehicle_ids() if sumo.lane_of(vehicle)]
    return float(len(speeds)), fmean(speeds) if speeds else 0.0


def _size(scenario: Scenario) -> str:
    short = replace(scenario, sumo=replace(scenario.sumo, warm_up_s=HALF_S))
    with closing(Forked(short, allow_unprojected=True)) as warm:
        ours = warm.call(driven)
    sumos = _sumos(short)
    each = zip(ours, sumos, strict=True)
    changes = (f"{round(one / other - 1, 3) + 0.0:+.1%}" if other else "–" for one, other in each)
    figures = (f"{count:.1f} vehicles at {mps * KMH_PER_MPS:.1f} km/h" for count, mps in (ours, sumos))
    return f"{' instead of '.join(figures)} in minutes 5 to 10 of seed 0 ({' and '.join(changes)})"


def _sumos(scenario: Scenario) -> Means:
    """Of SUMO's run by all that the configuration states."""
    given = read_configuration(scenario.config)
    with tempfile.TemporaryDirectory(prefix="automotive-cosim-difference-") as scratch:
        copies = copied(given, Path(scratch))
        options = run_options(copies, Setup(scenario)) | SUMMARY
        options |= {name: f"{stated:g}" for name, (stated, _) in stated_and_set(given, scenario.sumo).items()}
        options |= {INTERNAL: "true"} if INTERNAL in given.ignored else {}
        from_s = given.begin_s + HALF_S
        rows = []
        with (
            copies.named_as_given(),
            closing(summary(given.path.name, command_line(options)[1:], Path(scratch))) as steps,
        ):
            for step in steps:
                if step["time"] >= from_s + HALF_S:
                    break
                if step["time"] >= from_s:
                    rows.append((step["running"], step["meanSpeed"]))
    return _means(rows)


def _means(rows: Iterable[Means]) -> Means:
    counts, speeds = zip(*rows, strict=True)
    return fmean(counts), fmean(speeds)
