"""Parses a model's answer, strictly first, then leniently. It is data: nothing in it is ever evaluated.

Situation: what the driver wants and what matters here
Plan: what is left to do after this action
Action: {"action_type": ...}

or the same as one JSON object: ``{"situation": ..., "plan": ..., "action": {...}}``.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import zip_longest

from automotive_cosim.agents.thoughts import spoken
from automotive_cosim.cockpit.actions import parse
from automotive_cosim.contracts import Action, Json
from automotive_cosim.errors import ActionError

LONGEST = 20_000
"""Characters at the end of an answer in which to look for the action."""
LONGEST_WORDS = 120
"""Characters of situation and plan in an answer that is held to a schema: small models do not end by themselves."""
LONGEST_REPAIRED = 2_000
"""Characters of it in which to repair an object."""
END_TOKEN = re.compile(
    r"<\|(?:im_end|im_start|endoftext|end_of_text|eot_id|eom_id|eos|end|return)\|>|</s>|<eos>|<end_of_turn>"
    "|<\uff5cend\u2581of\u2581sentence\uff5c>"
)
"""What ends a turn in the templates of Qwen, Llama, Gemma, Phi, Mistral, DeepSeek and gpt-oss."""
FINAL = "<|channel|>final<|message|>"
"""What begins the answer proper of gpt-oss, after its thoughts."""
WIDE = str.maketrans("\uff5b\uff5d\uff1a", "{}:")
"""Braces and the colon of full width as ASCII."""
WIDE_COMMA = re.compile(r"""(?<=["'\u201d\u2019\del}\]])\s*\uff0c\s*(?=["'\u201c\u2018])""")
"""A comma of full width between a value and the name that follows it; others stay as they are."""
CLOCK = re.compile(r"""(["']\s*:\s*)(\d{1,2}:\d\d)(?=\s*[,}])""")
"""A time of day without quotes after its name; ``json_repair`` would keep the hour alone."""
FORM = {"situation", "plan", "action"}
"""Keys of an answer that is one object."""
LABELS = re.compile(
    r"^(?:[^\S\n]|[*_#>-])*(situation|reason|thought|plan|action|lesson)[*_]*\s*[:\uff1a][*_]*",
    re.IGNORECASE | re.MULTILINE,
)


@dataclass(frozen=True, slots=True)
class ParsedAnswer:
    """A parsed answer."""

    situation: str
    plan: str
    action: Action
    strict: bool
    """Whether it had the requested form."""


def read(text: str, *, is_cut: bool = False) -> ParsedAnswer:
    """The answer's parts.

    Args:
        is_cut: whether it was cut off at its longest. Then only a whole action after its label counts: any other
            may be a thought or half of one.

    Raises ActionError: it has no action, or a malformed one; the message says which."""
    text = ended(text)
    if (told := _object(text)) is not None:
        return ParsedAnswer(str(told["situation"]), str(told["plan"]), parse(told["action"]), strict=True)
    # Where no brace ends the text, each label would be tried up to there.
    is_closed = text.rstrip().endswith("}")
    strict = re.search(r"^Action: *(\{.*\})\s*\Z", text, re.DOTALL | re.MULTILINE) if is_closed else None
    if strict is not None:
        try:
            return _answer(text, json.loads(strict[1]), strict=True)
        except (ValueError, RecursionError):
            pass
    found = next(_answers(text, is_cut=is_cut), None)
    if found is None:
        raise ActionError("the answer has no JSON object with an action_type; end it with `Action: {...}`")
    return _answer(text, found, strict=False)


def labelled(text: str, *labels: str) -> str:
    """The text after the first of these labels, up to the next one; empty without it."""
    marks = list(LABELS.finditer(text))
    for mark, following in zip_longest(marks, marks[1:]):
        if mark[1].lower() in labels:
            return text[mark.end() : following.start() if following else len(text)].strip()
    return ""


def _answer(text: str, action: Json, *, strict: bool) -> ParsedAnswer:
    return ParsedAnswer(
        labelled(text, "situation", "reason", "thought"), labelled(text, "plan"), parse(action), strict
    )


def schema(action: Json) -> Json:
    """The JSON Schema of an answer that is one object."""
    words = {"type": "string", "maxLength": LONGEST_WORDS}
    return {
        "type": "object",
        "properties": {"situation": words, "plan": words, "action": action},
        "required": ["situation", "plan", "action"],
        "additionalProperties": False,
    }


def _object(text: str) -> Json | None:
    """The answer, if all of it is one object of that form."""
    try:
        told = json.loads(text)
    except (ValueError, RecursionError):
        return None
    return told if isinstance(told, dict) and told.keys() == FORM else None


def ended(text: str) -> str:
    """The end of the answer, without thoughts, up to the token that ends it, which some servers leave in it.

    Raises ActionError: it ended within its thoughts."""
    text = spoken(text)[-LONGEST:].rpartition(FINAL)[2]
    marks = list(END_TOKEN.finditer(text))
    first = next((mark.start() for mark in marks if text[: mark.start()].strip()), None)
    return END_TOKEN.sub("", text if first is None else text[:first])


def objects(text: str) -> Sequence[Json]:
    """JSON objects one after the other, those inside others left out; if none is written well, repaired ones."""
    return _written(text) or _repaired(text)


def _answers(text: str, *, is_cut: bool) -> Iterator[Json]:
    """Objects with an ``action_type``, from the end: after the last label first, then anywhere; as written first,
    then repaired."""
    label = max((mark.end() for mark in LABELS.finditer(text) if mark[1].lower() == "action"), default=None)
    if is_cut:
        yield from (told["action"] for told in _written(text) if told.keys() == FORM)
    for part in filter(None, ("" if label is None else text[label:], "" if is_cut else text)):
        for found in (_written,) if is_cut else (_written, _repaired):
            yield from reversed([inner for value in found(part) for inner in _with_type(value)])


def _written(text: str) -> list[Json]:
    found = []
    start = text.find("{")
    while start >= 0:
        try:
            value, end = json.JSONDecoder().raw_decode(text, start)
        except (ValueError, RecursionError):
            end = start + 1
        else:
            found.append(value)
        start = text.find("{", end)
    return found


def _repaired(text: str) -> list[Json]:
    """Objects whose brackets are not closed, in Python's notation, with quotes and commas of other scripts."""
    from json_repair import repair_json  # most answers need none

    narrow = text.translate(WIDE)
    start = narrow.find("{")
    if start < 0:
        return []
    plain = CLOCK.sub(r'\1"\2"', WIDE_COMMA.sub(",", narrow[start : start + LONGEST_REPAIRED]))
    try:
        value: object = repair_json(plain, return_objects=True, skip_json_loads=True)
    except (ValueError, RecursionError):
        return []
    return [each for each in (value if isinstance(value, list) else [value]) if isinstance(each, dict) and each]


def _with_type(value: object) -> Iterator[Json]:
    if isinstance(value, dict):
        if "action_type" in value:
            yield value
        for inner in value.values():
            yield from _with_type(inner)
