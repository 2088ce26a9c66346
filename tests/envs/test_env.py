"""The environment as gymnasium's users know it."""

import warnings

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env, data_equivalence

import automotive_cosim  # noqa: F401, registers the environment
from automotive_cosim.contracts import ActionType, FeedbackCode, GoalStatus, Observation
from automotive_cosim.envs.cockpit import CockpitEnv
from automotive_cosim.errors import ActionError, ScenarioError, UnknownNameError
from automotive_cosim.interface.spaces import decode
from automotive_cosim.voice.engines import as_wav

ID = "AutomotiveCosim/Cockpit-v0"
QUICK = {"task": "hvac_fan_max", "scenario": "grid"}


@pytest.fixture
def env(simulations):
    made = CockpitEnv(**QUICK, simulations=simulations)
    yield made
    made.close()


@pytest.mark.sumo
def test_check_env_has_nothing_to_say():
    env = gym.make(ID, **QUICK, render_mode="rgb_array")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env.unwrapped)
    env.close()


def test_the_checker_has_nothing_to_say_of_sound_either(simulations, monkeypatch):
    wav = as_wav(np.sin(np.arange(8000) / 9).astype(np.float32))
    monkeypatch.setattr("automotive_cosim.episode.specification.is_installed", lambda: True)
    monkeypatch.setattr("automotive_cosim.episode.session.sounding", lambda text, snr_db: wav)
    env = CockpitEnv(**QUICK, simulations=simulations, hear="audio")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env, skip_render_check=True)
    encoded, _ = env.reset(seed=0)
    assert (encoded["sound"]["count"], encoded["sound"]["length"]) == (1, 8000)
    encoded = env.step({"action_type": "ask_driver", "text": "Pardon?"})[0]
    assert (encoded["sound"]["count"], encoded["sound"]["length"]) == (2, 16000)
    env.close()


def test_the_default_task_can_be_made():
    env = gym.make(ID)
    assert env.spec is not None
    assert env.unwrapped.scenario.name == "paris_centre"
    env.close()


def test_same_seed_same_trace(simulations):
    hashes, observations = [], []
    for _ in range(2):
        env = CockpitEnv(**QUICK, simulations=simulations)
        seen = [env.reset(seed=5)[0]]
        seen.append(env.step({"action_type": "open_app", "app_name": "climate"})[0])
        encoded, _, terminated, _, info = env.step({"action_type": "status", "goal_status": "complete"})
        assert terminated
        hashes.append(info["trace_sha256"])
        observations.append([*seen, encoded])
        env.close()
    assert hashes[0] == hashes[1]
    assert all(data_equivalence(a, b) for a, b in zip(*observations, strict=True))


def test_another_seed_is_another_drive(simulations):
    starts = set()
    for seed in range(3):
        env = CockpitEnv(**QUICK, simulations=simulations)
        env.reset(seed=seed)
        starts.add(
            (
                env.episode.moments[0].driving.x_m,
                env.episode.moments[0].driving.y_m,
                env.episode.moments[0].driving.vehicle_count,
            )
        )
        env.close()
    assert len(starts) == 3


def test_reset_without_a_seed_keeps_the_traffic_and_draws_anew(env):
    env.reset(seed=1)
    goals = {env.reset()[0]["goal"].tobytes() for _ in range(8)}
    assert len(goals) > 1


def test_an_action_costs_its_time(env):
    env.reset(seed=0)
    before_s = env.episode.observation.time_s
    env.step({"action_type": "navigate_home"})
    assert env.episode.observation.time_s == pytest.approx(before_s + 1.0)
    env.step({"action_type": "wait", "seconds": 4})
    assert env.episode.observation.time_s == pytest.approx(before_s + 5.0)


def test_a_malformed_action_happens_not(env):
    env.reset(seed=0)
    for wrong in ("{", "[]", {"action_type": "click"}, {"action_type": "click", "index": 1, "x": 2, "y": 3}):
        with pytest.raises(ActionError):
            env.step(wrong)
    assert env.episode.observation.time_s == 0
    assert len(env.episode.steps) == 1


def test_a_refused_answer_counts_as_a_step(env):
    env.reset(seed=0)
    env.episode.refuse("no JSON in the answer")
    assert env.episode.observation.feedback.code is FeedbackCode.MALFORMED
    assert env.episode.observation.time_s == pytest.approx(1.0)


