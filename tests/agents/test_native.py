"""Native formats: what a model of each family answers, as actions; and back."""

import json
import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim.agents import AgentSettings, NativeAgent, make_agent
from automotive_cosim.agents.native.formats import FORMATS, chosen
from automotive_cosim.agents.native.grid import GuiScreen, Resized
from automotive_cosim.agents.native.verbs import Hand, actions, call_for
from automotive_cosim.contracts import (
    Action,
    ActionType,
    AlertKind,
    BoundingBox,
    Direction,
    Element,
    GoalStatus,
    Json,
    Observation,
)
from automotive_cosim.errors import ActionError, OutOfBudgetError, UnknownNameError, UserError
from automotive_cosim.models.base import ChatMessage, ModelReply

SIZES = ((1280, 720), (1920, 1080), (1024, 600))
CLICK, TYPE, SWIPE = ActionType.CLICK, ActionType.INPUT_TEXT, ActionType.SWIPE
FIELD = Element("", "", "EditText", BoundingBox(0, 0, 9, 9), "field", "", is_editable=True, is_focused=True)
ENTER = Action(ActionType.KEYBOARD_ENTER)
LIST = Element("", "", "ListView", BoundingBox(100, 100, 600, 600), "list", "", is_scrollable=True)
SHOWN = (LIST, FIELD)


def read(form: str, text: str, elements: Sequence[Element] = SHOWN) -> list[Action]:
    chosen_form = FORMATS[form]
    hand = Hand(GuiScreen(1280, 720, chosen_form.grid), elements)
    calls = chosen_form.syntax.read(text, chosen_form.verbs)
    return [action for call in calls for action in actions(chosen_form.verbs, call, hand)]


def tool(**arguments: object) -> str:
    return f"<tool_call>\n{json.dumps({'name': 'mobile_use', 'arguments': arguments})}\n</tool_call>"


def calls(*each: Json, say: str = "") -> str:
    """What a provider's own protocol comes to."""
    return json.dumps({"say": say, "calls": [{"name": call.pop("name"), "arguments": call} for call in each]})


def code(*lines: str) -> str:
    return "## Action:\nDo it.\n\n## Code:\n```python\n" + "\n".join(lines) + "\n```"


# --- coordinates --------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("form", "size"), list(product(FORMATS, SIZES)))
def test_every_pixel_comes_back_within_one(form: str, size: tuple[int, int]) -> None:
    screen = GuiScreen(*size, FORMATS[form].grid)
    for x, y in [*((x, 0) for x in range(size[0])), *((0, y) for y in range(size[1]))]:
        back = screen.pixel(*screen.point(x, y))
        assert max(abs(back[0] - x), abs(back[1] - y)) <= 1


@pytest.mark.parametrize(
    ("grid", "size", "span"),
    [
        (Resized(28, 3136, 12_845_056), (1280, 720), (1288, 728)),
        (Resized(32, 3136, 12_845_056), (1280, 720), (1280, 704)),
        (Resized(28, 3136, 28 * 28 * 100), (1280, 720), (364, 196)),
        (Resized(28, 28 * 28 * 1000, 12_845_056), (280, 280), (896, 896)),
        (Resized(28, 3136, 12_845_056), (7, 7), (56, 56)),
    ],
)
def test_pictures_are_resized_as_the_models_do(grid: Resized, size: tuple[int, int], span: tuple[int, int]) -> None:
    assert grid.span(*size) == span


def test_a_point_beyond_the_screen_is_at_its_edge() -> None:
    screen = GuiScreen(1280, 720, FORMATS["qwen3-vl"].grid)
    assert screen.pixel(5000, -3) == (1279, 0)
    assert screen.pixel(999, 999) == (1279, 719)


# --- both ways ----------------------------------------------------------------------------------------------

