"""The condition ``interface``: what an agent may do, what it costs, and that the verdict is the same."""

import pytest

from automotive_cosim.contracts import Action, ActionType, FeedbackCode, GoalStatus
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.episode.episode import Episode
from automotive_cosim.episode.situation import SituationFinder
from automotive_cosim.episode.specification import EpisodeSpec, SeedSource
from automotive_cosim.errors import UserError
from automotive_cosim.interface.functions import action_of
from automotive_cosim.tasks import CATALOGUE
from automotive_cosim.traffic.fork import Simulations

pytestmark = [pytest.mark.slow, pytest.mark.sumo]
HOME = Action(ActionType.NAVIGATE_HOME)
FAN = action_of("set_hvac_fan_speed", {"percent": 100})
DONE = Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE)


def begun(simulations: Simulations, **words: str) -> Episode:
    spec = EpisodeSpec("hvac_fan_max", scenario="grid", conditions=Conditions.named(words))
    return Episode.take_over(SituationFinder(spec, simulations).find(SeedSource(0).next()), spec.session())


@pytest.mark.parametrize(
    ("interface", "touch", "call"),
    [
        ("touch", FeedbackCode.NO_EFFECT, FeedbackCode.MALFORMED),
        ("functions", FeedbackCode.MALFORMED, FeedbackCode.OK),
        ("both", FeedbackCode.NO_EFFECT, FeedbackCode.OK),
    ],
)
def test_what_an_interface_lacks_is_a_failed_step_and_each_takes_a_second(
    simulations: Simulations, interface: str, touch: FeedbackCode, call: FeedbackCode
) -> None:
    episode = begun(simulations, interface=interface)
    for action, code, at_s in ((HOME, touch, 1.0), (FAN, call, 2.0)):
        episode.step(action)
        assert episode.steps[-1].feedback.code is code
        assert episode.seconds == pytest.approx(at_s)
    episode.step(DONE)
    assert episode.verdict is not None
    assert episode.verdict.success is (call is FeedbackCode.OK)
    episode.close()


def test_feedback_is_told_alike_but_a_reading_always_says_what_it_read(simulations: Simulations) -> None:
    told = {}
    for detail in ("quiet", "verbose"):
        episode = begun(simulations, interface="functions", see="nothing", feedback=detail)
        assert episode.observation.elements is None
        for action in (FAN, action_of("get_signals", {"path": "hvac"})):
            episode.step(action)
            told[detail, action.function] = episode.observation.feedback.text
        episode.close()
    assert told["quiet", FAN.function] == "set_hvac_fan_speed: done"
    assert "FanSpeed is 100" in told["verbose", FAN.function]
    assert told["quiet", "get_signals"] == told["verbose", "get_signals"]
    assert "FanSpeed" in told["quiet", "get_signals"]


def test_what_hangs_on_a_picture_is_refused_by_name(simulations: Simulations) -> None:
    task = next(task for task in CATALOGUE.values() if task.needs_picture)
    with pytest.raises(UserError, match="needs the picture, which interface = functions cannot open"):
        SituationFinder(EpisodeSpec(task.id, conditions=Conditions.named({"interface": "functions"})), simulations)
