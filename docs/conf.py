"""The documentation site: ``make docs`` builds it offline; a broken link or an unknown name fails.

The pages of ``_made/`` come from the package at each build: what a command prints is what it says of itself.
"""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Iterable, Sequence
from enum import Enum
from pathlib import Path

import typer
from sphinx.application import Sphinx
from typer.cli import get_docs_for_click
from typer.main import get_command
from typer.testing import CliRunner

from automotive_cosim import __version__, scenarios, schemas
from automotive_cosim.agents import FORMATS
from automotive_cosim.cli.main import app
from automotive_cosim.drives.events import KINDS
from automotive_cosim.drives.families import FAMILIES
from automotive_cosim.drives.settings import DriveSettings
from automotive_cosim.drives.wakes import WAKES
from automotive_cosim.episode.conditions import TABLE
from automotive_cosim.formats.docs import field_docs, member_docs
from automotive_cosim.interface import spaces
from automotive_cosim.interface.policy import HOUSE
from automotive_cosim.publish.leaderboard import board
from automotive_cosim.safety.space import LIBRARY, read_space
from automotive_cosim.tasking.task import Dimension, Module
from automotive_cosim.tasks import CATALOGUE

DOCS = Path(__file__).parent
MADE = DOCS / "_made"

HEADS = ("Agent", "Model", "Prompt", "Safety pairs", "All episodes", "Bundle")
"""Columns of the leaderboard that the site's page shows; the whole page has all."""

project = "automotive_cosim"
author = "The automotive_cosim authors"
project_copyright = "The automotive_cosim authors, Apache-2.0"
version = release = __version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_copybutton"]
INCLUDED = (
    "conditions",
    "functions",
    "native_formats",
    "leaderboard",
    "readme",
    "spaces",
    "drive_families",
    "drive_kinds",
    "drive_wakes",
    "fields_plan",
    "policy",
    "fields_scenario",
    "search_settings",
    "search_spaces",
)
"""Pages of ``_made/`` that are parts of others."""
exclude_patterns = ["_site", "examples", *(f"_made/{name}.md" for name in INCLUDED)]
myst_heading_anchors = 4
myst_enable_extensions = ["colon_fence", "deflist"]
napoleon_numpy_docstring = False
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True}
autodoc_mock_imports = ["ray", "stable_baselines3", "torch"]
highlight_language = "none"
html_theme = "furo"
html_title = f"automotive_cosim {__version__}"
html_static_path = ["_static"]
html_extra_path = ["_made/board"]
html_css_files = ["site.css"]
html_theme_options = {"navigation_with_keys": True}


def setup(sphinx: Sphinx) -> None:
    """Makes the pages before Sphinx looks for them."""
    shutil.rmtree(MADE, ignore_errors=True)
    _checkout()
    _catalogue()
    _gallery()
    _commands()
    _drives()
    _search()
    _conditions()
    _leaderboard()
    _table("policy.md", ("rule", "words", "source"), [(f"`{each.id}`", each.words, each.source) for each in HOUSE])
    for name in ("plan", "scenario"):
        _fields(name)
    _write("functions.md", "```text", _printed("show", "functions"), "```")
    forms = [(f"`{name}`", each.models, each.grid.told, each.declines) for name, each in FORMATS.items()]
    _table("native_formats.md", ("`format`", "models", "coordinates", "declines with"), forms)


def _write(page: str, *lines: str) -> None:
    path = MADE / page
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _checkout() -> None:
    """The files that lie beside docs/, with their links into it."""
    for page, source in (
        ("readme.md", "README.md"),
        ("contributing.md", "CONTRIBUTING.md"),
        ("changelog.md", "CHANGELOG.md"),
        ("benchmarks.md", "benchmarks/README.md"),
    ):
        text = (DOCS.parent / source).read_text(encoding="utf-8")
        _write(page, re.sub(r"\]\((\.\./)?docs/", "](../", text))
    _write("spaces.md", (spaces.__doc__ or "").replace("``", "`"))


def _printed(*arguments: str) -> str:
    """What a command prints."""
    ran = CliRunner().invoke(app, arguments, catch_exceptions=False)
    if ran.exit_code:
        raise RuntimeError(f"automotive-cosim {' '.join(arguments)} ended with code {ran.exit_code}: {ran.output}")
    return ran.output.rstrip()


def _catalogue() -> None:
    """A page for each module; each task is what `tasks show` prints of it."""
    index = ["# Catalogue", "", f"{len(CATALOGUE)} tasks, by module and dimension:", ""]
    index += ["| module | " + " | ".join(str(each).replace("_", " ") for each in Dimension) + " |"]
    index += ["|---" * (len(Dimension) + 1) + "|"]
    for module in Module:
        tasks = [task for task in CATALOGUE.values() if task.module is module]
        counts = [sum(task.dimension is each for task in tasks) for each in Dimension]
        index.append(f"| [{_title(module)}]({module}.md) | " + " | ".join(map(str, counts)) + " |")
        page = [f"# {_title(module)}", ""]
        for task in tasks:
            page += [f"## {task.id}", "", "```text", _printed("tasks", "show", task.id), "```", ""]
        _write(f"catalogue/{module}.md", *page)
    pages = [str(module) for module in Module]
    _write("catalogue/index.md", *index, "", "```{toctree}", ":hidden:", "", *pages, "```")


