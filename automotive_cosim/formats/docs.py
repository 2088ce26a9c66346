"""The docstrings below fields and members, which Python itself does not keep; they require the source code."""

from __future__ import annotations

import ast
import inspect
import sys
from dataclasses import is_dataclass
from enum import Enum
from functools import cache
from itertools import pairwise
from textwrap import dedent


def field_docs(cls: type) -> dict[str, str]:
    """The docstrings below the fields of a class, each on one line; a class without source names them itself."""
    if told := cls.__dict__.get("__field_docs__"):
        return dict(told)
    docs = {}
    for node, below in pairwise(_body(cls)):
        match node, below:
            case ast.AnnAssign(target=ast.Name(name)), ast.Expr(ast.Constant(str(text))):
                docs[name] = prose(text)
    return docs


def inherited_field_docs(cls: type) -> dict[str, str]:
    """The same with the fields of its bases."""
    return {
        name: text
        for base in reversed(cls.__mro__)
        if is_dataclass(base)
        for name, text in field_docs(base).items()
    }


def member_docs(cls: type[Enum]) -> dict[str, str]:
    """The docstrings below the members of an enumeration, by name; empty for those without one."""
    docs = dict.fromkeys(cls.__members__, "")
    for node, below in pairwise(_body(cls)):
        match node, below:
            case ast.Assign(targets=[ast.Name(name)]), ast.Expr(ast.Constant(str(text))) if name in docs:
                docs[name] = prose(text)
    return docs


def _body(cls: type) -> list[ast.stmt]:
    """The statements of a class."""
    if found := _classes(cls.__module__).get(cls.__qualname__):
        return found.body
    (inner,) = ast.parse(dedent(inspect.getsource(cls))).body
    assert isinstance(inner, ast.ClassDef)
    return inner.body


@cache
def _classes(module: str) -> dict[str, ast.ClassDef]:
    """The classes of a module, parsed once: the command line asks for many."""
    body = ast.parse(inspect.getsource(sys.modules[module])).body
    return {node.name: node for node in body if isinstance(node, ast.ClassDef)}


def prose(text: str) -> str:
    """A docstring on one line."""
    return " ".join(text.replace("``", "`").split())
