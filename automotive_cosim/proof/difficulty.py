"""How hard each half is, from the outcomes of contestants that differ.

    python -m automotive_cosim.proof.difficulty RESULT_FOLDER... [--name NAME]
    python -m automotive_cosim.proof.difficulty --play all --suite all

takes the trials of evaluations into ``run/difficulty.json``, or plays the built-in contestants from every hand-over
that is not on record, and measures anew. A half that has changed since loses what is on record of it.

The model is Rasch's: a contestant wins a half with the odds of e to the power of its ability less the difficulty.
Difficulties are drawn from a normal distribution whose width is estimated too (marginal maximum likelihood by
expectation and maximisation, on a grid), so that a half that all have won or lost has a finite one.
"""

from __future__ import annotations

import argparse
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from automotive_cosim.agents import make_agent
from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import TriggerNotReachedError
from automotive_cosim.proof.hand_over import Ground
from automotive_cosim.run.choosing import choose
from automotive_cosim.run.coverage import is_outdated
from automotive_cosim.run.difficulty import RECORD, Difficulties, Difficulty, Outcomes, read, write
from automotive_cosim.run.rows import EpisodeRow, read_trials
from automotive_cosim.tasking.fingerprint import fingerprint
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations
from automotive_cosim.traffic.future import KnownDrives

Reals: TypeAlias = NDArray[np.float64]
OutcomesByHalf: TypeAlias = Mapping[str, Outcomes]
"""Outcomes by task and half."""

TOLD = frozenset({"oracle", "rule-perfect"})
"""Agents that are told the answer, so that they say nothing about difficulty."""
BUILT_IN = ("asurada", "t3a", "caller", "always-alert", "always-ask", "random")
"""The contestants that ``--play`` plays, those with a model on the rule stand-in; M3A on it does what T3A does."""
ABILITY_SD = 3.0
"""Logits; keeps the ability of a contestant finite that has won nothing."""
GRID = np.linspace(-4.0, 4.0, 41)
"""Difficulties, in standard deviations."""
ROUNDS = 200
TO_WITHIN = 1e-4
"""Logits by which no ability changes any more when the estimate is taken."""
LEAST_CONTESTANTS = 5
"""Of a task's halves, for a place in the core."""
CORE_SIZE = 60
LEAST_SHARE = 0.1
"""Of the halves on record, for a contestant whose place on the core is compared."""
DRAWS = 2000
"""Bootstrap draws."""
WARM = 2
"""Simulations kept warm."""
SAVED_EVERY = 100
"""Halves; a killed run loses no more."""


# --- the model --------------------------------------------------------------------------------------------


@dataclass(frozen=True, slots=True)
class Rasch:
    """What the model makes of outcomes."""

    difficulties: Mapping[str, tuple[float, float]]
    """By task and half: logits and their standard error."""
    abilities: Mapping[str, float]
    """By contestant."""
    spread: float
    """Standard deviation of the difficulties."""


def fit(seen: OutcomesByHalf) -> Rasch:
    """Fits the model."""
    who = sorted({name for outcomes in seen.values() for name in outcomes.won})
    counts = np.array([[outcomes.won.get(name, (0, 0)) for name in who] for outcomes in seen.values()], dtype=float)
    won, lost = counts[..., 0], counts[..., 1] - counts[..., 0]
    abilities, spread = np.zeros(len(who)), 1.5
    for _ in range(ROUNDS):
        before, weight, at = abilities, _weights(won, lost, abilities, spread), GRID * spread
        wins, trials = won.T @ weight, (won + lost).T @ weight  # expected, by contestant and difficulty
        for _ in range(4):
            chances = _chances(abilities, at)
            slope = (wins - trials * chances).sum(axis=1) - abilities / ABILITY_SD**2
            abilities = abilities + slope / ((trials * chances * (1 - chances)).sum(axis=1) + ABILITY_SD**-2)
        spread = float(np.sqrt((weight @ at**2).mean()))
        if np.abs(abilities - before).max() < TO_WITHIN:
            break
    weight, at = _weights(won, lost, abilities, spread), GRID * spread
    mean = weight @ at
    error = np.sqrt(weight @ at**2 - mean**2)
    found = {name: (float(logits), float(by)) for name, logits, by in zip(seen, mean, error, strict=True)}
    return Rasch(found, dict(zip(who, map(float, abilities), strict=True)), spread)


