"""An XML file as a tree whose elements know their lines, and a reader that refuses what it does not know."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats import bounds
from automotive_cosim.formats.xml import scan


@dataclass(slots=True)
class XmlElement:
    """An element."""

    tag: str
    attributes: Mapping[str, str]
    line: int
    path: Path
    parts: list[XmlElement] = field(default_factory=list)

    def refused(self, why: str) -> ScenarioError:
        """The error that names it and its line."""
        return ScenarioError(f"{self.path} line {self.line}: <{self.tag}> {why}")

    def only(self, *tags: str) -> list[XmlElement]:
        """Its parts, all of which have one of these tags.

        Raises:
            ScenarioError: one has another.
        """
        for part in self.parts:
            if part.tag not in tags:
                raise part.refused(f"in <{self.tag}> is outside the subset that is imported; remove it")
        return self.parts

    def all(self, tag: str) -> list[XmlElement]:
        """Its parts with that tag."""
        return [part for part in self.parts if part.tag == tag]

    def find(self, tag: str) -> XmlElement | None:
        """Its first part with that tag."""
        return next((part for part in self.parts if part.tag == tag), None)

    def one(self, *tags: str) -> XmlElement:
        """Its only part, with one of these tags.

        Raises:
            ScenarioError: it has none, several or another.
        """
        found = self.only(*tags)
        if len(found) != 1:
            raise self.refused(f"has {len(found)} parts; it needs one of {', '.join(tags)}")
        return found[0]

    def text(self, name: str) -> str:
        """The value of an attribute.

        Raises:
            ScenarioError: it is missing, or an expression.
        """
        value = self.attributes.get(name)
        if value is None:
            raise self.refused(f"has no {name}")
        if value.startswith("$"):
            raise self.refused(f"has the parameter {name} = {value}; give its value")
        return value

    def number(self, name: str, otherwise: float | None = None) -> float:
        """The value of an attribute as a number.

        Raises:
            ScenarioError: it is missing, or no number.
        """
        if otherwise is not None and name not in self.attributes:
            return otherwise
        try:
            return float(self.text(name))
        except ValueError as error:
            raise self.refused(f"has {name} = {self.attributes[name]!r}, which is no number") from error


def read_tree(path: Path) -> XmlElement:
    """The root of an XML file.

    Raises:
        ScenarioError: it is missing or no XML.
    """
    open_elements: list[XmlElement] = []
    roots: list[XmlElement] = []

    def start(tag: str, attributes: dict[str, str], line: int) -> None:
        made = XmlElement(tag, attributes, line, path)
        (open_elements[-1].parts if open_elements else roots).append(made)
        open_elements.append(made)

    def end(tag: str) -> None:
        open_elements.pop()

    scan(path, start, end, error=ScenarioError, most_elements=bounds.KEPT_ELEMENTS)
    return roots[0]
