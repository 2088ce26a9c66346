"""Whether what the driver was told is true, judged without a model.

An agent that finds nothing to do may say so and declare ``complete`` instead of ``not_needed``. Its words count as
true if they say that all is well, and neither what would be right in the other half nor a danger.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from automotive_cosim.contracts import GoalStatus
from automotive_cosim.geo.text import KM_PER_MILE
from automotive_cosim.tasking.checks import AlertGiven, Check
from automotive_cosim.tasking.instance import Instance

WELL = re.compile(
    r"\b(no|not|nothing|none|nobody|without|fine|all right|alright|ok|okay|good|well|clear|safe|already|within"
    r"|allowed|permitted|legal|lawful|enough|unnecessary|may|stay|free|dry)\b|n't\b|n’t\b",
    re.IGNORECASE,
)
"""Words that say that nothing has to be done."""
TROUBLE = re.compile(
    r"(?<!not )(?<!n't )(?<!n’t )(?<!never )\b(too (fast|close|slow|hot|cold|quick|little|low)|slow down|exceed\w*"
    r"|over the limit|speeding|careful|danger\w*|beware|watch out|warning|brake|illegal|unlawful|forbidden"
    r"|prohibited|must (?!not)|have to|has to|need to|should"
    r"|not (an? )?(allowed|permitted|legal|lawful|fine|ok|okay|safe|good|well|clear|enough|all right|dry|free))\b",
    re.IGNORECASE,
)
"""Words that say that something is wrong or has to be done, unless they are denied."""
_NUMBER = re.compile(r"\d+(?:[.,]\d+)?")


def only_answered(instance: Instance, said: Sequence[str]) -> bool:
    """Whether nothing had to be done and the driver was told so, and nothing else.

    Args:
        instance: the instance of the task.
        said: every ``answer`` of the agent.
    """
    return (
        instance.half.declares is GoalStatus.NOT_NEEDED
        and bool(said)
        and all(_is_true(text, tuple(_figures_elsewhere(instance))) for text in said)
    )


def _is_true(text: str, wrong_kmh: tuple[float, ...]) -> bool:
    named = [float(number.replace(",", ".")) for number in _NUMBER.findall(text)]
    wrong = [figure for kmh in wrong_kmh for figure in (kmh, kmh / KM_PER_MILE)]
    is_other = any(abs(number - figure) < 1.0 for number in named for figure in wrong)
    return bool(WELL.search(text)) and not TROUBLE.search(text) and not is_other


def _figures_elsewhere(instance: Instance) -> Iterator[float]:
    """The speeds that the driver has to be told in the other half."""
    for name in instance.task.halves:
        if name != instance.half_name:
            yield from _figures(instance.task.half(name).goal)


def _figures(goal: Check) -> Iterator[float]:
    parts: tuple[Check, ...] = getattr(goal, "checks", (goal,))
    for part in parts:
        if isinstance(part, AlertGiven) and part.speed_kmh is not None:
            yield part.speed_kmh
