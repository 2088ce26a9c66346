"""One question before a run says what a model does not take."""

import pytest

from automotive_cosim.errors import ModelError
from automotive_cosim.models import ModelReply
from automotive_cosim.models.base import estimated_tokens
from automotive_cosim.run import fit
from automotive_cosim.run.forecast import longest_question
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
    assert fit.misfit(model, 2000, PICTURE) == ""
    assert model.asked == 1


@pytest.mark.parametrize(("model", "helps"), [
    (Model(pictures=False), "--see tree"),
    (Model(1000), "--prompt short"),
    (Model(1000, pictures=False), "--prompt short"),
])  # fmt: skip
def test_what_it_does_not_take_is_said_with_the_option_that_helps(model, helps):
    said = fit.misfit(model, 2000, PICTURE)
    assert helps in said
    assert "nowhere/m" in said
    assert "status 400" in said


def test_one_that_never_answers_is_no_misfit():
    with pytest.raises(ModelError):
        fit.misfit(Model(0), 2000, None)


def test_each_model_is_asked_once_for_all_trials_alike_and_the_stand_in_never(monkeypatch):
    asked = []
    monkeypatch.setattr(fit, "misfit", lambda model, *_: asked.append(model.name) or "")
    monkeypatch.setenv("NOWHERE_API_KEY", "any")
    monkeypatch.setenv("NOWHERE_BASE_URL", "http://127.0.0.1:9/v1")
    values = {"agents": ["t3a", "asurada"], "models": ["rules", "nowhere/m"], "tasks": ["hvac_fan_max"]}
    assert list(fit.misfits(make_plan(values | {"scenarios": ["grid"], "seeds": [0, 1]}).jobs())) == []
    assert asked == ["nowhere/m"] * 2


def test_a_longer_prompt_makes_longer_questions():
    def longest(prompt):
        plan = {"agents": ["t3a"], "tasks": ["hvac_fan_max"], "scenarios": ["grid"], "prompt": [prompt]}
        return longest_question(make_plan(plan).jobs()[0])

    assert longest("short") < longest("standard")
