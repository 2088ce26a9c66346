"""Reliability over repeats: the shares by hand, and the step in which two runs of an instance part."""

from dataclasses import replace

import pytest

from automotive_cosim.report.consistency import consistency, varied
from automotive_cosim.report.results import read_results
from automotive_cosim.run.plan import make_plan
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.store import opened, write_trace

WON = {
    ("hvac_fan_max", 0): (True, True, True),
    ("hvac_fan_max", 1): (True, False, False),
    ("hvac_cold_hands", 0): (True, True, False),
    ("hvac_cold_hands", 1): (False, False, False),
}


def step(**action):
    return {"step": 0, "action": action or None}


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    plan = make_plan(
        {"agents": ["t3a"], "tasks": ["hvac_fan_max", "hvac_cold_hands"], "seeds": [0, 1], "repeats": 3}
    )
    folder = tmp_path_factory.mktemp("repeats") / "e"
    with opened(folder, plan.as_json(), EpisodeRow) as store:
        for job in plan.jobs():
            won = WON[job.task, job.seed][job.repeat]
            store.append(replace(job.planned(), success=won))
            last = step(action_type="status", goal_status="complete") if won else step()
            write_trace(folder, job.id, [step(), step(action_type="click", index=3), last, {"result": {}}])
    return read_results(folder)


def test_shares_are_those_of_the_runs(results):
    (whole, *by_dimension) = consistency(results).rows
    assert [str(cell).partition(" ")[0] for cell in whole[2:]] == ["4", "50%", "25%", "75%"]
    assert len(by_dimension) == 2, "one task of explicit control, one of implicit intent"
    assert consistency(results).columns[3:] == ("pass^1", "pass^3", "pass@3")


def test_the_first_action_that_differs_is_shown_of_instances_that_did_not_end_alike(results):
    rows = {str(row[1]): tuple(map(str, row[2:])) for row in varied(results).rows}
    assert set(rows) == {"hvac_fan_max, first half, seed 1", "hvac_cold_hands, first half, seed 0"}
    assert rows["hvac_cold_hands, first half, seed 0"] == ("2 of 3", "2", "status complete", "none")


def test_tasks_that_all_agree_are_no_certainty(results):
    lost = replace(results, rows=tuple(replace(row, success=False) for row in results.rows))
    whole = consistency(lost).rows[0]
    assert [str(cell) for cell in whole[3:]] == ["0% (0 to 66)"] * 3, "Wilson's for none of two tasks"
