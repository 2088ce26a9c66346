"""The flat view of drives: what reinforcement learning sees of a drive."""

import warnings
from contextlib import closing
from types import SimpleNamespace

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from automotive_cosim.contracts import Action, ActionType, AlertKind
from automotive_cosim.drives.score import LEAST_WORTH, score
from automotive_cosim.drives.watchers import RulePerfect
from automotive_cosim.envs.drive import DriveEnv
from automotive_cosim.envs.flat_drive import (
    ACTIONS,
    CHANNELS,
    FEATURES,
    READINGS,
    SIGNS,
    SOON,
    DriveNumbers,
    FlatDriveEnv,
)
from automotive_cosim.episode.specification import SessionSetup
from automotive_cosim.errors import ActionError, UnknownNameError, UserError
from automotive_cosim.interface.observe import Channel

SEED, MINUTES = 0, 3
"""A drive of which three minutes hold an event."""
CAR = {
    "leader_gap_m": None,
    "leader_time_to_collision_s": None,
    "is_low_beam_on": True,
    "is_high_beam_on": False,
    "is_front_fog_on": False,
    "is_rear_fog_on": False,
    "aboard": "driver: adult, 75 kg, awake, belted",
}


@pytest.fixture
def flat(simulations):
    made = FlatDriveEnv("grid_june", minutes=MINUTES, simulations=simulations)
    yield made
    made.close()


@pytest.fixture(scope="module")
def ruled(simulations):
    """A drive by the rules: its actions, observations, rewards, last ``info``, and episode."""
    with closing(FlatDriveEnv("grid_june", minutes=MINUTES, simulations=simulations)) as env:
        yield *played(env, rules(env)), env.episode


def played(env, choose):
    """Actions, observations and rewards of the drive of the seed, and the last ``info``."""
    seen, _ = env.reset(seed=SEED)
    actions, views, rewards, over, info = [], [seen], [], False, {}
    while not over:
        assert info == {}
        actions.append(choose())
        seen, reward, terminated, truncated, info = env.step(np.int64(actions[-1]))
        assert not truncated
        assert env.observation_space.contains(seen)
        views.append(seen)
        rewards.append(reward)
        over = terminated
    return actions, views, rewards, info


def rules(env):
    watcher = RulePerfect()

    def choose():
        assert env.episode.judged_so_far() == env.episode._judged(), "what is kept is what would be judged now"
        number = env.number(watcher.act(env.episode.observation))
        return SOON if number is None else number

    return choose


@pytest.mark.sumo
def test_gymnasiums_check_has_nothing_to_say():
    env = gym.make("AutomotiveCosim/FlatDrive-v0", families="grid_june", minutes=0.2)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env.unwrapped, skip_render_check=True)
    env.close()


def test_who_waits_earns_nothing(flat):
    _, _, rewards, info = played(flat, lambda: 0)
    assert set(rewards) == {0.0}
    assert info["score"] == 0


def test_the_rules_score_high_and_the_rewards_sum_to_the_judges_utility(ruled):
    actions, views, rewards, info, episode = ruled
    judged = score(episode.judgement, episode.seconds)
    assert sum(rewards) == pytest.approx(judged.utility / (2 * LEAST_WORTH))
    assert judged.events >= 1
    assert info["score"] == judged.value >= 90
    alerts = [number for number in actions if ACTIONS[number].kind is not None]
    assert alerts
    shown = len(AlertKind)
    assert (views[0][-shown:] == 1).all()
    assert not (views[-1][-shown:] == 1).all()
    assert len({view.tobytes() for view in views}) > len(views) / 2


def test_the_same_acts_give_the_trace_of_the_drive(flat, ruled, simulations):
    actions, _, _, info, _ = ruled
    again = played(flat, iter(actions).__next__)
    assert again[3] == info
    env = DriveEnv("grid_june", minutes=MINUTES, channels=CHANNELS, simulations=simulations)
    env.reset(seed=SEED)
    told = {}
    for number in actions:
        *_, told = env.step(ACTIONS[number])
    assert (told["trace_sha256"], told["score"]) == (flat.episode.trace_sha256, info["score"])
    env.close()


def test_a_lean_drive_has_no_screen_and_coarse_traffic_and_the_same_worth(simulations):
    env = FlatDriveEnv("grid_june", minutes=MINUTES, lean=True, simulations=simulations)
    actions, views, rewards, info = played(env, rules(env))
    session = env.episode
    judged = score(session.judgement, session.seconds)
    assert info == {"score": judged.value}
    assert judged.value >= 90
    assert sum(rewards) == pytest.approx(judged.utility / (2 * LEAST_WORTH))
    assert {step.elements for step in session.steps} == {()}
    assert session.observation.elements is None
    assert {len(moment.passed) for moment in session.moments[1:]} == {1}
    trace = session.trace_sha256
    again = played(env, iter(actions).__next__)
    assert np.array_equal(again[1], views)
    assert env.episode.trace_sha256 == trace
    env.close()


