"""``summary.html``: one self-contained page that shows an episode, made from its record."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from typing import Any

from PIL import Image

from automotive_cosim.cockpit.actions import parse
from automotive_cosim.contracts import BoundingBox, Element, Json
from automotive_cosim.formats.files import write_whole
from automotive_cosim.report.plot import Plot
from automotive_cosim.report.templates import render
from automotive_cosim.run.episode import EpisodeResult
from automotive_cosim.run.record import screenshot
from automotive_cosim.run.row import from_json
from automotive_cosim.run.words import action_in_words

PARTS: Mapping[str, str] = {
    "goal": "Goal",
    "clean": "Clean",
    "safe": "Safe",
    "in_time": "In time",
    "declared": "Declared",
}
PICTURE_WIDTH, PICTURE_QUALITY = 960, 82


def write_page(folder: Path) -> Path:
    """Writes the page of a record and returns its path.

    Args:
        folder: with ``episode.json``, ``steps.jsonl`` and ``screenshots/``, and possibly ``episode.webp``.
    """
    record = json.loads((folder / "episode.json").read_text(encoding="utf-8"))
    result, manifest = from_json(EpisodeResult, record), record["manifest"]
    lines = (folder / "steps.jsonl").read_text(encoding="utf-8").splitlines()
    film = folder / "episode.webp"
    drive = result.path, result.timeline
    text = render(
        "report/page.html",
        result=result,
        manifest=manifest,
        parts=PARTS,
        plots={"wide": Plot(*drive, 960, 300), "narrow": Plot(*drive, 420, 280)},
        steps=_steps(folder, [json.loads(line) for line in lines]),
        film=embedded(film.read_bytes()) if film.is_file() else None,
        versions=sorted(manifest["versions"].items()),
    )
    page = folder / "summary.html"
    write_whole(page, text)
    return page


def _steps(folder: Path, steps: list[Json]) -> list[Json]:
    """What the page shows of each step; an action refers to the elements of the step before."""
    shown = []
    seen: tuple[Element, ...] = ()
    for step in steps:
        action = None if step["action"] is None else parse(step["action"])
        shown.append(
            {
                "number": step["step"],
                "at_s": step["time_s"] - steps[0]["time_s"],
                "words": action_in_words(action, seen) if step["step"] else "hand-over",
                "action": json.dumps(step["action"], ensure_ascii=False) if step["action"] else "",
                "thought": step["thought"],
                "feedback": step["feedback"],
                "context": step["context"],
                "picture": _picture(screenshot(folder, step["step"])),
            }
        )
        seen = tuple(map(element, step["elements"]))
    return shown


def element(entry: dict[str, Any]) -> Element:
    """An element from its form in a trace."""
    fields: dict[str, Any] = entry | {"bbox_pixels": BoundingBox(**entry["bbox_pixels"])}
    return Element(**fields)


def _picture(path: Path) -> str:
    """A screenshot as a data URL, small enough for a page with all of them."""
    with Image.open(path) as image:
        height = round(image.height * PICTURE_WIDTH / image.width)
        small = image.resize((PICTURE_WIDTH, height), Image.Resampling.LANCZOS)
    data = BytesIO()
    small.save(data, format="WEBP", quality=PICTURE_QUALITY)
    return embedded(data.getvalue())


def embedded(data: bytes, kind: str = "webp") -> str:
    """A picture as a data URL."""
    return f"data:image/{kind};base64," + base64.b64encode(data).decode()
