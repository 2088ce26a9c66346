"""What the import makes of each element and attribute of OpenSCENARIO XML 1.0 to 1.3: openscenario.txt as a table.

A row of it, ``Tag: attributes | parts``, says what an element may have. A name alone is carried out; after ``~`` it
is carried out with a difference, which a line below states; after ``-`` it is refused. A whole row after ``~`` is
not looked into, one after ``-`` stands for elements that are refused wherever they are.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files

CARRIED, DIFFERENT, REFUSED = "carried out", "carried out with a stated difference", "refused"
_WORDS = {"~": DIFFERENT, "-": REFUSED}


@dataclass(slots=True)
class SchemaRow:
    """An element."""

    word: str
    """What becomes of it where nothing else is said of it: carried out unless the whole row is marked."""
    attributes: Mapping[str, str]
    """Each attribute's word."""
    parts: Mapping[str, str]
    """The word of each element in it."""
    differences: dict[str, str] = field(default_factory=dict)
    """What is stated of an attribute or a part."""

    def told(self) -> Iterator[tuple[str, str, str]]:
        """Name, word and difference of each attribute (``@name``) and part."""
        for sign, names in (("@", self.attributes), ("", self.parts)):
            for name, word in names.items():
                yield f"{sign}{name}", word if self.word == CARRIED else self.word, self.differences.get(name, "")


@cache
def table() -> Mapping[str, SchemaRow]:
    """The rows by the elements' names."""
    rows: dict[str, SchemaRow] = {}
    row = None
    for line in (
        files("automotive_cosim.exchange").joinpath("openscenario.txt").read_text(encoding="utf-8").splitlines()
    ):
        head, _, rest = line.partition(":")
        if line.startswith(" "):
            assert row is not None
            row.differences |= dict.fromkeys(head.split(), rest.strip())
        else:
            attributes, _, parts = rest.partition("|")
            row = SchemaRow(_WORDS.get(head[0], CARRIED), _marked(attributes), _marked(parts))
            rows[head.lstrip("~-")] = row
    return rows


def _marked(names: str) -> Mapping[str, str]:
    return {name.lstrip("~-"): _WORDS.get(name[0], CARRIED) for name in names.split()}
