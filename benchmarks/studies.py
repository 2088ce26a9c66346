"""Whether the figures of `study reroute` are correct, in worlds whose truth is known.

    python benchmarks/studies.py                     # invented gains: a minute of one processor
    python benchmarks/studies.py --driven            # small studies, driven in SUMO

Each world makes 200 small studies of invented gains, with seeds, decisions and draws that differ as measured on
real networks, and passes them to the code that makes the report. It prints how often a 95 % interval contains the
true mean gain of `always`, and what `best` says where the truth is known. A driven study has two routes that
mirror each other, with the same signals and random traffic: the other route gains nothing, or loses exactly what a
longer free road behind it takes. The intervals of its disjoint small studies should contain that.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import fmean, stdev

import numpy as np

from automotive_cosim.run.processes import Processes
from automotive_cosim.studies.batch import run_study
from automotive_cosim.studies.intervals import SeedMean
from automotive_cosim.studies.plan import StudyPlan
from automotive_cosim.studies.results import choices, read_study
from automotive_cosim.studies.rows import (
    NOBODY,
    NOTHING,
    Branch,
    Decision,
    DriveRow,
    News,
    PolicyChoice,
    Replicate,
)
from automotive_cosim.studies.tables import mean_of, time_saved_s
from automotive_cosim.traffic import sumo_programs

SEEDS = 10
POLICIES = ("always", "best")


@dataclass(frozen=True, slots=True)
class World:
    """The spreads of gains, in seconds; each is normal."""

    name: str
    gain_s: float
    """The true mean gain of the other route."""
    between_s: float
    """Standard deviation between decisions, of which half the variance is the seed's."""
    within_s: float
    """Standard deviation of one draw within a decision."""

    def best_s(self, draws: int, rng: np.random.Generator) -> tuple[float, float]:
        """The gain of choosing by the true mean of every decision, and by all its draws but one."""
        true_s = rng.normal(self.gain_s, self.between_s, 1_000_000)
        known_s = true_s + rng.normal(0, self.within_s, len(true_s)) / max(1, draws - 1) ** 0.5
        return float(np.maximum(true_s, 0).mean()), float((true_s * (known_s > 0)).mean())


WORLDS = (
    World("nothing to gain, all luck", 0.0, 0.0, 26.0),
    World("nothing to gain on average", 0.0, 17.0, 5.4),
    World("a known loss of 30 s", -30.0, 17.0, 26.0),
    World("a known gain of 30 s", 30.0, 3.0, 5.4),
)
"""Spreads as measured: 26 s within a decision in Ingolstadt, 17 and 5.4 s between two mirrored ways."""


def invented(world: World, draws: int, rng: np.random.Generator) -> Iterator[DriveRow]:
    """A study: ten seeds of one to six decisions."""
    for seed in range(SEEDS):
        shift_s = rng.normal(world.gain_s, world.between_s * np.sqrt(0.5))
        decisions = []
        for _ in range(rng.integers(1, 7)):
            true_s = rng.normal(shift_s, world.between_s * np.sqrt(0.5))
            first, *more = rng.normal(true_s, world.within_s, draws)
            decisions.append(decision(first, more))
        yield DriveRow(
            id=f"{seed}",
            scenario="",
            share=0.0,
            seed=seed,
            departure_s=0.0,
            trip="",
            stay=NOTHING,
            decisions=tuple(decisions),
        )


def decision(first_s: float, more_s: Sequence[float]) -> Decision:
    return Decision(
        at_s=0.0,
        edge="",
        delay_s=60.0,
        eta_s=300.0,
        relative_speed=0.5,
        news=(News(age_s=0.0, stay_s=300.0, delay_s=60.0, offered_s=240.0, branch=0),),
        own=None,
        agents={},
        agents_rerouted=(),
        branches=(branch(first_s),),
        replicates=tuple(Replicate(seed=0, stay=branch(0.0), branches=(branch(gain_s),)) for gain_s in more_s),
    )


def branch(gain_s: float) -> Branch:
    return Branch(gains=replace(NOTHING, time_s=float(gain_s)), totals=NOTHING, others=NOBODY)


def means(rows: Sequence[DriveRow]) -> tuple[SeedMean, SeedMean]:
    """Of `always` and `best`."""
    found: list[PolicyChoice] = list(choices(rows, POLICIES))
    always, best = (mean_of([each for each in found if each.policy == name], time_saved_s) for name in POLICIES)
    assert always is not None
    assert best is not None
    return always, best


def show_invented(draws: int, count: int) -> None:
    rng = np.random.default_rng(draws)
    for world in WORLDS:
        studies = [means(list(invented(world, draws, rng))) for _ in range(count)]
        t, resampled = (
            fmean(
                interval.low <= world.gain_s <= interval.high
                for always, _ in studies
                if (interval := getattr(always, kind))
            )
            for kind in ("interval", "resampled")
        )
        gains = [best.value for _, best in studies]
        true_s, known_s = world.best_s(draws, rng)
        print(
            f"| {world.name} | {draws} | {t:.1%} | {resampled:.1%} | {true_s:.1f} | {known_s:.1f} "
            f"| {fmean(gains):+.2f} ± {stdev(gains) / len(gains) ** 0.5:.2f} |"
        )


# --- driven ---------------------------------------------------------------------------------------------------