SAMPLES: tuple[Action, ...] = (
    Action(CLICK, x=640, y=360),
    Action(ActionType.DOUBLE_TAP, x=1000, y=20),
    Action(ActionType.LONG_PRESS, x=3, y=700),
    Action(TYPE, x=5, y=5, text='don\'t "stop", 50 km/h (now)'),
    Action(SWIPE, x=300, y=300, direction=Direction.RIGHT, distance_px=200),
    Action(SWIPE, x=300, y=300, direction=Direction.UP),
    Action(ActionType.SCROLL, direction=Direction.DOWN),
    Action(ActionType.KEYBOARD_ENTER),
    Action(ActionType.NAVIGATE_HOME),
    Action(ActionType.NAVIGATE_BACK),
    Action(ActionType.OPEN_APP, app_name="climate"),
    Action(ActionType.WAIT, seconds=1),
    Action(ActionType.ANSWER, text="It is 50 km/h."),
    Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE),
    Action(ActionType.STATUS, goal_status=GoalStatus.INFEASIBLE),
    Action(ActionType.STATUS, goal_status=GoalStatus.NOT_NEEDED),
    Action(ActionType.SHOW_ALERT, kind=AlertKind.SPEED),
    Action(ActionType.PULL_OVER),
)


@pytest.mark.parametrize("form", FORMATS)
def test_what_a_format_can_say_is_read_as_it_was_meant(form: str) -> None:
    chosen_form = FORMATS[form]
    screen = GuiScreen(1280, 720, chosen_form.grid)
    said = {action: call for action in SAMPLES if (call := call_for(chosen_form.verbs, action, screen))}
    assert {CLICK, TYPE, ActionType.STATUS, ActionType.WAIT} <= {action.action_type for action in said}
    for action, call in said.items():
        shown = SHOWN if action.action_type is TYPE else ()
        back, *more = read(form, chosen_form.syntax.write("I see.", [call], chosen_form.verbs), shown)
        assert more == ([ENTER] if (form, action.action_type) == ("gemini", TYPE) else [])
        if back.x is not None and back.y is not None and action.x is not None and action.y is not None:
            assert max(abs(back.x - action.x), abs(back.y - action.y)) <= 1
        if action.distance_px is not None:
            assert back.distance_px is not None
            assert abs(back.distance_px - action.distance_px) <= 2
        where = {"x": None, "y": None, "index": None, "distance_px": None, "seconds": None}
        assert replace(back, **where) == replace(action, **where)
    both = list(said.values())[:1] * 2
    together = chosen_form.syntax.write("Two.", both, chosen_form.verbs)
    assert len(read(form, together)) == (1 if form == "json" else 2)


@pytest.mark.parametrize("form", FORMATS)
def test_the_prompt_names_every_word_of_the_format_and_it_says_what_it_lacks(form: str) -> None:
    chosen_form = FORMATS[form]
    told = chosen_form.syntax.describe(chosen_form.verbs, 1280, 720)
    if chosen_form.api is None:
        for name, verb in chosen_form.verbs.items():
            assert bool(re.search(rf"\b{name}\b", told)) != verb.unasked
    screen = GuiScreen(9, 9, chosen_form.grid)
    sayable = {action.action_type for action in SAMPLES if call_for(chosen_form.verbs, action, screen)}
    assert not {str(kind) for kind in sayable} & set(chosen_form.lacks)
    assert {"query", "estimate_position"} <= set(chosen_form.lacks)
    assert ("show_alert" in chosen_form.lacks) == ("not_needed" in chosen_form.lacks)


