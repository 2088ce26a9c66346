"""Many environments at the same time do what each does alone, and share their warm traffic."""

from collections.abc import Callable, Iterator
from contextlib import closing
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode, SyncVectorEnv

from automotive_cosim.contracts import GoalStatus
from automotive_cosim.envs.flat import APPS, CONTROLS, ENDS, FlatEnv
from automotive_cosim.envs.pool import SharedPool
from automotive_cosim.envs.vector import ConcurrentVectorEnv
from automotive_cosim.errors import ActionError, TrafficError, UserError
from automotive_cosim.scenarios import Scenario, load
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Simulations

COUNT, ROUNDS = 3, 8
TASKS = ("hvac_fan_max", "hvac_driver_seat_heater")
Make = Callable[..., FlatEnv]


@pytest.fixture
def make(simulations: Simulations) -> Make:
    return lambda: FlatEnv(TASKS, scenario="grid", max_steps=4, simulations=simulations)


@pytest.fixture(scope="module")
def actions() -> Any:
    moves = len(APPS) + len(CONTROLS)
    drawn = np.random.default_rng(5).integers(moves, size=(ROUNDS, COUNT))
    drawn[2, 0] = drawn[5, 2] = moves + ENDS.index(GoalStatus.COMPLETE)
    return drawn


def played(envs: SyncVectorEnv, actions: Any) -> Iterator[Any]:
    """What it gives, step by step, and the hash of every episode that ends."""
    yield envs.reset(seed=[3, 4, 5], options={"traffic_seed": 3})
    for row in actions:
        told = envs.step(row)
        _, _, terminated, truncated, _ = told
        over = terminated | truncated
        yield told
        if envs.autoreset_mode is not AutoresetMode.SAME_STEP:  # there the next one has begun
            yield [envs.envs[index].unwrapped.episode.trace_sha256 for index in np.flatnonzero(over)]
        if envs.autoreset_mode is AutoresetMode.DISABLED and over.any():
            yield envs.reset(options={"reset_mask": over})


def same(one: Any, other: Any) -> bool:
    if isinstance(one, dict):
        return one.keys() == other.keys() and all(same(one[name], other[name]) for name in one)
    if isinstance(one, list | tuple):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, np.ndarray) and one.dtype == object:
        return same(list(one), list(other))
    return bool(np.array_equal(one, other))


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_it_gives_what_gymnasiums_own_vector_gives(make: Make, actions: Any, mode: AutoresetMode) -> None:
    with (
        closing(SyncVectorEnv([make] * COUNT, autoreset_mode=mode)) as one_by_one,
        closing(ConcurrentVectorEnv([make] * COUNT, mode)) as at_once,
    ):
        expected, found = list(played(one_by_one, actions)), list(played(at_once, actions))
    assert len(expected) > ROUNDS
    assert any(told[2].any() for told in expected if len(told) == 5), "an episode ends"
    assert [
        index for index, (one, other) in enumerate(zip(expected, found, strict=True)) if not same(one, other)
    ] == []


def test_each_environment_has_the_trace_that_it_has_alone(
    make: Make, actions: Any, simulations: Simulations
) -> None:
    options = {"tasks": TASKS, "scenario": "grid", "max_steps": 4, "simulations": simulations}
    with closing(gym.make_vec("AutomotiveCosim/Flat-v0", num_envs=COUNT, **options)) as envs:
        assert isinstance(envs, ConcurrentVectorEnv)
        envs.reset(seed=3)
        rewards, ends = zip(*((step[1], step[2] | step[3]) for step in map(envs.step, actions)), strict=True)
        traces = [env.unwrapped.episode.trace_sha256 for env in envs.envs]
    assert len(set(traces)) == COUNT, "each draws its own"
    for number in range(COUNT):
        with closing(make()) as alone:
            alone.reset(seed=3 + number, options={"traffic_seed": 3})
            over = False
            for row, reward, end in zip(actions, rewards, ends, strict=True):
                if over:
                    alone.reset()
                    told, over = 0.0, False
                else:
                    _, told, terminated, truncated, _ = alone.step(row[number])
                    over = terminated or truncated
                assert (told, over) == (reward[number], end[number])
            assert alone.episode.trace_sha256 == traces[number]


def test_one_seed_warms_one_traffic_and_a_list_several(make: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    warmed = []
    warm = Simulations.warm

    def noted(pool: Simulations, scenario: Scenario, seed: int = 0, *arguments: Any) -> Any:
        warmed.append(seed)
        return warm(pool, scenario, seed, *arguments)

    monkeypatch.setattr(Simulations, "warm", noted)
    with closing(ConcurrentVectorEnv([make] * COUNT)) as envs:
        envs.reset()
        assert len(set(warmed)) == 1
        envs.reset()
        assert len(set(warmed)) == 1, "each keeps its traffic"
        warmed.clear()
        envs.reset(seed=3)
        assert set(warmed) == {3}
        warmed.clear()
        envs.reset(seed=[3, 4, 3])
        assert warmed == [3, 4, 3]


def test_an_environment_that_fails_is_told_and_all_can_begin_anew(make: Make, actions: Any) -> None:
    with closing(ConcurrentVectorEnv([make] * COUNT)) as envs:
        expected = envs.reset(seed=3)
        envs.envs[1].unwrapped.episode.world.close()
        with pytest.raises(TrafficError, match="closed"):
            envs.step(actions[0])
        assert same(envs.reset(seed=3), expected)
        assert envs.step(actions[0])[0].shape == envs.observation_space.shape


def test_what_the_environments_cannot_take_is_told() -> None:
    with pytest.raises(UserError, match="at least one task"):
        gym.make_vec("AutomotiveCosim/Flat-v0", num_envs=2, tasks=())


@pytest.mark.sumo
@pytest.mark.parametrize("actions", [[0], [0, 0, 0], 0])
def test_a_wrong_number_of_actions_is_told_and_nothing_happens(actions: Any) -> None:
    with closing(
        gym.make_vec("AutomotiveCosim/Flat-v0", num_envs=2, tasks="hvac_fan_max", scenario="grid")
    ) as envs:
        envs.reset(seed=0)
        with pytest.raises(ActionError, match=r"actions for 2 environments; give one for each"):
            envs.step(np.asarray(actions))
        assert [len(env.unwrapped.episode.steps) for env in envs.envs] == [1, 1]


class User:
    """Somebody who uses a pool."""


def test_shared_simulations_end_with_the_last_who_uses_them(grid_plan: tuple[Scenario, EgoPlan]) -> None:
    scenario, plan = grid_plan
    pool, users = SharedPool(), [User(), User()]
    (simulations, leave_first), (others, _) = map(pool.join, users)
    assert simulations is others
    warm = simulations.warm(scenario, 3)
    leave_first()
    leave_first()
    assert simulations.warm(scenario, 3) is warm, "the other still uses it"
    users.clear()  # gone without a word
    with pytest.raises(TrafficError, match="closed"):
        warm.depart(plan)


def test_a_simulation_that_is_held_is_not_ended(grid_plan: tuple[Scenario, EgoPlan]) -> None:
    scenario, plan = grid_plan
    with closing(Simulations(count_limit=1)) as pool:
        with pool.held(scenario, 3) as first:
            pool.warm(scenario, 4)
            first.depart(plan).close()
        with pytest.raises(TrafficError, match="closed"):
            first.depart(plan)


@pytest.fixture(scope="module")
def grid_plan(sumo: None) -> tuple[Scenario, EgoPlan]:
    grid = load("grid")
    return grid, EgoPlan(grid.trip("avenue"))