def _weights(won: Reals, lost: Reals, abilities: Reals, spread: float) -> Reals:
    """How likely each difficulty on the grid is, by half."""
    chances = _chances(abilities, GRID * spread)
    likely = won @ np.log(chances) + lost @ np.log1p(-chances) - GRID**2 / 2
    likely = np.exp(likely - likely.max(axis=1, keepdims=True))
    weights: Reals = likely / likely.sum(axis=1, keepdims=True)
    return weights


def _chances(abilities: Reals, difficulties: Reals) -> Reals:
    """Of winning, by ability and difficulty."""
    chances: Reals = 1 / (1 + np.exp(difficulties[None, :] - abilities[:, None]))
    return chances


# --- the core subset --------------------------------------------------------------------------------------


def core(seen: OutcomesByHalf, fitted: Rasch, size: int = CORE_SIZE) -> tuple[str, ...]:
    """Ids of the tasks that tell the contestants apart best, in the catalogue's order.

    Suites and subsets get their shares of the eligible tasks: those of which ``LEAST_CONTESTANTS`` have tried each
    half. One after the other, the task is taken that raises the sum of the logarithms of the contestants'
    information most (Fisher's, p (1 - p) of a half), so that whoever is known least gains most."""
    tasks = [CATALOGUE[task_id] for task_id in _tasks(seen)]
    eligible = [task for task in tasks if all(_is_eligible(seen, f"{task.id}/{h}") for h in task.halves)]
    abilities = np.array(list(fitted.abilities.values()))
    known = {}
    for task in eligible:
        at = np.array([fitted.difficulties[f"{task.id}/{half}"][0] for half in task.halves])
        chances = _chances(abilities, at)
        known[task.id] = (chances * (1 - chances)).sum(axis=1)
    left = _quotas(Counter((task.suite, task.subset) for task in eligible), size)
    total, chosen = np.full(len(abilities), 1e-3), list[str]()
    while sum(left.values()):
        free = [task for task in eligible if task.id not in chosen and left[task.suite, task.subset]]
        best = max(free, key=lambda task: float(np.log(total + known[task.id]).sum()))
        total = total + known[best.id]
        left[best.suite, best.subset] -= 1
        chosen.append(best.id)
    return tuple(task.id for task in tasks if task.id in chosen)


def _tasks(seen: OutcomesByHalf) -> tuple[str, ...]:
    """The ids of the tasks that were tried, in the order of the record, whatever the catalogue's is."""
    found = dict.fromkeys(name.split("/")[0] for name in seen)
    return tuple(task_id for task_id in found if task_id in CATALOGUE)


def _is_eligible(seen: OutcomesByHalf, name: str) -> bool:
    return name in seen and len(seen[name].won) >= LEAST_CONTESTANTS


def _quotas(sizes: Counter[tuple[str, str]], size: int) -> Counter[tuple[str, str]]:
    """Shares of the whole by the method of the largest remainder; all of it if it is no larger."""
    if (whole := sum(sizes.values())) <= size:
        return Counter(sizes)
    exact = {name: size * number / whole for name, number in sizes.items()}
    quotas = Counter({name: int(share) for name, share in exact.items()})
    by_remainder = sorted(exact, key=lambda name: (quotas[name] - exact[name], name))
    quotas.update(by_remainder[: size - sum(quotas.values())])
    return quotas


@dataclass(frozen=True, slots=True)
class Agreement:
    """How well a subset keeps the order of the contestants: rank correlations (Spearman) of their success on it
    with that on everything."""

    at_once: float
    mean: float
    """Over draws of tasks, from the subset and from everything."""
    low: float
    """Of twenty draws, nineteen have more."""
    left_out: float
    """With the success of each contestant on a subset that was chosen without it."""

    def __str__(self) -> str:
        return (
            f"rank correlation {self.at_once:.3f}; over draws of tasks {self.mean:.3f} in the mean, "
            f"{self.low:.3f} or more in 95 of 100; {self.left_out:.3f} on subsets chosen without the contestant"
        )


