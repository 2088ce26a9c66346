"""The speed limit that binds at one instant, and what says so."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache

from automotive_cosim.contracts import KMH_PER_MPS, Limit, LimitSource, RoadHere
from automotive_cosim.geo.applied import AppliedRule
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


def binding(road: RoadHere, default: AppliedRule | None, reduced: Sequence[AppliedRule]) -> BindingLimit | None:
    """The lowest limit that certainly applies: the sign's, else the law's; lowered by weather, light or hour.

    A sign is lowered only by rules that also lower signs (``caps``). None if no limit is known or there is none.

    Args:
        default: the legal limit for it, if it is certain.
        reduced: lower limits under conditions."""
    here = road.limit
    signed = here.is_posted
    found: list[BindingLimit] = []
    if here.posted_mps is not None:
        found.append(_of_sign(here, road.name))
    elif not signed and default is not None:
        found += _of_rule(default)
    for lower in reduced:
        if lower.certain and (lower.rule.caps or not signed):
            found += _of_rule(lower)
    if signed and default is not None and default.rule.caps:
        found += _of_rule(default)
    return min(found, key=lambda limit: limit.kmh, default=None)


@lru_cache(maxsize=1024)
def _of_sign(limit: Limit, road: str) -> BindingLimit:
    """The same one from second to second: drives keep them."""
    return BindingLimit(limit, SIGN, f"{limit.words} {road or 'this road'}", "sign", Status.VERIFIED)


def _of_rule(applied: AppliedRule) -> Iterator[BindingLimit]:
    value, rule = applied.value, applied.rule
    if isinstance(value, float):
        kmh = value * KM_PER_MILE if rule.unit == "mph" else value
        yield BindingLimit(Limit(kmh / KMH_PER_MPS, LimitSource.LAW), rule.id, rule.text, rule.law, rule.status)
