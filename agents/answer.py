"""Parses a model's answer, strictly first, then leniently. It is data: nothing in it is ever evaluated.

Situation: what the driver wants and what matters here
Plan: what is left to do after this action
Action: {"action_type": ...}
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import zip_longest

from automotive_cosim.cockpit.actions import parse
from automotive_cosim.contracts import Action, Json
from automotive_cosim.errors import ActionError

LONGEST = 20_000
"""Characters at the end of an answer in which to look for the action."""
MOST_TRIES = 40
"""Opening braces, from the last, at which to look for an object."""
LABELS = re.compile(r"^[\s*_#>-]*(situation|reason|thought|plan|action|lesson)[*_]*\s*:[*_]*", re.IGNORECASE | re.M)


@dataclass(frozen=True, slots=True)
class ParsedAnswer:
    """A parsed answer."""

    situation: str
    plan: str
    action: Action
    strict: bool
    """Whether it had the requested form."""


def read(text: str) -> ParsedAnswer:
    """The answer's parts.

    Raises:
        ActionError: it has no action, or a malformed one; the message says which.
    """
    strict = re.search(r"^Action: *(\{.*\})\s*\Z", text, re.DOTALL | re.MULTILINE)
    if strict is not None:
        try:
            return _answer(text, json.loads(strict[1]), strict=True)
        except (ValueError, RecursionError):
            pass
    found = next(_objects(text[-LONGEST:]), None)
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


def _objects(text: str) -> Iterator[Json]:
    """Objects with an ``action_type``, from the end: after the last label first, then anywhere; as written first,
    then repaired."""
    tail = text[max((mark.end() for mark in LABELS.finditer(text) if mark[1].lower() == "action"), default=0) :]
    for repaired in (tail, _repaired(tail), text, _repaired(text)):
        starts = [match.start() for match in re.finditer(r"\{", repaired)][-MOST_TRIES:]
        for start in reversed(starts):
            try:
                value, _ = json.JSONDecoder().raw_decode(repaired, start)
            except (ValueError, RecursionError):
                continue
            if isinstance(value, dict) and "action_type" in value:
                yield value


_TOKEN = re.compile(
    r"""
    (?P<double>"(?:[^"\\]|\\.)*")
    | (?<![\w'])'(?P<single>(?:[^'\\\n]|\\.|'(?=\w))*)'
    | (?P<word>\b(?:True|False|None)\b)
    | (?P<comma>,(?=\s*[}\]]))
    """,
    re.VERBOSE,
)
_WORDS = {"True": "true", "False": "false", "None": "null"}


def _repaired(text: str) -> str:
    """Python's notation as JSON: single quotes, True, False, None, an extra comma."""

    def repaired(match: re.Match[str]) -> str:
        if match["double"] is not None:
            return match[0]
        if match["single"] is not None:
            return json.dumps(match["single"].replace("\\'", "'"), ensure_ascii=False)
        return _WORDS.get(match[0], "")

    return _TOKEN.sub(repaired, text)