NODES = {"start": (0, 0), "fork": (500, 0), "north": (1000, 300), "south": (1000, -300), "join": (1500, 0)} | {
    "goal": (2000, 0),
    "up": (1000, 700),
    "down": (1000, -700),
    "east": (1400, 700),
    "west": (1400, -700),
}
SIGNALS = ("north", "south")
EDGES = {
    "access": ("start", "fork"),
    "north_in": ("fork", "north"),
    "north_out": ("north", "join"),
    "south_in": ("fork", "south"),
    "south_out": ("south", "join"),
    "exit": ("join", "goal"),
    "up_in": ("up", "north"),
    "up_out": ("north", "east"),
    "down_in": ("down", "south"),
    "down_out": ("south", "west"),
}
LENGTH_M = {"access": 500.0, "exit": 500.0} | {
    f"{way}_{part}": 600.0 for way in ("north", "south", "up", "down") for part in ("in", "out")
}
DEMAND = """<routes>
    <vType id="car" vClass="passenger" sigma="0.7"/>
    {flows}
</routes>"""
FLOW = '<flow id="{name}" type="car" begin="0" end="20000" probability="{rate}" from="{begin}" to="{end}"/>'
FLOWS = {
    "north": ("north_in", "north_out", 0.13),
    "south": ("south_in", "south_out", 0.13),
    "up": ("up_in", "up_out", 0.1),
    "down": ("down_in", "down_out", 0.1),
}
SCENARIO = """name = "mirror"
title = "Two ways that mirror each other"
about = "Neither way is better."
country = "FR"
start = "2026-03-10T08:30:00"
time_zone = "Europe/Paris"
has_place = false

[sumo]
config = "mirror.sumocfg"
step_length_s = 1.0
warm_up_s = 600.0
background_rerouting = 0.0

[ego]
driver = "steady"

[[ego.trips]]
name = "across"
from_edge = "access"
to_edge = "exit"
via = ["north_in"]

[[weather]]
at_s = 0.0
temperature_2m = 12.0
relative_humidity_2m = 60.0
precipitation = 0.0
weather_code = 1
cloud_cover = 10.0
visibility = 30000.0
wind_speed_10m = 5.0
"""


def mirrored(folder: Path, longer_m: float) -> Path:
    """Draws the network; the southern way is that much longer after its signals, where nobody else drives."""
    kinds = {name: "traffic_light" if name in SIGNALS else "priority" for name in NODES}
    nodes = "".join(f'<node id="{name}" x="{x}" y="{y}" type="{kinds[name]}"/>' for name, (x, y) in NODES.items())
    lengths = LENGTH_M | {"south_out": LENGTH_M["south_out"] + longer_m}
    edges = "".join(
        f'<edge id="{name}" from="{begin}" to="{end}" numLanes="1" speed="10" length="{lengths[name]}"/>'
        for name, (begin, end) in EDGES.items()
    )
    (folder / "m.nod.xml").write_text(f"<nodes>{nodes}</nodes>")
    (folder / "m.edg.xml").write_text(f"<edges>{edges}</edges>")
    built, printed = sumo_programs.run(
        "netconvert",
        [
            "-n",
            folder / "m.nod.xml",
            "-e",
            folder / "m.edg.xml",
            "-o",
            folder / "mirror.net.xml",
            "--no-turnarounds",
        ],
    )
    assert built, printed
    flows = [FLOW.format(name=name, begin=a, end=b, rate=rate) for name, (a, b, rate) in FLOWS.items()]
    (folder / "mirror.rou.xml").write_text(DEMAND.format(flows="".join(flows)))
    (folder / "mirror.sumocfg").write_text(
        '<configuration><input><net-file value="mirror.net.xml"/><route-files value="mirror.rou.xml"/></input>'
        "</configuration>"
    )
    (folder / "scenario.toml").write_text(SCENARIO)
    return folder


def show_driven(seeds: int, draws: int, workers: int) -> None:
    for longer_m in (0.0, 300.0):
        with tempfile.TemporaryDirectory() as scratch:
            (folder := Path(scratch) / "net").mkdir()
            plan = StudyPlan(
                str(mirrored(folder, longer_m)),
                departures_s=(0.0, 130.0, 290.0),
                seeds=tuple(range(seeds)),
                least_delay_s=0.0,
                per_drive=1,
                policies=POLICIES,
                replicates=draws,
            )
            run_study(plan, Path(scratch) / "study", executor=Processes(workers))
            rows = read_study(Path(scratch) / "study").rows
        true_s = -longer_m / 10.0
        assert not any(row.error for row in rows), [row.error for row in rows if row.error]
        always, best = means(rows)
        single = [replace(row, decisions=tuple(replace(d, replicates=()) for d in row.decisions)) for row in rows]
        parts = [means([row for row in rows if row.seed % (seeds // SEEDS) == n])[0] for n in range(seeds // SEEDS)]
        held = sum(part.interval.low <= true_s <= part.interval.high for part in parts if part.interval)
        print(
            f"true gain {true_s:+.0f} s: {always.count} decisions, mean {always.value:+.1f} s, "
            f"{always.interval}; {held} of {len(parts)} studies of {SEEDS} seeds contain it; best "
            f"{best.value:+.1f} s, by single draws {means(single)[1].value:+.1f} s"
        )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--driven", action="store_true", help="drive small studies in SUMO instead")
    parser.add_argument("--seeds", type=int, default=60, help="seeds of a driven study")
    parser.add_argument("--studies", type=int, default=200, help="invented studies of each world")
    parser.add_argument("--workers", type=int, default=1)
    options = parser.parse_args()
    if options.driven:
        show_driven(options.seeds, 4, options.workers)
        return
    print(
        "| world | draws | t interval contains mean | resampled | true best, s | by the other draws, s | best, s |"
    )
    print("|---|---:|---:|---:|---:|---:|---:|")
    for draws in (1, 4):
        show_invented(draws, options.studies)


if __name__ == "__main__":
    main()
