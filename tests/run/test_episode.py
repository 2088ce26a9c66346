import copy
import json
import os
import subprocess
import sys
from dataclasses import replace
from itertools import pairwise

import pytest

from automotive_cosim.agents import make_agent
from automotive_cosim.contracts import Action, ActionType
from automotive_cosim.episode.situation import SituationFinder
from automotive_cosim.episode.specification import End
from automotive_cosim.errors import ActionError, TrafficError, TriggerNotReachedError, UnknownNameError
from automotive_cosim.interface import trace
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.script import ScriptedAgent
from automotive_cosim.run.trial import TrialObserver, run_trial
from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasks import CATALOGUE

from .conftest import Memory

TASK = "hvac_fan_max"


class Broken:
    """Acts once, then raises."""

    name = "broken"
    model = "none"
    channels = frozenset()

    def __init__(self, error):
        self._error = error
        self._acted = False

    def reset(self, goal):
        self._acted = False

    def act(self, observation):
        if self._acted:
            raise self._error
        self._acted = True
        return Action(ActionType.NAVIGATE_HOME)


def _lines(folder):
    return [json.loads(line) for line in (folder / "steps.jsonl").read_text(encoding="utf-8").splitlines()]


def test_the_oracle_succeeds_and_everything_is_recorded(run):
    episode = run("oracle")
    result = episode.result
    assert result.success
    assert result.reward == 1.0
    assert result.end is End.DECLARED
    written = json.loads((episode.folder / "trial.json").read_text(encoding="utf-8"))
    assert written["row"]["trace_sha256"] == written["result"]["trace_sha256"] == result.trace_sha256
    assert written["result"]["verdict"]["success"]
    assert {"automotive-cosim", "python", "libsumo", "gymnasium", "numpy", "pillow"} <= set(
        written["manifest"]["versions"]
    )
    lines = _lines(episode.folder)
    pictures = sorted(path.name for path in (episode.folder / "screenshots").iterdir())
    assert [line["step"] for line in lines] == list(range(result.steps + 1))
    assert pictures == sorted(
        {f"step_{line['picture']:03d}.jpg" for line in lines} | {f"road_{line['step']:03d}.jpg" for line in lines}
    )
    assert [line["sha256"] for line in lines] == [trace.digests(line) for line in lines]


def test_the_hash_can_be_had_from_the_record(run):
    episode = run("oracle")
    assert trace.sha256(_lines(episode.folder)) == episode.result.trace_sha256


def test_doing_nothing_fails_at_the_last_step(run):
    result = run("no-op").result
    assert result.success is False
    assert result.reward == 0.0
    assert result.end is End.OUT_OF_STEPS
    assert result.steps == Suite.STANDARD.max_steps


def test_the_same_setup_gives_the_same_trace_and_another_seed_another(run):
    first, again, other = run("oracle", "a"), run("oracle", "b"), run("oracle", "c", seed=1)
    assert first.result == again.result
    assert (first.folder / "steps.jsonl").read_bytes() == (again.folder / "steps.jsonl").read_bytes()
    assert first.result.trace_sha256 != other.result.trace_sha256


