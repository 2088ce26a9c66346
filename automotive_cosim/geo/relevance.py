"""Which topics of the law can matter here and now; an agent may ask for the others.

It goes by topic and by coarse conditions, never by whether a rule's own condition holds: fog lamps are a matter of
any weather that hides the road, not of the metres that a law names.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from automotive_cosim.geo.rulefacts import RuleFacts

WINTER_BELOW_C = 7.0
"""Where winter tyres grip better than summer tyres, as tyre makers say."""
WARM_FROM_C = 22.0
"""From here on a driver may want to be cooled; our choice, well below the 26 degrees of EN 16798-1."""
_HIDING = frozenset(("drizzle", "dust", "fog", "precipitation"))
"""Weather in which less is seen."""


def _hidden(now: RuleFacts) -> bool:
    return now.phenomena is None or not _HIDING.isdisjoint(now.phenomena)


def _in_town(now: RuleFacts) -> bool:
    return now.built_up is not False


def _off_motorways(now: RuleFacts) -> bool:
    return now.motorway is not True


def _wide(now: RuleFacts) -> bool:
    return now.motorway is not False or now.dual_carriageway is not False or now.lanes >= 2


_ONLY_IF: Mapping[str, Callable[[RuleFacts], bool]] = {
    "front_fog": _hidden,
    "rear_fog": _hidden,
    "high_beam": lambda now: now.after_sunset is not False or now.tunnel or _hidden(now),
    "emergency_corridor": _wide,
    "turn_on_red": _off_motorways,
    "bus_lane": _off_motorways,
    "through_traffic": _off_motorways,
    "low_emission": _in_town,
    "school_zone": _off_motorways,
    "idling": lambda now: now.standing,
    "alcohol": lambda now: False,  # nothing that is done at the wheel depends on it
    "seat_belts": lambda now: False,  # they are fastened before the drive
}
"""Topics that do not always matter; unknown conditions count as if they could hold."""


def can_matter(topic: str, now: RuleFacts, air_c: float | None) -> bool:
    """Whether a topic of ``rules.TOPICS`` can matter by these facts, with that air temperature outside."""
    if topic in ("winter_tyres", "studs", "cold"):
        return air_c is None or air_c < WINTER_BELOW_C
    if topic == "heat":
        return air_c is None or air_c >= WARM_FROM_C
    return topic not in _ONLY_IF or _ONLY_IF[topic](now)
