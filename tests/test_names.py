"""One name, one thing: no two public classes or type aliases of the package share a name, and one thing run has few
words in what users read."""

import ast
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator
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
MEANT = re.compile(
    r"(?:percentage|gains?|loses?|cost|says about|more than|±\d+|cases and no) points"
    r"|points (?:for every|of the score|come from Euro)|point of crossing|trajectory with times, one point"
    r"|(?:set|reach(?:es)? the|give a) point|solves each by points|lead where points|base branch|VSS path, branch"
    r"|Inspect's samples|every sample is well formed|events a sample|1,182 samples",
    re.IGNORECASE,
)
"""What pages say of something else with a retired word: score, places, git, signals, what others call theirs."""


def retired() -> dict[str, str]:
    """The words that are retired, with what is said instead, as the glossary has them."""
    text = (ROOT / "docs/glossary.md").read_text(encoding="utf-8")
    _, _, section = text.partition("## One thing run")
    rows = re.findall(r"^\| (\w+) \| (.+?) \|$", section.partition("\n## ")[0], re.MULTILINE)
    return {word: instead for word, instead in rows if word != "retired"}


def any_of(words: Iterable[str]) -> re.Pattern[str]:
    return re.compile(rf"\b({'|'.join(words)})(e?s)?\b", re.IGNORECASE)


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
    found = any_of(words)
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


def prose(page: str) -> Iterator[str]:
    """The paragraphs and rows of a page, each in one line: no code, no targets of links, no retired word that says
    something else, and not the table that retires them."""
    text = re.sub(r"^## One thing run\n.*?(?=^## )|^( *)```.*?^\1```|^    [^\n]*$", "", page, flags=re.M | re.S)
    for part in re.split(r"\n\s*\n|\n(?=\||#| *[-*] )", text):
        words = re.sub(r"`[^`]*`|\]\([^)]*\)|\b(?:href|src)=\"[^\"]*\"", "", part)
        yield MEANT.sub("", " ".join(KEPT.sub("", words).split()))


def test_pages_keep_to_six_words() -> None:
    words = retired()
    assert len(words) == 7
    found = any_of(words)
    pages = [ROOT / "README.md", *(ROOT / "docs").glob("**/*.md")]
    pages = [page for page in pages if not {"_made", "_site"} & set(page.parts)]
    assert len(pages) > 40
    broken = [
        f"{page.relative_to(ROOT)}: “{each[0]}” in {text[max(0, each.start() - 60) : each.end() + 40]!r};"
        f" say {words[each[1].lower()]}"
        for page in pages
        for text in prose(page.read_text(encoding="utf-8"))
        for each in found.finditer(text)
    ]
    assert broken == []


@pytest.mark.parametrize(
    ("page", "said"),
    [
        ("## Replicates\n\nSee [Trials](#x), `trial.json` and\nboth futures.", ["Replicates", "Trials", "futures"]),
        ("| `--budget` | after 64\n| points |", ["points"]),
        ("It loses points; the nominal point of a base\nbranch has no branch.", ["point", "branch"]),
        ("```\na trial\n```\n\n    an instance\n\n* an\n  instance", ["instance"]),
    ],
)
def test_a_retired_word_on_a_page_is_found(page: str, said: list[str]) -> None:
    found = any_of(retired())
    assert [each[0] for text in prose(page) for each in found.finditer(text)] == said
