"""Demonstrations for imitation and offline learning, as one Parquet table.

    python -m automotive_cosim.exchange.demonstrations --families grid_june --seeds 0-9 --out demos.parquet
    python -m automotive_cosim.exchange.demonstrations --tasks hvac_fan_max --seeds 0-9 --out demos.parquet

The rule-perfect watcher plays drives through ``FlatDriveEnv``, the oracle tasks through ``FlatEnv``. Whatever the
watcher does that the flat view has no action for, such as an answer at a border, is played as a short wait; a task
that the oracle cannot solve with the actions of the flat view is refused.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, fields
from pathlib import Path

import numpy as np
import numpy.typing as npt

from automotive_cosim.agents.oracle import Oracle
from automotive_cosim.contracts import Action
from automotive_cosim.drives.watchers import RulePerfect
from automotive_cosim.envs.flat import FlatEnv
from automotive_cosim.envs.flat_drive import SOON, FlatDriveEnv
from automotive_cosim.errors import SetupError, UserError
from automotive_cosim.exchange.trajectories import NEEDS, write_frame
from automotive_cosim.traffic.fork import Simulations

MOST_STEPS = 60
"""Steps after which a demonstration of a task is cut off; the longest solution has fewer."""


@dataclass(frozen=True, slots=True)
class Demonstrated:
    """One step of a demonstration: a line of the table."""

    episode: int
    """Number of the episode in the table, from 0."""
    name: str
    """Id of the drive's family, or of the task."""
    seed: int
    step: int
    """Number of the step in its episode, from 0."""
    observation: npt.NDArray[np.float32]
    """What was seen before the action."""
    action: int
    reward: float
    terminated: bool
    truncated: bool
    next_observation: npt.NDArray[np.float32]
    """What was seen after it."""


def drives(
    families: Sequence[str],
    seeds: Sequence[int],
    *,
    minutes: float | None = None,
    simulations: Simulations | None = None,
) -> Iterator[Demonstrated]:
    """What the rule-perfect watcher does on drives of families.

    Args:
        minutes: when a drive is over, if its script ends later.
        simulations: warm simulations; by default those that the environments of this process share.

    Raises:
        UnknownNameError: no such family.
        UserError: ``minutes`` is out of bounds.
    """
    watcher = RulePerfect()
    for place, family in enumerate(families):
        with closing(FlatDriveEnv(family, minutes=minutes, simulations=simulations)) as env:

            def chosen(env: FlatDriveEnv = env) -> int:
                number = env.number(watcher.act(env.episode.observation))
                return SOON if number is None else number

            for at, seed in enumerate(seeds):
                seen, _ = env.reset(seed=seed)
                watcher.reset("")
                yield from _played(env, seen, chosen, place * len(seeds) + at, family, seed)


def tasks(
    names: Sequence[str],
    seeds: Sequence[int],
    *,
    scenario: str | None = None,
    simulations: Simulations | None = None,
) -> Iterator[Demonstrated]:
    """What the oracle does on tasks.

    Args:
        scenario: runs all tasks in this scenario instead of their own.
        simulations: warm simulations; by default those that the environments of this process share.

    Raises:
        UnknownNameError: no such task or scenario.
        UserError: a task takes an action that the flat view does not have.
    """
    oracle = Oracle()
    for place, task in enumerate(names):
        with closing(FlatEnv(task, scenario=scenario, max_steps=MOST_STEPS, simulations=simulations)) as env:

            def chosen(env: FlatEnv = env, task: str = task) -> int:
                action = oracle.act(env.episode.observation)
                number = env.number(action)
                if number is None:
                    raise UserError(f"{task} takes {_words(env, action)}, which the flat view does not have")
                return number

            for at, seed in enumerate(seeds):
                seen, _ = env.reset(seed=seed)
                oracle.reset("")
                oracle.brief(env.episode.instance)
                yield from _played(env, seen, chosen, place * len(seeds) + at, task, seed)


def _played(
    env: FlatDriveEnv | FlatEnv,
    seen: npt.NDArray[np.float32],
    chosen: Callable[[], int],
    episode: int,
    name: str,
    seed: int,
) -> Iterator[Demonstrated]:
    over, step = False, 0
    while not over:
        action = chosen()
        after, reward, terminated, truncated, _ = env.step(np.int64(action))
        yield Demonstrated(episode, name, seed, step, seen, action, reward, terminated, truncated, after)
        seen, over, step = after, terminated or truncated, step + 1


def _words(env: FlatEnv, action: Action) -> str:
    on = "" if action.index is None else f" on {env.episode.elements[action.index].resource_id}"
    return f"{action.action_type}{on}"


def write(steps: Iterable[Demonstrated], target: Path) -> int:
    """Writes demonstrations as Parquet, and returns how many steps they have.

    Raises SetupError: the extra ``reports`` is not installed."""
    try:
        import pandas as pd
    except ImportError as error:
        raise SetupError(NEEDS) from error
    columns = [entry.name for entry in fields(Demonstrated)]
    frame = pd.DataFrame(([getattr(step, name) for name in columns] for step in steps), columns=columns)
    write_frame(frame, target)
    return len(frame)


def main(words: Sequence[str] | None = None) -> None:
    """Plays demonstrations and writes them."""
    parser = argparse.ArgumentParser(description="Write demonstrations for imitation as a Parquet table.")
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--families", nargs="+", help="drives of these families, by the rule-perfect watcher")
    what.add_argument("--tasks", nargs="+", help="these tasks, by the oracle")
    parser.add_argument("--seeds", type=_seeds, default=range(10), help="as in 0-9", metavar="LIST")
    parser.add_argument("--minutes", type=float, help="when a drive is over, if its script ends later")
    parser.add_argument("--scenario", help="where to run tasks instead of in their own scenarios")
    parser.add_argument("--out", type=Path, required=True, help="the table, a .parquet")
    given = parser.parse_args(words)
    if given.families:
        steps = drives(given.families, given.seeds, minutes=given.minutes)
    else:
        steps = tasks(given.tasks, given.seeds, scenario=given.scenario)
    print(f"{write(steps, given.out)} steps in {given.out}")


def _seeds(text: str) -> range:
    first, _, last = text.partition("-")
    return range(int(first), int(last or first) + 1)


if __name__ == "__main__":
    main()