def _title(module: Module) -> str:
    return "HVAC" if module is Module.HVAC else str(module).capitalize()


def _gallery() -> None:
    """The README and the map of each scenario that is shipped."""
    page = ["# Shipped scenarios", ""]
    for name in scenarios.shipped():
        folder = scenarios.load(name).folder
        readme = (folder / "README.md").read_text(encoding="utf-8")
        page.append(re.sub(r"^#", "##", readme, flags=re.MULTILINE).replace("](map.webp)", f"](maps/{name}.webp)"))
        (MADE / "maps").mkdir(parents=True, exist_ok=True)
        shutil.copyfile(folder / "map.webp", MADE / "maps" / f"{name}.webp")
    _write("gallery.md", *page)


def _drives() -> None:
    """The tables of families, kinds of events and what ends a wait."""
    _table(
        "drive_families.md",
        ("family", "season", "what it is", "what is staged"),
        [(f"`{each.id}`", each.season, each.about, ", ".join(each.cast)) for each in FAMILIES.values()],
    )
    kinds = [
        (
            each.name,
            each.about,
            ", ".join(f"`{name}`" for name in each.told_by),
            each.neutral,
            each.lookalike,
            each.source,
            f"{each.lasts_s:.0f} s",
            f"{each.weight:g}",
            ", ".join(sorted(each.alerts))
            or ("none: the state counts" if each.by_state else "words, or the switch"),
        )
        for each in KINDS.values()
    ]
    heads = (
        "kind",
        "the event",
        "told by",
        "neutral: true, but not due",
        "its look-alike",
        "times",
        "prepares",
        "weight",
        "alerts",
    )
    _table("drive_kinds.md", heads, kinds)
    _table("drive_wakes.md", ("change", "when"), [(each.name, each.about) for each in WAKES])


def _search() -> None:
    """The tables of what a search varies on drives, and of the scenarios that it knows by name."""
    settings = [(f"`{name}`", about) for name, about in field_docs(DriveSettings).items()]
    _table("search_settings.md", ("factor of drives", "value"), settings)
    spaces = [(f"`{name}`", read_space(path).about) for name, path in LIBRARY.items()]
    _table("search_spaces.md", ("scenario", "what happens"), spaces)


def _conditions() -> None:
    """The table of conditions, with what each of their values means."""
    rows: list[tuple[str, str, str]] = []
    for each in TABLE:
        kind = type(each.default)
        docs = member_docs(kind) if issubclass(kind, Enum) else {}
        told = [f"`{kind[name]}`: {text}" if text else f"`{kind[name]}`" for name, text in docs.items()]
        rows.append((f"`--{each.word}`", each.help, "<br>".join(told) or f"`{each.default}` and up"))
    _table("conditions.md", ("option", "what it is about", "values, the usual one first"), rows)


def _leaderboard() -> None:
    """The page of all bundles in the repository, and its tables; a bundle with a problem fails the build."""
    out = MADE / "board" / "leaderboard.html"
    out.parent.mkdir(parents=True, exist_ok=True)
    made, left_out = board(DOCS / "leaderboard" / "bundles", out)
    if left_out:
        raise RuntimeError(f"docs/leaderboard/bundles: {'; '.join(left_out)}")
    page: list[str] = []
    for table, conditions, _ in made:
        shown = [place for place, head in enumerate(table.columns) if head in HEADS]
        page += [f"{conditions.tasks}, {conditions.scenarios}, seed {conditions.seeds}, {conditions.limits}:", ""]
        rows = [table.columns, ["---"] * len(table.columns), *table.rows]
        page += [f"| {' | '.join(str(row[place]) for place in shown)} |" for row in rows] + [""]
    _write("leaderboard.md", *page)


def _fields(name: str) -> None:
    """The fields of a file format, a table for each of its parts, from its JSON Schema."""
    schema = json.loads(schemas.text(name))
    page: list[str] = []
    for about, part in (("", schema), *((each["description"], each) for each in schema["$defs"].values())):
        fields = {field: each for field, each in part["properties"].items() if field != "kind"}
        if "kind" in part["properties"]:
            about = f'**`kind = "{part["properties"]["kind"]["const"]}"`** {about}'
        page += [about, "", "| field | default | meaning |", "|---|---|---|"] if fields else [about]
        for field, each in fields.items():
            default = json.dumps(each["default"]) if each.get("default") not in (None, {}, "") else ""
            page.append(f"| `{field}` | {f'`{default}`' if default else ''} | {each.get('description', '')} |")
        page.append("")
    _write(f"fields_{name}.md", *page)


def _table(page: str, heads: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    lines = [" | ".join(map(str, row)) for row in (heads, ["---"] * len(heads), *rows)]
    _write(page, *(f"| {line} |" for line in lines))


def _commands() -> None:
    """Every command and its options."""
    command = get_command(app)
    text = get_docs_for_click(
        obj=command, ctx=typer.Context(command), name="automotive-cosim", title="Command line"
    )
    _write("commands.md", text)
