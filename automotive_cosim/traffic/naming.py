"""Names for the streets of a network that was moved: a place there could have them, and they do not tell where the
network really lies. Motorways and main roads have numbers, as in "Main road 3", the others names that are common in
the language (``street_names.toml``).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache

from automotive_cosim.formats.shipped import shipped_table

ENGLISH = "en"
_KINDS = (("Motorway", frozenset({"motorway"})), ("Main road", frozenset({"trunk", "primary"})))
"""What a street is called by the highest class of its edges, the highest first."""


@dataclass(frozen=True, slots=True)
class StreetWords:
    """What streets are called in one language, as in "Mill Lane"."""

    kinds: tuple[str, ...]
    """As in ``"{} Lane"``."""
    names: tuple[str, ...]
    """As in ``"Mill"``."""


@cache
def languages() -> Mapping[str, StreetWords]:
    """The words of each language that has some, by its ISO 639-1 code."""
    told = shipped_table("traffic", "street_names.toml")
    return {code: StreetWords(tuple(each["kinds"]), _names(each["names"])) for code, each in told.items()}


def _names(text: str) -> tuple[str, ...]:
    return tuple(" ".join(name.split()) for name in text.split(","))


def local_names(streets: Iterable[tuple[str, str]], language: str) -> Mapping[str, str]:
    """A name for each street. The same streets get the same names, in the order given.

    Args:
        streets: name and road class of every edge; a street is the edges of one name. Those without are left out.
        language: ISO 639-1 code; without a list of its names, they are English."""
    classes: dict[str, set[str]] = {}
    for name, road_class in streets:
        if name:
            classes.setdefault(name, set()).add(road_class.removesuffix("_link"))
    words = languages().get(language) or languages()[ENGLISH]
    counts: Counter[str] = Counter()
    given: dict[str, str] = {}
    for name, found in classes.items():
        kind = next((kind for kind, own in _KINDS if own & found), "")
        drawn = name
        while drawn in classes:  # a name that it really has may tell where it lies
            counts[kind] += 1
            drawn = f"{kind} {counts[kind]}" if kind else _street(words, counts[kind] - 1)
        given[name] = drawn
    return given


def _street(words: StreetWords, number: int) -> str:
    """The street of a number: neighbours differ in both parts of the name, and none comes twice."""
    again, index = divmod(number, len(words.kinds) * len(words.names))
    turn, at = divmod(index, len(words.names))
    text = words.kinds[(at + turn) % len(words.kinds)].format(words.names[at])
    return f"{text} {again + 1}" if again else text
