"""The environment of drives."""

import warnings

import gymnasium as gym
import pytest
from gymnasium.utils.env_checker import check_env

import automotive_cosim  # noqa: F401, registers the environment
from automotive_cosim.drives.specification import DriveSpec
from automotive_cosim.envs.drive import DriveEnv
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.interface.spaces import decode
from automotive_cosim.traffic.fork import Simulations

WAIT = {"action_type": "wait"}


@pytest.mark.sumo
@pytest.mark.slow
def test_check_env_has_nothing_to_say() -> None:
    env = gym.make("AutomotiveCosim/Drive-v0", family="grid_june", minutes=0.2, render_mode="rgb_array")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env.unwrapped)
    env.close()


def test_a_drive_ends_with_its_score_as_the_reward(simulations: Simulations) -> None:
    env = DriveEnv("grid_june", minutes=0.5, simulations=simulations)
    with pytest.raises(gym.error.ResetNeeded):
        env.step(WAIT)
    seen, info = env.reset(seed=3)
    terminated, reward, steps = False, 0.0, 0
    while not terminated:
        assert (reward, "score" in info) == (0.0, False)
        seen, reward, terminated, truncated, info = env.step(WAIT)
        assert not truncated
        assert env.observation_space.contains(seen)
        steps += 1
    assert info["step"] == steps
    assert reward == info["score"] / 100 == info["result"]["value"] / 100
    assert "speed" in (decode(seen).vehicle.noticed or "")
    assert info["trace_sha256"] == env.episode.trace_sha256
    with pytest.raises(gym.error.ResetNeeded):
        env.step(WAIT)
    env.close()


def test_a_seed_is_a_drive_of_the_family(simulations: Simulations) -> None:
    env = DriveEnv("grid_june", simulations=simulations)
    assert env.reset(seed=4)
    begun = env.episode.trace_sha256
    session = DriveSpec("grid_june", 4).begin(simulations)
    assert session.trace_sha256 == begun
    session.close()
    assert env.reset()
    assert env.episode.trace_sha256 != begun
    env.close()


@pytest.mark.parametrize(
    ("options", "named"),
    [({"family": "grid_jun"}, "grid_june"), ({"minutes": 0.0}, "minutes"), ({"geo": "moon"}, "moon")],
)
def test_what_is_no_drive_is_refused_by_name(options: dict[str, object], named: str) -> None:
    with pytest.raises(UserError, match=named):
        DriveEnv(**options)


def test_there_is_one_render_mode() -> None:
    with pytest.raises(UnknownNameError, match="rgb_array"):
        DriveEnv(render_mode="human")
