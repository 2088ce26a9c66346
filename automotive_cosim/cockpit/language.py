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
from enum import StrEnum
from functools import lru_cache
from importlib.resources import files
from types import MappingProxyType
from typing import Any, TypeVar

from automotive_cosim.cockpit.widgets import Field, Row, Tile, Widget
from automotive_cosim.contracts import Feedback

W = TypeVar("W", bound=Widget)


class Language(StrEnum):
    """The languages of car and driver, by the codes of ``HMI.LANGUAGE``."""

    ENGLISH = "en"
    FRENCH = "fr"
    GERMAN = "de"
    JAPANESE = "ja"

    @property
    def words(self) -> str:
        """Its name in English: ``French``."""
        return self.name.capitalize()


_COMMON = ("text", "description", "disabled", "locked")
_OWN: Mapping[type[Widget], tuple[str, ...]] = {
    Field: ("hint",),
    Row: ("detail", "trail"),
    Tile: ("level",),
}
"""Additional text fields of some widgets."""
_WORD = re.compile(r"[^\W\d_]{2}")


@dataclass(frozen=True, slots=True)
class Lexicon:
    """Texts in one language, by the English ones."""

    words: Mapping[str, str]
    forms: tuple[tuple[re.Pattern[str], str], ...]
    """Templates, the most specific first."""
    keys: Mapping[str, str]
    """Texts of single widgets by their key, where an English word has several meanings."""

    @classmethod
    def of(cls, texts: Mapping[str, str], keys: Mapping[str, str] = MappingProxyType({})) -> Lexicon:
        """Sorts whole texts from templates."""
        forms = sorted((text for text in texts if "{}" in text), key=_fixed, reverse=True)
        return cls(
            {text: said for text, said in texts.items() if "{}" not in text},
            tuple((_pattern(form), texts[form]) for form in forms),
            keys,
        )

    def said(self, text: str) -> str:
        """A text in that language; unchanged if it is not in the table."""
        if not _WORD.search(text):
            return text
        if text in self.words:
            return self.words[text]
        for pattern, form in self.forms:
            found = pattern.fullmatch(text)
            if found is not None:
                return form.format(*map(self.said, found.groups()))
        return text


@lru_cache
def table(language: str, answers: bool = False) -> Lexicon:
    """The table of a language other than English; with or without what only answers say."""
    given: dict[str, dict[str, str]] = tomllib.loads(
        files("automotive_cosim.cockpit").joinpath("languages", f"{language}.toml").read_text("utf-8")
    )
    texts = given["words"] | (given["answers"] if answers else {})
    return Lexicon.of(texts, given["keys"])


@lru_cache(maxsize=16384)
def said(language: str, text: str, answers: bool = False) -> str:
    """A text of the screens, or of feedback, in that language; unchanged if it is not in the table."""
    return table(language, answers).said(text)


def answered(feedback: Feedback, language: str) -> Feedback:
    """The feedback to an action in that language."""
    return (
        feedback
        if language == Language.ENGLISH
        else replace(feedback, text=said(language, feedback.text, answers=True))
    )


def translated(widget: W, language: str) -> W:
    """The widget and its children in that language. Typed text stays."""
    if language == Language.ENGLISH:
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
