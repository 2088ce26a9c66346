"""Several cars in one traffic: a fleet of one is the environment alone, and PettingZoo has nothing to say."""

import os
import signal
import warnings
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from automotive_cosim.agents.cleanup import children
from automotive_cosim.envs.drive import DriveEnv, DrivesEnv
from automotive_cosim.envs.flat_drive import ACTIONS
from automotive_cosim.errors import ActionError, TrafficError, UserError
from automotive_cosim.traffic.fork import Simulations

pettingzoo = pytest.importorskip("pettingzoo", reason="the extra rl is not installed")

from pettingzoo.test import parallel_api_test, parallel_seed_test  # noqa: E402

from automotive_cosim.envs.fleet import FleetEnv, FleetVectorEnv  # noqa: E402

pytestmark = pytest.mark.sumo

WAIT = {"action_type": "wait", "seconds": 2}
ALERT = {"action_type": "show_alert", "kind": "speed", "severity": "warning"}
CALM: dict[str, Any] = {"channels": ("vehicle", "context")}


@pytest.mark.parametrize("place", ["grid_june", "london_november", "gulf_july"])
def test_a_fleet_of_one_is_the_environment_alone(simulations: Simulations, place: str) -> None:
    alone: DrivesEnv[Any, Any] = DriveEnv(place, minutes=0.3, simulations=simulations, **CALM)
    fleet = FleetEnv(1, family=place, minutes=0.3, simulations=simulations, **CALM)
    seen, info = alone.reset(seed=2)
    all_seen, infos = fleet.reset(seed=2)
    np.testing.assert_equal((all_seen, infos), ({"car_0": seen}, {"car_0": info}))
    for action in (ALERT, WAIT, WAIT, ALERT, *[{"action_type": "wait"}] * 20):
        mine, ours = alone.step(action), fleet.step({"car_0": action})
        np.testing.assert_equal([each["car_0"] for each in ours], list(mine))
        if mine[2]:
            break
    assert alone.episode.trace_sha256 == fleet.envs["car_0"].episode.trace_sha256 == mine[4]["trace_sha256"]
    assert fleet.agents == []
    alone.close()
    fleet.close()


def test_an_action_that_takes_longer_leaves_a_car_busy(simulations: Simulations) -> None:
    fleet = FleetEnv(2, family="grid_june", minutes=1.0, simulations=simulations, **CALM)
    fleet.reset(seed=3)
    while len(fleet.agents) < 2:
        fleet.step({"car_0": {"action_type": "wait", "seconds": 1}})
    told = fleet.step({"car_0": {"action_type": "wait", "seconds": 3}, "car_1": ALERT})
    assert told[4]["car_0"]["busy"]
    assert "busy" not in told[4]["car_1"]
    told = fleet.step({"car_1": ALERT})
    assert told[4]["car_0"]["busy"]
    told = fleet.step({"car_1": ALERT})
    times = {car: env.episode.world.moment.time_s for car, env in fleet.envs.items()}
    assert "busy" not in told[4]["car_0"]
    assert times["car_0"] == pytest.approx(times["car_1"])
    with pytest.raises(ActionError, match="car_1"):
        fleet.step({"car_0": WAIT})
    fleet.close()


def make(cars: int = 3) -> FleetEnv:
    return FleetEnv(cars, flat=True, lean=True, minutes=0.2)


@pytest.mark.slow
def test_pettingzoo_has_nothing_to_say() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        parallel_api_test(make(), num_cycles=40)
        parallel_seed_test(make, num_cycles=10)
    assert isinstance(pettingzoo.make("parallel", "AutomotiveCosim/Fleet-v0", cars=1), FleetEnv)


def test_the_same_seed_is_the_same_fleet(simulations: Simulations) -> None:
    """PettingZoo's own test of seeds ends with the first step, whatever it is told."""
    told = []
    for _ in range(2):
        fleet = FleetEnv(3, flat=True, lean=True, minutes=0.3, simulations=simulations)
        draws, seen = np.random.default_rng(1), [fleet.reset(seed=7)]
        while fleet.agents:
            seen.append(fleet.step({car: draws.integers(len(ACTIONS)) for car in fleet.agents}))  # type: ignore[arg-type]
        told.append(seen)
        fleet.close()
    np.testing.assert_equal(*told)
    assert {car for step in told[0][1:] for car in step[0]} == {"car_0", "car_1", "car_2"}


def test_one_policy_sees_all_cars_in_a_vector(simulations: Simulations) -> None:
    envs = gym.make_vec("AutomotiveCosim/Fleet-v0", 3, minutes=0.2, lean=True, simulations=simulations)
    seen, _ = envs.reset(seed=4)
    assert envs.observation_space.contains(seen)
    ended = np.zeros(3, int)
    while not ended.all():
        seen, rewards, terminated, truncated, info = envs.step(np.ones(3, np.int64))
        assert envs.observation_space.contains(seen)
        assert not rewards[~info["acted"]].any()
        ended += terminated | truncated
    assert ended.tolist() == [1, 1, 1]
    assert not (info["final_obs"] == seen).all()
    envs.close()


def test_cars_in_two_processes_are_told_the_same_as_in_one(simulations: Simulations) -> None:
    """They act, too: requests, and what do-nothing copies hear of the others', have an order."""
    told = []
    for apart in (False, True):
        envs = FleetVectorEnv(5, minutes=0.5, lean=True, simulations=simulations)
        envs.fleet.away = frozenset({"car_2", "car_4"}) if apart else frozenset()
        draws, seen = np.random.default_rng(3), [envs.reset(seed=8)]
        while "final_obs" not in seen[-1][-1]:
            actions = np.where(draws.random(5) < 0.3, draws.integers(len(ACTIONS), size=5), 1)
            seen.append(envs.step(actions))  # type: ignore[arg-type]
        told.append(seen)
        envs.close()
    np.testing.assert_equal(*told)


def test_a_fleet_whose_second_process_dies_says_so_and_departs_anew(simulations: Simulations) -> None:
    envs = FleetVectorEnv(2, minutes=0.3, lean=True, simulations=simulations)
    envs.fleet.away = frozenset()
    envs.reset(seed=8)
    before = set(children())
    envs.fleet.away = frozenset({"car_1"})
    envs.reset(seed=8)
    (copy,) = set(children()) - before
    os.kill(copy, signal.SIGKILL)
    with pytest.raises(TrafficError, match="half of the fleet's cockpits ended; reset the fleet"):
        envs.step(np.ones(2, np.int64))
    envs.reset(seed=8)
    envs.step(np.ones(2, np.int64))
    envs.close()


def test_what_is_no_fleet_is_refused() -> None:
    for cars in (0, -3, 2.5, "3"):
        with pytest.raises(UserError, match=f"of '?{cars}'? cars"):
            FleetEnv(cars)  # type: ignore[arg-type]
