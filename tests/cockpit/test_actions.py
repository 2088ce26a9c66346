"""Actions are read strictly, and a wrong one says what was wrong."""

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim.cockpit.actions import FIELDS, check, grammar, parse, perform, to_json
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.contracts import (
    UNCALLED,
    Action,
    ActionType,
    AlertKind,
    Direction,
    FeedbackCode,
    GoalStatus,
    Reason,
    Severity,
)
from automotive_cosim.errors import ActionError
from tests.cockpit.conftest import NAMES

SAMPLES = {
    "index": 3,
    "text": "hello",
    "clear_text": True,
    "direction": Direction.DOWN,
    "distance_px": 120,
    "app_name": "climate",
    "seconds": 2,
    "goal_status": GoalStatus.INFEASIBLE,
    "reason": "law",
    "kind": AlertKind.SPEED,
    "severity": Severity.CRITICAL,
    "speed_kmh": 50.0,
    "on": False,
    "destination": "Rue de Rivoli",
    "function": "reset_trip",
    "arguments": {"meter": "a"},
}


def full(kind: ActionType) -> dict[str, object]:
    takes = FIELDS[kind]
    names = (("index",) if takes.target else ()) + takes.required + takes.optional
    return {"action_type": str(kind)} | {name: SAMPLES[name] for name in names}


def test_every_action_type_has_its_fields_stated():
    assert set(FIELDS) == set(ActionType)


@pytest.mark.parametrize("kind", ActionType)
def test_json_round_trip(kind: ActionType):
    sent = full(kind)
    assert to_json(parse(json.dumps(sent))) == sent


@pytest.mark.parametrize("kind", ActionType)
def test_a_missing_required_field_is_named(kind: ActionType):
    for name in FIELDS[kind].required:
        sent = full(kind)
        del sent[name]
        with pytest.raises(ActionError, match=name):
            parse(sent)


@pytest.mark.parametrize("kind", ActionType)
def test_a_surplus_field_is_named(kind: ActionType):
    surplus = next(name for name in SAMPLES if name not in full(kind))
    with pytest.raises(ActionError, match=surplus):
        parse(full(kind) | {surplus: SAMPLES[surplus]})


@pytest.mark.parametrize("kind", [kind for kind, takes in FIELDS.items() if takes.target])
def test_target_is_an_index_or_a_point_never_both(kind: ActionType):
    sent = full(kind)
    with pytest.raises(ActionError, match="both"):
        parse(sent | {"x": 1, "y": 2})
    del sent["index"]
    with pytest.raises(ActionError, match="target"):
        parse(sent)
    with pytest.raises(ActionError, match="target"):
        parse(sent | {"x": 1})
    assert parse(sent | {"x": 1, "y": 2}).x == 1


@pytest.mark.parametrize(
    ("sent", "meant"),
    [
        ({"action_type": "click", "index": "3"}, Action(ActionType.CLICK, index=3)),
        ({"action_type": "click", "x": "640", "y": 360.0}, Action(ActionType.CLICK, x=640, y=360)),
        ({"action_type": "answer", "text": 50}, Action(ActionType.ANSWER, text="50")),
        ({"action_type": "long_press", "index": 3.0}, Action(ActionType.LONG_PRESS, index=3)),
        ({"action_type": "scroll", "direction": "DOWN"}, Action(ActionType.SCROLL, direction=Direction.DOWN)),
        ({"action_type": "CLICK", "index": " 3 "}, Action(ActionType.CLICK, index=3)),
        ({"action_type": "hazard_lights", "on": "True"}, Action(ActionType.HAZARD_LIGHTS, on=True)),
        ({"action_type": "show_alert", "kind": "Speed"}, Action(ActionType.SHOW_ALERT, kind=AlertKind.SPEED)),
    ],
)  # fmt: skip
def test_a_value_of_another_type_is_converted_where_nothing_is_lost(sent: dict[str, object], meant: Action) -> None:
    assert parse(sent) == meant


