"""Queries in an episode: each stands in the trace with its answer, and its time passes."""

import itertools
import json
from collections.abc import Iterator

import pytest

from automotive_cosim import geo
from automotive_cosim.contracts import FeedbackCode
from automotive_cosim.envs.cockpit import CockpitEnv
from automotive_cosim.geo import sensor
from automotive_cosim.traffic.fork import Simulations


@pytest.fixture(scope="module")
def env(simulations: Simulations) -> Iterator[CockpitEnv]:
    made = CockpitEnv(task="hvac_fan_max", scenario="border", max_steps=30, simulations=simulations)
    yield made
    made.close()


@pytest.fixture(scope="module")
def asked(env: CockpitEnv) -> CockpitEnv:
    env.reset(seed=0)
    for query in ("weather", "horn", "nonsense"):
        env.step({"action_type": "query", "text": query})
    return env


def test_each_query_is_in_the_trace_with_its_answer(asked: CockpitEnv) -> None:
    lines = [json.loads(json.dumps(step.as_json())) for step in asked.episode.steps[1:]]
    assert [line["action"]["text"] for line in lines] == ["weather", "horn", "nonsense"]
    assert [line["feedback"]["code"] for line in lines] == ["ok", "ok", "refused"]
    assert "Weather: snow" in lines[0]["feedback"]["text"]
    assert lines[1]["feedback"]["text"].startswith("Horn: not from 23:30")


def test_its_time_passes_on_top_of_the_actions(asked: CockpitEnv) -> None:
    times = [step.moment.time_s for step in asked.episode.steps]
    took = [after - before for before, after in itertools.pairwise(times)]
    assert took == pytest.approx(
        [1.0 + sensor.OVER_THE_AIR_S["4g"], 1.0 + sensor.ON_BOARD_S, 1.0 + sensor.ON_BOARD_S]
    )


def test_an_agent_without_the_context_cannot_ask(simulations: Simulations) -> None:
    blind = CockpitEnv(task="hvac_fan_max", scenario="border", channels=("elements",), simulations=simulations)
    blind.reset(seed=0)
    blind.step({"action_type": "query", "text": "weather"})
    assert blind.episode.observation.feedback.code is FeedbackCode.REFUSED
    blind.close()


def test_the_moments_of_an_episode_are_what_judges_check(asked: CockpitEnv) -> None:
    assert isinstance(geo.violations([*asked.episode.drive, *asked.episode.moments]), tuple)
