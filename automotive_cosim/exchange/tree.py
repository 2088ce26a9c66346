"""An XML file as a tree whose elements know their lines, and which refuses what it is not asked for."""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats import bounds
from automotive_cosim.formats.xml import FilePlace, scan

PARAMETER = re.compile(r"\$([A-Za-z_]\w*)")
_OPERATORS: Mapping[type[ast.AST], Any] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.Mod: operator.mod, ast.USub: operator.neg, ast.UAdd: operator.pos,
}  # fmt: skip
_FUNCTIONS: Mapping[str, Any] = {
    "abs": abs, "acos": math.acos, "asin": math.asin, "atan": math.atan, "ceil": math.ceil, "cos": math.cos,
    "floor": math.floor, "max": max, "min": min, "pow": math.pow, "round": round, "sin": math.sin,
    "sign": lambda value: (value > 0) - (value < 0), "sqrt": math.sqrt, "tan": math.tan,
}  # fmt: skip
"""Those of the standard."""


def evaluated(text: str, scope: Mapping[str, str]) -> str:
    """The value of an attribute.

    Args:
        text: a value, ``$parameter`` or ``${expression}``.

    Raises ValueError: it is no expression that can be evaluated, or names an unknown parameter."""
    if not text.startswith("$"):
        return text[1:] if text.startswith("\\$") else text
    if not text.startswith("${"):
        return _of(text.removeprefix("$"), scope)
    inner = PARAMETER.sub(lambda found: f"({_of(found[1], scope)})", text.removeprefix("${").removesuffix("}"))
    try:
        value = _number(ast.parse(inner.strip(), mode="eval").body)
    except (ArithmeticError, RecursionError, SyntaxError, TypeError) as error:
        raise ValueError("which cannot be evaluated") from error
    return repr(value)


def _of(name: str, scope: Mapping[str, str]) -> str:
    if name not in scope:
        raise ValueError(f"but nothing declares {name}")
    return scope[name]


def _number(node: Any) -> Any:
    """A whole number stays one."""
    match node:
        case ast.Constant(value=int() | float() as value):
            return value
        case ast.BinOp() if type(node.op) in _OPERATORS:
            return _OPERATORS[type(node.op)](_number(node.left), _number(node.right))
        case ast.UnaryOp() if type(node.op) in _OPERATORS:
            return _OPERATORS[type(node.op)](_number(node.operand))
        case ast.Call(func=ast.Name(id=name)) if name in _FUNCTIONS and not node.keywords:
            return _FUNCTIONS[name](*map(_number, node.args))
    raise ValueError("which cannot be evaluated")


