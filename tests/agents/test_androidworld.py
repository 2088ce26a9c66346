"""AndroidWorld's agents: what its device answers to ``execute_action`` and to adb; and, where a checkout of
AndroidWorld is at hand, its own classes in whole episodes."""

import io
import os
import re
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import redirect_stdout
from dataclasses import dataclass, replace
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

from automotive_cosim.agents import make_agent
from automotive_cosim.agents.androidworld import AndroidWorldAgent
from automotive_cosim.contracts import Action, ActionType, BoundingBox, Direction, Element, GoalStatus, Observation
from automotive_cosim.contracts.ids import resource_id as shown_id
from automotive_cosim.errors import ActionError
from automotive_cosim.replay.make import Touches, texts
from automotive_cosim.run.episode import EpisodeSetup
from automotive_cosim.run.trial import run_trial
from automotive_cosim.traffic.fork import Simulations

CHECKOUT = "AUTOMOTIVE_COSIM_ANDROID_WORLD"
"""A folder that holds the package ``android_world``."""
FIELD = Element("", "", "EditText", BoundingBox(0, 0, 9, 9), "field", "", is_editable=True, is_focused=True)
ENTER = Action(ActionType.KEYBOARD_ENTER)
TAP = Action(ActionType.CLICK, x=10, y=20)


class Said(SimpleNamespace):
    """AndroidWorld's ``JSONAction``."""

    def __getattr__(self, name: str) -> None:
        return None


class Request(SimpleNamespace):
    """An ``AdbRequest``."""

    timeout_sec = 10.0

    def WhichOneof(self, _: str) -> str:  # noqa: N802, protobuf's name
        return next(name for name in vars(self) if name != "timeout_sec")


def shell(*words: str) -> Request:
    return Request(generic=SimpleNamespace(args=["shell", *words]))


def tap(**named: float) -> Request:
    return Request(tap=SimpleNamespace(x=10, y=20), **named)


def types(*words: str) -> list[Request]:
    return [Request(input_text=SimpleNamespace(text=word)) for word in words]


def press(button: int) -> Request:
    return Request(press_button=SimpleNamespace(button=button))


@dataclass
class Result:
    done: bool
    data: dict[str, Any]


@pytest.fixture
def seen(observation: Callable[..., Observation]) -> Observation:
    return observation("x", screenshot=np.zeros((720, 1280, 3), np.uint8), elements=(FIELD,))


@pytest.fixture
def does(seen: Observation) -> Iterator[Callable[..., list[Action | str]]]:
    """What an agent's step comes to: its actions, and what it is told."""

    made: list[AndroidWorldAgent] = []

    def do(step: Callable[[Any], Result | None], count: int, shown: Observation = seen) -> list[Action | str]:
        class Mine:
            def __init__(self, env: Any) -> None:
                self.env = env

            def step(self, goal: str) -> Result:
                return step(self.env) or Result(False, {})

        agent = AndroidWorldAgent(Mine)
        made.append(agent)
        agent.reset("x")
        found: list[Action | str] = []
        for _ in range(count):
            try:
                found.append(agent.act(shown))
            except ActionError as error:
                found.append(str(error))
        return found

    yield do
    for agent in made:
        agent.reset("x")


