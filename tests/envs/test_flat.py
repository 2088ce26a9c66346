"""The flat view: what reinforcement learning sees of an episode."""

import warnings

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from automotive_cosim.contracts.ids import resource_id as shown_id
from automotive_cosim.envs.flat import CONTROLS, ENDS, FlatEnv
from automotive_cosim.errors import ActionError, UnknownNameError, UserError
from automotive_cosim.interface.spaces import APPS

TASKS = ("hvac_fan_max", "hvac_driver_seat_heater")
FIRST_CONTROL = len(APPS)
COMPLETE = len(APPS) + len(CONTROLS)


@pytest.fixture
def flat(simulations):
    made = FlatEnv(TASKS, scenario="grid", simulations=simulations)
    yield made
    made.close()


def tap(resource_id: str) -> int:
    return FIRST_CONTROL + CONTROLS.index(resource_id)


@pytest.mark.sumo
def test_gymnasiums_check_has_nothing_to_say():
    env = gym.make("AutomotiveCosim/Flat-v0", tasks=TASKS, scenario="grid")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env.unwrapped)
    env.close()


def test_stable_baselines_check_has_nothing_to_say(flat):
    checker = pytest.importorskip(
        "stable_baselines3.common.env_checker", reason="the extra rl is not installed", exc_type=ImportError
    )
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        checker.check_env(flat)


def test_stable_baselines_takes_copies_that_share_their_traffic(simulations):
    sb3 = pytest.importorskip("stable_baselines3", reason="the extra rl is not installed", exc_type=ImportError)
    from automotive_cosim.envs.sb3 import vec_env

    envs = vec_env(num_envs=2, tasks=TASKS[:1], scenario="grid", max_steps=3, simulations=simulations)
    envs.seed(0)
    seen = envs.reset()
    alone = FlatEnv(TASKS[:1], scenario="grid", max_steps=3, simulations=simulations)
    assert (seen[1] == alone.reset(seed=1, options={"traffic_seed": 0})[0]).all()
    for _ in range(3):
        seen, _, dones, infos = envs.step(np.array([0, 1]))
        last, *_ = alone.step(np.int64(1))
    assert dones.all()
    assert infos[1]["TimeLimit.truncated"]
    assert (infos[1]["terminal_observation"] == last).all()
    assert not (seen[1] == last).all(), "the next episode has begun"
    alone.close()
    learned = sb3.PPO("MlpPolicy", envs, n_steps=4, batch_size=8, seed=0).learn(8)
    assert learned.num_timesteps == 8
    envs.close()


def test_there_are_at_least_twenty_actions(flat):
    assert flat.action_space.n == len(APPS) + len(CONTROLS) + len(ENDS) >= 20


def test_every_control_is_on_some_screen(simulations):
    env = FlatEnv(TASKS, scenario="grid", max_steps=20, simulations=simulations)
    env.reset(seed=0)
    sighted = set()
    for app in range(len(APPS)):
        env.step(np.int64(app))
        sighted |= {element.resource_id for element in env.episode.observation.elements or ()}
    env.close()
    assert set(map(shown_id, CONTROLS)) <= sighted


def test_the_mask_leaves_what_does_something_on_this_screen(flat):
    _, info = flat.reset(seed=0)
    assert info["action_mask"].shape == (flat.action_space.n,)
    assert not info["action_mask"][tap("hvac.fan.max")]
    *_, info = flat.step(np.int64(APPS.index("climate")))
    assert info["action_mask"][tap("hvac.fan.max")]
    assert info["action_mask"][:FIRST_CONTROL].all()
    assert info["action_mask"][COMPLETE:].all()
    assert (info["action_mask"] == flat.action_masks()).all()


