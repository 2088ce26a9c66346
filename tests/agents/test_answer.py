"""Answers are read strictly first, then forgivingly, and never evaluated."""

import json
import time
from contextlib import suppress

import pytest
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim.agents.answer import labelled, read
from automotive_cosim.cockpit.actions import to_json
from automotive_cosim.contracts import Action, ActionType
from automotive_cosim.errors import ActionError

HOME = {"action_type": "navigate_home"}
TYPED = {"action_type": "input_text", "index": 3, "text": "it's {here}", "clear_text": True}


def test_the_form_that_is_asked_for():
    answer = read('Situation: cold hands\nPlan: tap the wheel\nAction: {"action_type": "click", "index": 2}')
    assert answer.strict
    assert (answer.situation, answer.plan) == ("cold hands", "tap the wheel")
    assert answer.action == Action(ActionType.CLICK, index=2)


def test_null_true_and_nested_objects_are_json_like_any_other():
    text = 'Action: {"action_type": "hazard_lights", "on": true, "index": null}'
    assert read(text).action.on is True
    with pytest.raises(ActionError, match="dict"):
        read('Action: {"action_type": "answer", "text": {"a": {"b": [1, null]}}}')


@pytest.mark.parametrize(
    "text",
    [
        '```json\n{"action_type": "navigate_home"}\n```',
        'Action:\n```\n{"action_type": "navigate_home"}\n```',
        'I go home. {"action_type": "navigate_home"} That is all.',
        "Action: {'action_type': 'navigate_home'}",
        "Action: {'action_type': 'navigate_home', 'index': None}",
        'Action: {"action_type": "navigate_home",}',
        '**Action:** {"action_type": "navigate_home"}',
        'action: {"action_type": "navigate_home"}',
        'Action: {"action_type": "navigate_home"}.',
        'Maybe {"action_type": "navigate_back"}? No.\nAction: {"action_type": "navigate_home"} !',
        '{"thought": "go", "action_type": 1} {"action_type": "navigate_home"} {"not": "one"}',
        '{"action": {"action_type": "navigate_home"}}',
        "Not {\"action_type\": \"navigate_back\"}.\nAction: {'action_type': 'navigate_home'}",
        "Situation: it's {odd} and \"quoted\nAction: {'action_type': 'navigate_home'}",
        'Action: {"action_type": "navigate_home"',
        "Action\uff1a {\u201caction_type\u201d\uff1a \u201cnavigate_home\u201d}",
        '{"tool": {"action": {"action_type": "navigate_home"}',
        "Action: {action_type: navigate_home}",
    ],
)
def test_near_misses_are_forgiven(text):
    answer = read(text)
    assert not answer.strict
    assert to_json(answer.action) == HOME


THOUGHTS = [
    *((f"<{name}>", f"</{name}>") for name in ("think", "thinking", "THINK", "thought", "reasoning", "seed:think")),
    *(
        (f"<{name}>", f"</{name}>")
        for name in ("longcat_think", "mm:think", "reflection", "scratchpad", "analysis", "antThinking", "cot")
    ),
    ("<think>\n<think>", "</think>"),
    ("&lt;think&gt;", "&lt;/think&gt;"),
    (f"<think_never_used_{'5' * 32}>", f"</think_never_used_{'5' * 32}>"),
    ("<|inner_prefix|>", "<|inner_suffix|>"),
    ('<details type="reasoning" done="true">\n<summary>Thought for 2 s</summary>\n', "\n</details>"),
    ("[THINK]", "[/THINK]"),
    ("<|begin_of_thought|>", "<|end_of_thought|>"),
    ("<|START_THINKING|>", "<|END_THINKING|>"),
    ("<|think|>", "<|/think|>"),
    ("\u25c1think\u25b7", "\u25c1/think\u25b7"),
    ("<unused94>thought", "<unused95>"),
    ("Here is my thought process: ", "\nHere is my response: "),
    ("Here are my reasoning steps:\n", "\n[BEGIN FINAL RESPONSE]"),
    ("<|channel>thought\n", "<channel|>"),
    ("<|channel|>analysis<|message|>", "<|end|><|start|>assistant<|channel|>final<|message|>"),
    ("<|channel|>analysis<|message|>", "<|start|>assistant<|channel|>final<|message|>"),
    ("analysis", "assistantfinal"),
]
"""What stands before and after the thoughts of a model whose server leaves them in the answer."""
WRONG = 'The fan. One way: Action: {"action_type": "emergency_call"} would be wrong, '


