"""Tries points, repeats what fails, and reduces each failure, with its nearest passing neighbour."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from enum import StrEnum
from typing import Any

from automotive_cosim.errors import BudgetSpentError, UserError
from automotive_cosim.safety.objective import TriedOutcome
from automotive_cosim.safety.samplers import UNTOLD, Sampler
from automotive_cosim.safety.space import FactorRange, FactorValue, PointKey, SearchPoint, Space, key_of, said

REPEATS = 3
"""Runs of a failure, which counts if all of them fail, and of what is beside it, which counts if none does."""
BISECTIONS = 4
"""Halvings between a number that fails and the nominal one: to a sixteenth of the distance."""

NOMINAL = "everything nominal"
"""What triggers a failure of the nominal point, in words."""
MOST_STALE = 1000
"""Points in a row that were all known, after which a space of few points is taken to be used up."""
MOST_BESIDE = 3
"""Points that passed of which a neighbour of a failing nominal point is made."""
MOST_PASSED = 8
"""Points in a row that are passed over because nothing comes due there, after which the next is run anyway."""
MOST_ASKED = 20
"""Points that a sampler is asked for at most, for each that is run."""

Evaluate = Callable[[SearchPoint, int], TriedOutcome]
"""Runs a point; the number says which repeat."""


class Phase(StrEnum):
    """Why a point was run."""

    NOMINAL = "nominal"
    SAMPLE = "sample"
    REPEAT = "repeat"
    MINIMISE = "minimise"


@dataclass(frozen=True, slots=True)
class Tried:
    """One run."""

    number: int
    phase: Phase
    point: SearchPoint
    repeat: int
    outcome: TriedOutcome
    even: bool = False
    """Whether it is one of those that represent the whole space."""


@dataclass(frozen=True, slots=True)
class MinimalFailure:
    """A failure with as few factors off their nominal values as it needs, and as little."""

    first: Tried
    """The failure that it was made of."""
    point: SearchPoint
    changed: tuple[str, ...]
    """The factors that it needs; empty if the nominal point fails."""
    neighbour: SearchPoint | None
    """The nearest point found that does not fail, however often it is run; None if there is none."""
    differs: str
    """The one factor in which the two differ."""
    why: str
    trial: str
    neighbour_trial: str
    neighbour_passes: bool = True
    """Whether the neighbour passes; otherwise nothing is due there."""
    prevented: bool | None = None
    """Whether a careful watcher does not fail there; None if it was not tried or judged."""
    act: str = ""
    """The act, or the missing act, that made it fail, in words; empty while it was not measured."""

    def covers(self, space: Space, point: SearchPoint) -> bool:
        """Whether a point has all that this failure needs, and perhaps more of it."""
        for name in self.changed:
            factor, mine, theirs = space.factor(name), self.point[name], point[name]
            if isinstance(factor, FactorRange) and factor.is_ordered:
                away = factor.unit(mine) - factor.unit(factor.nominal)
                if (factor.unit(theirs) - factor.unit(mine)) * (1 if away >= 0 else -1) < -1e-9:
                    return False
            elif mine != theirs:
                return False
        return True

    @property
    def beside(self) -> str:
        """What holds at the neighbour, in words; empty without one."""
        if self.neighbour is None:
            return ""
        what = "passes" if self.neighbour_passes else "nothing is due"
        return f"{what} with {said(self.differs, self.neighbour[self.differs])}"

    def words(self, space: Space) -> str:
        """The conditions that trigger it."""
        if not self.changed:
            return NOMINAL
        told_all = []
        for name in self.changed:
            factor, value = space.factor(name), self.point[name]
            if isinstance(factor, FactorRange) and factor.is_ordered:
                bound = "at least" if factor.unit(value) >= factor.unit(factor.nominal) else "at most"
                told_all.append(said(name, value, bound))
            else:
                told_all.append(said(name, value))
        return " and ".join(told_all)


@dataclass(slots=True)
class Hunt:
    """What a search has tried and found so far."""

    space: Space
    tried: list[Tried] = field(default_factory=list)
    minimal: list[MinimalFailure] = field(default_factory=list)
    unsteady: list[Tried] = field(default_factory=list)
    """Failures that passed when repeated."""
    not_reduced: list[Tried] = field(default_factory=list)
    """Failures beyond the number that are reduced."""
    passed_over: int = 0
    """Points at which nothing came due with nobody at the cockpit, and which no agent was given."""
    stopped: str = ""
    """Why it ended before its budget; empty if it did not."""
    interrupted: bool = False
    """Whether it was interrupted: by Ctrl-C, or by SIGTERM."""

    @property
    def samples(self) -> list[Tried]:
        """The points that the sampler chose, each once."""
        return [each for each in self.tried if each.phase is Phase.SAMPLE]

    @property
    def run(self) -> int:
        """How many of them could be run."""
        return sum(not each.outcome.is_unrunnable for each in self.samples)


def hunt(
    space: Space,
    evaluate: Evaluate,
    sampler: Sampler,
    budget: int,
    *,
    most_failures: int = 5,
    place: Callable[[SearchPoint], SearchPoint | None] = lambda point: point,
    tell: Callable[[Hunt], None] = lambda found: None,
) -> Hunt:
    """Searches a space.

    Args:
        budget: how many points of its choice are run; combinations that cannot be run are passed over. Repeats and
            reductions come in addition: about thirty runs a failure.
        most_failures: how many failures are reduced; those that one of them explains are not.
        place: the point itself, or one near it at which something comes due; None if nothing does, as far as that
            is known without the agent: such points are passed over.
        tell: called after each point.

    Returns:
        What it found; after an interruption, what it had found by then.

    Raises:
        UserError: the nominal point is not judged.
        BudgetSpentError: ``evaluate`` refused the nominal point; a later refusal ends the search.
        KeyboardInterrupt: interrupted in the nominal point; a later interruption ends the search.
    """
    found = Hunt(space)
    run = _Runner(found, evaluate)
    nominal = run(Phase.NOMINAL, space.nominal).outcome
    if not nominal.held and not nominal.failed:
        raise UserError(
            f"the nominal combination is not judged ({nominal.error}); give another, the first of each list"
        )
    passed, stale, at_once = 0, 0, [found.tried[0]] if nominal.failed else []
    for _ in range(MOST_ASKED * budget):
        if found.run >= budget:
            break
        if stale >= MOST_STALE:
            found.stopped = f"nothing new in {MOST_STALE} points"
            break
        point, even = sampler.ask()
        stale = 0 if run.is_new(point) else stale + 1
        try:
            while at_once:
                _reduce(run, at_once.pop(), most_failures)
            if run.is_new(point) and passed < MOST_PASSED:
                if (placed := place(point)) is None:
                    passed, found.passed_over = passed + 1, found.passed_over + 1
                    sampler.tell(point, UNTOLD)
                    continue
                point = placed
            passed = 0
            tried = run(Phase.SAMPLE, point, even=even)
            margin = tried.outcome.margin
            sampler.tell(point, UNTOLD if margin is None else margin)
            if tried.outcome.failed and not any(each.covers(space, point) for each in found.minimal):
                _reduce(run, tried, most_failures)
            tell(found)
        except BudgetSpentError as spent:
            found.stopped = str(spent)
            break
        except KeyboardInterrupt:
            found.stopped, found.interrupted = "interrupted", True
            break
    try:
        _look_beside(run)
    except BudgetSpentError as spent:
        found.stopped = str(spent)
    except KeyboardInterrupt:
        found.stopped, found.interrupted = "interrupted", True
    return found


def try_carefully(found: Hunt, careful: Evaluate) -> None:
    """Notes which minimal failures a careful watcher prevents, as ISO 34502 asks of a preventable situation.

    Args:
        found: the search; changed in place.
        careful: runs a point with that watcher.
    """
    for number, each in enumerate(found.minimal):
        outcome = careful(each.point, 0)
        found.minimal[number] = replace(each, prevented=outcome.held if outcome.failed or outcome.held else None)


def blame(found: Hunt, act_of: Callable[[MinimalFailure], str]) -> None:
    """Notes which act, or missing act, made each minimal failure; the search is changed in place."""
    for number, each in enumerate(found.minimal):
        found.minimal[number] = replace(each, act=act_of(each))


class _Runner:
    """Runs points, each repeat once."""

    def __init__(self, found: Hunt, evaluate: Evaluate) -> None:
        self.found = found
        self._evaluate = evaluate
        self._known: dict[tuple[PointKey, int], TriedOutcome] = {}

    def __call__(self, phase: Phase, point: SearchPoint, repeat: int = 0, *, even: bool = False) -> Tried:
        key = key_of(point), repeat
        fresh = key not in self._known
        if fresh:
            self._known[key] = self._evaluate(point, repeat)
        tried = Tried(len(self.found.tried), phase, point, repeat, self._known[key], even)
        if fresh or phase is Phase.SAMPLE:
            self.found.tried.append(tried)
        return tried

    def is_new(self, point: SearchPoint) -> bool:
        """Whether a point has not been run."""
        return (key_of(point), 0) not in self._known

    def again(self, point: SearchPoint) -> Iterator[TriedOutcome]:
        """What comes of a point that has been run, each further time."""
        return (self(Phase.REPEAT, point, repeat).outcome for repeat in range(1, REPEATS))

    def is_steady(self, point: SearchPoint) -> bool:
        """Whether a point that failed does so each time."""
        return all(outcome.failed for outcome in self.again(point))

    def holds(self, point: SearchPoint) -> bool:
        """Whether a point that did not fail never does."""
        return all(outcome.held for outcome in self.again(point))


def _reduce(run: _Runner, first: Tried, most: int) -> None:
    try:
        _sort_out(run, first, most)
    except (BudgetSpentError, KeyboardInterrupt):
        run.found.not_reduced.append(first)
        raise


def _sort_out(run: _Runner, first: Tried, most: int) -> None:
    found = run.found
    if not run.is_steady(first.point):
        found.unsteady.append(first)
    elif len(found.minimal) >= most:
        found.not_reduced.append(first)
    else:
        found.minimal.append(minimise(run, first))


def _look_beside(run: _Runner) -> None:
    """Gives a failure of the nominal point, from which nothing leads back, its neighbour from what has passed."""
    found = run.found
    for number, each in enumerate(found.minimal):
        if not each.changed and each.neighbour is None and not found.stopped:
            held = sorted(
                (tried for tried in found.samples if tried.outcome.held),
                key=lambda tried: found.space.distance(tried.point, found.space.nominal),
            )
            near, differs = _neighbour(run, each.point, held[:MOST_BESIDE])
            if near is not None:
                found.minimal[number] = replace(each, **_beside(run, near, differs))


def minimise(run: _Runner, first: Tried) -> MinimalFailure:
    """Takes factors back to nominal while it still fails, then bisects the numbers that are left.

    Each step is one run; of its results the first that are no chance are taken, the smallest and the nearest.

    Args:
        first: a failure that fails each time.
    """
    space = run.found.space
    point: dict[str, FactorValue] = dict(first.point)
    failing, passing = [first], list[Tried]()
    for factor in sorted(space.factors, key=lambda each: isinstance(each, FactorRange)):
        if point[factor.name] == factor.nominal:
            continue
        tried = run(Phase.MINIMISE, point | {factor.name: factor.nominal})
        if tried.outcome.failed:
            point = dict(tried.point)
            failing.append(tried)
        elif tried.outcome.held:
            passing.append(tried)
    for factor in space.factors:
        if not isinstance(factor, FactorRange) or not factor.is_ordered:
            continue
        if point[factor.name] != factor.nominal:
            bad, good = factor.unit(point[factor.name]), factor.unit(factor.nominal)
            for _ in range(BISECTIONS):
                middle = factor.at((bad + good) / 2)
                if middle in (factor.at(bad), factor.at(good)):
                    break
                tried = run(Phase.MINIMISE, point | {factor.name: middle})
                if tried.outcome.failed:
                    point, bad = dict(tried.point), factor.unit(middle)
                    failing.append(tried)
                elif tried.outcome.held:
                    passing.append(tried)
                    good = factor.unit(middle)
                else:
                    break
    last = next(each for each in reversed(failing) if each is first or run.is_steady(each.point))
    point = dict(last.point)
    changed = tuple(each.name for each in space.factors if point[each.name] != each.nominal)
    made = MinimalFailure(first, point, changed, None, "", last.outcome.why, last.outcome.trial, "")
    neighbour, differs = _neighbour(run, point, passing)
    return made if neighbour is None else replace(made, **_beside(run, neighbour, differs))


def _beside(run: _Runner, neighbour: Tried, differs: str) -> dict[str, Any]:
    """What a minimal failure says of the point beside it."""
    outcomes = (neighbour.outcome, *run.again(neighbour.point))
    return {
        "neighbour": neighbour.point,
        "differs": differs,
        "neighbour_trial": neighbour.outcome.trial,
        "neighbour_passes": all(each.passed for each in outcomes),
    }


def _neighbour(run: _Runner, point: SearchPoint, passing: Sequence[Tried]) -> tuple[Tried | None, str]:
    """The nearest point that differs in one factor and passes each time, or else has nothing due: known, or made of
    those that nearly do."""
    space = run.found.space
    made: list[Tried] = []
    for tried in passing:
        for name in _differing(tried.point, point):
            near = run(Phase.MINIMISE, {**point, name: tried.point[name]})
            if near.outcome.held:
                made.append(near)
    made.sort(key=lambda each: (not each.outcome.passed, space.distance(each.point, point)))
    nearest = next((each for each in made if run.holds(each.point)), None)
    return nearest, "" if nearest is None else next(_differing(nearest.point, point))


def _differing(one: SearchPoint, other: SearchPoint) -> Iterator[str]:
    return (name for name in one if one[name] != other[name])
