"""Random, press-everything, and a person at the terminal."""

import io
from dataclasses import replace

import pytest

from automotive_cosim.agents import Human, PressEverything, Random
from automotive_cosim.agents.human import understood
from automotive_cosim.agents.limits import LimitTeller
from automotive_cosim.cockpit.actions import check
from automotive_cosim.contracts import UNCALLED, Action, ActionType, Direction, GoalStatus, Reason
from automotive_cosim.errors import ActionError


def test_random_acts_by_every_type_and_is_well_formed(observation):
    agent = Random(3)
    agent.reset("x")
    actions = [check(agent.act(observation("x"))) for _ in range(600)]
    assert {action.action_type for action in actions} == set(UNCALLED)
    agent.reset("x")
    assert [agent.act(observation("x")) for _ in range(600)] == actions
    other = Random(4)
    assert [other.act(observation("x")) for _ in range(20)] != actions[:20]


def test_random_finds_something_to_do_on_an_empty_screen(observation):
    agent = Random()
    for _ in range(200):
        check(agent.act(observation("x", elements=())))


def test_every_control_is_pressed_once_then_complete(observation, button):
    agent = PressEverything()
    agent.reset("x")
    screen = (
        button("a"), replace(button("b"), is_enabled=False), button("c"), replace(button("d"), is_clickable=False),
        replace(button("e"), is_visible=False), button(""),
    )  # fmt: skip
    actions = [agent.act(observation("x", elements=screen)) for _ in range(4)]
    assert [action.index for action in actions] == [0, 2, 5, None]
    assert actions[-1].goal_status is GoalStatus.COMPLETE
    agent.reset("x")
    assert agent.act(observation("x", elements=screen)).index == 0


@pytest.mark.parametrize(
    ("line", "action"),
    [
        ("12", Action(ActionType.CLICK, index=12)),
        ("12 Rue de Rivoli", Action(ActionType.INPUT_TEXT, index=12, text="Rue de Rivoli", clear_text=True)),
        ("open climate", Action(ActionType.OPEN_APP, app_name="climate")),
        ("Down", Action(ActionType.SCROLL, direction=Direction.DOWN)),
        ("wait", Action(ActionType.WAIT)),
        ("wait 4", Action(ActionType.WAIT, seconds=4)),
        ("alert distance", Action(ActionType.SHOW_ALERT, kind="distance")),
        ("done", Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE)),
        ("no already_so", Action(ActionType.STATUS, goal_status=GoalStatus.NOT_NEEDED, reason=Reason.ALREADY_SO)),
        ("cannot law", Action(ActionType.STATUS, goal_status=GoalStatus.INFEASIBLE, reason=Reason.LAW)),
        ('{"action_type": "pull_over"}', Action(ActionType.PULL_OVER)),
    ],
)
def test_a_person_says_it_in_a_word(line, action):
    assert understood(line) == action


@pytest.mark.parametrize("line", ["", "fly", "-1", "{", "no why", "wait 99"])
def test_what_a_person_mistypes_is_told(line):
    with pytest.raises(ActionError):
        understood(line)


def test_a_person_sees_numbers_and_is_asked_again(observation):
    lines = iter(["what?", "1"])
    out = io.StringIO()
    human = Human(lambda: next(lines), out)
    human.reset("My hands are cold")
    assert human.act(observation("x")).index == 1
    told = out.getvalue()
    assert "My hands are cold" in told
    assert "  1  Warn driver" in told
    assert "'what?' is not an action" in told


def test_a_person_asks_and_hears_each_answer_once(observation):
    lines, out = iter(["ask Left or right?", "done", "done"]), io.StringIO()
    human = Human(lambda: next(lines), out)
    human.reset("Move the sound over")
    seen = observation("x")
    assert human.act(seen) == Action(ActionType.ASK_DRIVER, text="Left or right?")
    human.act(replace(seen, said=("To the left.",)))
    human.act(replace(seen, said=("To the left.", "Thanks.")))
    assert [out.getvalue().count(text) for text in ("To the left.", "Thanks.")] == [1, 1]


def test_the_end_of_the_input_interrupts(observation):
    def ended() -> str:
        raise EOFError

    with pytest.raises(KeyboardInterrupt):
        Human(ended, io.StringIO()).act(observation("x"))


UNSIGNED = """Speed limit here: not posted
Default limit: 130 km/h on motorways (FR, verified)
Reduced limit: 110 km/h on motorways in rain or other precipitation (FR, verified)
Reduced limit: 50 km/h everywhere with visibility under 50 m (FR, verified)
Weather: {weather}, wind 14 km/h"""


@pytest.mark.parametrize(
    ("context", "by_sign", "by_law"),
    [
        (UNSIGNED.format(weather="clear, 14 °C, humidity 55 %, visibility 20000 m (good)"), None, 130.0),
        (UNSIGNED.format(weather="rain, 14 °C, humidity 92 %, 1.6 mm/h, visibility 7000 m (good)"), None, 110.0),
        (UNSIGNED.format(weather="fog, 6 °C, humidity 99 %, visibility 40 m (dense)"), None, 50.0),
        ("Speed limit here: 30 mph (posted on Euston Road)\nWeather: fog, visibility 900 m", 48.3, 48.3),
        ("Speed limit here: none posted\nDefault limit: none on motorways (DE, verified)", None, None),
    ],
)
def test_who_reads_signs_alone_tells_less_than_who_knows_the_law(observation, context, by_sign, by_law):
    for knows_law, kmh in ((False, by_sign), (True, by_law)):
        agent = LimitTeller(knows_law=knows_law)
        seen = replace(observation("x"), context=context)
        told = check(agent.act(seen))
        assert told.speed_kmh == kmh
        assert kmh is None or check(agent.act(seen)).goal_status is GoalStatus.COMPLETE
        assert agent.act(replace(seen, on_watch=True)).action_type is ActionType.WAIT
