"""The speed limit that binds at an instant: the sign's, else the law's, lowered by weather, light or hour."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from automotive_cosim.contracts import KMH_PER_MPS, Limit, LimitSource
from automotive_cosim.geo.applied import AppliedRule
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.rules import Status
from automotive_cosim.geo.text import KM_PER_MILE

SIGN = "posted"
"""Id of the rule if a sign sets the limit."""


@dataclass(frozen=True, slots=True)
class BindingLimit:
    """The limit that applies at one instant, and what says so."""

    limit: Limit
    """From a sign or by law, always with a speed."""
    rule: str
    text: str
    law: str
    status: Status

    @property
    def kmh(self) -> float:
        """The speed in km/h."""
        assert self.limit.kmh is not None
        return self.limit.kmh


def binding_limit(context: GeoContext) -> BindingLimit | None:
    """The lowest limit that certainly applies: the sign's, else the law's; lowered by weather, light or hour.

    A sign is lowered only by rules that also lower signs (``caps``). None if no limit is known or there is none.
    """
    here = context.road.limit
    signed = here.is_posted
    found: list[BindingLimit] = []
    if here.posted_mps is not None:
        words = f"posted on {context.road.name or 'this road'}"
        found.append(BindingLimit(here, SIGN, words, "sign", Status.VERIFIED))
    elif not signed and context.default_limit is not None:
        found += _of_rule(context.default_limit)
    for reduced in context.reduced_limits:
        if reduced.certain and (reduced.rule.caps or not signed):
            found += _of_rule(reduced)
    return min(found, key=lambda limit: limit.kmh, default=None)


def _of_rule(applied: AppliedRule) -> Iterator[BindingLimit]:
    value, rule = applied.value, applied.rule
    if isinstance(value, float):
        kmh = value * KM_PER_MILE if rule.unit == "mph" else value
        yield BindingLimit(Limit(kmh / KMH_PER_MPS, LimitSource.LAW), rule.id, rule.text, rule.law, rule.status)
