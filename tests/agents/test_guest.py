"""Agents of somebody's own: loaded by name, and told what they lack."""

import sys
import textwrap

import pytest

from automotive_cosim.agents import make_agent
from automotive_cosim.agents.androidworld import AndroidWorldAgent, translated
from automotive_cosim.contracts import Action, ActionType, GoalStatus
from automotive_cosim.errors import ActionError, UserError
from automotive_cosim.interface.observe import ALL, Channel

STEPS = "class Mine:\n    def __init__(self, env): ...\n    def step(self, goal): ...\n"
WHOLE = """
class Mine:
    def reset(self, goal): self.goal = goal
    def act(self, observation): return {"action_type": "answer", "text": self.goal}
"""


@pytest.fixture
def module(tmp_path, monkeypatch, request):
    """Writes a module into the working folder and returns its name."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("sys.path", [*sys.path])

    def write(text: str) -> str:
        name = f"guest_{abs(hash(request.node.name))}_{len(list(tmp_path.iterdir()))}"
        (tmp_path / f"{name}.py").write_text(textwrap.dedent(text), encoding="utf-8")
        return name

    return write


def test_a_class_with_two_methods_is_an_agent(module, observation):
    agent = make_agent(f"{module(WHOLE)}:Mine")
    agent.reset("hello")
    assert (agent.name, agent.model, agent.channels) == ("Mine", "none", ALL)
    assert agent.act(observation("x")) == Action(ActionType.ANSWER, text="hello")


def test_what_it_prints_is_no_part_of_a_commands_answer(module, observation, capsys):
    text = """
        print("imported")
        class Mine:
            def __init__(self): print("made")
            def reset(self, goal): print("reset")
            def act(self, seen):
                print("acts")
                return {"action_type": "wait"}
    """
    agent = make_agent(f"{module(text)}:Mine")
    agent.reset("hello")
    agent.act(observation("x"))
    said = capsys.readouterr()
    assert (said.out, said.err.split()) == ("", ["imported", "made", "reset", "acts"])


def test_it_may_say_its_name_and_channels(module):
    text = WHOLE + "    name, model, channels = 'my agent', 'gpt', ('elements', 'vehicle')\n"
    agent = make_agent(f"{module(text)}:Mine")
    assert (agent.name, agent.model) == ("my agent", "gpt")
    assert agent.channels == {Channel.ELEMENTS, Channel.VEHICLE}


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("class Mine:\n    def reset(self, goal): ...\n", r"lacks act\(observation\)"),
        ("class Mine:\n    def act(self, observation): ...\n", r"lacks reset\(goal\)"),
        ("class Mine: ...\n", r"lacks reset\(goal\) and act\(observation\)"),
        ("class Mine:\n    def reset(self): ...\n    def act(self, observation): ...\n", r"reset\(goal\)"),
        ("class Mine:\n    def reset(self, goal): ...\n    def act(self, a, b): ...\n", r"act\(observation\)"),
        (WHOLE + "    def __init__(self, weights): ...\n", "without arguments"),
        ("def Mine(): ...\n", "name a class"),
        ("class Other: ...\n", "has no Mine; it has Other"),
        ("import nothing_of_that_name\n", "cannot import"),
        ("1 / 0\n", "ZeroDivisionError"),
        ("raise SystemExit\n", "SystemExit"),
        ("class Mine\n", "SyntaxError"),
        (WHOLE + "    channels = ('radar',)\n", "radar.*channels are screenshot, elements, "),
        (WHOLE + "    channels = 3\n", "channels"),
    ],
)  # fmt: skip
def test_a_broken_one_is_told_what_is_missing(module, text, said):
    with pytest.raises(UserError, match=said) as caught:
        make_agent(f"{module(text)}:Mine")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("my_agents", r"did you mean my_agents:Cautious\?"),
        ("my_agents.py", r"did you mean my_agents:Cautious\?"),
        ("my_agents.py:Cautious", "omit the .py, as in my_agents:Cautious"),
        ("code/my_agents.py:Cautious", "run the command in the folder of its file and give my_agents:Cautious"),
    ],
)
def test_a_forgotten_class_and_a_needless_suffix_are_told(tmp_path, monkeypatch, name, said):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "my_agents.py").write_text("class Words: ...\n" + WHOLE.replace("Mine", "Cautious"))
    with pytest.raises(UserError, match=said):
        make_agent(name)


@pytest.mark.parametrize("name", ["nowhere_to_be_found:X", ":X", "x:", "os:path", "os:no_such_thing"])
def test_a_name_that_leads_nowhere_is_told(name):
    with pytest.raises(UserError, match="agent"):
        make_agent(name)


def test_what_a_module_raises_is_told_with_its_line(module):
    name = module("import json\n\njson.loads('{')\n")
    with pytest.raises(UserError, match=rf"raised JSONDecodeError: .+ \({name}\.py line 3\)$"):
        make_agent(f"{name}:Mine")
    with pytest.raises(UserError, match=r"raised SyntaxError: .+ \(\w+\.py, line 1\)$"):
        make_agent(f"{module('def x:')}:Mine")


def test_a_module_without_classes_is_told(module):
    with pytest.raises(UserError, match=r"has no Mine; it has no class$"):
        make_agent(f"{module('')}:Mine")


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ("raise KeyError('x')", "raised KeyError"),
        ("raise SystemExit(3)", "raised SystemExit"),
        ("from automotive_cosim.errors import ModelError; raise ModelError('x')", "raised ModelError"),
        ("from automotive_cosim.errors import TrafficError; raise TrafficError('x')", "raised TrafficError"),
        ("return None", "returned NoneType"),
        ("return 7", "returned int"),
        ("return '{'", "not JSON"),
        ("return {'action_type': 'fly'}", "fly"),
    ],
)
def test_what_goes_wrong_in_a_step_is_the_steps_fault(module, observation, body, said):
    text = f"class Mine:\n    def reset(self, goal): ...\n    def act(self, observation): {body}\n"
    agent = make_agent(f"{module(text)}:Mine")
    with pytest.raises(ActionError, match=said):
        agent.act(observation("x"))


@pytest.mark.parametrize(
    ("body", "place"),
    [("return helped()", r"line 2\)"), ("return json.loads('{')", r"line 5\)"), ("return self.act()", r"line 5\)")],
)
def test_what_an_agent_raised_is_told_with_the_line_of_its_own_file(module, observation, body, place):
    text = (
        "import json\ndef helped(): return 1 / 0\nclass Mine:\n    def reset(self, goal): ...\n"
        f"    def act(self, observation): {body}\n"
    )
    name = module(text)
    with pytest.raises(ActionError, match=rf"raised \w+: .+ \({name}\.py {place}$"):
        make_agent(f"{name}:Mine").act(observation("x"))


# --- AndroidWorld's agents --------------------------------------------------------------------------------------


class Said:
    """AndroidWorld's ``JSONAction``, as far as it matters."""

    def __init__(self, action_type: str, **fields: object) -> None:
        self.action_type = action_type
        for name in ("index", "x", "y", "text", "direction", "goal_status", "app_name", "keycode", "clear_text"):
            setattr(self, name, fields.get(name))