@pytest.mark.parametrize(
    ("requests", "expected"),
    [
        ([tap()], [TAP]),
        ([tap(timeout_sec=0), tap()], [Action(ActionType.DOUBLE_TAP, x=10, y=20)]),
        ([tap(timeout_sec=0)], [TAP]),
        ([shell("input", "tap", "10", "20")], [TAP]),
        ([shell("input", "swipe", "10", "20", "10", "20", "1000")], [Action(ActionType.LONG_PRESS, x=10, y=20)]),
        (
            [shell("input", "swipe", "640", "600", "640", "100", "")],
            [Action(ActionType.SWIPE, x=640, y=600, direction=Direction.UP, distance_px=500)],
        ),
        (
            [shell("input", "draganddrop", "100", "20", "300", "30", "4000")],
            [Action(ActionType.SWIPE, x=100, y=20, direction=Direction.RIGHT, distance_px=200)],
        ),
        ([press(0)], [Action(ActionType.NAVIGATE_HOME)]),
        ([press(1)], [Action(ActionType.NAVIGATE_BACK)]),
        ([shell("input", "keyevent", "KEYCODE_BACK")], [Action(ActionType.NAVIGATE_BACK)]),
        ([shell("input", "keyevent", "66")], [ENTER]),
        (
            [*types("Rue", "%s", "d\\'Ulm"), press(2)],
            [Action(ActionType.INPUT_TEXT, index=0, text="Rue d'Ulm"), ENTER],
        ),
        (
            [shell("input", "keycombination", "113", "29", "&&", "input", "keyevent", "67"), *types("a")],
            [Action(ActionType.INPUT_TEXT, index=0, text="a", clear_text=True)],
        ),
        ([shell("monkey", "-p", "climate", "1")], [Action(ActionType.OPEN_APP, app_name="climate")]),
    ],
)
def test_adb_works_the_car(does: Any, requests: list[Request], expected: list[Action]) -> None:
    def step(env: Any) -> None:
        assert [env.controller.execute_adb_call(request).status for request in requests] == [1] * len(requests)

    assert does(step, len(expected)) == expected


@pytest.mark.parametrize(
    ("request_", "said"),
    [
        (shell("input", "keyevent", "KEYCODE_POWER"), "no key 'KEYCODE_POWER'"),
        (shell("input", "roll", "1"), "nothing that this car knows"),
        (shell("settings", "put", "system", "pointer_location", "0"), "took no action"),
    ],
)
def test_adb_for_what_the_car_does_not_have_costs_the_step(does: Any, request_: Request, said: str) -> None:
    [told] = does(lambda env: env.controller.execute_adb_call(request_) and None, 1)
    assert said in told


def test_adb_tells_the_frame_and_the_orientation(does: Any) -> None:
    told: list[str] = []

    def step(env: Any) -> None:
        for words in (("dumpsys", "input"), ("dumpsys", "window"), ("wm", "size")):
            told.append(env.controller.execute_adb_call(shell(*words)).generic.output.decode())

    does(step, 1)
    assert "physicalFrame=[0, 0, 1280, 720]" in told[0]
    assert "mCurrentRotation=ROTATION_0" in told[1]
    assert "1280x720" in told[2]


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        (
            Said(action_type="input_text", text="a", index=0),
            [Action(ActionType.INPUT_TEXT, index=0, text="a"), ENTER],
        ),
        (Said(action_type="input_text", text="a"), [Action(ActionType.INPUT_TEXT, index=0, text="a"), ENTER]),
        (
            Said(action_type="swipe", direction="left"),
            [Action(ActionType.SWIPE, x=640, y=360, direction=Direction.RIGHT)],
        ),
        (Said(action_type="answer", text="50"), [Action(ActionType.ANSWER, text="50")]),
    ],
)
def test_actions_do_what_they_do_on_its_device(does: Any, said: Said, expected: list[Action]) -> None:
    assert does(lambda env: env.execute_action(said), len(expected)) == expected


@pytest.mark.parametrize("kind", ["click", "double_tap", "long_press"])
def test_a_touch_without_a_target_is_an_error(does: Any, kind: str) -> None:
    caught: list[Exception] = []

    def step(env: Any) -> None:
        try:
            env.execute_action(Said(action_type=kind))
        except ValueError as error:
            caught.append(error)

    [told] = does(step, 1)
    assert "took no action" in told
    assert f"Invalid {kind} action" in str(caught[0])


@pytest.mark.parametrize(
    ("data", "status"),
    [
        ({}, GoalStatus.COMPLETE),
        ({"action": Said(goal_status="infeasible")}, GoalStatus.INFEASIBLE),
        (
            {
                "action_prompt": '{"action_type": "status", "goal_status": "complete"}',
                "action_output": 'Reason: no.\nAction: {"action_type": "status", "goal_status": "infeasible"}',
            },
            GoalStatus.INFEASIBLE,
        ),
        ({"action_output": "Action: {'goal_status': 'not_needed'}"}, GoalStatus.NOT_NEEDED),
        (
            {
                "action": Said(action_type="status", goal_status="task_complete"),
                "dummy_action": {"name": "mobile_use", "arguments": {"action": "terminate", "status": "failure"}},
            },
            GoalStatus.INFEASIBLE,
        ),
        ({"action_output": 'Action: {"goal_status": "perhaps"}', "summary": None}, GoalStatus.COMPLETE),
    ],
)
def test_the_declared_status_arrives(does: Any, data: dict[str, Any], status: GoalStatus) -> None:
    [action] = does(lambda env: Result(True, data), 1)
    assert action.goal_status is status


