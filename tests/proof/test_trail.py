"""What is on record of a task: gates passed, readers, changes; and results that no longer stand."""

import re
from dataclasses import replace

from automotive_cosim.proof import trail
from automotive_cosim.proof.prover import GATES, Proof
from automotive_cosim.run.coverage import coverage, is_outdated
from automotive_cosim.run.plan import make_plan
from automotive_cosim.tasking.fingerprint import fingerprint
from automotive_cosim.tasks import CATALOGUE
from tests.laws import over

TASK = "hvac_fan_max"
PLAN = make_plan({"agents": ["oracle"], "tasks": [TASK]})
ROW = replace(PLAN.jobs()[0].planned(), success=True)


def proof(seed, **wrong):
    return Proof(id=f"{TASK}-seed{seed}", task=TASK, seed=seed, wrong=wrong)


def test_a_gate_is_passed_if_it_is_with_every_seed():
    found = trail.merged({}, [proof(0, oracle=[], near=[]), proof(1, oracle=[], near=["too near"])], "2026-11-29")
    assert found == {TASK: trail.Passed((fingerprint(CATALOGUE[TASK], "first"),), {"2026-11-29": ("oracle",)})}


def test_a_proof_with_an_error_proves_nothing():
    assert trail.merged({}, [replace(proof(0, oracle=[]), error="gone")], "2026-11-29") == {}


def test_each_gate_stands_under_the_last_day_it_was_passed_on_and_a_changed_task_loses_all():
    before = trail.merged({}, [proof(0, oracle=[], slip=[])], "2026-11-01")
    assert trail.merged(before, [proof(0, oracle=[])], "2026-11-29")[TASK].gates == {
        "2026-11-01": ("slip",),
        "2026-11-29": ("oracle",),
    }
    changed = {TASK: replace(before[TASK], halves=("as it was",))}
    assert trail.merged(changed, [], "2026-11-29") == {}


def test_a_record_comes_back_from_its_file(tmp_path):
    record = trail.merged({}, [proof(0, oracle=[], slip=[])], "2026-11-01")
    trail.write(tmp_path / "passed.json", record)
    assert trail.read(tmp_path / "passed.json") == record


@over([task.id for task in CATALOGUE.values()])
def test_every_task_tells_its_trail(task_id):
    task = CATALOGUE[task_id]
    labels = [label for label, _ in trail.of_task(task)]
    assert labels[0] == "proved"
    assert labels.count("changed") == len(task.changed)
    for change in task.changed:
        assert re.fullmatch(r"20\d\d-\d\d-\d\d: .+", change)
    for half in task.halves:
        assert [label for label, _ in trail.of_half(task, half)] == ["reached", "won by", "readers", "digest"]


def test_what_is_on_record_is_of_tasks_and_gates_that_exist():
    for task_id, passed in trail.read(trail.RECORD).items():
        assert len(passed.halves) == len(CATALOGUE[task_id].halves)
        assert {gate for gates in passed.gates.values() for gate in gates} <= set(GATES)


def test_results_on_a_half_that_has_changed_since_are_counted():
    assert not is_outdated(ROW)
    assert not is_outdated(replace(ROW, half_digest="")), "rows of 0.2.0 do not say"
    changed = replace(ROW, half_digest="of another wish")
    assert is_outdated(changed)
    assert is_outdated(replace(ROW, task="gone"))
    told = str(coverage({"plan": PLAN.as_json(), "episodes": 1}, {changed.id: changed}))
    assert told == "1 of 1 planned episode judged, 1 on tasks that have changed since"