@pytest.mark.parametrize(("begin", "end"), THOUGHTS, ids=lambda each: each[:20])
def test_thoughts_are_not_actions_in_any_form_closed_or_cut_off(begin, end):
    said = f"Situation: a\nAction: {json.dumps(HOME)}"
    assert to_json(read(f"{begin}{WRONG}{end}{said}").action) == HOME
    for text in (f"{begin}{WRONG}", f"{begin}{WRONG}{end}", f"{begin}{said}", f"{said}\n{begin}{WRONG}"):
        if begin[:1] in "Ha" and text.startswith("Sit"):
            continue  # these begin the answer
        with pytest.raises(ActionError, match="ended within its thoughts"):
            read(text)
    if end.startswith(("</", "[/", "<|end_", "<|END_")):  # the beginning stands in the prompt
        assert to_json(read(f"{WRONG}{end}{said}").action) == HOME


def test_a_tag_of_thoughts_without_any_is_none():
    assert to_json(read(f"<think>\n</think>Action: {json.dumps(HOME)}<think>").action) == HOME


@pytest.mark.parametrize(
    "text",
    [
        f"{WRONG} so",
        f'Perhaps {{"action_type": "pull_over"}}? {WRONG[:40]}',
        'Action: {"action_type": "answer", "text": "It',
    ],
)
def test_of_an_answer_that_was_cut_off_only_a_whole_action_after_its_label_counts(text):
    with pytest.raises(ActionError, match="no JSON object"):
        read(text.replace('Action: {"action_type": "em', '{"action_type": "em'), is_cut=True)
    whole = json.dumps({"situation": "a", "plan": "b", "action": HOME})
    for said in (f"Action: {json.dumps(HOME)}\n\nNow I wait, as", whole, f"{whole}\nNow I"):
        assert to_json(read(said, is_cut=True).action) == HOME


def test_punctuation_of_full_width_is_read_and_texts_keep_theirs():
    greeting = "\u4f60\u597d\uff0c\u4e16\u754c"
    told = {"action_type": "answer", "text": greeting}
    names = (f"\u201c{name}\u201d\uff1a\u201c{value}\u201d" for name, value in told.items())
    wide = "Action\uff1a\uff5b" + "\uff0c".join(names) + "\uff5d"
    assert read(wide).action == Action(ActionType.ANSWER, text=greeting)


@pytest.mark.parametrize("token", ["<|im_end|>", "</s>", "<|eot_id|>", "<|im_end|>\n<|im_start|>user\nAction: {}"])
def test_the_token_that_ends_an_answer_is_no_part_of_it(token):
    answer = read(f"Situation: cold\nAction: {json.dumps(HOME)}{token}")
    assert answer.strict
    assert to_json(answer.action) == HOME


def test_single_quotes_around_an_apostrophe():
    answer = read("Action: {'action_type': 'answer', 'text': 'it's on', 'index': None}")
    assert answer.action.text == "it's on"


def test_a_time_of_day_without_quotes_keeps_its_minutes():
    assert read('Action: {"action_type": "answer", "text": 17:45}').action.text == "17:45"
    assert read("{'action_type': 'answer', 'text': 'at noon: 12:30, or so'}").action.text == "at noon: 12:30, or so"
    with pytest.raises(ActionError, match="12:30"):
        read('Action: {"action_type": "click", "index": 12:30}')


@pytest.mark.parametrize(
    "text",
    [
        "", "   ", "I would rather not.", "Action:", "Action: none", "Action: {", "Action: {}", "Action: []",
        'Action: {"index": 3}', 'Action: {"action_type": "fly"}', 'Action: {"action_type": "click"}',
        "Action: __import__('os').system('true')", "Action: {'action_type': open('/etc/passwd')}",
        "{" * 50_000, '{"action_type": ' * 10_000, "'" * 50_000, "\0", '{"action_type": "click", "index": 1e999}',
    ],
    ids=lambda text: repr(text[:30]),
)  # fmt: skip
def test_what_cannot_be_read_says_why_in_one_line(text):
    with pytest.raises(ActionError) as caught:
        read(text)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 500


@given(st.text())
def test_anything_is_an_answer_or_an_action_error(text):
    try:
        read(text)
    except ActionError as error:
        assert str(error)


@given(st.text(), st.text())
def test_an_action_is_found_whatever_stands_around_it(before, after):
    """Unless what stands around it closes or opens another object."""
    text = f"{before}\nAction: {json.dumps(TYPED)}\n{after}"
    if "{" not in after and '"' not in before + after and "'" not in before + after:
        assert to_json(read(text).action) == TYPED


def test_labels_are_found_in_any_order_and_dress():
    text = "**Plan:** first a\nthen b\n- Situation: cold\nLesson: none"
    assert labelled(text, "plan") == "first a\nthen b"
    assert labelled(text, "situation") == "cold"
    assert labelled(text, "action") == ""


@pytest.mark.parametrize("piece", ["  \n", "Action: {\n", "Action: ", "{", "<think>", "plan:\n"])
def test_an_answer_costs_a_time_that_grows_with_its_length_alone(piece):
    """A model may say whatever it likes, up to some megabytes."""
    began_s = time.process_time()
    with suppress(ActionError):
        read(piece * (300_000 // len(piece)))
    assert time.process_time() - began_s < 3.0
