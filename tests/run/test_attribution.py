"""Which act did it: laws over small recorded trials on the grid."""

import json
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import pytest

from automotive_cosim.contracts import Action, ActionType, GoalStatus
from automotive_cosim.errors import UserError
from automotive_cosim.report.page import write_page
from automotive_cosim.run.attribution import FILE, REDRAWS, attribute, path_of, read_effects
from automotive_cosim.run.effect import ActEffect
from automotive_cosim.run.forks import Forks, forked, together
from automotive_cosim.run.rerun import recorded
from automotive_cosim.run.script import ScriptedAgent
from automotive_cosim.traffic.fork import Simulations

FAN = Action(ActionType.CALL, function="set_hvac_fan_speed", arguments={"percent": 100})
HOME = Action(ActionType.NAVIGATE_HOME)
SLOW = Action(ActionType.REQUEST_SLOW_DOWN, speed_kmh=15.0)
SAYS = Action(ActionType.ANSWER, text="all is well")
WAIT = Action(ActionType.WAIT, seconds=10)
DONE = Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE)
TRIALS = {
    "twice": [HOME, FAN, FAN, DONE],
    "slow": [SLOW, SAYS, WAIT, WAIT, DONE],
    "attention_on": [FAN, SLOW, SAYS, WAIT, SAYS, WAIT, DONE],
}


@pytest.fixture
def folder(request: pytest.FixtureRequest, run: Callable[..., Any]) -> Path:
    """A recorded trial by name."""
    attention = "on" if request.param == "attention_on" else "off"
    trial: Path = run(ScriptedAgent(TRIALS[request.param]), interface="both", attention=attention).folder
    return trial


@pytest.fixture
def forks(folder: Path, simulations: Simulations) -> Iterator[Forks]:
    with forked(recorded(folder), simulations) as found:
        yield found


def driven(forks: Forks, steps: Sequence[int]) -> list[Any]:
    run = forks.driving(forks._forks[0], frozenset(steps), 0, forks.moments[-1].time_s)
    (moments,) = together([run])
    return moments


def told(moments: Sequence[Any]) -> list[Any]:
    return [(moment.driving, moment.signals, moment.commands) for moment in moments]


@pytest.mark.parametrize("folder", TRIALS, indirect=True)
def test_with_all_acts_it_is_the_trial_and_without_any_the_do_nothing_run(forks: Forks) -> None:
    assert told(driven(forks, [])) == told(forks.moments)
    alone = driven(forks, [act.step for act in forks.acts])
    count = len(forks.untouched)
    assert told(alone[:count]) == told(forks.untouched)
    assert told(alone) != told(forks.moments)


@pytest.mark.parametrize("folder", ["twice"], indirect=True)
def test_acts_that_matter_only_together_are_found_as_a_pair(folder: Path, simulations: Simulations) -> None:
    one, other, both = attribute(folder, simulations=simulations)
    assert one.is_neutral
    assert other.is_neutral
    assert both.steps == one.steps + other.steps == (2, 3)
    assert both.verdict.startswith("success, the opposite without it (goal")
    assert both.draws == 1, "the road is the same without them: there is nothing to redraw"
    assert read_effects(path_of(folder)) == [one, other, both]
    assert "the opposite without it" in write_page(folder).read_text()


@pytest.mark.parametrize("folder", ["slow"], indirect=True)
def test_a_decisive_act_is_told_with_its_effect_and_a_neutral_one_as_such(
    folder: Path, simulations: Simulations
) -> None:
    slow, says, *lacking = attribute(folder, simulations=simulations)
    assert slow.draws == 1 + REDRAWS
    difference, noise = slow.changed["arrival_s"]
    assert difference > 5.0 > noise
    assert slow.came.startswith(("obeyed", "ignored"))
    assert says.is_neutral
    assert says.effect.startswith("neutral; a glance of ")
    assert slow.act == "asks for 15 km/h"
    kept = (folder / FILE).read_text()
    assert attribute(folder, simulations=simulations) == [slow, says, *lacking]
    assert (folder / FILE).read_text() == kept, "the same seed gives the same effects"


@pytest.mark.parametrize("folder", ["slow"], indirect=True)
def test_a_step_that_commanded_nothing_changes_nothing(folder: Path, simulations: Simulations) -> None:
    (effect,) = attribute(folder, only=[3], simulations=simulations)
    assert effect.is_neutral
    assert effect.act == "commands nothing"
    assert not (folder / FILE).exists(), "only what is measured in full is kept"
    with pytest.raises(UserError, match="no step 9; the run's steps are 1 to 5"):
        attribute(folder, only=[9], simulations=simulations)


@pytest.mark.parametrize("folder", ["slow"], indirect=True)
def test_a_failure_for_want_of_an_act_is_told_as_that(folder: Path, simulations: Simulations) -> None:
    lacking = [each for each in attribute(folder, simulations=simulations) if not each.steps]
    assert [each.effect.partition(":")[0] for each in lacking] == ["goal", "in time"]


@pytest.mark.parametrize("folder", ["twice"], indirect=True)
def test_acts_that_are_too_many_are_counted(
    folder: Path, simulations: Simulations, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("automotive_cosim.run.forks.MOST_ACTS", 1)
    one, later = attribute(folder, simulations=simulations)
    assert one.steps == (2,)
    assert later.effect == "not measured: 1"


@pytest.mark.parametrize("content", ["", "[]", "{}", '{"acts": [1]}', '{"acts": [{"steps": "x"}]}'])
def test_effects_that_cannot_be_read_are_refused_in_a_line(tmp_path: Path, content: str) -> None:
    assert read_effects(tmp_path / FILE) == []
    (tmp_path / FILE).write_text(content)
    with pytest.raises(UserError, match="`automotive-cosim attribute` measures them"):
        read_effects(tmp_path / FILE)


def test_what_is_no_more_than_chance_is_no_effect() -> None:
    effect = ActEffect((3,), 1.0, "alert speed", chance={"over_s": (8.0, 11.0)}, draws=5)
    assert effect.is_neutral
    assert effect.effect == "neutral; no more than chance: +8.0 s above the limit (draws differ by 11)"
    assert json.loads(json.dumps(effect.changed)) == {}


@pytest.mark.parametrize("folder", ["slow"], indirect=True)
def test_where_an_act_makes_no_difference_any_more_the_trial_itself_goes_on(forks: Forks) -> None:
    until_s = forks.moments[-1].time_s
    slow, says = (list(forks.driving(act.fork, frozenset([act.step]), 0, until_s)) for act in forks.acts[:2])
    assert max(map(len, slow)) == 1, "the road is another from there on"
    assert max(map(len, says)) > 1, "what comes is taken from the trial"
    assert told([moment for part in says for moment in part]) == told(forks.moments[forks.acts[1].fork.at :])


@pytest.mark.parametrize("folder", ["slow"], indirect=True)
def test_what_is_driven_with_acts_is_followed_as_long_as_without_them_whatever_was_driven_before(
    forks: Forks, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Forks, "is_drive", True)
    monkeypatch.setattr("automotive_cosim.run.forks.FOLLOWED_S", 3.0)
    slow, says = forks.acts
    ends = [{moments[-1].time_s for moments in forks.both(left, 1)} for left in ([slow], [slow, says])]
    assert [len(each) for each in ends] == [1, 1]
    assert max(ends[0]) < max(ends[1])