@pytest.mark.parametrize(
    ("sent", "said"),
    [
        ("not json", "not JSON"),
        ("[1]", "list"),
        ("{}", "action_type"),
        ({"action_type": "clik", "index": 1}, "click"),
        ({"action_type": "click", "index": "first"}, "int"),
        ({"action_type": "click", "index": 1.5}, "int"),
        ({"action_type": "click", "index": "1_000_000_000_000"}, "-2147483647 to 2147483647"),
        ({"action_type": "hazard_lights", "on": "yes"}, "bool"),
        ({"action_type": "answer", "text": ["a"]}, "str"),
        ({"action_type": "click", "index": True}, "int"),
        ({"action_type": "click", "idx": 1}, "index"),
        ({"action_type": "wait", "seconds": 0}, "1 to 60"),
        ({"action_type": "answer", "text": "x" * 121}, "120"),
        ({"action_type": "request_reroute", "destination": "x" * 121}, "destination has 121"),
        ({"action_type": "open_app", "app_name": "x" * 121}, "app_name has 121"),
        ('{"action_type": "answer", "text": "\\ud800"}', "surrogate"),
        ({"action_type": "swipe", "index": 1, "direction": "left", "distance_px": 0}, "1 to 8192"),
        ({"action_type": "request_slow_down", "speed_kmh": float("nan")}, "float"),
        ({"action_type": "request_slow_down", "speed_kmh": -1}, "0 to 300"),
        ({"action_type": "status", "goal_status": "done"}, "complete"),
        ("[" * 100_000, "not JSON"),
        ('{"action_type": "click", "x": 1e999, "y": 3}', "int"),
        ('{"action_type": "click", "x": 1' + "0" * 400 + ', "y": 3}', "-2147483647 to 2147483647"),
    ],
)
def test_what_is_wrong_is_said(sent: object, said: str):
    with pytest.raises(ActionError, match=said) as caught:
        parse(sent)  # type: ignore[arg-type]
    assert "\n" not in str(caught.value)


def test_null_means_absent():
    assert parse({"action_type": "navigate_home", "index": None}) == Action(ActionType.NAVIGATE_HOME)


@pytest.mark.parametrize("nothing", [None, "null", "None", " "])
@pytest.mark.parametrize("kind", ActionType)
def test_who_fills_in_every_field_says_nothing_by_it(kind: ActionType, nothing: object):
    takes = FIELDS[kind]
    said = {"action_type": str(kind)} | {name: SAMPLES[name] for name in takes.required}
    said |= {"index": 3} if takes.target else {}
    said |= {"arguments": SAMPLES["arguments"]} if kind is ActionType.CALL else {}
    filled = dict.fromkeys((name for name in SAMPLES if name not in {*said, "reason", "arguments"}), nothing)
    assert parse(said | filled) == parse(said)


def test_a_word_of_a_field_is_none_of_those_that_say_nothing():
    asked = {"action_type": "status", "goal_status": "not_needed"}
    assert [parse(asked | {"reason": word}).reason for word in ("none", "None", "null", "")] == [
        Reason.NONE,
        Reason.NONE,
        None,
        None,
    ]


def test_grammar_names_every_action():
    lines = grammar().splitlines()
    assert len(lines) == len(UNCALLED)
    for kind, line in zip(UNCALLED, lines, strict=True):
        assert f'"action_type": "{kind}"' in line


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
    max_leaves=8,
)


@given(json_values | st.dictionaries(st.sampled_from(["action_type", *SAMPLES]), json_values))
@pytest.mark.slow
def test_anything_is_an_action_or_an_action_error(value: object):
    try:
        action = parse(value)  # type: ignore[arg-type]
    except ActionError as error:
        assert str(error)
    else:
        assert check(action) is action


def test_a_route_to_a_street_that_is_not_there_is_refused_at_once(cockpit: Cockpit):
    asked = perform(Action(ActionType.REQUEST_REROUTE, destination="Nowhere Lane"), cockpit, ())
    assert (asked.code, asked.text) == (FeedbackCode.REFUSED, "No street or place with this name")
    assert not cockpit.given
    known = perform(Action(ActionType.REQUEST_REROUTE, destination=NAMES[0].lower()), cockpit, ())
    assert known.code is FeedbackCode.OK


@pytest.mark.parametrize("destination", ["nan,nan", "inf,0", "181,0", "0,-90.5", "1e300,1e300"])
def test_a_route_to_no_place_on_earth_is_refused(cockpit: Cockpit, destination: str):
    asked = perform(Action(ActionType.REQUEST_REROUTE, destination=destination), cockpit, ())
    assert asked.code is FeedbackCode.REFUSED
    assert "not a position on earth" in asked.text
    assert (
        perform(Action(ActionType.REQUEST_REROUTE, destination="2.35,48.85"), cockpit, ()).code is FeedbackCode.OK
    )
