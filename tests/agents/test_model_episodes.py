"""Whole episodes with a model: recorded, replayed, stopped, and failed."""

import json
from dataclasses import replace

import pytest

from automotive_cosim.agents import AgentSettings, ModelAgent, make_agent
from automotive_cosim.agents.settings import ASURADA, T3A
from automotive_cosim.envs.cockpit import CockpitEnv
from automotive_cosim.episode.specification import End
from automotive_cosim.errors import ModelError
from automotive_cosim.geo.earth import METRES_PER_DEGREE
from automotive_cosim.geo.gps import Gps
from automotive_cosim.interface import trace
from automotive_cosim.models import ModelReply, make_model
from automotive_cosim.run.episode import EpisodeSetup, estimates
from automotive_cosim.run.record import Recorder
from automotive_cosim.run.trial import run_trial
from automotive_cosim.tasking.sets import Suite

QUICK = EpisodeSetup(task="hvac_fan_max", scenario="grid")


class Says:
    """A model that says one thing for ever, or raises."""

    name, sees_pictures = "says", True

    def __init__(self, text: str | Exception) -> None:
        self._text = text

    def chat(self, messages) -> ModelReply:
        if isinstance(self._text, Exception):
            raise self._text
        return ModelReply(self._text, 1000, 10, 0.5, 1.5)


def _run(simulations, agent, folder=None):
    watchers = [Recorder(QUICK, folder, whole=True)] if folder else []
    return run_trial(QUICK, agent, watchers, simulations=simulations)


def _lines(folder) -> list[dict]:
    return [json.loads(line) for line in (folder / "steps.jsonl").read_text(encoding="utf-8").splitlines()]


@pytest.mark.parametrize("model", ["rules", "pictures"])
def test_a_recorded_episode_replays_to_the_same_trace(simulations, tmp_path, model):
    chat_model = make_model("rules")
    if model == "pictures":
        chat_model.sees_pictures = True
    first = _run(simulations, ModelAgent(ASURADA, chat_model), tmp_path / "first")
    again = _run(simulations, make_agent("asurada", f"replay/{tmp_path / 'first'}"), tmp_path / "again")
    assert first.success
    assert first.trace_sha256 == again.trace_sha256
    assert (tmp_path / "first" / "steps.jsonl").read_bytes() == (tmp_path / "again" / "steps.jsonl").read_bytes()
    assert replace(first, agent="", model="") == replace(again, agent="", model="")


def test_a_replay_of_another_episode_is_an_error_and_no_failure(simulations, tmp_path):
    _run(simulations, make_agent("asurada"), tmp_path / "first")
    result = _run(simulations, make_agent("t3a", f"replay/{tmp_path / 'first'}"))
    assert result.end is End.ERROR
    assert result.success is None
    assert "question 1 differs" in (result.error or "")


def test_stages_stand_in_the_record_and_outside_the_hash(simulations, tmp_path):
    result = _run(simulations, make_agent("t3a"), tmp_path / "out")
    lines = _lines(tmp_path / "out")
    names = [[stage["stage"] for stage in line["stages"]] for line in lines]
    cycle = ["perceive", "interpret", "plan", "act"]
    assert names == [[], cycle, *[["remember", *cycle]] * (result.steps - 1)]
    told = [stage["reply"] for line in lines for stage in line["stages"] if stage["reply"]]
    assert result.tokens_in == sum(reply["tokens_in"] for reply in told)
    bare = [{name: value for name, value in line.items() if name != "stages"} for line in lines]
    assert trace.sha256(bare) == trace.sha256(lines) == result.trace_sha256


def test_costs_add_up(simulations):
    result = _run(simulations, ModelAgent(T3A, Says('Action: {"action_type": "wait"}')))
    assert result.end is End.OUT_OF_STEPS
    asked = result.steps  # a lesson is asked for after an act that failed
    assert (result.tokens_in, result.tokens_out) == (1000 * asked, 10 * asked)
    assert result.cost_usd == pytest.approx(0.5 * asked)
    assert result.model_seconds == pytest.approx(1.5 * asked)