# --- what each family answers -------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("form", "text", "expected"),
    [
        ("ui-tars-1.0", "Thought: a\nAction: click(start_box='(500,500)')", [Action(CLICK, x=640, y=360)]),
        (
            "ui-tars-1.0",
            "Thought: a\nAction: click(start_box='<|box_start|>(400,450,600,550)<|box_end|>')",
            [Action(CLICK, x=640, y=360)],
        ),
        ("ui-tars-1.5", "Action: click(point='<point>644 364</point>')", [Action(CLICK, x=640, y=360)]),
        (
            "ui-tars-1.5",
            "Thought: Type it.\nAction: type(content='Rue d'Ulm\\n')",
            [Action(TYPE, index=1, text="Rue d'Ulm"), Action(ActionType.KEYBOARD_ENTER)],
        ),
        (
            "ui-tars-1.5",
            "Action: scroll(point='<point>300 300</point>', direction='down')",
            [Action(ActionType.SCROLL, index=0, direction=Direction.DOWN)],
        ),
        (
            "ui-tars-1.5",
            "Action: drag(start_point='<point>322 364</point>', end_point='<point>644 374</point>')",
            [Action(SWIPE, x=320, y=360, direction=Direction.RIGHT, distance_px=320)],
        ),
        (
            "ui-tars-1.5",
            "Thought: x\nAction: press_back()\n\nfinished(content='done')",
            [Action(ActionType.NAVIGATE_BACK), Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE)],
        ),
        ("ui-tars-1.5", "Action: call_user()", [Action(ActionType.STATUS, goal_status=GoalStatus.INFEASIBLE)]),
        ("qwen2.5-vl", tool(action="click", coordinate=[644, 364]), [Action(CLICK, x=640, y=360)]),
        (
            "qwen2.5-vl",
            tool(action="swipe", coordinate=[644, 600], coordinate2=[644, 300]),
            [Action(SWIPE, x=640, y=593, direction=Direction.UP, distance_px=296)],
        ),
        ("qwen2.5-vl", tool(action="system_button", button="Back"), [Action(ActionType.NAVIGATE_BACK)]),
        ("qwen2.5-vl", tool(action="wait", time=2), [Action(ActionType.WAIT, seconds=2)]),
        ("qwen2.5-vl", tool(action="wait", time=99.5), [Action(ActionType.WAIT, seconds=10)]),
        (
            "qwen2.5-vl",
            tool(action="terminate", status="failure"),
            [Action(ActionType.STATUS, goal_status=GoalStatus.INFEASIBLE)],
        ),
        (
            "qwen2.5-vl",
            '<tool_call>{"name": "car", "arguments": {"action_type": "show_alert", "kind": "speed"}}</tool_call>',
            [Action(ActionType.SHOW_ALERT, kind=AlertKind.SPEED)],
        ),
        (
            "qwen3-vl",
            "Thought: a\nAction: Tap it.\n" + tool(action="click", coordinate=[999, 0]),
            [Action(CLICK, x=1279, y=0)],
        ),
        ("qwen3-vl", tool(action="answer", text="50"), [Action(ActionType.ANSWER, text="50")]),
        ("gui-owl", tool(action="key", text="enter"), [Action(ActionType.KEYBOARD_ENTER)]),
        ("gui-owl-1.5", tool(action="interact", text="Which?"), [Action(ActionType.ASK_DRIVER, text="Which?")]),
        ("mai-ui", tool(action="ask_user", text="Which one?"), [Action(ActionType.ASK_DRIVER, text="Which one?")]),
        ("gui-owl-1.5", tool(action="click", coordinate=[500, 500]), [Action(CLICK, x=640, y=360)]),
        ("mai-ui", tool(action="swipe", direction="up"), [Action(SWIPE, x=640, y=360, direction=Direction.UP)]),
        (
            "mai-ui",
            "<thinking>\na {brace} and <tool_call>\n</thinking>\n" + tool(action="open", text="climate"),
            [Action(ActionType.OPEN_APP, app_name="climate")],
        ),
        ("opencua", code("import pyautogui", "pyautogui.click(x=644, y=364)"), [Action(CLICK, x=640, y=360)]),
        (
            "opencua",
            code("pyautogui.click(644, 364)", "pyautogui.write('Ulm')", "pyautogui.press(['enter'])"),
            [Action(CLICK, x=640, y=360), Action(TYPE, index=1, text="Ulm"), Action(ActionType.KEYBOARD_ENTER)],
        ),
        (
            "opencua",
            code("pyautogui.moveTo(x=322, y=364)", "pyautogui.dragTo(x=644, y=364, button='left')"),
            [Action(SWIPE, x=320, y=360, direction=Direction.RIGHT, distance_px=320)],
        ),
        ("opencua", code("pyautogui.scroll(-3)"), [Action(ActionType.SCROLL, direction=Direction.DOWN)]),
        (
            "opencua",
            code("computer.terminate(status='success')"),
            [Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE)],
        ),
        (
            "openai",
            calls({"name": "click", "button": "left", "x": 640, "y": 360}, {"name": "keypress", "keys": ["ENTER"]}),
            [Action(CLICK, x=640, y=360), ENTER],
        ),
        (
            "openai",
            calls({"name": "scroll", "x": 300, "y": 300, "scroll_x": 0, "scroll_y": 120}),
            [Action(ActionType.SCROLL, index=0, direction=Direction.DOWN)],
        ),
        (
            "openai",
            calls({"name": "drag", "path": [{"x": 320, "y": 360}, {"x": 400, "y": 360}, {"x": 640, "y": 365}]}),
            [Action(SWIPE, x=320, y=360, direction=Direction.RIGHT, distance_px=320)],
        ),
        ("openai", calls(say="It is done."), [Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE)]),
        (
            "openai",
            calls({"name": "car", "action_type": "status", "goal_status": "not_needed"}),
            [Action(ActionType.STATUS, goal_status=GoalStatus.NOT_NEEDED)],
        ),
        ("anthropic", calls({"name": "left_click", "coordinate": [640, 360]}), [Action(CLICK, x=640, y=360)]),
        (
            "anthropic",
            calls({"name": "scroll", "coordinate": [1, 1], "scroll_direction": "up", "scroll_amount": 3}),
            [Action(ActionType.SCROLL, direction=Direction.UP)],
        ),
        ("anthropic", calls({"name": "key", "text": "Return"}), [ENTER]),
        ("anthropic", calls({"name": "wait", "duration": 3}), [Action(ActionType.WAIT, seconds=3)]),
        ("gemini", calls({"name": "click_at", "x": 500, "y": 500}), [Action(CLICK, x=640, y=360)]),
        (
            "gemini",
            calls({"name": "type_text_at", "x": 500, "y": 500, "text": "Ulm"}),
            [Action(TYPE, x=640, y=360, text="Ulm"), ENTER],
        ),
        (
            "gemini",
            calls({"name": "type_text_at", "x": 500, "y": 500, "text": "Ulm", "press_enter": False}),
            [Action(TYPE, x=640, y=360, text="Ulm")],
        ),
        ("gemini", calls({"name": "go_back"}), [Action(ActionType.NAVIGATE_BACK)]),
        ("gemini", calls({"name": "wait_5_seconds"}), [Action(ActionType.WAIT, seconds=5)]),
        (
            "json",
            'Situation: a\nPlan: b\nAction: {"action_type": "click", "x": 640, "y": 360}',
            [Action(CLICK, x=640, y=360)],
        ),
    ],
)
def test_answers_are_read(form: str, text: str, expected: list[Action]) -> None:
    assert read(form, text) == expected


