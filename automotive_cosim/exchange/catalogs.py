"""Checks an OpenSCENARIO file against the table, gives values to its parameters, and puts in what it takes from
catalogs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.resources import files
from pathlib import Path

from automotive_cosim.exchange.tree import XmlElement, read_tree

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


NAMELESS = SchemaRow(CARRIED, {}, {})
"""An element that can have neither attributes nor parts."""


class Catalogs:
    """The catalogs of a file."""

    def __init__(self, root: XmlElement) -> None:
        """Notes where they are. Raises ScenarioError: a place has no folder."""
        self._folders: list[Path] = []
        self._read: dict[Path, XmlElement] = {}
        rows = table()
        for places in root.all("CatalogLocations"):
            for place in places.parts:
                if rows["CatalogLocations"].parts.get(place.tag) == CARRIED:
                    places.taken.add(place.tag)
                    self._folders.append(place.part("Directory").beside("path"))

    def complete(self, element: XmlElement, scope: Mapping[str, str]) -> None:
        """Checks an element and all in it; gives them their parameters; replaces references by what they name.

        Raises ScenarioError: something is refused, unknown, or not to be found."""
        row = table().get(element.tag, NAMELESS)
        element.scope = scope = _declared(element, scope)
        for name in element.attributes:
            if ":" not in name and row.attributes.get(name, REFUSED) == REFUSED:
                raise element.refused(
                    f"has {name} = {element.attributes[name]!r}: {_outside(row, row.attributes, name)}"
                )
        for place, part in enumerate(element.parts):
            self._check(row, element, part)
            if row.parts[part.tag] == DIFFERENT and part.tag == "CatalogReference":
                continue
            if part.tag == "CatalogReference":
                self.complete(part, scope)
                entry, values = self._entry(part)
                self._check(row, element, entry)
                element.parts[place] = entry
                self.complete(entry, {**scope, **values})
            elif table().get(part.tag, NAMELESS).word == CARRIED:
                self.complete(part, scope)

    @staticmethod
    def _check(row: SchemaRow, element: XmlElement, part: XmlElement) -> None:
        if row.parts.get(part.tag, REFUSED) == REFUSED:
            raise part.refused(f"in <{element.tag}>: {_outside(row, row.parts, part.tag)}")

    def _entry(self, reference: XmlElement) -> tuple[XmlElement, dict[str, str]]:
        """What a reference names, and the values that it assigns."""
        name, wanted = reference.text("catalogName"), reference.text("entryName")
        found: list[tuple[bool, XmlElement]] = []
        for folder in self._folders:
            for path in sorted(folder.glob("*.xosc")):
                root = self._read.get(path) or self._read.setdefault(path, read_tree(path))
                for catalog in root.all("Catalog"):
                    entries = [each for each in catalog.parts if each.attributes.get("name") == wanted]
                    if entries and name in (catalog.attributes.get("name"), path.stem):
                        found.append((catalog.attributes.get("name") != name, entries[0]))
        if found:
            return _copied(min(found, key=lambda each: each[0])[1]), dict(_assigned(reference))
        looked = ", ".join(map(str, self._folders)) or "none"
        raise reference.refused(
            f"names {wanted!r} of the catalog {name!r}, which is in none of the folders: {looked}"
        )


def _outside(row: SchemaRow, known: Mapping[str, str], name: str) -> str:
    if name not in known:
        return "OpenSCENARIO 1.0 to 1.3 has no such name here"
    return f"outside what is imported; {row.differences.get(name, 'remove it')}"


def _copied(element: XmlElement) -> XmlElement:
    return XmlElement(element.tag, element.attributes, element.line, element.path, [*map(_copied, element.parts)])


def _assigned(reference: XmlElement) -> Iterator[tuple[str, str]]:
    for values in reference.all("ParameterAssignments"):
        for value in values.all("ParameterAssignment"):
            value.scope = reference.scope
            yield f"={value.attributes.get('parameterRef', '').lstrip('$')}", value.text("value")


def _declared(element: XmlElement, scope: Mapping[str, str]) -> Mapping[str, str]:
    """The parameters that hold within an element: what a reference assigns goes before what is declared."""
    made = dict(scope)
    for declarations in element.all("ParameterDeclarations"):
        for each in declarations.all("ParameterDeclaration"):
            each.scope = made
            name = each.text("name")
            given, own = made.pop(f"={name}", None), each.text("value")
            made[name] = own if given is None else given
    return made


def unread(element: XmlElement) -> None:
    """Checks that everything that is carried out has been asked for. Raises ScenarioError: something has not."""
    row = table().get(element.tag, NAMELESS)
    for name in element.attributes:
        if row.attributes.get(name) == CARRIED and name not in element.taken:
            raise element.refused(
                f"has {name} = {element.attributes[name]!r}, which is not imported here; remove it"
            )
    for part in element.parts:
        if row.parts.get(part.tag) == CARRIED and part.tag not in element.taken:
            raise part.refused(f"in <{element.tag}> is not imported here; remove it")
        is_left = row.parts.get(part.tag) == DIFFERENT and part.tag == "CatalogReference"
        if table().get(part.tag, NAMELESS).word == CARRIED and not is_left:
            unread(part)
