"""Values of OpenSCENARIO's attributes: parameters and expressions, evaluated where they are used."""

from __future__ import annotations

import ast
import math
import operator
import re
from collections.abc import Mapping
from typing import Any

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
        scope: the values of the parameters.

    Raises:
        ValueError: it is no expression that can be evaluated, or names an unknown parameter.
    """
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
