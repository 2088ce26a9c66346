"""Compares the sensitivity of `search` with SALib's estimators from given data, on functions with known indices.

    pip install SALib
    python -m benchmarks.sensitivity

The error is the root mean square over factors and seeds of first-order Sobol indices, from Sobol sequences as
`search` draws them. Without SALib, there is the column `here` alone.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import warnings
from collections.abc import Callable, Sequence
from importlib.util import find_spec
from math import pi

import numpy as np
from numpy.typing import NDArray
from scipy.stats import qmc

from automotive_cosim.safety.findings import sensitivity
from automotive_cosim.safety.hunt import Hunt, Phase, Tried
from automotive_cosim.safety.objective import TriedOutcome
from automotive_cosim.safety.space import FactorChoices, FactorRange, SearchPoint, Space

Numbers = NDArray[np.float64]
DRIVERS = np.array([0.0, 0.9, 0.1, 0.0])
"""What four drivers cost, in no order."""


def ishigami(units: Numbers) -> Numbers:
    """The usual test function of sensitivity analysis, which rises and falls twice over its second factor."""
    x = -pi + 2 * pi * units
    made: Numbers = np.sin(x[:, 0]) + 7 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])
    return made


def mixed(units: Numbers) -> Numbers:
    """A margin such as those of drives: a list of drivers, sight, an hour from which it is dark, and latency."""
    driver = DRIVERS[np.minimum(3, (units[:, 0] * 4).astype(int))]
    made: Numbers = 0.6 - driver + 0.5 * units[:, 1] - 0.3 * (units[:, 2] > 0.8) + 0.2 * units[:, 3]
    return made


RANGES = tuple(FactorRange(name, 0, 1, 0.5) for name in ("visibility_m", "hour", "latency_s"))
PARTS = np.array([DRIVERS.var(), 0.25 / 12, 0.09 * 0.16, 0.04 / 12])
CASES: dict[str, tuple[Space, Callable[[Numbers], Numbers], Numbers]] = {
    "Ishigami": (Space(RANGES), ishigami, np.array([0.3139, 0.4424, 0.0])),
    "a list and ranges": (
        Space((FactorChoices("driver", ("a", "b", "c", "d")), *RANGES)),
        mixed,
        PARTS / PARTS.sum(),
    ),
}


def ours(space: Space, points: Sequence[SearchPoint], values: Numbers) -> list[float]:
    """What `search` says."""
    outcomes = [TriedOutcome(float(value), bool(value < 0), trial="t") for value in values]
    found = Hunt(space)
    found.tried = [
        Tried(number, Phase.SAMPLE, point, 0, outcome, True)
        for number, (point, outcome) in enumerate(zip(points, outcomes, strict=True))
    ]
    shares = {factor.name: share for factor, share, _ in sensitivity(found)}
    return [shares.get(factor.name, 0.0) for factor in space.factors]


def theirs(name: str, space: Space, points: Sequence[SearchPoint], values: Numbers) -> list[float]:
    """What an estimator of SALib says, lists as coordinates; nothing if there are too few points for it."""
    from SALib.analyze import delta, rbd_fast

    problem = {
        "num_vars": space.dimensions,
        "names": [each.name for each in space.factors],
        "bounds": [[0, 1]] * space.dimensions,
    }
    units = np.array([space.units(point) for point in points])
    analyze = {"rbd_fast": rbd_fast.analyze, "delta": delta.analyze}[name]
    with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
        warnings.simplefilter("ignore")
        try:
            return [float(share) for share in analyze(problem, units, values, num_resamples=2, seed=1)["S1"]]
        except ValueError:
            return [float("nan")] * space.dimensions


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=15)
    parser.add_argument("--points", default="16,64,256")
    parser.add_argument("--delta", action="store_true", help="SALib's delta too, which takes minutes")
    given = parser.parse_args()
    names = (["rbd_fast"] + ["delta"] * given.delta) if find_spec("SALib") else []
    print(f"| {' | '.join(['function', 'points', 'here', *names])} |\n|---|---:|---:|{'---:|' * len(names)}")
    for title, (space, function, truth) in CASES.items():
        for count in map(int, given.points.split(",")):
            errors: dict[str, list[list[float]]] = {"here": [], **{name: [] for name in names}}
            for seed in range(given.seeds):
                units = qmc.Sobol(space.dimensions, rng=np.random.default_rng(seed)).random(count)
                points, values = [space.at(row.tolist()) for row in units], function(units)
                errors["here"].append(ours(space, points, values))
                for name in names:
                    errors[name].append(theirs(name, space, points, values))
            cells = [f"{float(np.sqrt(np.mean((np.array(each) - truth) ** 2))):.3f}" for each in errors.values()]
            print(f"| {title} | {count} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
