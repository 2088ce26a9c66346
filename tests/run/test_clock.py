"""What an answer takes passes on the road, is recorded, and is repeated exactly."""

import json
from dataclasses import replace

import pytest

from automotive_cosim.agents import make_agent
from automotive_cosim.agents.base import Stage, StageName
from automotive_cosim.contracts.given import Clock
from automotive_cosim.models import ModelReply
from automotive_cosim.report.findings import by_condition
from automotive_cosim.report.results import Results, contestant
from automotive_cosim.run.coverage import Coverage
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.rerun import Player, compare
from automotive_cosim.tasks import CATALOGUE

DEADLINE_S = CATALOGUE["hvac_fan_max"].half("first").deadline.seconds


class Slow:
    """The oracle, with a model that takes its time."""

    def __init__(self, seconds):
        self._oracle = make_agent("oracle")
        self.name, self.model, self.channels = "slow", "none", self._oracle.channels
        self._seconds = iter(seconds)
        self.stages = []

    def reset(self, goal):
        self._oracle.reset(goal)

    def brief(self, instance, *, drawn, branch):
        self._oracle.brief(instance, drawn=drawn, branch=branch)

    def act(self, observation):
        reply = ModelReply("", seconds=next(self._seconds, 0.0))
        self.stages = [Stage(StageName.ACT, "", observation.time_s, reply)]
        return self._oracle.act(observation)


def _lines(episode):
    text = (episode.folder / "steps.jsonl").read_text(encoding="utf-8")
    return [json.loads(line) for line in text.splitlines()]


def test_a_latency_passes_before_each_action(run):
    quick, slow = run("oracle"), run("oracle", out="slow", latency_s=3.0)
    assert slow.result.steps == quick.result.steps
    assert slow.result.sim_seconds == quick.result.sim_seconds + 3.0 * quick.result.steps
    assert [line["thought_s"] for line in _lines(slow)] == [0.0] + [3.0] * slow.result.steps
    assert slow.result.success


def test_the_models_seconds_pass_only_by_the_models_clock(run):
    fixed = run(Slow([4.26, 2.0]))
    timed = run(Slow([4.26, 2.0]), out="timed", clock=Clock.MODEL)
    assert fixed.result.trace_sha256 == run("oracle", out="same").result.trace_sha256
    assert timed.result.sim_seconds == pytest.approx(fixed.result.sim_seconds + 6.3)
    assert [line["thought_s"] for line in _lines(timed)][1:3] == [4.3, 2.0]


@pytest.mark.parametrize("clock", Clock)
def test_what_was_recorded_is_repeated_exactly(run, clock):
    first = run(Slow([4.26, 2.0]), clock=clock, latency_s=1.0)
    again = run(Player(_lines(first)[1:], make_agent("oracle").channels, None), out="again")
    assert again.result.trace_sha256 == first.result.trace_sha256
    assert not any(step.differs for step in compare(_lines(first), _lines(again)))


def test_whoever_thinks_beyond_the_deadline_is_too_late_and_nobody_waits_for_more(run):
    late = run("oracle", latency_s=10 * DEADLINE_S)
    assert late.result.success is False
    assert not late.result.parts.in_time
    assert _lines(late)[1]["thought_s"] == DEADLINE_S


def _planned(**values):
    plan = make_plan({"agents": ["oracle"], "tasks": ["hvac_fan_max"]} | values)
    return [job.planned() for job in plan.jobs()]


def test_each_latency_is_an_episode_of_its_own():
    rows = _planned(latency_s=[0, 1, 3])
    assert len({row.id for row in rows}) == 3
    assert {row.conditions.latency_s for row in rows} == {0.0, 1.0, 3.0}
    assert _planned()[0].id == _planned(latency_s=[0])[0].id
    assert _planned(clock=["model"])[0].id != _planned()[0].id


def test_success_is_shown_over_think_time(tmp_path):
    rows = tuple(_planned(latency_s=[0, 3]))
    assert {contestant(row).label for row in rows} == {
        "oracle (told the answer)",
        "oracle (told the answer), latency 3 s",
    }
    whole = Results(tmp_path, {"plan": {}}, rows, Coverage(2, 0, shared=frozenset(row.id for row in rows)))
    [table] = [table for table in by_condition(whole) if table.rows]
    assert table.columns == ("Contestant", "0 s", "3 s")
    assert len(table.rows) == 1
    assert not any(table.rows for table in by_condition(replace(whole, rows=rows[:1])))