@pytest.mark.slow
@pytest.mark.sumo
def test_lean_drives_in_processes_of_their_own_are_what_they_are_alone(simulations):
    options = {"families": "grid_june", "minutes": 1.0, "lean": True}
    envs = gym.make_vec("AutomotiveCosim/FlatDrive-v0", num_envs=2, vectorization_mode="async", **options)
    acts = np.random.default_rng(0).integers(1, len(ACTIONS), size=(8, 2))
    begun, _ = envs.reset(seed=[3, 4])
    together = [begun, *(envs.step(each)[0] for each in acts)]
    envs.close()
    for number, seed in enumerate((3, 4)):
        with closing(FlatDriveEnv(**options, simulations=simulations)) as env:
            alone = [env.reset(seed=seed)[0], *(env.step(each[number])[0] for each in acts)]
        assert np.array_equal(alone, [views[number] for views in together])


def test_a_lean_session_has_no_screen_to_see():
    with pytest.raises(UserError, match="a lean session has no screen"):
        SessionSetup(frozenset({Channel.ELEMENTS}), lean=True)


def test_what_disturbs_costs_at_once(flat):
    flat.reset(seed=SEED)
    fatigue = flat.number(Action(ActionType.SHOW_ALERT, kind=AlertKind.FATIGUE))
    assert [flat.step(np.int64(fatigue))[1] < 0 for _ in range(2)] == [True, True]


def test_an_alert_and_the_speed_are_seen(flat):
    seen, _ = flat.reset(seed=SEED)
    speed = list(FEATURES).index("speed")
    slower = seen[speed]
    tunnel = ACTIONS.index(Action(ActionType.SHOW_ALERT, kind=AlertKind.TUNNEL))
    seen, *_ = flat.step(np.int64(tunnel))
    lately = list(AlertKind).index(AlertKind.TUNNEL) - len(AlertKind)
    assert 0 <= seen[lately] < 0.3
    assert [flat.step(np.int64(SOON))[0][speed] for _ in range(3)] != [slower] * 3
    memory = len(AlertKind) + 2 * len(SIGNS)
    assert set(seen[-memory - len(READINGS) : -memory]) <= {0.0, 1.0}


def test_it_remembers_since_when_a_sign_is_there_and_whether_it_was_told_of():
    numbers, at = DriveNumbers(), list(SIGNS).index("above the limit")

    def read(time_s, kmh, limit):
        context = f"Speed limit here: {limit} km/h (posted on a sign)"
        car = SimpleNamespace(speed_kmh=kmh, noticed="", **CAR)
        seen = numbers.read(SimpleNamespace(time_s=time_s, vehicle=car, context=context))
        memory = seen[-len(AlertKind) - 2 * len(SIGNS) :]
        return float(memory[at]), float(memory[len(SIGNS) + at])

    assert read(0, 52, 50) == (0, 0)
    assert read(2, 60, 50) == (0, 1)
    age, untold = read(6, 60, 50)
    assert age == pytest.approx(np.log1p(4) / np.log(601))
    assert untold == 1
    numbers.show(AlertKind.DISTANCE, 6)
    assert read(7, 60, 50)[1] == 1
    numbers.show(AlertKind.SPEED, 7)
    assert read(8, 60, 50)[1] == 0
    assert read(10, 49, 50) == (0, 0)
    assert read(20, 60, 50) == (0, 0)
    assert read(22, 60, 40)[1] == 1
    numbers.show(AlertKind.SPEED, 22)
    assert read(24, 30, 40) == (0, 0)
    assert read(60, 60, 40) == (0, 1)


def test_waits_have_the_nearest_number_and_others_none(flat):
    waits = [Action(ActionType.WAIT), Action(ActionType.WAIT, seconds=1), Action(ActionType.WAIT, seconds=2)]
    assert [flat.number(wait) for wait in waits] == [0, SOON, SOON]
    assert flat.number(Action(ActionType.ANSWER, text="mph here")) is None


@pytest.mark.parametrize("action", [-1, 999, 1.0, True, None, "1", np.array([1, 2]), np.nan])
def test_an_action_outside_the_space_is_refused_and_nothing_happens(flat, action):
    flat.reset(seed=SEED)
    steps = len(flat.episode.steps)
    with pytest.raises(ActionError, match=f"whole number from 0 to {len(ACTIONS) - 1}"):
        flat.step(action)
    assert len(flat.episode.steps) == steps


def test_families_are_drawn_and_a_seed_is_one_drive(simulations):
    env = FlatDriveEnv(["grid_june", "grid_january"], simulations=simulations)
    begun = [(env.reset(seed=seed), env.episode.trace_sha256)[1] for seed in (0, 1, 2, 0)]
    assert begun[0] == begun[3]
    assert len(set(begun)) == 3
    single = FlatDriveEnv("grid_june", simulations=simulations)
    winter = [float(env.reset(seed=seed)[0][list(FEATURES).index("sun")]) for seed in range(4)]
    summer = [float(single.reset(seed=seed)[0][list(FEATURES).index("sun")]) for seed in range(4)]
    assert 0 < sum(one == other for one, other in zip(winter, summer, strict=True)) < 4
    env.close()
    single.close()


@pytest.mark.parametrize(
    ("options", "error", "named"),
    [
        ({"families": ()}, UserError, "at least one family"),
        ({"families": ("grid_june", "grid_jun")}, UnknownNameError, "grid_june"),
        ({"minutes": 0.0}, UserError, "minutes"),
        ({"render_mode": "ansi"}, UserError, "no render mode named 'ansi'"),
    ],
)
def test_what_is_no_drive_is_refused_by_name(options, error, named):
    with pytest.raises(error, match=named):
        FlatDriveEnv(**options)
