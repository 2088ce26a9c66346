"""What to try next: each sampler is asked for a point and told its margin."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from math import ceil, log2, prod
from typing import Any, Protocol

import numpy as np

from automotive_cosim.errors import SetupError, UnknownNameError, install_hint
from automotive_cosim.safety.space import Factor, FactorChoices, FactorValue, SearchPoint, Space, key_of

NEEDS = f"the sampler {{}} needs the extra safety: {install_hint('safety')}"
SHARE = 0.25
"""Share of its points that a sampler that learns spreads evenly first."""
LEAST_EVEN = 8
BEST = 4
"""Points that ``climb`` starts steps from."""
STEP = 0.15
"""Standard deviation of a step of ``climb``, as a share of the range."""


UNTOLD = 2.0
"""What a sampler is told of a point without a margin: further from failing than any pass, so that it is drawn
elsewhere. A trial in which nothing was due is no success."""
MOST_RELAID = 4
"""Times the points of an even design that are tried to find as many at which something is due."""


class Sampler(Protocol):
    """Proposes points."""

    def ask(self) -> tuple[SearchPoint, bool]:
        """The next point, and whether it is one of those that represent the whole space."""
        ...

    def tell(self, point: SearchPoint, margin: float) -> None:
        """By how much a point passed (above 0) or failed."""
        ...


def even_points(sampler: Sampler, most: int) -> Iterator[SearchPoint]:
    """The points, at most so many, that a sampler proposes before it has learnt anything."""
    for _ in range(most):
        point, even = sampler.ask()
        if not even:
            return
        yield point
        sampler.tell(point, 1.0)


class RandomSampler:
    """Draws every point by itself."""

    def __init__(self, space: Space, budget: int, rng: np.random.Generator) -> None:
        self._space, self._rng = space, rng

    def ask(self) -> tuple[SearchPoint, bool]:
        """A random point."""
        return self._space.at(self._rng.random(self._space.dimensions).tolist()), True

    def tell(self, point: SearchPoint, margin: float) -> None:
        """Learns nothing."""


class _EvenSampler:
    """Spreads its points evenly: Sobol's sequence, scrambled, or a Latin hypercube (scipy.stats.qmc)."""

    def __init__(self, space: Space, budget: int, rng: np.random.Generator, *, latin: bool = False) -> None:
        """Lays out ``budget`` points. Raises SetupError: scipy is not installed."""
        try:
            from scipy.stats import qmc
        except ImportError as missing:
            raise SetupError(NEEDS.format("lhs" if latin else "sobol")) from missing
        if latin:
            laid = qmc.LatinHypercube(space.dimensions, rng=rng).random(budget)
        else:
            laid = qmc.Sobol(space.dimensions, rng=rng).random_base2(max(1, ceil(log2(budget))))
        self._space, self._rng = space, rng
        self._laid = [space.at(units.tolist()) for units in laid[:budget]]
        self.laid = budget
        self._next = 0

    def ask(self) -> tuple[SearchPoint, bool]:
        """The next of them; random ones once they are used up."""
        if self._next >= len(self._laid):
            return self._space.at(self._rng.random(self._space.dimensions).tolist()), True
        self._next += 1
        return self._laid[self._next - 1], True

    def tell(self, point: SearchPoint, margin: float) -> None:
        """Learns nothing."""


class _GridSampler:
    """Takes every value of every list with the middles of equal parts of every range, in random order."""

    def __init__(self, space: Space, budget: int, rng: np.random.Generator) -> None:
        """Cuts the ranges into as many parts as ``budget`` points allow, but at least one."""
        counts = [len(each.values) if isinstance(each, FactorChoices) else 1 for each in space.factors]
        most = [_most_parts(each) for each in space.factors]
        parts, finer = 1, counts
        while prod(finer) <= budget:
            counts, parts = finer, parts + 1
            finer = [max(count, min(parts, limit)) for count, limit in zip(counts, most, strict=True)]
            if finer == counts and parts > max(most):
                break
        self._space, self._rng, self._counts = space, rng, counts
        self._left = [int(number) for number in rng.permutation(prod(counts))[:budget]]

    def ask(self) -> tuple[SearchPoint, bool]:
        """The next of them; random ones once they are used up."""
        if not self._left:
            return self._space.at(self._rng.random(self._space.dimensions).tolist()), True
        number, units = self._left.pop(), []
        for count in self._counts:
            number, place = divmod(number, count)
            units.append((place + 0.5) / count)
        return self._space.at(units), True

    def tell(self, point: SearchPoint, margin: float) -> None:
        """Learns nothing."""


def _most_parts(factor: Factor) -> int:
    """Into how many parts a factor can be cut."""
    if isinstance(factor, FactorChoices):
        return len(factor.values)
    return round(factor.most - factor.least) + 1 if factor.whole else 1000


