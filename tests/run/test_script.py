import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim.cockpit.actions import to_json
from automotive_cosim.contracts import Action, ActionType, AlertKind
from automotive_cosim.errors import ActionError
from automotive_cosim.run.script import ScriptedAgent, read_script

ALERT = Action(ActionType.SHOW_ALERT, kind=AlertKind.SPEED)
HOME = Action(ActionType.NAVIGATE_HOME)


def _write(tmp_path, text):
    path = tmp_path / "actions.jsonl"
    path.write_text(text, encoding="utf-8")
    return path


def test_actions_are_played_in_order_and_then_it_waits(tmp_path, observation):
    path = _write(tmp_path, json.dumps(to_json(ALERT)) + "\n\n" + json.dumps(to_json(HOME)))
    script = read_script(path)
    seen = observation("")
    for _ in range(2):
        script.reset("")
        played = [script.act(seen) for _ in range(4)]
        assert played[:2] == [ALERT, HOME]
        assert {action.action_type for action in played[2:]} == {ActionType.WAIT}


@pytest.mark.parametrize(
    ("bad", "names"),
    [
        ("{", "JSON"),
        ("[]", "object"),
        ('{"action_type": "clik"}', "click"),
        ('{"action_type": "click"}', "index"),
        ('{"action_type": "click", "index": "one"}', "int"),
        ('{"action_type": "wait", "seconds": 99}', "seconds"),
    ],
)
def test_a_bad_line_is_refused_by_file_and_number(tmp_path, bad, names):
    path = _write(tmp_path, json.dumps(to_json(HOME)) + "\n" + bad + "\n")
    with pytest.raises(ActionError) as error:
        read_script(path)
    assert f"{path}, line 2" in str(error.value)
    assert names in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("content", [b"", b"\n \n", b"\xff\xfe\x00"])
def test_a_file_without_actions_is_refused(tmp_path, content):
    path = tmp_path / "actions.jsonl"
    path.write_bytes(content)
    with pytest.raises(ActionError, match=r"actions\.jsonl"):
        read_script(path)


@pytest.mark.parametrize("name", ["missing.jsonl", ".", "/dev/zero"])
def test_what_cannot_be_read_is_refused(tmp_path, name):
    with pytest.raises(ActionError, match="cannot read"):
        read_script(tmp_path / name)


def test_a_file_longer_than_anybody_writes_is_refused(tmp_path):
    with pytest.raises(ActionError, match="larger than 1 MB"):
        read_script(_write(tmp_path, "\n" * (2**20 + 1)))


@given(st.text(max_size=60))
def test_any_text_is_either_read_or_refused_in_words(tmp_path_factory, text):
    path = tmp_path_factory.mktemp("script") / "actions.jsonl"
    path.write_text(text, encoding="utf-8", newline="")
    try:
        assert isinstance(read_script(path), ScriptedAgent)
    except ActionError as error:
        assert str(error)
