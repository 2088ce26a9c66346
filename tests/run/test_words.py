from collections.abc import Callable
from dataclasses import replace

import pytest

from automotive_cosim.cockpit.actions import FIELDS, action_in_words
from automotive_cosim.contracts import (
    NO_LIMIT,
    Action,
    ActionType,
    AlertKind,
    Direction,
    Element,
    GoalStatus,
    Limit,
    LimitSource,
    RoadHere,
)
from automotive_cosim.run.timeline import is_over, limit_in_words, road_in_words

VALUES = {
    "text": "hello",
    "direction": Direction.UP,
    "app_name": "climate",
    "goal_status": GoalStatus.COMPLETE,
    "kind": AlertKind.SPEED,
    "speed_kmh": 50.0,
    "on": True,
    "function": "reset_trip",
}


def _action(kind: ActionType) -> Action:
    takes = FIELDS[kind]
    fields = {name: VALUES[name] for name in takes.required}
    return Action(kind, **fields | ({"index": 1} if takes.target else {}))  # type: ignore[arg-type]


@pytest.mark.parametrize("kind", ActionType)
def test_every_action_is_one_plain_line(kind: ActionType, button: Callable[..., Element]):
    words = action_in_words(_action(kind), (button("a", "First"), button("b", "Second")))
    assert words
    assert "\n" not in words
    assert "None" not in words
    if FIELDS[kind].target:
        assert "Second" in words


def test_different_actions_read_differently(button: Callable[..., Element]):
    elements = (button("a", "First"), button("b", "Second"))
    said = [action_in_words(_action(kind), elements) for kind in ActionType]
    assert len(set(said)) == len(said)


@pytest.mark.parametrize("index", [2, 7])
def test_an_element_that_does_not_exist_is_named_by_its_number(index: int, button: Callable[..., Element]):
    words = action_in_words(Action(ActionType.CLICK, index=index), (button("a"), button("b")))
    assert str(index) in words


def test_unreadable_answers_have_words_too():
    assert action_in_words(None, ())


@pytest.mark.parametrize(
    ("speed_kmh", "limit_kmh", "over"), [(52.0, 50.0, True), (50.9, 50.0, False), (200.0, None, False)]
)
def test_the_last_digit_of_a_speedometer_is_not_speeding(speed_kmh: float, limit_kmh: float | None, over: bool):
    assert is_over(speed_kmh, limit_kmh) is over


def _road(**changes: object) -> RoadHere:
    road = RoadHere("e", "e_0", 0, 1, 0.0, "", "primary", NO_LIMIT, False, None, None, None, 1.0)
    return replace(road, **changes)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("name", "road_class", "words"),
    [
        ("Ring Road", "unclassified", "Ring Road"),
        ("", "unclassified", "a minor road"),
        ("", "primary", "a primary road"),
        ("", "residential", "a residential street"),
        ("", "cycle_street", "a cycle street"),
        ("", "living_street", "a living street"),
        ("", "motorway_link", "a slip road"),
        ("", "", "an unnamed road"),
    ],
)
def test_a_road_is_called_as_people_say(name: str, road_class: str, words: str):
    assert road_in_words(_road(name=name, road_class=road_class)) == words


@pytest.mark.parametrize(
    ("limit_mps", "source", "unit", "words"),
    [
        (50 / 3.6, LimitSource.POSTED, "km/h", "50 posted"),
        (13.41, LimitSource.POSTED, "mph", "30 posted"),
        (8.94, LimitSource.POSTED, "mph", "20 posted"),
        (70 / 3.6, LimitSource.LAW, "km/h", "70 by law"),
        (26.82, LimitSource.LAW, "mph", "60 by law"),
        (None, LimitSource.POSTED, "km/h", "no limit"),
        (None, LimitSource.NONE, "km/h", "no limit known"),
    ],
)
def test_a_limit_is_told_as_its_sign_shows_it(limit_mps: float | None, source: LimitSource, unit: str, words: str):
    assert limit_in_words(Limit(limit_mps, source), unit) == words