def test_another_process_in_another_folder_gives_the_same_trace(run, tmp_path):
    here = run("oracle").result.trace_sha256
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    arguments = ["run", "--json", "--task", TASK, "--scenario", "grid", "--agent", "oracle"]
    program = "from automotive_cosim.cli.main import main; main()"
    environment = os.environ | {"PYTHONHASHSEED": "77", "TZ": "Asia/Tokyo", "LC_ALL": "C"}
    done = subprocess.run(
        [sys.executable, "-c", program, *arguments],
        cwd=elsewhere, env=environment, capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert json.loads(done.stdout)["trace_sha256"] == here


def test_changing_anything_hashed_changes_the_hash(run):
    """Every leaf of traffic, signals, action and two elements of one step, one at a time."""
    step = _lines(run("oracle").folder)[1]
    step["elements"] = step["elements"][:2]
    whole = trace.sha256([step])
    assert step["action"]
    changed = 0
    for name in ("traffic", "signals", "elements", "action"):
        for path in _leaves(step[name]):
            other = copy.copy(step)
            other[name] = copy.deepcopy(step[name])
            _spoil(other[name], path)
            assert trace.sha256([other]) != whole, (name, path)
            changed += 1
    assert changed > 100


def test_what_follows_from_the_rest_is_not_hashed(run):
    lines = _lines(run("oracle").folder)
    for name in ("time_s", "local_time", "feedback", "context", "weather", "thought"):
        assert trace.sha256([line | {name: "other"} for line in lines]) == trace.sha256(lines), name


def _leaves(value, path=()):
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else None
    if items is None:
        yield path
        return
    for key, entry in items:
        yield from _leaves(entry, (*path, key))


def _spoil(value, path):
    for key in path[:-1]:
        value = value[key]
    old = value[path[-1]]
    value[path[-1]] = (not old) if isinstance(old, bool) else old + 1e-9 if isinstance(old, float) else [old]


def test_a_different_action_is_a_different_trace(run):
    waits = [Action(ActionType.WAIT, seconds=1)] * 2
    end = Action(ActionType.STATUS, goal_status="complete")
    hashes = {
        run(ScriptedAgent([*actions, end]), f"out{number}").result.trace_sha256
        for number, actions in enumerate((waits, [waits[0], Action(ActionType.NAVIGATE_HOME)], waits[:1]))
    }
    assert len(hashes) == 3


def test_the_record_shows_the_drive_without_a_jump(run):
    path = run("oracle").memory.told.path
    assert path[0].at_s < 0 < path[-1].at_s
    for before, after in pairwise(path):
        seconds = after.at_s - before.at_s
        assert 0 < seconds <= 1.01
        driven = ((after.x_m - before.x_m) ** 2 + (after.y_m - before.y_m) ** 2) ** 0.5
        fastest = max(before.speed_kmh, after.speed_kmh) / 3.6 + 10 * seconds
        assert driven <= fastest * seconds


def test_the_timeline_is_in_order_and_begins_with_the_departure(run):
    result = run("oracle").memory.told
    times = [entry.at_s for entry in result.timeline]
    kinds = [entry.kind for entry in result.timeline]
    assert times == sorted(times)
    assert kinds[0] == "departure"
    assert result.timeline[kinds.index("hand_over")].at_s == 0
    assert kinds.index("hand_over") < kinds.index("action") < kinds.index("declared")


def test_watchers_hear_of_drive_steps_and_aftermath(run):
    memory = run("oracle").memory
    steps_s = [shot.step.moment.time_s for shot in memory.shots]
    assert [shot.step.number for shot in memory.shots] == list(range(len(steps_s)))
    assert memory.moved_s == sorted(memory.moved_s)
    assert memory.moved_s[0] < steps_s[0]
    assert memory.moved_s[-1] > steps_s[-1]
    assert len(memory.rows) == 1


def test_a_road_that_fails_after_the_end_is_an_error_too(simulations):
    class Fails(TrialObserver):
        episode = None

        def begun(self, session, shot):
            self.episode = session

        def moved(self, moment, cockpit):
            if self.episode is not None and self.episode.end is not None:
                raise TrafficError("the simulation died")

    setup = EpisodeSetup("hvac_fan_max", scenario="grid", agent="oracle", model="none")
    result = run_trial(setup, make_agent("oracle"), (Fails(),), simulations=simulations)
    assert (result.end, result.error) == (End.ERROR, "the simulation died")
    assert (result.success, result.parts) == (None, None)


def test_an_unreadable_answer_costs_a_step(run):
    result = run(Broken(ActionError("the answer has no action"))).result
    assert result.end is End.OUT_OF_STEPS
    assert result.steps == Suite.STANDARD.max_steps


def test_a_failing_road_is_an_error_and_no_failure(run):
    episode = run(Broken(TrafficError("the simulation died")))
    result = episode.result
    assert result.end is End.ERROR
    assert result.error == "the simulation died"
    assert result.success is None
    assert result.parts is None
    written = json.loads((episode.folder / "trial.json").read_text(encoding="utf-8"))
    assert written["row"]["error"] == "the simulation died"
    assert len(_lines(episode.folder)) == 2
    assert trace.sha256(_lines(episode.folder)) == result.trace_sha256


def test_an_interruption_keeps_what_was_recorded_and_is_passed_on(run, tmp_path):
    with pytest.raises(KeyboardInterrupt):
        run(Broken(KeyboardInterrupt()))
    written = json.loads((tmp_path / "out" / "trial.json").read_text(encoding="utf-8"))
    assert written["row"]["end"] == "interrupted"
    assert written["row"]["success"] is None
    assert len(_lines(tmp_path / "out")) == 2


@pytest.mark.parametrize("names", [{"task": "nope"}, {"half": "third"}, {"scenario": "nope"}])
def test_an_unknown_name_leaves_no_folder(run, tmp_path, names):
    with pytest.raises(UnknownNameError):
        run("oracle", **names)
    assert not list(tmp_path.iterdir())


def test_watching_changes_nothing(run, simulations):
    watched = run("oracle").result
    alone = run_trial(
        EpisodeSetup(task=TASK, scenario="grid", agent="oracle", model="none"),
        make_agent("oracle"),
        simulations=simulations,
    )
    assert alone == watched


def test_spare_traffic_is_for_a_situation_that_does_not_come_about_and_the_same_for_every_agent(
    simulations, monkeypatch
):
    find, tried = SituationFinder.find, []

    def never_in_the_first(self, seeds):
        tried.append(seeds.traffic)
        if seeds.traffic == 0:
            raise TriggerNotReachedError("not in this traffic")
        return find(self, seeds)

    monkeypatch.setattr(SituationFinder, "find", never_in_the_first)
    spare = EpisodeSetup(TASK, scenario="grid", spare_traffic=(0, 1, 2))
    memories = Memory(), Memory()
    results = [
        run_trial(spare, make_agent(name), (memory,), simulations=simulations)
        for name, memory in zip(("oracle", "no-op"), memories, strict=True)
    ]
    assert tried == [0, 0, 1] * 2
    assert [result.traffic_seed for result in results] == [1, 1]
    assert {memory.told.goal for memory in memories} == {draw(CATALOGUE[TASK], "first", 0).goal}
    none_left = run_trial(replace(spare, spare_traffic=()), make_agent("no-op"), simulations=simulations)
    assert (none_left.error_kind, none_left.traffic_seed) == ("TriggerNotReachedError", None)
