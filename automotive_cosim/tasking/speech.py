"""What the driver says in another language than English.

A task is written in English. Its speech in another language has as many phrasings in the same order, so that one
draw takes the same one, and a word for each value of a parameter that is said. What others write stays as it is.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from automotive_cosim.cockpit.language import Language, word
from automotive_cosim.tasking.dialogue import Topic
from automotive_cosim.tasking.parameters import Parameter

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


@dataclass(frozen=True, slots=True)
class Speech:
    """How a driver says one task in a language."""

    language: Language
    templates: tuple[str, ...]
    """The phrasings, in the order of ``Task.templates``, with the same ``{name}``."""
    lines: Lexicon
    """What is said besides the wish: remarks, answers, and the questions of the reference solutions."""
    words: Mapping[str, str] = field(default_factory=dict)
    """Words for values of parameters, where neither the screens show another one nor it stays as it is."""
    asked: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Words by which a question is about a topic, by the English ones, which count as well."""

    def phrased(self, template: str, parameters: Mapping[str, Parameter]) -> str:
        """A phrasing with the parameters filled in."""
        return template.format_map({name: self.word(value) for name, value in parameters.items()})

    def word(self, value: Parameter) -> Parameter:
        """A parameter's value as the driver says it: by his own word for it, or else as the car shows it."""
        if not isinstance(value, str):
            return value
        return self.words.get(value) or word(value, self.language)

    def topic(self, topic: Topic) -> Topic:
        """The topic, to be asked about in this language or in English, and answered in this one."""
        return replace(
            topic,
            reply=self.lines.said(topic.reply),
            choices=tuple(self._both(words) for words in topic.choices),
            about=self._both(topic.about),
        )

    def _both(self, words: tuple[str, ...]) -> tuple[str, ...]:
        return (*words, *(word for each in words for word in self.asked.get(each, ())))
