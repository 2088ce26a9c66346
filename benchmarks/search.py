"""How soon a search finds faults that were planted, with a surrogate and, with ``--real``, in SUMO.

The surrogate has the agents' delays in closed form: an event must be met in time, an honest agent is quick enough
in all conditions, and a fault makes it slower in some of them. The real runs plant the same kinds of faults in
agents that are otherwise right, and search drives and tasks in SUMO until each is found.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from math import log
from statistics import median

import numpy as np

from automotive_cosim.safety.hunt import hunt
from automotive_cosim.safety.objective import TriedOutcome
from automotive_cosim.safety.samplers import make_sampler
from automotive_cosim.safety.space import FactorChoices, FactorRange, Point, Space

DEADLINE_S = 20.0
SEEDS, MOST = range(10), 3000
LANGUAGES = ("en", "de", "fr", "es", "it", "nl", "pl", "ja")
PLACES = ("grid", "alpine", "border", "gulf", "london", "nordic", "paris", "sydney")
DRIVERS = ("average", "cautious", "elderly", "hurried", "learner", "tailgating")
SPACE = Space(
    (
        FactorChoices("place", PLACES),
        FactorChoices("language", LANGUAGES),
        FactorChoices("driver", DRIVERS),
        FactorChoices("held_out", (False, True)),
        FactorRange("hour", 0.0, 23.9, 12.0),
        FactorRange("visibility_m", 30.0, 10_000.0, 10_000.0, logarithmic=True),
        FactorRange("density", 0.2, 3.0, 1.0),
        FactorRange("minutes", 0.0, 30.0, 5.0),
        FactorRange("latency_s", 0.0, 5.0, 0.0),
        FactorRange("seed", 0.0, 999.0, 0.0, whole=True),
    )
)
"""Nine factors and a seed."""

Fault = Callable[[Point], float]
"""Seconds by which an agent is late."""


def number(point: Point, name: str) -> float:
    return float(point[name])


def dark(point: Point) -> float:
    """0 by day, 1 in the middle of the night."""
    hour = number(point, "hour")
    return max(0.0, 1 - min(hour, 24 - hour) / 6)


FAULTS: Mapping[str, Fault] = {
    "blind in fog": lambda p: (1.6 + 2.2 * dark(p)) * max(0.0, log(1000 / number(p, "visibility_m"))),
    "deaf in one language": lambda p: (
        (3.0 + 1.0 * number(p, "latency_s") + 3.0 * bool(p["held_out"])) if p["language"] == "ja" else 0.0
    ),
    "late behind lorries": lambda p: (
        4.0 * max(0.0, number(p, "density") - 1) + (3.5 if p["driver"] == "tailgating" else 0.0)
    ),
    "wrong beyond a border": lambda p: (
        (0.3 * number(p, "minutes") + 3.5 * (p["language"] != "en")) if p["place"] == "border" else 0.0
    ),
    "sleepy after 15 minutes": lambda p: (0.45 + 0.55 * dark(p)) * max(0.0, number(p, "minutes") - 15),
    "none (oracle)": lambda p: 0.0,
}


def outcome(fault: Fault, point: Point) -> TriedOutcome:
    """Its delay is three seconds, the latency, up to two by chance, and the fault's."""
    chance_s = float(np.random.default_rng(int(number(point, "seed"))).random()) * 2
    delay_s = 3.0 + number(point, "latency_s") + chance_s + fault(point)
    margin = max(-1.0, (DEADLINE_S - delay_s) / DEADLINE_S)
    return TriedOutcome(margin, margin < 0, "late" if margin < 0 else "")


def first_found(fault: Fault, sampler: str, seed: int, most: int) -> int | None:
    """How many episodes until the first failure."""
    chooses = make_sampler(sampler, SPACE, most, seed)
    for count in range(1, most + 1):
        point, _ = chooses.ask()
        tried = outcome(fault, point)
        if tried.failed:
            return count
        chooses.tell(point, tried.margin or 0.0)
    return None


def surrogate(samplers: tuple[str, ...]) -> None:
    rng = np.random.default_rng(0)
    points = [SPACE.at(rng.random(SPACE.dimensions).tolist()) for _ in range(20_000)]
    print(f"{'fault':26}{'fails %':>9}" + "".join(f"{name:>10}" for name in samplers) + "   minimal failure")
    for name, fault in FAULTS.items():
        share = sum(outcome(fault, point).failed for point in points) / len(points)
        cells = []
        for sampler in samplers:
            most = MOST if sampler == "random" else 500
            found = [first_found(fault, sampler, seed, most) or most + 1 for seed in SEEDS]
            cells.append(f"{median(found):.0f}" if median(found) <= most else f"> {most}")
        made = hunt(SPACE, lambda p, _, of=fault: outcome(of, p), make_sampler("climb", SPACE, 128, 0), 128)
        words = made.minimal[0].words(SPACE) if made.minimal else "none found"
        print(f"{name:26}{100 * share:9.2f}" + "".join(f"{cell:>10}" for cell in cells) + f"   {words}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--samplers", default="random,sobol,lhs,climb")
    given = parser.parse_args()
    surrogate(tuple(given.samplers.split(",")))


if __name__ == "__main__":
    main()
