"""One name, one thing: no two public classes or type aliases of the package share a name."""

import ast
import pkgutil
import re
from collections import defaultdict
from importlib.util import find_spec
from pathlib import Path

import automotive_cosim

CLASS_LIKE = re.compile(r"[A-Z][A-Za-z0-9]*[a-z][A-Za-z0-9]*")


def defined(tree: ast.Module):
    """Public classes, nested ones included, and what a module assigns to a name like a class's."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ClassDef):
            yield node.name
    for node in tree.body:
        if isinstance(node, ast.Assign):
            yield from (target.id for target in node.targets if isinstance(target, ast.Name))
        elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            yield node.target.id


def test_no_two_classes_share_a_name():
    places = defaultdict(set)
    modules = [found.name for found in pkgutil.walk_packages(automotive_cosim.__path__, "automotive_cosim.")]
    for module in modules:
        tree = ast.parse(Path(find_spec(module).origin).read_text(encoding="utf-8"))
        for name in filter(CLASS_LIKE.fullmatch, defined(tree)):
            places[name].add(module)
    assert len(modules) > 250
    assert len(places) > 400
    assert {name: sorted(found) for name, found in places.items() if len(found) > 1} == {}