MIDDLE = [Action(CLICK, x=640, y=360)]
BOXES = (
    "start_box='<|box_start|>(644,364)<|box_end|>'",
    "start_box='(644,364)'",
    'start_box="(644, 364)"',
    "start_box='[644, 364]'",
    "start_box='[630, 350, 658, 378]'",
    "start_box='<|box_start|>(630,350),(658,378)<|box_end|>'",
    "start_box='<bbox>630 350 658 378</bbox>'",
    "start_box='<point>644 364</point>'",
    "start_box=<|box_start|>(644,364)<|box_end|>",
    "start_box=(644, 364)",
    "point='<point>644 364</point>'",
    "point='644 364'",
    "start_point='<point>644 364</point>'",
    "'<point>644 364</point>'",
    "644, 364",
)
"""A point as UI-TARS 1.5 writes it, whatever the prompt asks for: bytedance/UI-TARS 125, 183; UI-TARS-desktop 28,
37, 233, 234, 942."""


@pytest.mark.parametrize("box", BOXES)
def test_a_point_is_read_in_every_spelling(box: str) -> None:
    assert read("ui-tars-1.5", f"Thought: The fan.\nAction: click({box})") == MIDDLE


@pytest.mark.parametrize(
    "text",
    [
        "Action: click(point='<point>644 364</point>'",  # UI-TARS-desktop 942
        "Action: click(point='<point>644 364</point>)",
        "Action: click(point='<point>644 364</point>\"",
        "Action: click(start_box='<|box_start|>(644,364)<|box_end|>'",
        "Action: click(start_box='(644,364)')<|im_end|>",
        "Action: click(start_box='(644,364)')<|im_end|>\n<|im_start|>user\nAction: press_back()",
        "Action: click(start_box='(644,364)')</s>",
        "Action\uff1aclick(start_box='(644,364)')",  # midscene 843
        "Action\uff1aclick\uff08start_box=\u2018\uff08644\uff0c364\uff09\u2019\uff09",
        "Action: click(start_box\uff1d'(644\uff0c364)')",
        "Action: click(start_box='(644,364)') to open it.",
        "Action:\n```\nclick(start_box='(644,364)')\n```",
        "Action: `click(start_box='(644,364)')`",
        "action: click(start_box='(644,364)');",
        "Thought: Action: none yet, (so) it's time.\nAction: click(start_box='(644,364)')",
        "1. The fan.\nAction: click(start_box='<|box_start|>(644,364)<|box_end|>')",
        "click(start_box='(644,364)')",
        "Action: Click(start_box='(644,364)')",
        "Action: <action>click(start_box='(644,364)')</action>",
        "Action: click(x=644, y=364)",
        "Action: click(position='(644,364)')",
        "Action: left_single(point='<point>644 364</point>')",
    ],
)
def test_an_answer_of_ui_tars_is_read_though_its_end_or_its_punctuation_is_not_as_asked(text: str) -> None:
    assert read("ui-tars-1.5", text) == MIDDLE


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("hotkey(key='enter')", [ENTER]),
        ("hotkey(hotkey='Return')", [ENTER]),
        ("press(key='esc')", [Action(ActionType.NAVIGATE_BACK)]),
        ("right_single(start_box='(644,364)')", [Action(ActionType.LONG_PRESS, x=640, y=360)]),
        (
            "drag(start_box='<|box_start|>(322,364)<|box_end|>', end_box='<|box_start|>(644,374)<|box_end|>')",
            [Action(SWIPE, x=320, y=360, direction=Direction.RIGHT, distance_px=320)],
        ),
        ("type(content='don't (stop), now')", [Action(TYPE, index=1, text="don't (stop), now")]),
        ("type(content='\u4f60\uff0c\u597d'", [Action(TYPE, index=1, text="\u4f60\uff0c\u597d")]),
        ("type(text='Ulm'", [Action(TYPE, index=1, text="Ulm")]),
        (
            "scroll(direction='down', start_box='(300,300)'",
            [Action(ActionType.SCROLL, index=0, direction=Direction.DOWN)],
        ),
        ("scroll(up)", [Action(ActionType.SCROLL, direction=Direction.UP)]),
        ("press_back", [Action(ActionType.NAVIGATE_BACK)]),
        ("`finished`.", [Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE)]),
        ("finished(content='done')<|im_end|>", [Action(ActionType.STATUS, goal_status=GoalStatus.COMPLETE)]),
    ],
)  # fmt: skip
def test_every_word_of_ui_tars_is_read_in_the_same_spellings(text: str, expected: list[Action]) -> None:
    assert read("ui-tars-1.5", f"Thought: so.\nAction: {text}") == expected