def agreement(seen: OutcomesByHalf, chosen: Sequence[str], draws: int = DRAWS, seed: int = 0) -> Agreement:
    """Compares success on some tasks with success on all; contestants that tried few halves are left out."""
    tried = Counter(name for outcomes in seen.values() for name in outcomes.won)
    who = sorted(name for name, halves in tried.items() if halves >= LEAST_SHARE * len(seen))
    ids = _tasks(seen)
    counts = np.zeros((len(ids), len(who), 2))
    for at, task_id in enumerate(ids):
        for half in CATALOGUE[task_id].halves:
            if outcomes := seen.get(f"{task_id}/{half}"):
                counts[at] += [outcomes.won.get(name, (0, 0)) for name in who]
    own = np.array([at for at, task_id in enumerate(ids) if task_id in set(chosen)])
    every = np.arange(len(ids))
    rng = np.random.default_rng(seed)
    whole = _success(counts, every)
    found = [
        correlation(_success(counts, rng.choice(own, len(own))), _success(counts, rng.choice(every, len(ids))))
        for _ in range(draws)
    ]
    without = np.zeros(len(who))
    for at, name in enumerate(who):
        others = {
            half: Outcomes(each.half, {one: each.won[one] for one in each.won if one != name})
            for half, each in seen.items()
        }
        others = {half: each for half, each in others.items() if each.won}
        blind = set(core(others, fit(others), len(chosen)))
        without[at] = _success(counts, np.array([n for n, task_id in enumerate(ids) if task_id in blind]))[at]
    return Agreement(
        correlation(_success(counts, own), whole),
        float(np.mean(found)),
        float(np.quantile(found, 0.05)),
        correlation(without, whole),
    )


def _success(counts: Reals, tasks: NDArray[np.intp]) -> Reals:
    """Share won by contestant; of none tried, none."""
    won, tried = counts[tasks].sum(axis=0).T
    share: Reals = won / np.maximum(tried, 1)
    return share


def correlation(one: Reals, other: Reals) -> float:
    """Spearman's rank correlation; equal values share a rank."""
    ranks = [
        (values[:, None] > values).sum(axis=1) - (values[:, None] < values).sum(axis=1) for values in (one, other)
    ]
    return float(np.corrcoef(*ranks)[0, 1])


# --- outcomes ---------------------------------------------------------------------------------------------


def outcomes_of(folders: Sequence[Path], name: str = "") -> dict[str, Outcomes]:
    """The outcomes of evaluations; no trials count that ended in an error, of halves that have changed since, or of
    agents that are told the answer.

    Args:
        folders: result folders of ``eval``, run on the catalogue as it is.
        name: what all their contestants together are called; by default, each by its agent and model."""
    counts: dict[str, dict[str, list[int]]] = defaultdict(lambda: defaultdict(lambda: [0, 0]))
    for folder in folders:
        for row in read_trials(folder).values():
            if not isinstance(row, EpisodeRow) or row.success is None or row.error or row.agent in TOLD:
                continue
            if row.task in CATALOGUE and not is_outdated(row):
                count = counts[f"{row.task}/{row.half}"][name or contestant(row.agent, row.model)]
                count[0] += row.success
                count[1] += 1
    return {
        half: Outcomes(_now(half), {who: (won, tried) for who, (won, tried) in of.items()})
        for half, of in counts.items()
    }


def contestant(agent: str, model: str) -> str:
    """What the record calls it."""
    return agent if model in ("", "none") else f"{agent}, {model}"


