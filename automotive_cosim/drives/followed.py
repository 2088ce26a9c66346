"""What became of each act of a drive: whether the driver heard, obeyed or ignored it, and what the car then did.

Read from the timeline that every recorded drive has, so it can be told of drives that were recorded before.
"""

from __future__ import annotations

import re
from bisect import bisect_left
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from automotive_cosim.contracts import Json
from automotive_cosim.drives.faults import was
from automotive_cosim.drives.judge import JudgedAct, JudgedEvent

OVER_KMH = 1.0
"""A car this much above the limit exceeds it (``harm``)."""
LATER_S = 30.0
"""How long after an act its later speed is read: a driver who heeds it has reacted and slowed down by then."""
FOLLOWED_S = 120.0
"""For how long after an act the seconds above the limit count: as long as a driver keeps to advice
(``departure.ADVICE_S``)."""
ANSWER_S = 8.0
"""The latest answer: reaction times are log-normal around one or two seconds."""
NEAR_S = 0.3
"""Times in the timeline and in its words are rounded to a tenth of a second."""
HEARD = ("takes note of", "cannot ", "has found no place")
"""Answers of a driver who has heard and could do nothing, or has nothing to do."""
NOT_ASKED = "nothing asked"
ASKS = re.compile(r"alert (\w+)|.*\b(SlowDown|PullOver)\b")


@dataclass(frozen=True, slots=True)
class Followed:
    """What became of one act."""

    answer: str
    """``obeyed``, ``heard``, ``ignored``, ``unanswered``; empty for an act that asks nothing of the driver."""
    answered_s: float | None
    """Seconds from the act to the driver's answer."""
    did: str
    """What the driver did, in words."""
    before_kmh: float
    """Speed at the act."""
    after_kmh: float
    """Speed ``LATER_S`` after it, or at the end of the drive."""
    over_s: float
    """Seconds above the limit in the ``FOLLOWED_S`` after it."""

    @property
    def words(self) -> str:
        """In words."""
        when = "" if self.answered_s is None else f" after {self.answered_s:.1f} s"
        did = f" ({self.did})" if self.did else ""
        over = f", {self.over_s:.0f} s above the limit in the next {FOLLOWED_S:.0f} s" if self.over_s else ""
        drove = f"{self.before_kmh:.0f} to {self.after_kmh:.0f} km/h in {LATER_S:.0f} s"
        return f"{self.answer or NOT_ASKED}{when}{did}; {drove}{over}"


def followed(acts: Sequence[JudgedAct], timeline: Json) -> list[Followed]:
    """What became of each act, in their order.

    Args:
        acts: of a drive, with times since departure.
        timeline: of the same drive (``timeline.timeline``).
    """
    answers: dict[int, list[tuple[float, str]]] = {}
    for time_s, text in timeline.get("driver", ()):
        if (number := _asked(acts, answers, time_s, text)) is not None:
            answers.setdefault(number, []).append((time_s, text))
    return [_followed(act, answers.get(number, ()), timeline) for number, act in enumerate(acts)]


def _asked(acts: Sequence[JudgedAct], answered: Mapping[int, object], time_s: float, text: str) -> int | None:
    """Number of the act that the driver answers; None if it is no answer to one."""
    known = [
        (number, act, asks[1])
        for number, act in enumerate(acts)
        if act.time_s - NEAR_S <= time_s <= act.time_s + ANSWER_S and (asks := ASKS.match(act.words))
    ]
    after = re.search(r"([\d.]+) s after (?:the alert|the request|it)\b", text)
    if after is not None:
        asked_s = time_s - float(after[1])
        near = [(abs(act.time_s - asked_s), number) for number, act, _ in known]
        nearest = min(near, default=(NEAR_S, None))
        return nearest[1] if nearest[0] < NEAR_S else None
    ignored = re.search(r"hears the (?:(\w+) alert|request)", text)
    if ignored is None:
        return None
    return next((number for number, _, kind in known if kind == ignored[1] and number not in answered), None)


def _followed(act: JudgedAct, answers: Sequence[tuple[float, str]], timeline: Json) -> Followed:
    times_s: list[float] = timeline["time_s"]
    at, later, end = (
        min(bisect_left(times_s, act.time_s + after_s), len(times_s) - 1) for after_s in (0.0, LATER_S, FOLLOWED_S)
    )
    over_s = sum(
        times_s[number] - times_s[number - 1]
        for number in range(at + 1, end + 1)
        if (limit_kmh := timeline["limit_kmh"][number]) is not None
        and timeline["speed_kmh"][number] > limit_kmh + OVER_KMH
    )
    asks = ASKS.match(act.words) is not None
    texts = [text.removeprefix("driver ") for _, text in answers]
    answer = "" if not asks else "unanswered" if not texts else _kind(texts)
    did = "; ".join(re.sub(r",? ?[\d.]+ s after .*", "", text) for text in texts if "does not react" not in text)
    return Followed(
        answer,
        max(0.0, round(answers[0][0] - act.time_s, 1)) if answers else None,
        did,
        timeline["speed_kmh"][at],
        timeline["speed_kmh"][later],
        over_s,
    )


def _kind(texts: Iterable[str]) -> str:
    if any("does not react" in text for text in texts):
        return "ignored"
    return "heard" if all(text.startswith(HEARD) for text in texts) else "obeyed"


def told(acts: Sequence[JudgedAct], events: Sequence[JudgedEvent], timeline: Json) -> list[str]:
    """What each act was and what became of it, in words; arguments as of ``followed`` and ``faults.was``.

    Without a timeline, as of a drive that is not over, what each was.
    """
    came = followed(acts, timeline) if timeline else ()
    ends = [f"; {each.words}" for each in came] or [""] * len(acts)
    return [was(act, events) + end for act, end in zip(acts, ends, strict=True)]