def test_a_wait_of_which_the_device_hears_nothing_is_a_wait(does: Any) -> None:
    said = Said(action_type="wait")
    assert does(lambda env: Result(False, {"action": said}), 1) == [Action(ActionType.WAIT)]


def test_it_hears_what_the_driver_says_later(seen: Observation) -> None:
    heard: list[str] = []

    class Mine:
        def __init__(self, env: Any) -> None:
            self.env = env

        def step(self, goal: str) -> Result:
            heard.append(goal)
            self.env.execute_action(Said(action_type="wait"))
            return Result(False, {})

    agent = AndroidWorldAgent(Mine)
    agent.reset("x")
    for said in ((), (), ("No, the other one.",), ("No, the other one.", "Thanks.")):
        agent.act(replace(seen, said=said))
    agent.reset("x")
    once = "x\nSince then: No, the other one."
    assert heard == ["x", "x", once, f"{once}\nSince then: Thanks."]


@pytest.mark.parametrize("keeps", [False, True])
def test_the_devices_modules_pause_only_if_the_class_wants_it(
    seen: Observation, monkeypatch: pytest.MonkeyPatch, keeps: bool
) -> None:
    device, others = ModuleType("android_world.env.actuation"), ModuleType("android_world.agents.infer")
    for module in (device, others):
        module.time = time  # type: ignore[attr-defined]
        monkeypatch.setitem(sys.modules, module.__name__, module)

    class Mine:
        keeps_pauses = keeps

        def __init__(self, env: Any) -> None:
            self.transition_pause = 1.0

        def step(self, goal: str) -> Result:
            return Result(True, {"transition_pause": self.transition_pause})

    agent = AndroidWorldAgent(Mine)
    agent.reset("x")
    agent.act(seen)
    agent.reset("x")
    assert (device.time is time) is keeps
    assert others.time is time
    if not keeps:
        device.time.sleep(600)
        assert device.time.monotonic() >= 0


def test_its_pauses_are_off_and_what_it_prints_is_not_our_output(seen: Observation) -> None:
    class Mine:
        def __init__(self, env: Any) -> None:
            self.env, self.transition_pause, self.wait_after_action_seconds = env, 1.0, 2.0

        def step(self, goal: str) -> Result:
            print("----------step 1")
            assert (self.transition_pause, self.wait_after_action_seconds) == (None, 0.0)
            return Result(True, {})

    agent = AndroidWorldAgent(Mine)
    agent.reset("x")
    with redirect_stdout(io.StringIO()) as printed:
        assert agent.act(seen).action_type is ActionType.STATUS
        print("ours")
    assert printed.getvalue() == "ours\n"
    agent.reset("x")


# --- AndroidWorld's own classes -----------------------------------------------------------------------------------


@pytest.fixture
def checkout(monkeypatch: pytest.MonkeyPatch) -> None:
    """Makes AndroidWorld's own package importable."""
    folder = os.environ.get(CHECKOUT)
    if folder is None:
        pytest.skip(f"{CHECKOUT} is not set: a folder with AndroidWorld's package android_world")
    if not (Path(folder) / "android_world").is_dir():
        pytest.skip(f"{folder} has no android_world")
    pytest.importorskip("android_env", reason="AndroidWorld's own dependencies are not installed")
    monkeypatch.setattr(sys, "path", [folder, *sys.path])


def needs(*modules: str) -> None:
    """Skips where one is missing."""
    for name in modules:
        try:
            __import__(name)
        except ImportError as error:
            pytest.skip(f"this checkout or its dependencies lack {name}: {error}")