@pytest.mark.parametrize("form", ["qwen2.5-vl", "gui-owl"])
@pytest.mark.parametrize(
    "text",
    [
        '<tool_call>\n{"name": "mobile_use", "arguments": {"action": "click", "coordinate": [644, 364]}',
        '<tool_call>{"name": "mobile_use", "arguments": {"action": "click", "coordinate": [644, 364]}}<|im_end|>',
        '{"name": "mobile_use", "arguments": "{\\"action\\": \\"click\\", \\"coordinate\\": [644, 364]}"}',
        "<tool_call>{'name': 'mobile_use', 'arguments': {'action': 'click', 'coordinate': [644, 364]}}</tool_call>",
        '{"action": "click", "coordinate": [644, 364]}',  # X-PLUG/MobileAgent 182
        '{"name": "click", "arguments": {"coordinate": [644, 364]}}',
        '<tool_call>{"name": "mobile_use", "arguments": {"action": "click", "coordinate": [644 364]}}</tool_call>',
        '{"name": "mobile_use", "arguments": {"action": "click", "coordinate": "[644, 364]"}}',
        '<tool_call>{\u201cname\u201d\uff1a \u201cmobile_use\u201d\uff0c \u201carguments\u201d\uff1a '
        '{\u201caction\u201d\uff1a \u201cclick\u201d\uff0c \u201ccoordinate\u201d\uff1a [644, 364]}}</tool_call>',
        '```json\n{"name": "mobile_use", "parameters": {"action": "click", "coordinate": [644, 364]}}\n```',
    ],
)  # fmt: skip
def test_a_tool_call_is_read_though_its_json_is_not_as_asked(form: str, text: str) -> None:
    assert read(form, text) == MIDDLE


