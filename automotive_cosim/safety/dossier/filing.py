"""Writes a safety report: one HTML page, one PDF, and a folder with its data."""

from __future__ import annotations

import json
from dataclasses import asdict
from importlib.resources import files
from pathlib import Path

from automotive_cosim.contracts import Json
from automotive_cosim.formats import bounds
from automotive_cosim.formats.writing import beneath, copy, drafted, make_folder, remove, write_whole
from automotive_cosim.report.templates import render
from automotive_cosim.run.job_row import as_json
from automotive_cosim.run.store import cannot_write
from automotive_cosim.safety.dossier.document import Dossier, dossier
from automotive_cosim.safety.dossier.subject import read_subject
from automotive_cosim.safety.page import PLANS

FOLDER, PAGE, PDF, DATA = "safety", "safety.html", "safety.pdf", "data"
TEMPLATE, CONTENT = "dossier.typ", "report.json"
FONTS = "font_roboto", "noto_cjk_sans_jp_regular"
"""Packages with the fonts of the PDF, so that it is the same on every machine."""


def write_dossier(folder: Path, agent: str = "") -> tuple[Path, Path | None]:
    """Writes the report about an agent into ``safety/`` of its run's folder.

    Args:
        folder: of ``eval`` or ``search``.
        agent: whose trials; empty if there is only one.

    Returns:
        The page and the PDF; no PDF without the extra ``reports``.

    Raises:
        UserError: the folder has no judged trials of it, or cannot be written.
        SetupError: the extra ``reports`` is not installed.
    """
    subject = read_subject(folder, agent)
    made = dossier(subject)
    target = folder / FOLDER
    try:
        with drafted(make_folder(folder, FOLDER) / PAGE) as page:
            remove(target / DATA)
            data = make_folder(target, DATA)
            write_whole(data / CONTENT, json.dumps(content(made), indent=1, ensure_ascii=False) + "\n")
            for section in made.sections:
                for table in section.tables:
                    write_whole(data / f"{table.name}.csv", table.csv())
            lines = (json.dumps(as_json(row), ensure_ascii=False) for row in subject.rows)
            write_whole(data / "trials.jsonl", "".join(f"{line}\n" for line in lines))
            if subject.findings is not None:
                for plan in sorted((folder / PLANS).glob("*.toml")):
                    copy(
                        beneath(folder, f"{PLANS}/{plan.name}"),
                        make_folder(data, PLANS) / plan.name,
                        bounds.TEXT_BYTES,
                    )
            titles = {section.name: section.title for section in made.sections}
            page.write(render("safety/dossier/dossier.html", made=made, titles=titles).encode())
            return target / PAGE, _pdf(data, target / PDF)
    except OSError as error:
        raise cannot_write(target, error) from error


def content(made: Dossier) -> Json:
    """The report as a JSON object: all that page and PDF show."""
    told: Json = asdict(made)
    for section in told["sections"]:
        for table in section["tables"]:
            table["rows"] = [
                [cell if isinstance(cell, str) else cell["text"] for cell in row] for row in table["rows"]
            ]
    return told


def _pdf(data: Path, target: Path) -> Path | None:
    try:
        import typst
    except ImportError:
        return None
    source = data / TEMPLATE
    write_whole(source, (files("automotive_cosim.safety.dossier") / TEMPLATE).read_bytes())
    fonts = [str(files(package)) for package in FONTS]
    write_whole(target, typst.compile(str(source), root=str(data), font_paths=fonts, ignore_system_fonts=True))
    remove(source)
    return target
