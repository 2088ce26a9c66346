"""What the driver says besides the wish: answers to questions, and remarks of his own.

A driver who is asked answers from the task's data, without a model: a question is about the topic whose words it
has, so the same question in other words gets the same answer. Whatever no topic is about gets ``NEUTRAL``, which
helps nobody. Question and answer take as long as it takes to say them.
"""

from __future__ import annotations

import math
import re
import unicodedata
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from automotive_cosim.contracts import ActionType
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.interface.trace import Step
from automotive_cosim.tasking.triggers import TriggerCondition

NEUTRAL = "You know as much as I do. Do as you think best."
"""The answer to a question that the task has no topic for."""
TOLD_HEARD = "Words are heard in the noise of the cabin and may be wrong; the driver repeats them if you ask."
"""What an agent that hears is told at first."""
PARDON = "What did you say?"
"""What the driver says if he did not understand the car."""
TALKED_OVER = "Somebody talked over you, and the driver took in none of it."
"""What the agent is told if he did."""
LOOK_FIRST = "The calendar and the memos may say it; what the car doesn't know, ask me."
"""What the driver adds to a wish of the suite ``clarify``, which is in English alone: where one may look."""
AS_SEEN = "Go by what's in front of us as I say this."
"""The same of the suite ``camera``, whose signals change."""
ROUNDING_S = 1e-9
"""Tolerance of sums of simulated seconds."""
WORDS_PER_S = 2.5
"""How fast people talk: 150 words a minute, the usual rate of conversation and audio books."""
JAPANESE_PER_WORD = 2
"""Japanese has no spaces between words: it is read at 300 characters a minute, as by NHK's announcers."""
_JAPANESE = "\u3005-\u3007\u3040-\u30ff\u4e00-\u9fff"
_TOKEN = re.compile(rf"[{_JAPANESE}]|[^\W{_JAPANESE}]+")
"""A word, or one character of Japanese."""


_AGAIN = re.compile(
    r"\b(repeat|again|pardon|once more|say that|did you say)\b"
    r"|(not|n't) (hear|catch|understand|get) (you|that|it)\b"
)


@dataclass(frozen=True, slots=True)
class Topic:
    """Something that the driver can be asked about, and what he answers."""

    name: str
    choices: tuple[tuple[str, ...], ...]
    """The alternatives that a question has to name, each by any of its words: ``(("keller",), ("holm",))``."""
    reply: str
    """The answer, the same however the question is put."""
    about: tuple[str, ...] = ()
    """Words by which a question is about this topic even if it names no alternative."""

    def named(self, question: str) -> int:
        """How many of the alternatives a question names."""
        said = _said(question)
        return sum(any(_has(said, word) for word in words) for words in self.choices)

    def fits(self, question: str) -> int:
        """How many of the topic's words a question has; 0 if it is about something else."""
        said = _said(question)
        return self.named(question) + sum(_has(said, word) for word in self.about)


@dataclass(frozen=True, slots=True)
class Says:
    """A remark of the driver's, made once, after the first step at whose end all that is given here is so."""

    text: str
    step: int = 0
    """Number of actions that the agent must have made."""
    time_s: float = 0.0
    """Seconds since the hand-over."""
    when: TriggerCondition | None = None
    """What must hold, at that moment."""
    changed: frozenset[str] = frozenset()
    """Keys of ``Moment.commands``, one of which must have changed since the hand-over."""
    after: int = 0
    """Number of questions that the driver must have answered."""
    over_s: float = 0.0
    """Seconds into words of the agent at which he talks over them; 0 if he waits until nobody speaks."""
    unchanged: frozenset[str] = frozenset()
    """Keys of ``Moment.commands``, none of which may have changed since then: a wish that is said again."""

    def __str__(self) -> str:
        told = (
            f"after {self.step} actions" if self.step else "",
            f"after {self.time_s:g} s" if self.time_s else "",
            f"once {' or '.join(sorted(self.changed))} has changed" if self.changed else "",
            f"while {' and '.join(sorted(self.unchanged))} has not changed" if self.unchanged else "",
            f"after {self.after} answers" if self.after else "",
            f"once {self.when}" if self.when else "",
            f"{self.over_s:g} s into what the car says" if self.over_s else "",
        )
        return " and ".join(filter(None, told)) or "at once"

    def is_due(self, hand_over: Moment, now: Moment, steps: int) -> bool:
        """Whether the driver says it now, unless he has said it already.

        Args:
            hand_over: the moment of it.
            steps: actions so far."""
        return (
            steps >= self.step
            and now.time_s - hand_over.time_s >= self.time_s - ROUNDING_S
            and (not self.changed or any(now.commands[key] != hand_over.commands[key] for key in self.changed))
            and all(now.commands[key] == hand_over.commands[key] for key in self.unchanged)
            and len(questions(hand_over, now)) >= self.after
            and (self.when is None or self.when(now))
        )