class _ClimbSampler:
    """Spreads points evenly, then takes steps from the worst ones: one factor or two at a time."""

    def __init__(self, space: Space, budget: int, rng: np.random.Generator) -> None:
        even = max(min(budget, LEAST_EVEN), round(SHARE * min(budget, 64)))
        self._space, self._rng, self._even = space, rng, _EvenSampler(space, even, rng)
        self._left = even
        self._known: dict[Any, tuple[float, SearchPoint]] = {}

    def ask(self) -> tuple[SearchPoint, bool]:
        """An even point at first, then a step from one of the worst."""
        if self._left > 0 or not self._known:
            self._left -= 1
            return self._even.ask()
        worst = sorted(self._known.values(), key=lambda each: each[0])[:BEST]
        for _ in range(50):
            point = self._step(worst[min(len(worst) - 1, int(self._rng.exponential(1.0)))][1])
            if key_of(point) not in self._known:
                return point, False
        return self._space.at(self._rng.random(self._space.dimensions).tolist()), False

    def tell(self, point: SearchPoint, margin: float) -> None:
        """Notes the margin; instead of an even point at which nothing was due, another one is laid."""
        self._left += self._left >= 0 and margin >= UNTOLD and len(self._known) < MOST_RELAID * self._even.laid
        self._known[key_of(point)] = margin, point

    def _step(self, point: SearchPoint) -> SearchPoint:
        made = dict(point)
        moved = self._rng.permutation(self._space.dimensions)[: 1 + int(self._rng.random() < 0.5)]
        for index in moved:
            factor = self._space.factors[index]
            if isinstance(factor, FactorChoices):
                made[factor.name] = factor.values[int(self._rng.integers(len(factor.values)))]
            else:
                far = STEP if self._rng.random() < 0.7 else 3 * STEP
                unit = factor.unit(made[factor.name]) + float(self._rng.normal(0, far))
                inside = min(1.0, max(0.0, unit)) if factor.is_ordered else float(self._rng.random())
                made[factor.name] = factor.at(inside)
        return made


class _CmaSampler:
    """Spreads points evenly, then adapts a normal distribution to the worst one (CMA-ES, ``cma``)."""

    def __init__(self, space: Space, budget: int, rng: np.random.Generator) -> None:
        """Lays out its first points. Raises SetupError: cma is not installed."""
        try:
            import cma
        except ImportError as missing:
            raise SetupError(NEEDS.format("cma")) from missing
        self._make: Callable[..., Any] = cma.CMAEvolutionStrategy
        even = max(min(budget, LEAST_EVEN), round(SHARE * min(budget, 64)))
        self._space, self._rng, self._even, self._left = space, rng, _EvenSampler(space, even, rng), even
        self._strategy: Any = None
        self._asked: list[list[float]] = []
        self._told: list[tuple[list[float], float]] = []
        self._known: list[tuple[float, list[float]]] = []

    def ask(self) -> tuple[SearchPoint, bool]:
        """An even point at first, then one of the distribution."""
        if self._left > 0 or not self._known:
            self._left -= 1
            return self._even.ask()
        if self._strategy is None or self._strategy.stop():
            worst = min(self._known)[1]
            options = {"bounds": [0, 1], "seed": int(self._rng.integers(1, 2**31)), "verbose": -9}
            self._strategy = self._make(worst, 0.25, options)
            self._asked, self._told = [], []
        if not self._asked:
            self._asked = [list(map(float, units)) for units in self._strategy.ask()]
            self._told = []
        units = self._asked[len(self._told)]
        return self._space.at(units), False

    def tell(self, point: SearchPoint, margin: float) -> None:
        self._known.append((margin, self._space.units(point)))
        if self._asked:
            self._told.append((self._asked[len(self._told)], margin))
            if len(self._told) == len(self._asked):
                self._strategy.tell([units for units, _ in self._told], [value for _, value in self._told])
                self._asked = []


class _BayesSampler:
    """Models which values fail (tree-structured Parzen estimators, ``optuna``)."""

    def __init__(self, space: Space, budget: int, rng: np.random.Generator) -> None:
        """Starts a study in memory. Raises SetupError: optuna is not installed."""
        try:
            import optuna
        except ImportError as missing:
            raise SetupError(NEEDS.format("bayes")) from missing
        optuna.logging.set_verbosity(optuna.logging.WARNING)
        self._random = max(min(budget, LEAST_EVEN), round(SHARE * min(budget, 64)))
        sampler = optuna.samplers.TPESampler(seed=int(rng.integers(2**31)), n_startup_trials=self._random)
        self._study = optuna.create_study(sampler=sampler)
        of = optuna.distributions
        self._space = space
        self._distributions: dict[str, Any] = {
            each.name: of.CategoricalDistribution(list(range(len(each.values))))
            if isinstance(each, FactorChoices)
            else of.FloatDistribution(0.0, 1.0)
            for each in space.factors
        }
        self._trial: Any = None

    def ask(self) -> tuple[SearchPoint, bool]:
        """The next point of the study."""
        self._trial = self._study.ask(self._distributions)
        given = self._trial.params
        point = {each.name: _value(each, given[each.name]) for each in self._space.factors}
        return point, self._trial.number < self._random

    def tell(self, point: SearchPoint, margin: float) -> None:
        self._study.tell(self._trial, margin)


def _value(factor: Factor, given: Any) -> FactorValue:
    """A value from optuna's: the number of one in the list, or a coordinate."""
    return factor.values[given] if isinstance(factor, FactorChoices) else factor.at(given)


def _latin(space: Space, budget: int, rng: np.random.Generator) -> Sampler:
    return _EvenSampler(space, budget, rng, latin=True)


SAMPLERS: Mapping[str, Callable[[Space, int, np.random.Generator], Sampler]] = {
    "climb": _ClimbSampler,
    "random": RandomSampler,
    "sobol": _EvenSampler,
    "lhs": _latin,
    "grid": _GridSampler,
    "cma": _CmaSampler,
    "bayes": _BayesSampler,
}
"""By name."""


def make_sampler(name: str, space: Space, budget: int, seed: int) -> Sampler:
    """A sampler by name.

    Raises:
        UnknownNameError: there is none.
        SetupError: it needs a package that is not installed.
    """
    if name not in SAMPLERS:
        raise UnknownNameError("sampler", name, SAMPLERS)
    return SAMPLERS[name](space, budget, np.random.default_rng(seed))
