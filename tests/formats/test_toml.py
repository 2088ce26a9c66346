"""Where things stand in a TOML file, held against what is in it."""

import tomllib
from collections.abc import Iterator
from importlib.resources import files
from pathlib import Path

import pytest

from automotive_cosim.errors import ScenarioError, UserError
from automotive_cosim.formats.toml import Document, parse
from tests.laws import over

ROOT = Path(str(files("automotive_cosim")))
SHIPPED = [
    *ROOT.glob("sumo_scenarios/*/scenario.toml"),
    *ROOT.glob("geo/data/*.toml"),
    *ROOT.glob("tasks/limits/*.toml"),
]
AWKWARD = '''# a = 1
a = 1
"q.x"."y=1" = """
[not]
b = 2
"""
l = [ # c ]
  1, "]",
  { z = 1 },
]
[[rules]]
id = 'x' # [foo]
[rules.when]
k = 1
[[rules]]
id = "y"
cases = [
 { value = 1 },
]
  [ "a b" . c ]  # hi
s = \'\'\'it's''\'\'\'
e = "\\"[["
f.g = 3
[[rules.inner]]
h = 1
'''


def _document(text: str) -> Document:
    return parse(text, Path("a.toml"))


def _keys(value: object, steps: tuple[str | int, ...] = ()) -> Iterator[tuple[str | int, ...]]:
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for step, inner in items:
        if isinstance(step, str):
            yield (*steps, step)
        yield from _keys(inner, (*steps, step))


@over([AWKWARD, *(path.read_text("utf-8") for path in SHIPPED)])
def test_every_key_is_found_on_a_line_that_names_it_or_encloses_it(text: str) -> None:
    document, lines = _document(text), text.splitlines()
    assert SHIPPED
    for steps in _keys(tomllib.loads(text)):
        where, _ = document.place(steps)
        number = int(where.split(" ")[2])
        keys = [step for step in steps if isinstance(step, str)]
        assert any(key in lines[number - 1] for key in keys), (steps, where)


@pytest.mark.parametrize(
    ("steps", "where", "name"),
    [
        ((), "a.toml", ""),
        (("a",), "a.toml line 2", "a"),
        (("q.x", "y=1"), "a.toml line 3", "q.x.y=1"),
        (("l", 2, "z"), "a.toml line 7", "l[2].z"),
        (("rules",), "a.toml line 11", "rules"),
        (("rules", 0), "a.toml line 11 [[rules]] x", ""),
        (("rules", 0, "when", "k"), "a.toml line 14 [rules.when]", "k"),
        (("rules", 1, "cases", 0, "value"), "a.toml line 17 [[rules]] y", "cases[0].value"),
        (("rules", 1, "absent"), "a.toml line 15 [[rules]] y", "absent"),
        (("rules", 1, "inner", 0, "h"), "a.toml line 25 [[rules.inner]]", "h"),
        (("a b", "c", "f", "g"), "a.toml line 23 [a b.c]", "f.g"),
        (("absent",), "a.toml", "absent"),
    ],
)
def test_a_place_has_file_line_table_and_name(steps: tuple[str | int, ...], where: str, name: str) -> None:
    assert _document(AWKWARD).place(steps) == (where, name)


def test_a_refusal_is_of_the_documents_class() -> None:
    document = parse("[sumo]\nscale = 3\n", Path("a.toml"), ScenarioError)
    refused = document.refused(("sumo", "scale"), "is odd")
    assert type(refused) is ScenarioError
    assert str(refused) == "a.toml line 2 [sumo]: scale is odd"
    with pytest.raises(ScenarioError, match=r"a\.toml is not TOML: .* \(at line 1, column 5\)"):
        parse("a = = 1", Path("a.toml"), ScenarioError)


def test_an_error_of_several_problems_has_a_line_for_each() -> None:
    assert str(UserError("one", "two")) == "one\ntwo"
    assert str(UserError("one")) == "one"