@dataclass(slots=True)
class XmlElement:
    """An element."""

    tag: str
    attributes: Mapping[str, str]
    line: int
    path: Path
    parts: list[XmlElement] = field(default_factory=list)
    scope: Mapping[str, str] = field(default_factory=dict)
    """The values of the parameters that hold here."""
    taken: set[str] = field(default_factory=set)
    """The attributes and parts that have been asked for."""

    def refused(self, why: str) -> ScenarioError:
        """The error that names it and its line."""
        return ScenarioError(f"{self.path} line {self.line}: <{self.tag}> {why}")

    def only(self, *tags: str) -> list[XmlElement]:
        """Its parts, all of which have one of these tags. Raises ScenarioError: one has another."""
        for part in self.parts:
            if part.tag not in tags:
                raise part.refused(f"in <{self.tag}> is outside the subset that is imported here; remove it")
        self.taken.update(tags)
        return self.parts

    def all(self, tag: str) -> list[XmlElement]:
        """Its parts with that tag."""
        self.taken.add(tag)
        return [part for part in self.parts if part.tag == tag]

    def find(self, tag: str) -> XmlElement | None:
        """Its only part with that tag, or None. Raises ScenarioError: it has several."""
        found = self.all(tag)
        if len(found) > 1:
            raise found[1].refused(f"is the second in <{self.tag}>, which can have one")
        return found[0] if found else None

    def one(self, *tags: str) -> XmlElement:
        """Its only part, with one of these tags. Raises ScenarioError: it has none, several or another."""
        found = self.only(*tags)
        if len(found) != 1:
            raise self.refused(f"has {len(found)} parts; it needs one of {', '.join(tags)}")
        return found[0]

    def part(self, tag: str) -> XmlElement:
        """Its only part with that tag. Raises ScenarioError: it has none, or several."""
        found = self.find(tag)
        if found is None:
            raise self.refused(f"has no {tag}")
        return found

    def beside(self, name: str) -> Path:
        """The file or folder that an attribute names: beside this file, below it, or in a folder next to its own.

        Raises ScenarioError: the attribute is missing, or leads elsewhere on this machine."""
        given, here = self.text(name), self.path.resolve().parent
        there, below = Path(here.anchor), Path().parts
        with suppress(OSError, ValueError):
            there = (here / given).resolve()
            below = there.relative_to(here.parent).parts if here.parent != Path(here.anchor) else ()
        is_next = len(below) > 1 or (len(below) == 1 and there.is_dir())
        if Path(given).is_absolute() or not (is_next or there.is_relative_to(here)):
            raise self.refused(f"names {given[:80]!r}, which is not beside it; copy it there")
        return self.path.parent / given

    def take(self) -> None:
        """Takes all in it for read: it says nothing that does not follow from elsewhere."""
        self.taken.update(self.attributes, (part.tag for part in self.parts))
        for part in self.parts:
            part.take()

    def text(self, name: str, otherwise: str | None = None) -> str:
        """The value of an attribute, with the values of parameters.

        Raises ScenarioError: it is missing, or an expression that cannot be evaluated."""
        self.taken.add(name)
        value = self.attributes.get(name, otherwise)
        if value is None:
            raise self.refused(f"has no {name}")
        try:
            return evaluated(value, self.scope) if value.startswith(("$", "\\")) else value
        except ValueError as error:
            raise self.refused(f"has {name} = {value}, {error}") from error

    def number(self, name: str, otherwise: float | None = None) -> float:
        """The value of an attribute as a finite number. Raises ScenarioError: it is missing, or no such number."""
        self.taken.add(name)
        if otherwise is not None and name not in self.attributes:
            return otherwise
        try:
            value = float(self.text(name))
        except ValueError as error:
            raise self.refused(f"has {name} = {self.attributes[name]!r}, which is no number") from error
        if not abs(value) < float("inf"):
            raise self.refused(f"has {name} = {self.attributes[name]!r}; a finite number is needed")
        return value

    def word(self, name: str, *words: str, otherwise: str | None = None) -> str:
        """The value of an attribute, one of these. Raises ScenarioError: it is missing, or another."""
        value = self.text(name, otherwise)
        if value not in words:
            raise self.refused(f"has {name} = {value!r}; what is imported is {', '.join(words)}")
        return value

    def is_true(self, name: str, *, otherwise: str | None = None) -> bool:
        """The value of an attribute that is true or false. Raises ScenarioError: it is missing, or neither."""
        return self.word(name, "true", "false", "1", "0", otherwise=otherwise) in ("true", "1")


def read_tree(path: Path, kept: frozenset[str] | None = None) -> XmlElement:
    """The root of an XML file.

    Args:
        kept: of which elements there is a node, in that of the nearest kept one around it; None keeps all.

    Raises ScenarioError: it is missing or no XML."""
    open_elements: list[XmlElement] = []
    roots: list[XmlElement] = []
    place = FilePlace()

    def start(tag: str, attributes: dict[str, str]) -> None:
        if kept is None or not open_elements or tag in kept:
            made = XmlElement(tag, attributes, place.line, path)
            (open_elements[-1].parts if open_elements else roots).append(made)
            open_elements.append(made)

    def end(tag: str) -> None:
        if kept is None or tag in kept:
            open_elements.pop()

    scan(path, start, end, place=place, error=ScenarioError, most_elements=bounds.KEPT_ELEMENTS)
    return roots[0]
