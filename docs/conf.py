"""The documentation site: ``make docs`` builds it offline; a broken link or an unknown name fails.

The pages of ``_made/`` are those that lie beside docs/, and what is too long for a page of a checkout.
"""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterable
from pathlib import Path

import typer
from sphinx.application import Sphinx
from typer.cli import get_docs_for_click
from typer.main import get_command

from automotive_cosim import __version__, scenarios
from automotive_cosim.cli.main import app
from automotive_cosim.tasking.task import Dimension, Module
from automotive_cosim.tasks import CATALOGUE
from docs.tables import printed

DOCS = Path(__file__).parent
TOP = DOCS.parent
MADE = DOCS / "_made"
BESIDE = {
    "README.md": "index.md",
    "CHANGELOG.md": "_made/changelog.md",
    "CONTRIBUTING.md": "_made/contributing.md",
    "SECURITY.md": "_made/security.md",
    "benchmarks/README.md": "_made/benchmarks.md",
}
"""Pages that lie beside docs/, and where the site has them."""
SITE_ALONE = ("_made/catalogue/index", "_made/gallery", "_made/commands")

project = "automotive_cosim"
author = "The automotive_cosim authors"
project_copyright = "The automotive_cosim authors, Apache-2.0"
version = release = __version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_copybutton"]
exclude_patterns = ["_site", "examples"]
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
html_css_files = ["site.css"]
html_theme_options = {"navigation_with_keys": True}


def setup(sphinx: Sphinx) -> None:
    """Makes the pages before Sphinx looks for them."""
    shutil.rmtree(MADE, ignore_errors=True)
    for source, page in BESIDE.items():
        if page.startswith("_made/"):
            _write(page, _linked(TOP / source, page))
    _catalogue()
    _write("_made/gallery.md", "# Shipped scenarios", *map(_scenario, scenarios.shipped()))
    program = get_command(app)
    told = get_docs_for_click(
        obj=program, ctx=typer.Context(program), name="automotive-cosim", title="Command line"
    )
    _write("_made/commands.md", told)
    sphinx.connect("source-read", _read)


def _write(page: str, *lines: str) -> None:
    path = DOCS / page
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def _linked(source: Path, page: str) -> str:
    """A file of the checkout with its links as they are from a page of the site."""

    def link(found: re.Match[str]) -> str:
        target = Path(os.path.normpath(source.parent / found[1]))
        if not target.exists():
            return found[0]
        there = DOCS / BESIDE.get(os.path.relpath(target, TOP), os.path.relpath(target, DOCS))
        return f"]({os.path.relpath(there, (DOCS / page).parent)}"

    return re.sub(r"\]\(([^)#:\s]+)", link, source.read_text(encoding="utf-8"))


def _read(sphinx: Sphinx, name: str, content: list[str]) -> None:
    """The pages of docs/ link to those beside it; the first begins as the README does, and orders the others."""
    page = f"{name}.md"
    if not name.startswith("_made/"):
        content[0] = _linked(DOCS / page, page)
    if name == "index":
        begun = _linked(TOP / "README.md", page).partition("\n")[2].partition("## Documentation")[0]
        title, _, lists = content[0].partition("\n")
        trees = ["", _tree("On the site alone", SITE_ALONE)]
        for caption, _, under in (part.partition("\n") for part in lists.split("\n## ")[1:]):
            trees.insert(-1, _tree(caption, re.findall(r"\]\((\w[^)#:]*)\.md\)", under)))
        content[0] = "\n".join((title, begun, "## Documentation", lists.replace("\n## ", "\n### "), *trees))


def _tree(caption: str, pages: Iterable[str]) -> str:
    return "\n".join(("```{toctree}", ":hidden:", f":caption: {caption}", "", *pages, "```", ""))


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
            page += [f"## {task.id}", "", "```text", printed("tasks", "show", task.id), "```", ""]
        _write(f"_made/catalogue/{module}.md", *page)
    pages = [str(module) for module in Module]
    _write("_made/catalogue/index.md", *index, "", "```{toctree}", ":hidden:", "", *pages, "```")


def _title(module: Module) -> str:
    return "HVAC" if module is Module.HVAC else str(module).capitalize()


def _scenario(name: str) -> str:
    """The README of a scenario that is shipped, with its map."""
    readme = TOP / "sumo_scenarios" / name / "README.md"
    return re.sub(r"^#", "\n##", _linked(readme, "_made/gallery.md"), flags=re.MULTILINE)
