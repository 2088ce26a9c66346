"""The docstrings below fields and members, which Python itself does not keep; they require the source code."""

from __future__ import annotations

import ast
import inspect
from dataclasses import is_dataclass
from enum import Enum
from itertools import pairwise
from textwrap import dedent


def field_docs(cls: type) -> dict[str, str]:
    """The docstrings below the fields of a class, each on one line; a class without source names them itself."""
    if told := cls.__dict__.get("__field_docs__"):
        return dict(told)
    (body,) = ast.parse(dedent(inspect.getsource(cls))).body
    assert isinstance(body, ast.ClassDef)
    docs = {}
    for node, below in pairwise(body.body):
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
    (body,) = ast.parse(dedent(inspect.getsource(cls))).body
    assert isinstance(body, ast.ClassDef)
    docs = dict.fromkeys(cls.__members__, "")
    for node, below in pairwise(body.body):
        match node, below:
            case ast.Assign(targets=[ast.Name(name)]), ast.Expr(ast.Constant(str(text))) if name in docs:
                docs[name] = prose(text)
    return docs


def prose(text: str) -> str:
    """A docstring on one line."""
    return " ".join(text.replace("``", "`").split())
