"""The traces of the reference solutions are those on record, so that no change alters an episode unnoticed.

A change that means to alter them (another signal, another text on a screen) renews the record:

    automotive-cosim tasks validate --suite all --gates start --seeds 0 --workers 2 --json > tests/proof/traces.json

CI compares a tenth of them in turn; here are some.
"""

import json
from pathlib import Path

import pytest

from automotive_cosim.errors import UserError
from automotive_cosim.proof.hand_over import Ground
from automotive_cosim.proof.prover import changed_traces, read_traces
from automotive_cosim.tasks import CATALOGUE

RECORD = Path(__file__).with_name("traces.json")
SAMPLE = sorted(read_traces(RECORD))[::101]


def test_the_record_holds_every_half():
    assert set(read_traces(RECORD)) >= {
        f"{task.id}/{half}/0" for task in CATALOGUE.values() for half in task.halves
    }


@pytest.mark.slow
@pytest.mark.parametrize("name", SAMPLE)
def test_a_reference_solution_gives_the_trace_on_record(simulations, name):
    task_id, half, seed = name.split("/")
    ground = Ground.reach(CATALOGUE[task_id], half, int(seed), simulations)
    assert ground.reference.trace_sha256 == read_traces(RECORD)[name]
    ground.close()


def test_a_changed_trace_is_told_and_a_missing_or_new_one_is_not():
    before = {"a/first/0": "1", "b/first/0": "2", "c/first/0": "3"}
    now = {"a/first/0": "1", "b/first/0": "9", "d/first/0": "4"}
    assert changed_traces(before, now) == ("b/first/0",)


@pytest.mark.parametrize("text", ["", "[]", "{}", json.dumps({"traces": {"a": 1}}), json.dumps({"traces": []})])
def test_a_file_without_traces_is_refused(tmp_path, text):
    path = tmp_path / "before.json"
    path.write_text(text)
    with pytest.raises(UserError, match="validate --json"):
        read_traces(path)