def play(tasks: Sequence[str], suite: str, record: OutcomesByHalf, seed: int = 0) -> Iterator[tuple[str, Outcomes]]:
    """Plays each half that ``BUILT_IN`` have not tried, all of them from the same hand-over.

    A half whose situation does not come about with this seed is left out."""
    names = [contestant(agent, make_agent(agent).model) for agent in BUILT_IN]
    halves = [(task_id, half) for task_id in choose(tasks, suite) for half in CATALOGUE[task_id].halves]
    halves = [each for each in halves if not _known(record, "/".join(each)).keys() >= set(names)]
    with closing(Simulations(count_limit=WARM)) as simulations, closing(KnownDrives(simulations)) as drives:
        for task_id, half in sorted(halves, key=_traffic):
            try:
                ground = Ground.reach(CATALOGUE[task_id], half, seed, drives)
            except TriggerNotReachedError:
                continue
            with closing(ground):
                won = {
                    name: (int(ground.play(ground.agent(make_agent(agent)), stop_when_lost=True).success), 1)
                    for name, agent in zip(names, BUILT_IN, strict=True)
                }
            yield f"{task_id}/{half}", Outcomes(_now(f"{task_id}/{half}"), won)


def _traffic(entry: tuple[str, str]) -> str:
    task_id, half = entry
    start = CATALOGUE[task_id].half(half).start
    return f"{start.scenario} {start.origin}"


def _now(name: str) -> str:
    task_id, half = name.split("/")
    return fingerprint(CATALOGUE[task_id], half)


def _known(record: OutcomesByHalf, name: str) -> Mapping[str, tuple[int, int]]:
    """What is on record of a half as it is now."""
    return record[name].won if name in record and record[name].half == _now(name) else {}


def merged(record: OutcomesByHalf, new: OutcomesByHalf) -> dict[str, Outcomes]:
    """A record with new outcomes in place of the same contestants' older ones, without halves that have changed."""
    names = [f"{task.id}/{half}" for task in CATALOGUE.values() for half in task.halves]
    found = {
        name: Outcomes(_now(name), {**_known(record, name), **_known(new, name)})
        for name in names
        if name in record or name in new
    }
    return {name: outcomes for name, outcomes in found.items() if outcomes.won}


def measured(seen: OutcomesByHalf) -> Difficulties:
    """Everything that a record says."""
    fitted = fit(seen)
    halves = {name: Difficulty(*fitted.difficulties[name], seen[name]) for name in seen}
    return Difficulties(halves, fitted.abilities, core(seen, fitted))


def main() -> None:
    """Measures, and says how well the core keeps the order of the contestants."""
    parser = argparse.ArgumentParser(description="Measure how hard each half is.")
    parser.add_argument("folders", type=Path, nargs="*", help="result folders of `automotive-cosim eval`")
    parser.add_argument("--name", default="", help="call all contestants of the folders so, as one")
    parser.add_argument("--play", default="", help="tasks for the built-in contestants, as for `tasks validate`")
    parser.add_argument("--suite", default=str(Suite.STANDARD), help=f"{', '.join(Suite)}, live or all")
    parser.add_argument("--out", type=Path, default=RECORD, help="the record, by default the shipped one")
    given = parser.parse_args()
    record: OutcomesByHalf = {name: each.outcomes for name, each in read(given.out).halves.items()}
    seen = merged(record, outcomes_of(given.folders, given.name))
    if given.play:
        known = seen
        for number, (name, outcomes) in enumerate(play(given.play.split(","), given.suite, known), start=1):
            seen = {**seen, **merged({name: seen[name]} if name in seen else {}, {name: outcomes})}
            if number % SAVED_EVERY == 0:
                write(given.out, measured(seen))
    found = measured(seen)
    write(given.out, found)
    for name, ability in sorted(found.abilities.items(), key=lambda each: -each[1]):
        won, tried = np.array([each.won[name] for each in seen.values() if name in each.won]).sum(axis=0)
        print(f"{name}: won {won:,} of {tried:,}; ability {ability:+.2f} logits")
    print(
        f"{counted(len(seen), 'half', 'halves')} measured; core of {len(found.core)}: {agreement(seen, found.core)}"
    )


if __name__ == "__main__":
    main()
