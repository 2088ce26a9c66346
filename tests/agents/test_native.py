"""Native formats: what a model of each family answers, as actions; and back."""

import json
import re
from collections.abc import Sequence
from dataclasses import replace
from datetime import date
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim.agents import AgentSettings, NativeAgent, make_agent
from automotive_cosim.agents.native.formats import FORMATS, chosen, vocabularies
from automotive_cosim.agents.native.grid import Grid, GuiScreen, Resized
from automotive_cosim.agents.native.verbs import GuiCall, Hand, actions, call_for
from automotive_cosim.agents.thoughts import spoken
from automotive_cosim.cockpit.actions import to_json
from automotive_cosim.contracts import (
    Action,
    ActionType,
    AlertKind,
    BoundingBox,
    Direction,
    Element,
    Feedback,
    FeedbackCode,
    GoalStatus,
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
    hand = Hand(GuiScreen(1280, 720, FORMATS[form].grid), elements)
    return [action for action, _ in FORMATS[form].acts(text, hand)]


def tool(**arguments: object) -> str:
    return f"<tool_call>\n{json.dumps({'name': 'mobile_use', 'arguments': arguments})}\n</tool_call>"


def code(*lines: str) -> str:
    return "## Action:\nDo it.\n\n## Code:\n```python\n" + "\n".join(lines) + "\n```"


# --- coordinates --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("grid", {each.grid for each in FORMATS.values()}, ids=lambda grid: grid.told)
def test_every_pixel_comes_back_within_one(grid: Grid) -> None:
    for size in SIZES:
        screen = GuiScreen(*size, grid)
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
        assert more == ([ENTER] if form.startswith("holo") and action.action_type is TYPE else [])
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


# --- what each family answers: ``native_answers.jsonl`` -----------------------------------------------------------

ANSWERS = [
    json.loads(line) for line in Path(__file__).with_name("native_answers.jsonl").read_text("utf-8").splitlines()
]
"""A line for each answer: its format, the answer or the body of a provider's response, what it does as actions or
what is said of it, and where it was seen: repository and commit, issue, or package."""


@pytest.mark.parametrize("form", FORMATS)
def test_answers_are_read_as_their_families_mean_them(form: str) -> None:
    api, mine = FORMATS[form].api, [each for each in ANSWERS if each["format"] == form]
    assert mine
    for told in mine:
        text = told["answer"] if api is None or "answer" in told else api.read(told["body"]).text
        if "says" in told:
            with pytest.raises(ActionError, match=told["says"]) as caught:
                read(form, text)
            assert "\n" not in str(caught.value)
        else:
            assert [to_json(action) for action in read(form, text)] == told["does"], told


@pytest.mark.parametrize("form", FORMATS)
def test_what_holds_no_action_says_so_and_a_thought_holds_none(form: str) -> None:
    for text in ("", "I do not know.", "{", "Action: ", code()):
        with pytest.raises(ActionError, match=r"the answer|the code"):
            read(form, text)
    chosen_form = FORMATS[form]
    call = call_for(chosen_form.verbs, SAMPLES[0], GuiScreen(1280, 720, chosen_form.grid))
    assert call is not None
    said = chosen_form.syntax.write("I see.", [call], chosen_form.verbs)
    if chosen_form.api is None:
        said = spoken(said)
        for begin, end in (("<think>", "</think>"), ("[THINK]", "[/THINK]"), ("<thinking>", "</thinking>")):
            for text in (f"{begin}{said}", f"{begin}{said}{end}", f"{said}{end}"):
                with pytest.raises(ActionError, match="within its thoughts"):
                    read(form, text)
            assert read(form, f"{begin}{said} was wrong.{end}{said}") == read(form, said)
        assert not chosen_form.syntax.whole.search(said[: len(said) // 2])
    assert chosen_form.syntax.whole.search(said)  # this much counts even of an answer that was cut off


def test_every_word_has_a_version_a_date_and_a_source_and_an_unknown_one_says_who_knows_it() -> None:
    used = [words for form in FORMATS.values() for words in form.words]
    for name, words in vocabularies().items():
        assert words in used, name
        assert words.version, name
        assert date.fromisoformat(words.date) < date(2026, 11, 29), name
        assert re.search(r"github \S+/\S+ [0-9a-f]{7}\b|PyPI \S+ \d", words.source), name
    for form, each in FORMATS.items():
        for word in {word for other in FORMATS.values() for word in other.verbs} - each.verbs.keys():
            call = SimpleNamespace(read=lambda *_, word=word: [GuiCall(word, {})])
            with pytest.raises(ActionError, match=rf"named '{word}'.*would know '{word}'"):
                replace(each, syntax=call).acts("", Hand(GuiScreen(9, 9, each.grid)))
            assert form


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


@pytest.mark.parametrize(("form", "second"), [("anthropic", "home"), ("openai", "back")])
def test_of_claude_what_follows_a_failed_action_of_the_same_answer_is_left_out(
    seen: Observation, form: str, second: str
) -> None:
    def keys(*names: str) -> str:
        name, key = ("key", "text") if form == "anthropic" else ("keypress", "keys")
        return json.dumps({"say": "", "calls": [{"name": name, "arguments": {key: each}} for each in names]})

    agent = native(Answers(keys("enter", "esc"), keys("home")), form)
    agent.act(seen)
    failed = replace(seen, feedback=Feedback(FeedbackCode.REFUSED, "locked"))
    assert agent.act(failed).action_type == f"navigate_{second}"


def test_an_answer_has_no_more_actions_than_the_limit_and_none_of_it_is_done(seen: Observation) -> None:
    agent = native(Answers("Action: " + "\n".join(["press_home()"] * 11), "Action: finished()"))
    with pytest.raises(ActionError, match="11 actions; at most 10"):
        agent.act(seen)
    assert agent.act(seen).action_type is ActionType.STATUS


@pytest.mark.parametrize(
    ("form", "reply", "why"),
    [
        (
            "ui-tars-1.5",
            ModelReply("Thought: Perhaps\nclick(start_box='(1,1)", finish="length"),
            "no whole call.*longest",
        ),
        (
            "qwen3-vl",
            ModelReply('One way is {"action": "click", "coordinate": [1, 1]}', finish="length"),
            "no whole call",
        ),
        ("glm-4.5v", ModelReply("", reasoning="Hm.", finish="length"), "ended within its thoughts"),
        ("anthropic", ModelReply('{"say": "Let me", "calls": []}', finish="length"), "no whole call.*longest"),
        (
            "openai",
            ModelReply('{"say": "I must not.", "calls": []}', finish="content_filter"),
            "not finished.*filter",
        ),
        ("gemini", ModelReply('{"say": "<think>Hm.", "calls": []}'), "empty|within its thoughts"),
    ],
)
def test_an_answer_that_was_cut_off_is_no_action_and_declares_nothing(
    seen: Observation, form: str, reply: ModelReply, why: str
) -> None:
    model = Answers()
    model.chat = lambda messages: reply  # type: ignore[method-assign]
    with pytest.raises(ActionError, match=why):
        native(model, form).act(seen)


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