class Result:
    def __init__(self, done: bool, data: dict) -> None:
        self.done, self.data = done, data


class Foreign:
    """Written against AndroidWorld's environment and unaware of ours."""

    script: tuple = ()

    def __init__(self, env) -> None:
        self.env = env
        self.seen: list = []
        self.left = list(self.script)

    def step(self, goal: str) -> Result:
        state = self.env.get_state(wait_to_stabilize=False)
        self.seen.append((state.pixels.shape, [element.text for element in state.ui_elements]))
        said = self.left.pop(0) if self.left else "raise"
        if said == "raise":
            raise RuntimeError("out of script")
        if said == "exit":
            raise SystemExit("enough")
        if said is None:
            return Result(False, {})
        if said.action_type == "status":
            return Result(True, {"action_output_json": said})
        self.env.execute_action(said)
        after = self.env.get_state()
        assert after.ui_elements[0].bbox_pixels.center == (50.0, 30.0)
        return Result(False, {"summary": goal})


def foreign(*said: object) -> AndroidWorldAgent:
    agent = AndroidWorldAgent(type("Mine", (Foreign,), {"script": said}))
    agent.reset("Watch my speed")
    return agent


def test_an_androidworld_agent_acts_and_declares_unchanged(observation):
    agent = foreign(
        Said("open_app", app_name="climate"), Said("click", index=1), Said("status", goal_status="infeasible")
    )
    actions = [agent.act(observation("x")) for _ in range(3)]
    assert actions == [
        Action(ActionType.OPEN_APP, app_name="climate"),
        Action(ActionType.CLICK, index=1),
        Action(ActionType.STATUS, goal_status=GoalStatus.INFEASIBLE),
    ]


def test_done_without_a_word_is_complete(observation):
    agent = foreign(Said("status"))
    assert agent.act(observation("x")).goal_status is GoalStatus.COMPLETE


def test_its_faults_cost_it_the_step_and_no_more(observation):
    agent = foreign(None, Said("unknown"), Said("click", index=0), "raise", Said("navigate_home"), "exit")
    said = []
    for _ in range(6):
        try:
            said.append(agent.act(observation("x")).action_type)
        except ActionError as error:
            said.append(str(error))
    assert "took no action" in said[0]
    assert "unknown" in said[1]
    assert said[2] == "click"
    assert "RuntimeError" in said[3]
    assert said[4] == "navigate_home"
    assert "SystemExit: enough" in said[5]


def test_one_that_cannot_be_made_costs_every_step(observation):
    class Broken:
        def __init__(self, env) -> None:
            raise ValueError("no weights")

        def step(self, goal): ...

    agent = AndroidWorldAgent(Broken)
    agent.reset("x")
    for _ in range(3):
        with pytest.raises(ActionError, match="no weights"):
            agent.act(observation("x"))


def test_a_reset_starts_it_anew(observation):
    agent = foreign(Said("navigate_home"), Said("navigate_back"))
    for _ in range(3):
        assert agent.act(observation("x")).action_type is ActionType.NAVIGATE_HOME
        agent.reset("x")


@pytest.mark.parametrize(
    ("said", "action"),
    [
        (Said("swipe", direction="up"), Action(ActionType.SWIPE, x=640, y=360, direction="up")),
        (Said("scroll", direction="down", index=3), Action(ActionType.SCROLL, direction="down", index=3)),
        (Said("click", x=10.4, y=20.0), Action(ActionType.CLICK, x=10, y=20)),
        (Said("wait", index=2, text="surplus"), Action(ActionType.WAIT)),
    ],
)
def test_its_actions_are_translated(said, action):
    assert translated(said) == action


def test_a_class_with_step_is_loaded_as_one(module):
    agent = make_agent(module(STEPS) + ":Mine")
    assert isinstance(agent, AndroidWorldAgent)
    assert agent.name == "Mine"
