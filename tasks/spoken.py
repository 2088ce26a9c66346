"""The phrasings in other languages: one file per language, ``phrasings/fr.toml`` and so on, with a table per task.

[any.words]                    # values of parameters, in every task
"On my way" = "J'arrive"       # what the car's button says, where it is a button

[hard_example]
says = ["...", ...]            # as many as in English, in the same order, with the same {parameters}
words = { calendar = "agenda" }                        # of this task alone
lines = { "It's for {}." = "C'est pour {}." }          # remarks, answers, questions; {} is what varies
asked = { time = ["heure"] }                           # more words for a topic that can be asked about
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from importlib.resources import files
from typing import Any

from automotive_cosim.cockpit.language import Language
from automotive_cosim.tasking.lexicon import Lexicon
from automotive_cosim.tasking.speech import Speech
from automotive_cosim.tasking.task import Task

FOREIGN = tuple(language for language in Language if language is not Language.ENGLISH)
ANY = "any"
"""The table of what is said in every task."""


def spoken(task: Task) -> Task:
    """The task with its phrasings in every language that has them."""
    found: dict[Language, Speech] = {
        language: _speech(language, phrasings(language)[task.id]) for language in FOREIGN if _has(task, language)
    }
    return replace(task, spoken=found) if found else task


@lru_cache
def phrasings(language: Language) -> Mapping[str, Any]:
    """The file of a language: tables by the id of the task, and ``ANY``."""
    packed = files("automotive_cosim.tasks").joinpath("phrasings", f"{language}.toml")
    return tomllib.loads(packed.read_text("utf-8"))


def _has(task: Task, language: Language) -> bool:
    return task.id in phrasings(language)


def _speech(language: Language, own: Mapping[str, Any]) -> Speech:
    shared = phrasings(language)[ANY]
    return Speech(
        language,
        tuple(own["says"]),
        Lexicon.of(shared["lines"] | own.get("lines", {})),
        shared["words"] | own.get("words", {}),
        {word: tuple(others) for word, others in own.get("asked", {}).items()},
    )