class Chooses:
    """A model that finds the fan by what AndroidWorld's environment shows; every second answer is a summary."""

    def __init__(self, env: Any, last: str) -> None:
        self.env, self.last, self.asked = env, last, 0

    def predict(self, prompt: str) -> tuple[str, bool, object]:
        self.asked += 1
        return (self.action() if self.asked % 2 else "Done."), True, {"raw": "answer"}

    def predict_mm(self, prompt: str, images: list[Any]) -> tuple[str, bool, object]:
        return self.predict(prompt)

    def action(self) -> str:
        ids = [element.resource_id for element in self.env.get_state().ui_elements]
        wanted = {1: "dock.climate", 3: "hvac.fan.max"}.get(self.asked)
        if wanted:
            index = ids.index(shown_id(wanted))
            return f'Reason: I see.\nAction: {{"action_type": "click", "index": {index}}}'
        return f'Reason: I see.\nAction: {{"action_type": "status", "goal_status": "{self.last}"}}'


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("last", ["complete", "infeasible"])
@pytest.mark.parametrize("name", ["t3a.T3A", "m3a.M3A"])
def test_its_agents_run_whole_episodes(checkout: None, simulations: Simulations, name: str, last: str) -> None:
    module, _, named = name.partition(".")
    original = getattr(__import__(f"android_world.agents.{module}", fromlist=[named]), named)

    class Mine(original):  # type: ignore[misc]
        def __init__(self, env: Any) -> None:
            super().__init__(env, Chooses(env, last))

    setup = EpisodeSetup("hvac_fan_max", scenario="grid", agent=named, model="own")
    result = run_trial(setup, AndroidWorldAgent(Mine), simulations=simulations)
    assert (result.success, result.steps, result.end) == (last == "complete", 3, "declared")
    assert result.parts
    assert result.parts.goal


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
def test_seeact_runs_whole_episodes(
    checkout: None, simulations: Simulations, monkeypatch: pytest.MonkeyPatch
) -> None:
    needs("IPython", "matplotlib", "requests")
    from android_world.agents import seeact, seeact_utils

    wanted = [r"climate", r"max", None]
    asked: list[str] = []

    def answer(url: str, json: dict[str, Any], **_: Any) -> SimpleNamespace:
        """OpenAI, asked twice a step: for words, and for the choice that they mean."""
        text = json["messages"][-1]["content"][0]["text"]
        said = "I see."
        if "Multichoice" in text:
            label = wanted.pop(0)
            found = label and re.search(rf"^([A-Z]+)\. .*{label}", text, re.MULTILINE | re.IGNORECASE)
            said = (
                f"ELEMENT: {found[1] if found else None}\nACTION: {'CLICK' if found else 'TERMINATE'}\nVALUE: None"
            )
        asked.append(text)
        return SimpleNamespace(json=lambda: {"choices": [{"message": {"content": said}}]})

    monkeypatch.setattr(seeact_utils.requests, "post", answer)
    monkeypatch.setenv("OPENAI_API_KEY", "none")
    setup = EpisodeSetup("hvac_fan_max", scenario="grid", agent="SeeAct", model="own")
    result = run_trial(setup, AndroidWorldAgent(seeact.SeeAct), simulations=simulations)
    assert (result.success, result.steps, result.end) == (True, 3, "declared")
    assert len(asked) == 6


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("last", ["complete", "infeasible"])
def test_gui_owl_runs_whole_episodes(
    checkout: None, simulations: Simulations, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, last: str
) -> None:
    needs("android_world.agents.gui_owl", "qwen_agent")
    from android_world.agents import gui_owl

    watcher = Touches()
    setup = EpisodeSetup("hvac_fan_max", scenario="grid", agent="oracle", model="none")
    run_trial(setup, make_agent("oracle"), (watcher,), simulations=simulations)
    *touches, _ = watcher.actions
    acts = [*touches, Action(ActionType.STATUS, goal_status=GoalStatus(last))]
    answers = texts("gui-owl-1.5", acts)

    class Mine(gui_owl.GUIOwl):  # type: ignore[misc]
        def __init__(self, env: Any) -> None:
            model = SimpleNamespace(predict_mm=lambda prompt, images, messages: (answers.pop(0), None, None))
            super().__init__(env, model, "qwen-vl", None, None, output_path=str(tmp_path / "out"))

    setup = EpisodeSetup("hvac_fan_max", scenario="grid", agent="GUIOwl", model="own")
    result = run_trial(setup, AndroidWorldAgent(Mine), simulations=simulations)
    assert (result.success, result.steps, result.end) == (last == "complete", len(acts), "declared")
    assert result.parts
    assert result.parts.goal
