"""Monitoring: one standing order, a watch before the trigger, and silence where nothing is to be done."""

import pytest

from automotive_cosim.agents import make_agent
from automotive_cosim.contracts import Action, ActionType, AlertKind
from automotive_cosim.envs.cockpit import CockpitEnv
from automotive_cosim.episode.situation import WATCH_S
from automotive_cosim.errors import UserError
from automotive_cosim.tasking.task import STANDING_ORDER

pytestmark = pytest.mark.slow
TASK = "road_speed_80_in_50"
WAIT = Action(ActionType.WAIT, seconds=1)
WARN = Action(ActionType.SHOW_ALERT, kind=AlertKind.SPEED)


@pytest.fixture
def watch(simulations):
    envs = []

    def begin(half: str = "first", **names: object) -> CockpitEnv:
        env = CockpitEnv(
            TASK, half, mode="monitoring", channels=("elements",), simulations=simulations, max_steps=200, **names
        )
        env.reset(seed=0)
        envs.append(env)
        return env

    yield begin
    for env in envs:
        env.close()


def end(env: CockpitEnv, first: tuple[Action, ...] = ()) -> bool:
    """Carries out the actions, then waits until it is over."""
    todo, done = list(first), False
    while not done:
        _, reward, terminated, truncated, _ = env.step(todo.pop(0) if todo else WAIT)
        done = terminated or truncated
    return bool(reward)


def until_trigger(env: CockpitEnv) -> tuple[Action, ...]:
    return (WAIT,) * int(env.episode.instance.trigger_after_s + 1)


def test_it_begins_with_the_order_half_a_minute_early(watch):
    env = watch()
    assert env.episode.observation.goal == STANDING_ORDER
    assert WATCH_S <= env.episode.instance.trigger_after_s <= 2 * WATCH_S
    assert env.episode.moments[0].driving.speed_mps * 3.6 < 90


def test_a_message_lures_before_the_trigger(watch):
    env = watch()
    seen = []
    for _ in range(int(env.episode.instance.trigger_after_s)):
        seen.append(any("New message" in element.text for element in env.episode.elements))
        env.step(WAIT)
    assert not seen[0]
    assert any(seen)


def test_the_oracle_acts_at_the_trigger_and_succeeds(watch):
    env = watch()
    oracle = make_agent("oracle")
    oracle.reset("")
    oracle.brief(env.episode.instance)
    done = False
    while not done:
        _, reward, terminated, truncated, _ = env.step(oracle.act(env.episode.observation))
        done = terminated or truncated
    assert reward == 1.0
    assert env.episode.verdict is not None
    assert env.episode.verdict.declared.why == "a watch declares nothing"


def test_acting_before_the_trigger_is_a_false_alarm(watch):
    env = watch()
    assert not end(env, (WARN,))
    assert env.episode.verdict is not None
    assert "false alarm" in env.episode.verdict.clean.why


def test_silence_is_right_where_nothing_is_to_be_done_and_wrong_where_something_is(watch):
    assert end(watch("second"))
    assert not end(watch("first"))


def test_an_alert_where_none_is_needed_fails(watch):
    env = watch("second")
    assert not end(env, (*until_trigger(env), WARN))


def test_a_general_task_cannot_be_monitored(simulations):
    with pytest.raises(UserError, match="only safety tasks can be monitored"):
        CockpitEnv("hvac_fan_max", mode="monitoring", simulations=simulations)