@pytest.mark.parametrize(
    "text",
    [
        "## Action:\nTap.\n\n## Code:\n```python\npyautogui.click(x=644, y=364)<|im_end|>",
        "## Code:\npyautogui.click(x=644, y=364)",
        "## Code:\n```python\npyautogui.click(x=644, y=364\n```",
        "## Code:\n```python\npyautogui.click\uff08x=644\uff0c y=364\uff09\n```",
    ],
)
def test_code_is_read_though_its_frame_is_not_as_asked(text: str) -> None:
    assert read("opencua", text) == MIDDLE


@pytest.mark.parametrize(
    ("form", "text", "said"),
    [
        *(
            (form, text, "the answer|the code")
            for form in FORMATS
            for text in ("", "I do not know.", "{", "Action: ", code())
        ),
        ("ui-tars-1.5", "Action: fly(point='<point>1 1</point>')", "no action in this format named 'fly'"),
        ("ui-tars-1.5", "Action: click(point='here')", "no point"),
        ("ui-tars-1.5", "Action: click()", "no point"),
        ("ui-tars-1.5", "Action: scroll(direction='sideways')", "direction"),
        ("qwen2.5-vl", tool(action="click", coordinate=[1]), "no point"),
        ("qwen2.5-vl", tool(action="click", coordinate=[True, False]), "no point"),
        ("qwen2.5-vl", tool(action="type", text=["a", "b"]), "give one text"),
        ("qwen2.5-vl", tool(action="system_button", button="Menu"), "no key 'Menu'"),
        ("qwen2.5-vl", tool(action="terminate", status="maybe"), "status"),
        ("qwen2.5-vl", tool(action="type", text="x" * 500), "500 characters"),
        ("qwen3-vl", tool(action="key", text="enter"), "no action in this format named 'key'"),
        ("opencua", code("__import__('os').system('ls')"), "no call of pyautogui"),
        ("opencua", code("pyautogui.click(x=1+1j, y=open('x'))"), "cannot be read"),
        ("opencua", code("pyautogui.moveTo(1, 1)"), "nothing on a touch screen"),
        ("opencua", code("pyautogui.hotkey('ctrl', 'c')"), "combinations"),
        ("opencua", code("pyautogui.dragTo(1, 1)"), "no point"),
        ("opencua", code("pyautogui.click("), "no point"),
        ("openai", calls({"name": "move", "x": 1, "y": 1}), "no action in this format named 'move'"),
        ("openai", calls({"name": "drag", "path": []}), "no list of calls"),
        ("anthropic", calls(), "the answer is empty"),
        ("gemini", calls({"name": "key_combination", "keys": "control+c"}), "no key"),
    ],
)
def test_what_cannot_be_done_is_told(form: str, text: str, said: str) -> None:
    with pytest.raises(ActionError, match=said) as caught:
        read(form, text)
    assert "\n" not in str(caught.value)


def test_a_text_goes_to_the_field_with_the_focus_or_to_the_last_touch() -> None:
    form = FORMATS["qwen3-vl"]
    [call] = form.syntax.read(tool(action="type", text="Ulm"), form.verbs)
    screen = GuiScreen(1280, 720, form.grid)
    assert actions(form.verbs, call, Hand(screen, SHOWN, (5, 6))) == [Action(TYPE, index=1, text="Ulm")]
    assert actions(form.verbs, call, Hand(screen, (), (5, 6))) == [Action(TYPE, x=5, y=6, text="Ulm")]
    with pytest.raises(ActionError, match="tap one first"):
        actions(form.verbs, call, Hand(screen))


