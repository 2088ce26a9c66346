"""Calibrates shipped scenarios to counts of a twin world, whose demand is known to have a different mix of routes.

    python benchmarks/calibration.py --scenario paris_centre --seeds 3

The twin has the scenario's network, with each flow multiplied by a factor drawn from a lognormal distribution
(spread ``--spread``) and by ``--level``. Sites are drawn among the roads that it uses. The
scenario's own demand then has to be calibrated to the twin's counts; 30 % of the sites are held out.
"""

from __future__ import annotations

import argparse
import csv
import tempfile
import time
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np

from automotive_cosim import scenarios
from automotive_cosim.calibration.calibrate import calibrate
from automotive_cosim.calibration.driving import CountedTime, drive
from automotive_cosim.calibration.result import Met
from automotive_cosim.calibration.settings import CalibrationOptions
from automotive_cosim.scenarios import Scenario
from automotive_cosim.traffic.options import Setup, copied, read_configuration, run_options

LEAST_PER_H = 50
"""Sites are placed where the twin has at least this much traffic."""

RATES = ("probability", "vehsPerHour", "number")


def write_twin(scenario: Scenario, target: Path, spread: float, level: float, rng: np.random.Generator) -> None:
    """Writes the scenario's flows with other rates."""
    configuration = read_configuration(scenario.config)
    (routes,) = configuration.files["route-files"]
    root = ET.parse(routes).getroot()
    for flow in root.iter("flow"):
        factor = level * float(np.exp(rng.normal(0.0, spread)))
        for rate in RATES:
            if rate in flow.attrib:
                flow.set(rate, f"{float(flow.attrib[rate]) * factor:g}")
        period = flow.get("period", "")
        if period.startswith("exp("):
            flow.set("period", f"exp({float(period[4:-1]) * factor:g})")
        elif period:
            flow.set("period", f"{float(period) / factor:g}")
    ET.ElementTree(root).write(target)


def write_counts(scenario: Scenario, twin: Path, target: Path, share: float, rng: np.random.Generator) -> int:
    """Drives the twin and writes an hour of its counts; returns the number of sites."""
    configuration = read_configuration(scenario.config)
    clock = CountedTime(configuration.begin_s, scenario.sumo.warm_up_s, 1)
    scratch = target.parent
    copies = copied(configuration, scratch)
    options = run_options(copies, Setup(scenario, seed=99))
    options |= {"route-files": twin.name, "step-length": "1", "default.action-step-length": "1"}
    driven = drive(scenario.name, options, clock, scratch)
    used = sorted(edge for (edge, _), flow in driven.flows.items() if flow >= LEAST_PER_H)
    sites = rng.choice(used, round(share * len(used)), replace=False).tolist()
    with target.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(["site", "hour", "vehicles_per_hour", "edge"])
        writer.writerows([edge, scenario.start.hour, driven.flows[edge, 0], edge] for edge in sorted(sites))
    return len(sites)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scenario", default="paris_centre")
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--spread", type=float, default=0.6)
    parser.add_argument("--level", type=float, default=1.0)
    parser.add_argument("--share", type=float, default=0.25)
    parser.add_argument("--rounds", type=int, default=10)
    given = parser.parse_args()
    scenario = scenarios.load(given.scenario)
    print("seed  sites  set         unfitted                          calibrated")
    for seed in range(given.first_seed, given.first_seed + given.seeds):
        rng = np.random.default_rng(seed)
        with tempfile.TemporaryDirectory() as folder:
            twin, counts = Path(folder) / "twin.rou.xml", Path(folder) / "counts.csv"
            write_twin(scenario, twin, given.spread, given.level, rng)
            sites = write_counts(scenario, twin, counts, given.share, rng)
            begun_s = time.monotonic()
            options = CalibrationOptions(rounds=given.rounds, seed=seed)
            found = calibrate(scenario, counts, Path(folder) / "out", options, lambda _said, _share: None)
        for held_out, name in ((False, "calibrated"), (True, "held out")):
            before, after = found.met(held_out=held_out, unfitted=True), found.met(held_out=held_out)
            print(f"{seed:4}  {sites:5}  {name:10}  {_shown(before)}  {_shown(after)}")
        carried = found.carried
        print(
            f"      {carried.vehicles} vehicles, {carried.routes} routes, {carried.teleports} teleports"
            f" ({found.given.teleports} before), round {found.kept + 1} of {len(found.tries)},"
            f" {time.monotonic() - begun_s:.0f} s; other seed: {found.again.good} of {found.again.count}"
        )


def _shown(met: Met) -> str:
    return f"{met.good:3} of {met.count:3}, GEH {met.mean_geh:4.1f}, total {met.total:4.2f}"


if __name__ == "__main__":
    main()
