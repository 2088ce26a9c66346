"""The cockpit in other languages: the finished widget tree, and its answers, translated by one table per language.

Screens are written in English. A table (``languages/fr.toml`` and so on) maps texts to texts; one with ``{}``
is a template whose variable parts are translated in turn: "Sent to {}: {}". Texts that are in no table stay as they
are: names of people, places and music, numbers and units, messages, and signals in feedback.
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import lru_cache
from importlib.resources import files
from typing import Any, TypeVar

from automotive_cosim.cockpit.widgets import Field, Row, Tile, Widget
from automotive_cosim.contracts import Feedback

W = TypeVar("W", bound=Widget)

ENGLISH = "en"
_COMMON = ("text", "description", "disabled", "locked")
_OWN: Mapping[type[Widget], tuple[str, ...]] = {
    Field: ("hint",),
    Row: ("detail", "trail"),
    Tile: ("level",),
}
"""Additional text fields of some widgets."""
_WORD = re.compile(r"[^\W\d_]{2}")


@dataclass(frozen=True, slots=True)
class Language:
    """One language."""

    words: Mapping[str, str]
    keys: Mapping[str, str]
    """Texts of single widgets by their key, where an English word has several meanings."""
    forms: tuple[tuple[re.Pattern[str], str], ...]
    """Templates, the most specific first."""


@lru_cache
def table(language: str, answers: bool = False) -> Language:
    """The table of a language other than English; with or without what only answers say."""
    given: dict[str, dict[str, str]] = tomllib.loads(
        files("automotive_cosim.cockpit").joinpath("languages", f"{language}.toml").read_text("utf-8")
    )
    texts = given["words"] | (given["answers"] if answers else {})
    forms = sorted((text for text in texts if "{}" in text), key=_fixed, reverse=True)
    return Language(
        {text: said for text, said in texts.items() if "{}" not in text},
        given["keys"],
        tuple((_pattern(form), texts[form]) for form in forms),
    )


@lru_cache(maxsize=16384)
def said(language: str, text: str, answers: bool = False) -> str:
    """A text of the screens, or of feedback, in that language; unchanged if it is not in the table."""
    if not _WORD.search(text):
        return text
    known = table(language, answers)
    if text in known.words:
        return known.words[text]
    for pattern, form in known.forms:
        found = pattern.fullmatch(text)
        if found is not None:
            return form.format(*(said(language, part, answers) for part in found.groups()))
    return text


def answered(feedback: Feedback, language: str) -> Feedback:
    """The feedback to an action in that language."""
    return feedback if language == ENGLISH else replace(feedback, text=said(language, feedback.text, answers=True))


def translated(widget: W, language: str) -> W:
    """The widget and its children in that language. Typed text stays."""
    if language == ENGLISH:
        return widget
    changes: dict[str, Any] = {}
    for name in (*_COMMON, *_OWN.get(type(widget), ())):
        text: str = getattr(widget, name)
        if text and not (name == "text" and isinstance(widget, Field)):
            changes[name] = said(language, text)
    if widget.key in table(language).keys:
        changes["text"] = table(language).keys[widget.key]
    if widget.children:
        changes["children"] = tuple(translated(child, language) for child in widget.children)
    return replace(widget, **changes)


def _fixed(form: str) -> int:
    """Number of fixed letters in a template."""
    return len(form.replace("{}", ""))


def _pattern(form: str) -> re.Pattern[str]:
    return re.compile("(.+?)".join(map(re.escape, form.split("{}"))))
