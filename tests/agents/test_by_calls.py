"""The oracle by calls: the reference solution without a screen, with the verdict that touch has."""

import pytest

from automotive_cosim.agents import AgentSettings, make_agent
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.errors import ActionError
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.trial import run_trial
from automotive_cosim.traffic.fork import Simulations

pytestmark = pytest.mark.slow


def played(task: str, interface: str, simulations: Simulations) -> EpisodeRow:
    conditions = Conditions.named({"interface": interface})
    setup = EpisodeSetup(task, scenario="grid", agent="oracle", model="none", conditions=conditions)
    row = run_trial(setup, make_agent("oracle", settings=AgentSettings(conditions)), simulations=simulations)
    assert isinstance(row, EpisodeRow)
    return row


@pytest.mark.parametrize("task", ["hvac_fan_max", "comms_answer_call"])  # what is touched is in an app, or on top
def test_calls_win_what_touch_wins_in_no_more_steps(task: str, simulations: Simulations) -> None:
    by_touch, by_calls = (played(task, name, simulations) for name in ("touch", "functions"))
    assert by_touch.success
    assert by_calls.success
    assert by_calls.steps == 2 <= by_touch.steps, "one call, and that it is done"
    assert by_calls.interaction_s == 0.0


def test_who_was_not_told_the_task_knows_no_call(simulations: Simulations) -> None:
    oracle = make_agent("oracle", settings=AgentSettings(Conditions.named({"interface": "functions"})))
    with pytest.raises(ActionError, match="has to be told the task"):
        oracle.act(None)  # type: ignore[arg-type]
