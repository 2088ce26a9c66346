"""The cost of the surrogate measures of a step, in this process, at the fastest of many repeats.

    python -m benchmarks.measures [TRIAL ...]

Without a trial: twenty vehicles within 50 m, half of them in the car's lane and half on a road that it crosses.
"""

from __future__ import annotations

import argparse
import timeit
from collections import deque
from pathlib import Path

from automotive_cosim.contracts import SeenVehicle
from automotive_cosim.exchange.recording import read_recording
from automotive_cosim.measures import pair_readings
from automotive_cosim.measures.encounters import RoadScene

STEPS = 20
REPEATS = 300


def crowded() -> list[RoadScene]:
    """The car at 36 km/h among twenty others."""

    def car(name: str, x_m: float, y_m: float, heading_deg: float, speed_mps: float) -> SeenVehicle:
        return SeenVehicle(name, "passenger", 4.5, 1.8, x_m, y_m, heading_deg, speed_mps, 0)

    scenes: list[RoadScene] = []
    for step in range(STEPS):
        others = [
            vehicle
            for number in range(10)
            for vehicle in (
                car(f"lane {number}", (-1) ** number * (6 + 4 * number), 0.2, 91, 7.5 + number / 2 + step / 100),
                car(f"across {number}", 20 + 1.5 * number, -18 - number, 0, 9),
            )
        ]
        scenes.append((float(step), [car("ego", 0, 0, 90, 10 - step / 100), *others]))
    return scenes


def told(name: str, scenes: list[RoadScene], ego: str | None) -> None:
    """Prints a line of the table."""
    found = sum(1 for _ in pair_readings(scenes, ego)) / len(scenes)
    vehicles = sum(len(seen) for _, seen in scenes) / len(scenes)
    repeats = REPEATS if ego else REPEATS // 10
    taken_s = min(timeit.repeat(lambda: deque(pair_readings(scenes, ego), maxlen=0), number=1, repeat=repeats))
    of = "the car" if ego else "everybody"
    print(f"| {name} | {of} | {vehicles:.0f} | {found:.1f} | {1000 * taken_s / len(scenes):.3f} ms |", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("trials", nargs="*", type=Path, help="folders of recorded trials")
    given = parser.parse_args()
    print("| states | pairs of | vehicles | readings a step | a step |")
    print("|---|---|---:|---:|---:|")
    kept = {"twenty close vehicles": crowded()}
    for trial in given.trials:
        seconds = read_recording(trial).road.seconds
        middle = max(0, (len(seconds) - STEPS) // 2)
        kept[trial.name] = [(each.at_s, each.vehicles) for each in seconds[middle : middle + STEPS]]
    for name, scenes in kept.items():
        for ego in ("ego", None):
            told(name, scenes, ego)


if __name__ == "__main__":
    main()
