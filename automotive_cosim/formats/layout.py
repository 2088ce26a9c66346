"""Where results lie. A trial's folder is the same for a half of a task and for a drive, whatever ran it:

    trial.json      from the beginning its ``manifest``: the setup and, outside of evaluations, versions and more;
                    at the end also its ``row`` as in ``episodes.jsonl`` and its ``result`` as in the last line of a
                    trace
    steps.jsonl     one line per step, written step by step: what a page shows, and hashes of the state for a replay
                    (steps.jsonl.gz of a drive that is over, which has hundreds)
    screenshots/    step_000.jpg, ...: the cockpit after each step that changed it; a line says which one shows it
                    road_000.jpg, ...: the view through the windshield after each step;
                    of a drive, if the agent is given it
    sounds/         step_000_0.wav, ...: what was said by the end of a step, as the microphone had it; with ``--hear
                    cabin`` or ``audio``, beside a page, if the extra ``voice`` is installed
    road.jsonl.gz   the road with every vehicle, second by second (format: ``run.road``)

``run`` adds a film and a page, and the whole state to each line of its steps; a pair is a folder with both. In the
folder of an evaluation (``run.store``), trials whose pictures are kept have theirs in ``pictures/ID``; in that of a
study, drives that are watched, and the equipped cars of every share of one of adoption, have theirs in ``live/ID``,
with neither ``trial.json`` nor screenshots.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

TRIAL = "trial.json"
STEPS = "steps.jsonl"
PACKED_STEPS = "steps.jsonl.gz"
"""The same, once a drive is over."""
SCREENSHOTS = "screenshots"
SOUNDS = "sounds"
ROAD = "road.jsonl.gz"
FILM = "episode.webp"
PAGE = "summary.html"
OF_A_TRIAL = (TRIAL, STEPS, PACKED_STEPS, SCREENSHOTS, SOUNDS, ROAD, FILM, PAGE)

PAIR = ("with_place", "without_place")
"""The folders of the two runs of ``run --pair``."""
TRACES = "traces"
PICTURES = "pictures"
LIVE = "live"
DUE = "due.json"
"""Of a search's folder, from its dry run on: by trial, why nothing comes due in it; empty if something does."""
WATCHED = "watched"
"""A file in ``LIVE`` that is locked while somebody watches."""


PictureOf = Callable[[Path, int], Path]
"""``road_view`` or ``screenshot``: the path of a picture from a trial's folder and the number of a step."""


def steps_in(folder: Path) -> Path:
    """The steps of a trial."""
    packed = folder / PACKED_STEPS
    return packed if packed.is_file() else folder / STEPS


def road_view(folder: Path, step: int) -> Path:
    """Path of the view through the windshield after a step."""
    return folder / SCREENSHOTS / f"road_{step:03d}.jpg"


def screenshot(folder: Path, step: int) -> Path:
    """Path of the screenshot of a step that changed the screen."""
    return folder / SCREENSHOTS / f"step_{step:03d}.jpg"


def sound(folder: Path, step: int, number: int) -> Path:
    """Path of the sound of the words with that number among those of a step."""
    return folder / SOUNDS / f"step_{step:03d}_{number}.wav"
