"""One question before a run says what a model does not take."""

import re

import pytest

from automotive_cosim.errors import ModelError
from automotive_cosim.models import ModelReply
from automotive_cosim.models.base import estimated_tokens
from automotive_cosim.run import model_check
from automotive_cosim.run.forecast import longest_question, pictures_of
from automotive_cosim.run.plan import make_plan

PICTURE = b"a picture"


class Model:
    """Refuses pictures, long questions, or everything."""

    name, sees_pictures = "nowhere/m", True

    def __init__(self, most_tokens=10**6, pictures=True):
        self.most_tokens, self.pictures, self.asked = most_tokens, pictures, 0

    def chat(self, messages):
        self.asked += 1
        if messages[0].pictures and not self.pictures:
            raise ModelError("refused: status 400: no image input")
        if estimated_tokens(messages[0].text) > self.most_tokens:
            raise ModelError("refused: status 400: too long")
        return ModelReply("OK")


def test_a_model_that_takes_all_is_asked_once():
    model = Model()
    assert model_check.misfit(model, 2000, PICTURE) == ""
    assert model.asked == 1


@pytest.mark.parametrize(("model", "helps"), [
    (Model(pictures=False), "--see tree"),
    (Model(1000), "--prompt short"),
    (Model(1000, pictures=False), "--prompt short"),
])  # fmt: skip
def test_what_it_does_not_take_is_said_with_the_option_that_helps(model, helps):
    said = model_check.misfit(model, 2000, PICTURE)
    assert helps in said
    assert "nowhere/m" in said
    assert "status 400" in said


def test_one_that_never_answers_is_no_misfit():
    with pytest.raises(ModelError):
        model_check.misfit(Model(0), 2000, None)


class Calls(Model):
    """Answers with a call, or with words, and takes no results."""

    def __init__(self, text, takes=True):
        super().__init__()
        self.text, self.takes, self.roles = text, takes, []

    def chat(self, messages):
        self.roles.append([message.role for message in messages])
        if messages[-1].role == "tool":
            assert messages[-1].call_id == messages[-2].calls[-1].id
            assert estimated_tokens(messages[-1].text) > 1900
            if not self.takes:
                raise ModelError("refused: status 400: Unexpected role 'user' after role 'tool'")
        return ModelReply(self.text)


@pytest.mark.parametrize("text", ["OK", "<think>Hm.", '{"say": "", "calls": [{"name": "wait", "arguments": {}}]}'])
def test_one_that_calls_is_asked_a_second_question_with_a_result_in_it(text):
    model = Calls(text)
    assert model_check.misfit(model, 2000, PICTURE, calls=True) == ""
    assert model.roles == [["system", "user"], ["system", "user", "assistant", "tool"]]
    said = model_check.misfit(Calls(text, takes=False), 2000, PICTURE, calls=True)
    assert re.search("no question with the result of a call .*Unexpected role.*t3a", said)


def test_each_model_is_asked_once_for_all_trials_alike_and_the_stand_in_never(monkeypatch):
    asked = []
    monkeypatch.setattr(model_check, "misfit", lambda model, *_, calls: asked.append((model.name, calls)) or "")
    monkeypatch.setenv("NOWHERE_API_KEY", "any")
    monkeypatch.setenv("NOWHERE_BASE_URL", "http://127.0.0.1:9/v1")
    values = {"agents": ["t3a", "caller"], "models": ["rules", "nowhere/m"], "tasks": ["hvac_fan_max"]}
    assert list(model_check.misfits(make_plan(values | {"scenarios": ["grid"], "seeds": [0, 1]}).jobs())) == []
    assert sorted(asked) == [("nowhere/m", False), ("nowhere/m", True)]


@pytest.mark.parametrize(("see", "count"), [("both", 1), ("picture", 1), ("tree", 0), ("nothing", 0)])
def test_what_an_agent_is_not_shown_is_no_part_of_the_question(see, count):
    plan = {"agents": ["caller"], "tasks": ["hvac_fan_max"], "scenarios": ["grid"], "see": [see]}
    assert pictures_of(make_plan(plan | {"interface": ["functions"]}).jobs()[0]) == count


def test_a_longer_prompt_makes_longer_questions():
    def longest(prompt):
        plan = {"agents": ["t3a"], "tasks": ["hvac_fan_max"], "scenarios": ["grid"], "prompt": [prompt]}
        return longest_question(make_plan(plan).jobs()[0])

    assert longest("short") < longest("standard")
