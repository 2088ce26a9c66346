"""Demonstrations of the rule-perfect watcher and the oracle as a table."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from automotive_cosim.contracts import Action, ActionType
from automotive_cosim.drives.watchers import RulePerfect
from automotive_cosim.envs.flat_drive import ACTIONS, SOON
from automotive_cosim.errors import UserError
from automotive_cosim.exchange.demonstrations import drives, main, tasks
from automotive_cosim.traffic.fork import Simulations


def test_a_drive_is_a_chain_of_steps_that_earns(simulations: Simulations) -> None:
    steps = list(drives(["grid_june"], [2], minutes=3, simulations=simulations))
    assert [step.step for step in steps] == list(range(len(steps)))
    assert {(step.episode, step.name, step.seed) for step in steps} == {(0, "grid_june", 2)}
    assert [step.terminated for step in steps] == [False] * (len(steps) - 1) + [True]
    for step, after in pairwise(steps):
        assert np.array_equal(step.next_observation, after.observation)
    assert sum(step.reward for step in steps) > 0
    assert any(ACTIONS[step.action].kind for step in steps)


def test_what_the_view_cannot_say_is_a_short_wait(
    simulations: Simulations, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(RulePerfect, "act", lambda self, seen: Action(ActionType.ANSWER, text="mph here"))
    steps = list(drives(["grid_june"], [1], minutes=0.2, simulations=simulations))
    assert {step.action for step in steps} == {SOON}


@pytest.mark.sumo
def test_the_oracle_is_written_as_parquet(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    out = tmp_path / "demos.parquet"
    main(["--tasks", "hvac_fan_max", "--scenario", "grid", "--seeds", "0-1", "--out", str(out)])
    table = pandas.read_parquet(out)
    assert capsys.readouterr().out == f"{len(table)} steps in {out}\n"
    assert list(table.groupby("episode").reward.sum()) == [1.0, 1.0]
    assert list(table.seed.unique()) == [0, 1]
    assert set(table.name) == {"hvac_fan_max"}
    assert np.stack(table.observation).dtype == np.float32


def test_a_task_beyond_the_flat_view_is_refused(simulations: Simulations) -> None:
    with pytest.raises(UserError, match=r"takes .*, which the flat view does not have"):
        list(tasks(["maps_voice_for_alerts_only"], [0], scenario="grid", simulations=simulations))
