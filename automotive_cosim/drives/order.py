"""What the driver says on a drive: one order, and one answer to any question."""

from __future__ import annotations

from collections.abc import Mapping

from automotive_cosim.contracts import Json
from automotive_cosim.contracts.given import Language, Order
from automotive_cosim.formats.shipped import shipped_table
from automotive_cosim.tasking.dialogue import NEUTRAL

SPOKEN: Mapping[Language, Json] = {
    Language(code): told for code, told in shipped_table("drives", "words.toml").items()
}
"""What is said in each language; each order fits into the observation space."""
ANSWERS: Mapping[Language, str] = {language: told.get("answer", NEUTRAL) for language, told in SPOKEN.items()}
"""The answer to a question."""


def ordered(order: Order, language: Language, *, with_errands: bool) -> str:
    """What the driver says at departure. The thresholds of ``full`` stand in the prompt, not in his words."""
    told = SPOKEN[language]
    if order is Order.PLAIN:
        return f"{told['plain']} {told['plain_errands']}" if with_errands else str(told["plain"])
    return str(told["with_errands" if with_errands else "standing"])