@given(text=st.text(), form=st.sampled_from(sorted(FORMATS)))
def test_no_answer_breaks_a_reader(text: str, form: str) -> None:
    for said in (text, f"Action: click({text})", f"<tool_call>{text}</tool_call>", code(text)):
        try:
            read(form, said)
        except ActionError as error:
            assert str(error)


# --- the agent ----------------------------------------------------------------------------------------------


class Answers:
    """A model that gives these answers."""

    name, sees_pictures = "answers", True

    def __init__(self, *texts: str) -> None:
        self.left = list(texts)
        self.asked: list[ChatMessage] = []

    def chat(self, messages: Sequence[ChatMessage]) -> ModelReply:
        self.asked += messages
        return ModelReply(self.left.pop(0), 10, 5)


@pytest.fixture
def seen(observation) -> Observation:
    made: Observation = observation("Warm my hands", screenshot=np.zeros((720, 1280, 3), np.uint8), elements=SHOWN)
    return made


def native(model: Answers, form: str = "ui-tars-1.5", **settings: int) -> NativeAgent:
    agent = NativeAgent("local/m", model, FORMATS[form], AgentSettings(**settings))  # type: ignore[arg-type]
    agent.reset("Warm my hands")
    return agent


def test_it_asks_once_for_several_actions_and_shows_the_picture_alone(seen: Observation) -> None:
    model = Answers("Action: press_home()\n\npress_back()", "Action: finished()")
    agent = native(model)
    acted = [agent.act(seen).action_type for _ in range(3)]
    assert acted == [ActionType.NAVIGATE_HOME, ActionType.NAVIGATE_BACK, ActionType.STATUS]
    assert len(model.asked) == 2
    for question in model.asked:
        assert len(question.pictures) == 1
        assert "Warm my hands" in question.text
        assert "field" not in question.text
        assert "speed_kmh" not in question.text
        assert "Paris" not in question.text
    assert f"Step 2 at {seen.time_s:.0f} s: press_back()" in model.asked[1].text
    assert f"{seen.time_s:.0f} s have passed" in model.asked[1].text


def test_an_answer_that_cannot_be_carried_out_is_told_to_the_model(seen: Observation) -> None:
    model = Answers("Action: fly()", "Action: finished()")
    agent = native(model)
    with pytest.raises(ActionError, match="fly"):
        agent.act(seen)
    assert agent.stages[-1].text.startswith("no action in this format")
    assert agent.stages[-1].reply
    agent.act(seen)
    assert "## Last answer" not in model.asked[0].text
    assert "named 'fly'" in model.asked[1].text


def test_an_answer_has_no_more_actions_than_the_limit_and_none_of_it_is_done(seen: Observation) -> None:
    agent = native(Answers("Action: " + "\n".join(["press_home()"] * 11), "Action: finished()"))
    with pytest.raises(ActionError, match="11 actions; at most 10"):
        agent.act(seen)
    assert agent.act(seen).action_type is ActionType.STATUS


def test_its_budget_ends_it(seen: Observation) -> None:
    agent = native(Answers("Action: press_home()", "Action: press_home()"), most_tokens=15)
    agent.act(seen)
    with pytest.raises(OutOfBudgetError):
        agent.act(seen)
    agent.reset("x")
    assert agent.act(seen).action_type is ActionType.NAVIGATE_HOME


def test_the_format_is_a_setting_of_the_model() -> None:
    assert chosen("local/ui-tars?seed=3&format=ui-tars-1.5&timeout_s=30")[0] == "local/ui-tars?seed=3&timeout_s=30"
    assert chosen("replay/a/b?format=json")[0] == "replay/a/b"
    with pytest.raises(UserError, match="requires the format"):
        chosen("local/m")
    with pytest.raises(UnknownNameError, match="did you mean 'qwen3-vl'"):
        chosen("local/m?format=qwen3vl")
    with pytest.raises(UserError, match="sees none"):
        make_agent("native", "rules?format=json")
