"""One name, one thing: no two public classes or type aliases of the package share a name, and one thing run has few
words in what users read."""

import ast
import re
from collections import defaultdict
from collections.abc import Iterator
from glob import glob
from pathlib import Path
from typing import Any

import pytest
from typer.main import get_command

import automotive_cosim
from automotive_cosim.cli.main import app

CLASS_LIKE = "[A-Z][A-Za-z0-9]*[a-z][A-Za-z0-9]*"
DEFINED = re.compile(rf"^[ \t]*class ({CLASS_LIKE})\b|^({CLASS_LIKE})(?::.*)? =(?!=)", re.MULTILINE)
"""Classes, nested ones included, and what a module assigns to a name like a class's."""


def test_no_two_classes_share_a_name():
    places = defaultdict(set)
    (folder,) = automotive_cosim.__path__
    files = glob(f"{folder}/**/*.py", recursive=True)  # noqa: PTH207, which goes through links as well
    for file in files:
        for defined in DEFINED.finditer(Path(file).read_text(encoding="utf-8")):
            places[defined[1] or defined[2]].add(file)
    assert len(files) > 250
    assert len(places) > 400
    assert {name: sorted(found) for name, found in places.items() if len(found) > 1} == {}


# --- the words for one thing run ---------------------------------------------------------------------------------

ROOT = Path(__file__).parents[1]
KEPT = re.compile(r"`[^`]*`|--[\w-]+|\[\[?\w+\]?\]|\b\w*[_./]\w[\w./]*|\$\{[^}]*\}")
"""Names of options, fields and files, which keep theirs, and what a text is filled with."""
OTHERWISE = {
    "point": r"percentage points?|points of score|of 100 points|\{\} points|offset points|or points |no point"
    r"|score,|<point|score of|touch or point|tap a|swipe from|nearest point of the street|the point \{\},\{\} is"
    r"|POINTS|^point$|^Points$",
    "branch": "A VSS path",
}
"""Where a retired word says something else."""


def retired() -> dict[str, str]:
    """The words that are retired, with what is said instead, as the glossary has them."""
    text = (ROOT / "docs/glossary.md").read_text(encoding="utf-8")
    _, _, section = text.partition("## One thing run")
    rows = re.findall(r"^\| (\w+) \| (.+?) \|$", section.partition("\n## ")[0], re.MULTILINE)
    return {word: instead for word, instead in rows if word != "retired"}


def shown() -> Iterator[tuple[str, str]]:
    """Every text that users read, with where it stands: of commands and options, of modules, pages and scripts."""
    yield from told("automotive-cosim", get_command(app))
    (folder,) = automotive_cosim.__path__
    for name in glob(f"{folder}/**/*.py", recursive=True):  # noqa: PTH207, which goes through links as well
        yield from literals(name, ast.parse(Path(name).read_text(encoding="utf-8")))
    for kind in ("html", "js", "typ"):
        for name in glob(f"{folder}/**/*.{kind}", recursive=True):  # noqa: PTH207
            text = re.sub(r"\{\{.*?\}\}|\{%.*?%\}", "", Path(name).read_text(encoding="utf-8"), flags=re.DOTALL)
            texts = re.findall(r">([^<>{}]+)<|\"([^\"\n]*)\"|`([^`]*)`", text)
            yield from ((name, each) for found in texts for each in found if " " in each or each.istitle())


def told(name: str, command: Any) -> Iterator[tuple[str, str]]:
    for each in command.params:
        yield name, " ".join(filter(None, (getattr(each, "help", ""), str(each.metavar or ""))))
    yield name, command.help or ""
    for part, within in getattr(command, "commands", {}).items():
        yield from told(f"{name} {part}", within)


def literals(name: str, tree: ast.Module) -> Iterator[tuple[str, str]]:
    """The texts in a module, with ``{}`` for what they are filled with; no docstrings, and no names."""
    passed = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call)]
    nouns = {id(each) for call in calls if getattr(call.func, "id", "") == "counted" for each in call.args}
    for node in ast.walk(tree):
        if isinstance(node, ast.JoinedStr):
            parts = [str(each.value) if isinstance(each, ast.Constant) else "{}" for each in node.values]
            passed |= set(map(id, node.values))
            text = "".join(parts)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in passed:
            text = node.value
        else:
            continue
        if " " in text or text.istitle() or id(node) in nouns:
            yield f"{name}:{node.lineno}", text


@pytest.mark.slow
def test_one_thing_run_has_six_words() -> None:
    words = retired()
    assert len(words) == 7
    found = re.compile(rf"\b({'|'.join(words)})(e?s)?\b", re.IGNORECASE)
    texts = list(shown())
    assert len(texts) > 3_000
    broken = []
    for where, text in texts:
        for each in found.finditer(KEPT.sub("", text)):
            word = each[1].lower()
            if not (word in OTHERWISE and re.search(OTHERWISE[word], text)):
                broken.append(
                    f"{where.rpartition('automotive_cosim/')[2]}: “{each[0]}” in {text[:110]!r}; say {words[word]}"
                )
    assert broken == []
