"""Recorded answers come back in order, each to its own question."""

import json

import pytest

from automotive_cosim.errors import ModelError, UnknownNameError, UserError
from automotive_cosim.models import ChatMessage, ModelReply, make_model
from automotive_cosim.models.base import digest

ONE, TWO = [ChatMessage("user", "one")], [ChatMessage("user", "two", (b"png",))]


@pytest.fixture
def record(tmp_path):
    stages = [
        {"reply": ModelReply("1", 5, 2, 0.1, 0.5).as_json(), "asked": digest(ONE), "pictures": 0},
        {"reply": None, "asked": "", "pictures": 0},
        {"reply": ModelReply("2", finish="length").as_json(), "asked": digest(TWO), "pictures": 1},
    ]
    lines = [json.dumps({"stages": []}), json.dumps({"stages": stages[:2]}), json.dumps({"stages": stages[2:]})]
    (tmp_path / "steps.jsonl").write_text("\n".join(lines), encoding="utf-8")
    return tmp_path


def test_answers_come_as_they_were(record):
    model = make_model(f"replay/{record}")
    assert model.chat(ONE) == ModelReply("1", 5, 2, 0.1, 0.5)
    assert model.chat(TWO) == ModelReply("2", finish="length")
    assert model.sees_pictures


@pytest.mark.parametrize(
    "asked", [[ChatMessage("user", "other")], [ChatMessage("system", "one")], [ChatMessage("user", "one", (b"",))]]
)
def test_another_question_is_refused(record, asked):
    with pytest.raises(ModelError, match="question 1 differs"):
        make_model(f"replay/{record}").chat(asked)


def test_a_question_too_many_is_refused(record):
    model = make_model(f"replay/{record}")
    model.chat(ONE)
    model.chat(TWO)
    with pytest.raises(ModelError, match="2 answers"):
        model.chat(ONE)


@pytest.mark.parametrize(
    "text",
    ["", "{", "[1]", '{"stages": 3}', '{"stages": []}', '{"stages": [{"reply": {"txt": 1}, "asked": ""}]}', "\0"],
)
def test_what_is_no_recording_is_told_in_one_line(tmp_path, text):
    (tmp_path / "steps.jsonl").write_text(text, encoding="utf-8")
    with pytest.raises(UserError, match="answer") as caught:
        make_model(f"replay/{tmp_path}")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("name", ["ruls", "openai", "openai/", "/m", ""])
def test_what_is_no_model_is_told(name):
    with pytest.raises(UnknownNameError, match="no model named"):
        make_model(name)


def test_a_missing_recording_is_told(tmp_path):
    with pytest.raises(UserError, match=r"steps\.jsonl"):
        make_model(f"replay/{tmp_path / 'nowhere'}")