def test_the_right_actions_win_and_the_others_do_not(flat):
    right = {"fan": "hvac.fan.max", "blower": "hvac.fan.max", "seat": "hvac.driver_seat_heating"}
    flat.reset(seed=0)
    for _ in range(6):
        goal = flat.episode.observation.goal.lower()
        control = next(control for word, control in right.items() if word in goal)
        rewards = [flat.step(np.int64(action))[1] for action in (APPS.index("climate"), tap(control))]
        _, reward, terminated, _, info = flat.step(np.int64(COMPLETE))
        assert (rewards, reward, terminated, info["is_success"]) == ([0.0, 0.0], 1.0, True, True)
        flat.reset()
        _, reward, terminated, _, info = flat.step(np.int64(COMPLETE))
        assert (reward, terminated, info["is_success"]) == (0.0, True, False)
        flat.reset()


def test_both_tasks_come_up_and_look_different(flat):
    seen, goals = [], set()
    flat.reset(seed=0)
    for _ in range(12):
        seen.append(flat.reset()[0])
        goals.add(flat.episode.instance.task.id)
    assert goals == set(TASKS)
    assert len({observation.tobytes() for observation in seen}) > 2


def test_the_same_seed_is_the_same_episode(simulations):
    traces = []
    for _ in range(2):
        env = FlatEnv(TASKS, scenario="grid", simulations=simulations)
        seen = [env.reset(seed=3)[0]]
        env.action_space.seed(1)
        seen += [env.step(env.action_space.sample())[0] for _ in range(2)]
        traces.append(np.stack(seen).tobytes())
        env.close()
    assert traces[0] == traces[1]


def test_a_control_out_of_sight_costs_a_second_and_changes_nothing(flat):
    flat.reset(seed=0)
    before = dict(flat.episode.moments[-1].commands)
    flat.step(np.int64(tap("wiper.rear.slow")))
    assert flat.episode.moments[-1].commands == before
    assert flat.episode.observation.time_s == pytest.approx(1.0)


def test_the_bonus_comes_with_the_goal_and_goes_with_it(simulations):
    env = FlatEnv(("hvac_driver_seat_heater",), scenario="grid", goal_bonus=0.5, simulations=simulations)
    env.reset(seed=0)
    env.step(np.int64(APPS.index("climate")))
    taps = [env.step(np.int64(tap("hvac.driver_seat_heating")))[1] for _ in range(3)]
    assert taps == [0.5, 0.0, -0.5]
    env.close()


@pytest.mark.parametrize("action", [-1, 999, 1.0, True, None, "1", np.array([1, 2]), np.nan])
def test_an_action_outside_the_space_is_refused_and_nothing_happens(flat, action):
    flat.reset(seed=0)
    steps = len(flat.episode.steps)
    with pytest.raises(ActionError, match="whole number from 0 to"):
        flat.step(action)
    assert len(flat.episode.steps) == steps


@pytest.mark.parametrize("action", [1, np.int64(1), np.array(1), np.array([1])])
def test_a_number_is_taken_as_policies_return_it(flat, action):
    flat.reset(seed=0)
    flat.step(action)
    assert flat.episode.steps[-1].action == flat._action(1)


@pytest.mark.sumo
def test_it_is_rendered_as_gymnasiums_wrappers_expect(simulations):
    env = FlatEnv("hvac_fan_max", scenario="grid", render_mode="rgb_array", simulations=simulations)
    recorded = gym.wrappers.RenderCollection(env)
    recorded.reset(seed=0)
    recorded.step(0)
    frames = recorded.render()
    assert len(frames) == 2
    assert {frame.shape for frame in frames} == {(720, 1280, 3)}
    recorded.close()


def test_a_render_mode_that_is_not_there_is_told():
    with pytest.raises(UserError, match="no render mode named 'ansi'"):
        FlatEnv("hvac_fan_max", scenario="grid", render_mode="ansi")


@pytest.mark.parametrize(("tasks", "controls"), [((), CONTROLS), (TASKS, ())])
def test_nothing_to_do_is_refused(tasks, controls):
    with pytest.raises(UserError):
        FlatEnv(tasks, controls)


def test_an_unknown_task_is_told():
    with pytest.raises(UnknownNameError, match="hvac_fan_max"):
        FlatEnv(("hvac_fan_mx",))
