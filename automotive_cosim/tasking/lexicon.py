"""What drivers say in another language, by the English sentence: whole, or with ``{}`` for what varies."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

_WORD = re.compile(r"[^\W\d_]{2}")


@dataclass(frozen=True, slots=True)
class Lexicon:
    """Sentences in one language, by the English ones."""

    words: Mapping[str, str]
    forms: tuple[tuple[re.Pattern[str], str], ...]
    """Templates, the most specific first."""

    @classmethod
    def of(cls, texts: Mapping[str, str]) -> Lexicon:
        """Sorts whole sentences from templates."""
        forms = sorted((text for text in texts if "{}" in text), key=_fixed, reverse=True)
        return cls(
            {text: said for text, said in texts.items() if "{}" not in text},
            tuple((_pattern(form), texts[form]) for form in forms),
        )

    def said(self, text: str) -> str:
        """A sentence in that language; unchanged if it is not known."""
        if not _WORD.search(text):
            return text
        if text in self.words:
            return self.words[text]
        for pattern, form in self.forms:
            found = pattern.fullmatch(text)
            if found is not None:
                return form.format(*map(self.said, found.groups()))
        return text


def _fixed(form: str) -> int:
    """Number of fixed letters in a template."""
    return len(form.replace("{}", ""))


def _pattern(form: str) -> re.Pattern[str]:
    return re.compile("(.+?)".join(map(re.escape, form.split("{}"))))
