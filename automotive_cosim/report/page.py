"""``summary.html``: one self-contained page that shows an episode, made from its record."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping, Sequence
from io import BytesIO
from pathlib import Path

from PIL import Image

from automotive_cosim.contracts import Json
from automotive_cosim.errors import UserError
from automotive_cosim.formats import bounds
from automotive_cosim.formats.files import read_bytes
from automotive_cosim.formats.layout import FILM, PAGE, screenshot
from automotive_cosim.formats.writing import write_whole
from automotive_cosim.report.hearing import level_plot, with_sounds
from automotive_cosim.report.plot import Plot
from automotive_cosim.report.templates import render
from automotive_cosim.run.attribution import path_of, read_effects
from automotive_cosim.run.episode import EpisodeResult
from automotive_cosim.run.job_row import from_json
from automotive_cosim.run.rows import EpisodeRow
from automotive_cosim.run.trial_folder import read_steps, read_trial

PARTS: Mapping[str, str] = {
    "goal": "Goal",
    "clean": "Clean",
    "safe": "Safe",
    "in_time": "In time",
    "declared": "Declared",
}
SIZES = {"wide": 960, "narrow": 420}
"""Widths of plots on wide pages and on phones, pixels."""
PICTURE_WIDTH, PICTURE_QUALITY = 960, 82


def write_page(folder: Path) -> Path:
    """Writes the page of a record and returns its path.

    Args:
        folder: of a trial (``formats.layout``).

    Raises UserError: it cannot be read, or the run has not ended."""
    told = read_trial(folder)
    if not told.get("result"):
        raise UserError(f"{folder} has no result: the run has not ended")
    row, result = from_json(EpisodeRow, told["row"]), from_json(EpisodeResult, told["result"])
    manifest = told["manifest"]
    film = folder / FILM
    drive = result.path, result.timeline
    steps = read_steps(folder)
    said, silent = with_sounds(folder, steps, result.goal)
    levels = [(step["at_s"], step["cabin_db"]) for step in steps if "cabin_db" in step]
    text = render(
        "report/page.html",
        row=row,
        result=result,
        manifest=manifest,
        parts=PARTS,
        plots={"wide": Plot(*drive, 960, 300), "narrow": Plot(*drive, 420, 280)},
        steps=_steps(folder, steps),
        said=[each | {"wav": each["wav"] and embedded(each["wav"], "audio/wav")} for each in said],
        silent=silent,
        levels=levels and [(size, level_plot(levels, said, width, 220)) for size, width in SIZES.items()],
        effects=read_effects(path_of(folder)),
        film=embedded(read_bytes(film), "image/webp") if film.is_file() else None,
        versions=sorted(manifest["versions"].items()),
    )
    page = folder / PAGE
    write_whole(page, text)
    return page


def _steps(folder: Path, steps: Sequence[Json]) -> list[Json]:
    """What the page shows of each step."""
    return [
        {
            "number": step["step"],
            **{name: step[name] for name in ("at_s", "words", "thought", "feedback", "context")},
            "action": json.dumps(step["action"], ensure_ascii=False) if step["action"] else "",
            "picture": _picture(screenshot(folder, step["picture"])),
        }
        for step in steps
    ]


def _picture(path: Path) -> str:
    """A screenshot as a data URL, small enough for a page with all of them."""
    with open_picture(path) as image:
        height = round(image.height * PICTURE_WIDTH / image.width)
        small = image.resize((PICTURE_WIDTH, height), Image.Resampling.LANCZOS)
    data = BytesIO()
    small.save(data, format="WEBP", quality=PICTURE_QUALITY)
    return embedded(data.getvalue(), "image/webp")


def embedded(data: bytes, kind: str) -> str:
    """A picture or a sound as a data URL, by its media type."""
    return f"data:{kind};base64," + base64.b64encode(data).decode()


def open_picture(path: Path) -> Image.Image:
    """A picture whose pixels are not read yet.

    Raises UserError: it cannot be read, or says that it has more than ``bounds.PIXELS``."""
    try:
        picture = Image.open(path if path.is_file() else "")
    except (OSError, Image.DecompressionBombError) as error:
        raise UserError(f"{path} is no picture that can be read; record the run again") from error
    if picture.width * picture.height > bounds.PIXELS:
        picture.close()
        raise UserError(f"{path} has over {bounds.PIXELS:,} pixels; a screen has not")
    return picture