def test_a_runaway_is_stopped_and_judged_as_it_stands(simulations, tmp_path):
    agent = ModelAgent(T3A, Says('Action: {"action_type": "wait"}'), AgentSettings(most_tokens=3000))
    result = _run(simulations, agent, tmp_path / "out")
    assert result.end is End.OUT_OF_BUDGET
    assert result.success is False
    assert result.tokens_in <= 4000
    assert len(_lines(tmp_path / "out")) == result.steps + 1


def test_a_model_out_of_reach_is_an_error_and_no_failure(simulations):
    result = _run(simulations, ModelAgent(T3A, Says(ModelError("no answer"))))
    assert (result.end, result.success, result.error) == (End.ERROR, None, "no answer")


@pytest.mark.parametrize("text", ["", "I will not.", "Action: {", 'Action: {"action_type": "query", "text": "x"}'])
def test_unreadable_answers_are_recorded_steps(simulations, tmp_path, text):
    result = _run(simulations, ModelAgent(T3A, Says(text)), tmp_path / "out")
    lines = _lines(tmp_path / "out")[1:]
    assert result.steps == Suite.STANDARD.max_steps == len(lines)
    for line in lines:
        assert line["action"] is None
        assert line["feedback"]["code"] == "malformed"
        assert line["feedback"]["text"] == line["stages"][-1]["text"]


# --- position without GPS ---------------------------------------------------------------------------------------


@pytest.fixture
def tunnel(monkeypatch):
    """GPS is lost after the second second, wherever the car is."""
    read = Gps.read

    def lost(self, driving, dt_s):
        fix = read(self, driving, dt_s)
        self.seconds = getattr(self, "seconds", 0.0) + dt_s
        if self.seconds <= 2:
            self.last = fix
            return fix
        return replace(self.last, has_fix=False, age_s=self.seconds - 2)

    monkeypatch.setattr(Gps, "read", lost)


def test_estimates_are_scored_beside_dead_reckoning(simulations, tunnel):
    env = CockpitEnv("hvac_fan_max", scenario="grid", simulations=simulations)
    env.reset(seed=0)
    assert not env.episode.observation.gps.has_fix
    for north_m in (0.0, 40.0):
        truth = env.episode.moments[-1].driving
        text = f"{truth.lon_deg:.8f},{truth.lat_deg + north_m / METRES_PER_DEGREE:.8f}"
        env.step({"action_type": "estimate_position", "text": text})
        assert env.episode.observation.feedback.code == "ok"
    env.step({"action_type": "estimate_position", "text": "somewhere"})
    assert env.episode.observation.feedback.code == "refused"
    found = estimates(env.episode.steps, [*env.episode.drive, *env.episode.moments[1:]])
    env.close()
    assert [round(estimate.error_m, 1) for estimate in found] == [0.0, 40.0]
    assert all(0 < estimate.dead_reckoning_error_m < 60 for estimate in found)
    assert found[1].age_s == pytest.approx(found[0].age_s + 1)


def test_estimates_with_gps_at_work_do_not_count(simulations):
    env = CockpitEnv("hvac_fan_max", scenario="grid", simulations=simulations)
    env.reset(seed=0)
    env.step({"action_type": "estimate_position", "text": "0,0"})
    assert estimates(env.episode.steps, [*env.episode.drive, *env.episode.moments[1:]]) == ()
    env.close()


@pytest.mark.parametrize("text", ["181,0", "0,91", "1", "1,2,3", "a,b", "nan,0", "", "inf,0"])
def test_what_is_no_position_is_refused(simulations, text):
    env = CockpitEnv("hvac_fan_max", scenario="grid", simulations=simulations)
    env.reset(seed=0)
    env.step({"action_type": "estimate_position", "text": text})
    assert env.episode.observation.feedback.code == "refused"
    env.close()
