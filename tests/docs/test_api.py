"""docs/reference/api.md lists exactly what is public, and all of it is there, documented and typed."""

import ast
import importlib
import inspect
import re
from pathlib import Path

import pytest

import automotive_cosim
from tests.laws import over

TOP = Path(__file__).parents[2]
PAGE = (TOP / "docs/reference/api.md").read_text(encoding="utf-8")
DIRECTIVE = re.compile(r"^\.\. auto(class|function|module):: (\S+)$", re.MULTILINE)
LISTED = {name: kind for kind, name in DIRECTIVE.findall(PAGE)}
MODULES = sorted(name for name, kind in LISTED.items() if kind == "module")
NAMES = sorted(name for name, kind in LISTED.items() if kind != "module")


def found(name):
    module, _, last = name.rpartition(".")
    return getattr(importlib.import_module(module), last)


def own(module):
    """The classes and functions that a module or package defines under a public name."""
    return [
        each
        for name, each in ((name, getattr(module, name)) for name in dir(module))
        if not name.startswith("_")
        and (inspect.isclass(each) or inspect.isfunction(each))
        and each.__module__.startswith(module.__name__)
    ]


PUBLIC = [(name, found(name)) for name in NAMES]
PUBLIC += [(f"{name}.{each.__name__}", each) for name in MODULES for each in own(importlib.import_module(name))]


def test_the_page_lists_exactly_the_names_of_the_package():
    assert [name.partition(".")[2] for name in NAMES if name.count(".") == 1] == automotive_cosim.__all__


@over([*sorted((TOP / "automotive_cosim").rglob("__init__.pyi")), TOP / "agents/__init__.pyi"])
def test_every_name_of_a_stub_is_there_and_from_where_it_says(stub):
    home = stub.parent.name
    package = importlib.import_module(f"automotive_cosim.{home}".removesuffix(".automotive_cosim"))
    body = ast.parse(stub.read_text(encoding="utf-8")).body
    homes = {name.name: each.module for each in body if isinstance(each, ast.ImportFrom) for name in each.names}
    (names,) = (ast.literal_eval(each.value) for each in body if isinstance(each, ast.Assign))
    assert sorted(names) == package.__all__ == sorted(homes)
    assert all(getattr(package, name) is getattr(importlib.import_module(homes[name]), name) for name in homes)


@over([each for _, each in PUBLIC])
def test_what_is_public_is_documented_and_typed(each):
    assert len(inspect.getdoc(each) or "") > 5
    if inspect.isfunction(each):
        parameters = inspect.signature(each).parameters.values()
        assert not [one.name for one in parameters if one.annotation is one.empty]
        assert inspect.signature(each).return_annotation is not inspect.Signature.empty


def test_what_the_docs_import_is_public():
    code = "\n".join(page.read_text(encoding="utf-8") for page in (TOP / "README.md", *TOP.glob("docs/**/*.md")))
    imported = re.findall(r"^from (automotive_cosim\S*) import (.+)$", code, re.MULTILINE)
    asked = {f"{module}.{name.strip()}" for module, names in imported for name in names.split(",")}
    assert len(asked) > 12
    assert asked - {name for name, _ in PUBLIC} <= {"automotive_cosim.geo"}


def test_a_name_that_is_not_there_is_an_attribute_error():
    with pytest.raises(AttributeError, match="has no attribute 'Acton'"):
        automotive_cosim.Acton  # noqa: B018
    assert set(automotive_cosim.__all__) <= set(dir(automotive_cosim))
