"""The cockpit in other languages: the finished widget tree, and its answers, translated by one table per language.

Screens are written in English. A table (``languages/fr.toml`` and so on) gives a text for a text; one with ``{}``
is a form, in which what varies is translated in turn: "Sent to {}: {}". What no table knows stays as it is: names
of people, places and music, numbers and units, what people wrote, and resource ids and signals in an answer.
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
"""Further texts of some widgets."""
_WORD = re.compile(r"[^\W\d_]{2}")


@dataclass(frozen=True, slots=True)
class Language:
    """One language."""

    words: Mapping[str, str]
    keys: Mapping[str, str]
    """Texts of single widgets by their resource id, where an English word has several meanings."""
    forms: tuple[tuple[re.Pattern[str], str], ...]
    """The most specific first."""


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
    """A text of the screens, or of answers, in that language; as it is if no table knows it."""
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
    """What came of an action, told in that language."""
    return feedback if language == ENGLISH else replace(feedback, text=said(language, feedback.text, answers=True))


def translated(widget: W, language: str) -> W:
    """The widget and all in it, in that language. What was typed stays."""
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
    """How many letters of a form do not vary."""
    return len(form.replace("{}", ""))


def _pattern(form: str) -> re.Pattern[str]:
    return re.compile("(.+?)".join(map(re.escape, form.split("{}"))))
