"""The house rules, as an agent is told them: what a car maker has its assistant keep to, whatever it is asked.

The words are in ``house_rules.toml``. What breaks a rule is a matter of the judge alone (``tasking.policy``).
"""

from __future__ import annotations

from dataclasses import dataclass

from automotive_cosim.contracts.given import ToldPolicy
from automotive_cosim.formats.shipped import shipped_table


@dataclass(frozen=True, slots=True)
class HouseRule:
    """One house rule."""

    id: str
    words: str
    """As agents are told."""
    source: str
    """What it rests on; what nobody has set is a car maker's choice, here ours."""


HOUSE: tuple[HouseRule, ...] = tuple(
    HouseRule(name, **told) for name, told in shipped_table("interface", "house_rules.toml").items()
)
"""The house rules, in the order in which they are told."""


def told(policy: ToldPolicy) -> str | None:
    """The rules as an agent reads them, one a line; None if it is told none."""
    if policy is ToldPolicy.NONE:
        return None
    return "\n".join(f"{number}. {rule.words}" for number, rule in enumerate(HOUSE, start=1))