@dataclass(frozen=True, slots=True)
class Question:
    """A question that the driver was asked."""

    text: str
    topic: Topic | None
    """What it is about; None if the driver can only shrug."""
    is_needed: bool
    """Whether what it asks for could not be found out otherwise, and had not been asked before."""
    reply: str
    """What the driver answers."""

    @property
    def seconds(self) -> float:
        """How long question and answer take from the driver's attention."""
        return spoken_s(self.text, self.reply)


def words_of(said: Iterable[str]) -> int:
    """How many words were said in all."""
    return math.ceil(sum(map(_words, said)))


def untold(said: Iterable[str], tells: Iterable[tuple[str, ...]]) -> tuple[tuple[str, ...], ...]:
    """What of it the driver was not told.

    Args:
        said: every answer of the agent.
        tells: what he has to be told, each by any of its words or phrases."""
    heard = "".join(map(_said, said))
    return tuple(words for words in tells if not any(_has(heard, word) for word in words))


def spoken_s(*texts: str) -> float:
    """Whole seconds that it takes to say the texts, one at least."""
    return float(max(1, math.ceil(sum(map(_words, texts)) / WORDS_PER_S)))


def _words(text: str) -> float:
    """How many words it takes as long as."""
    apart, characters = re.subn(f"[{_JAPANESE}]", " ", text)
    return len(apart.split()) + characters / JAPANESE_PER_WORD


def topic_of(question: str, topics: Sequence[Topic]) -> Topic | None:
    """The topic that a question fits best, the first of several that fit equally; None if it fits none."""
    best = max(topics, key=lambda topic: topic.fits(question), default=None)
    return best if best is not None and best.fits(question) else None


def asks_again(question: str) -> bool:
    """Whether the driver is asked to repeat what he has said, in English."""
    return _AGAIN.search(question.casefold().replace("’", "'")) is not None


def is_lost(said: Collection[str], feedback: str | None) -> bool:
    """Whether the driver did not understand what the agent said to him in a step, or talked over it.

    Args:
        said: what he said in it."""
    return PARDON in said or feedback == TALKED_OVER


def understood(step: Step) -> tuple[str, ...]:
    """What the agent told the driver in a step; nothing if it was lost."""
    action = step.action
    is_told = action is not None and action.action_type is ActionType.ANSWER
    is_told = is_told and not is_lost(step.said, step.feedback.text)
    return (action.text or "",) if action is not None and is_told else ()


def questions(hand_over: Moment, now: Moment) -> list[dict[str, Any]]:
    """The questions since a moment, as the cockpit keeps them: ``text``, and the number of ``commands`` before."""
    before, after = (moment.commands.get("questions", []) for moment in (hand_over, now))
    asked: list[dict[str, Any]] = after[len(before) :]
    return asked


def dialogue(
    texts: Iterable[str], topics: Sequence[Topic], needed: Collection[Topic], neutral: str = NEUTRAL
) -> tuple[Question, ...]:
    """Questions in order, with what each is about and whether it is needed.

    Args:
        topics: what the driver can be asked about.
        needed: the topics that have to be asked about, once each.
        neutral: the answer to a question about none of them."""
    left, found = list(needed), []
    for text in texts:
        topic = topic_of(text, topics)
        is_needed = topic in left
        if topic is not None and is_needed:
            left.remove(topic)
        found.append(Question(text, topic, is_needed, neutral if topic is None else topic.reply))
    return tuple(found)


def _said(text: str) -> str:
    """A text as words between single spaces, so that words and phrases are found whole."""
    words = _TOKEN.findall(unicodedata.normalize("NFKC", text).casefold())
    return f" {' '.join(words)} "


def _has(said: str, phrase: str) -> bool:
    return _said(phrase) in said
