"""Names for the streets of a network that was moved: they must not say where it really lies."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping

_KINDS = (
    ("Motorway", frozenset({"motorway"})),
    ("Main road", frozenset({"trunk", "primary"})),
)
"""What a street is called by the highest class of its edges, the highest first."""
_ANY_OTHER = "Street"


def neutral_names(streets: Iterable[tuple[str, str]]) -> Mapping[str, str]:
    """A name that fits every country for each street, as in "Main road 3", numbered in the order given.

    Args:
        streets: name and road class of every edge; a street is the edges of one name. Those without are left out.
    """
    classes: dict[str, set[str]] = {}
    for name, road_class in streets:
        if name:
            classes.setdefault(name, set()).add(road_class.removesuffix("_link"))
    numbers: Counter[str] = Counter()
    neutral = {}
    for name, found in classes.items():
        kind = next((kind for kind, own in _KINDS if own & found), _ANY_OTHER)
        numbers[kind] += 1
        neutral[name] = f"{kind} {numbers[kind]}"
    return neutral