def test_wrong_actions_cost_time_and_break_nothing(env):
    env.reset(seed=0)
    before = dict(env.episode.moments[-1].commands)
    for action in (
        {"action_type": "click", "index": 9999},
        {"action_type": "click", "x": 1279, "y": 1},
        {"action_type": "input_text", "index": 0, "text": "x"},
        {"action_type": "open_app", "app_name": "no such app"},
        {"action_type": "scroll", "direction": "down", "index": 0},
    ):
        _, reward, terminated, truncated, info = env.step(action)
        assert (reward, terminated, truncated) == (0.0, False, False)
        assert info["action_result"] != "ok"
    assert env.episode.moments[-1].commands == before


def test_withheld_channels_are_absent(simulations):
    env = CockpitEnv(**QUICK, channels=("elements", "vehicle"), simulations=simulations)
    encoded, _ = env.reset(seed=0)
    assert set(encoded) == {"goal", "said", "time_s", "feedback", "elements", "vehicle"}
    assert env.episode.observation.context is None
    assert env.episode.observation.gps is None
    encoded = env.step({"action_type": "query", "text": "weather"})[0]
    assert env.episode.observation.feedback.code is FeedbackCode.REFUSED
    env.close()


def test_what_is_decoded_is_what_was_seen(env):
    encoded, _ = env.reset(seed=0)
    back, seen = decode(encoded), env.episode.observation
    assert isinstance(seen, Observation)
    assert (back.goal, back.context, back.feedback) == (seen.goal, seen.context, seen.feedback)
    assert np.array_equal(back.screenshot, seen.screenshot)
    assert len(back.elements) == len(seen.elements)


def test_nothing_tells_the_answer_before_the_end(env):
    _, info = env.reset(seed=0)
    _, _, _, _, later = env.step({"action_type": "navigate_home"})
    assert set(info) == set(later) == {"step", "action_result", "events"}
    _, _, _, _, last = env.step({"action_type": "status", "goal_status": "infeasible"})
    assert {"verdict", "trace_sha256"} <= set(last)


def test_it_is_cut_off_after_its_steps(simulations):
    env = CockpitEnv(**QUICK, max_steps=3, simulations=simulations)
    env.reset(seed=0)
    ends = [env.step({"action_type": "wait"})[2:4] for _ in range(3)]
    assert ends == [(False, False), (False, False), (False, True)]
    assert env.episode.verdict is not None
    assert not env.episode.verdict.declared.ok
    with pytest.raises(gym.error.ResetNeeded):
        env.step({"action_type": "wait"})
    env.close()


def test_step_before_reset_is_refused(simulations):
    env = CockpitEnv(**QUICK, simulations=simulations)
    with pytest.raises(gym.error.ResetNeeded):
        env.step({"action_type": "wait"})


def test_every_sampled_action_is_taken(env):
    env.reset(seed=0)
    env.action_space.seed(0)
    for _ in range(60):
        _, _, terminated, truncated, _ = env.step(env.action_space.sample())
        if terminated or truncated:
            env.reset()


def test_unknown_names_are_told(simulations):
    with pytest.raises(UnknownNameError, match="hvac_fan_max"):
        CockpitEnv("hvac_fan_mx", simulations=simulations)
    with pytest.raises(UnknownNameError, match="grid"):
        CockpitEnv("hvac_fan_max", scenario="gird", simulations=simulations)
    with pytest.raises(UnknownNameError, match="first"):
        CockpitEnv("hvac_fan_max", "second", simulations=simulations)
    with pytest.raises((UnknownNameError, ScenarioError)):
        CockpitEnv("hvac_fan_max", scenario="/nowhere", simulations=simulations)


def test_declared_status_is_what_is_judged(env):
    env.reset(seed=0)
    env.step({"action_type": "status", "goal_status": "infeasible", "reason": "safety"})
    assert env.episode.verdict is not None
    assert not env.episode.verdict.success
    assert env.episode.steps[-1].action.action_type is ActionType.STATUS
    assert env.episode.steps[-1].action.goal_status is GoalStatus.INFEASIBLE


def test_any_seed_and_any_odd_action_is_answered(env):
    env.reset(seed=2**40)
    env.reset()
    for odd in ({}, {"action_type": None}, '{"action_type": "click", "index": ' + "9" * 5000 + "}"):
        with pytest.raises(ActionError):
            env.step(odd)
