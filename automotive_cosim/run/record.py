"""Writes the results folder of one episode.

    episode.json    verdict, timeline, manifest, the drive once a second
    steps.jsonl     one line per step (trace.Step.as_json), written step by step, so that they survive a kill
    screenshots/    step_000.png, ...: the cockpit after each step
    road.jsonl.gz   the road with every vehicle, second by second (format: ``run.road``)

The folder is created at the hand-over; an earlier failure leaves none.
"""

from __future__ import annotations

import json
import platform
import shutil
import tempfile
from collections.abc import Iterable
from dataclasses import asdict
from datetime import datetime
from pathlib import Path
from typing import IO

from PIL import Image

from automotive_cosim.contracts import Json
from automotive_cosim.episode.episode import Episode
from automotive_cosim.errors import UserError
from automotive_cosim.formats.files import write_whole
from automotive_cosim.run.episode import EpisodeObserver, EpisodeResult, EpisodeSetup
from automotive_cosim.run.observer import Shot
from automotive_cosim.run.versions import installed

OURS = ("episode.json", "steps.jsonl", "screenshots", "road.jsonl.gz", "episode.webp", "summary.html")
"""The contents of a record; ``force`` removes only these."""
STAMPED = ("automotive-cosim", "libsumo", "gymnasium", "numpy", "pillow")


def default_folder(setup: EpisodeSetup, ending: str = "") -> Path:
    """``runs/<timestamp>-<task>-<half>-<agent>-seed<seed><ending>``."""
    return stamped_folder(f"{setup.task}-{setup.half}-{setup.agent}-seed{setup.seed}{ending}")


def stamped_folder(name: str) -> Path:
    """``runs/<timestamp>-<name>``; a second one in the same second gets a number."""
    folder = Path("runs") / f"{datetime.now():%Y%m%d-%H%M%S}-{name.replace('/', '_')}"
    number = 2
    while folder.exists():
        folder = folder.with_name(f"{folder.name.removesuffix(f'-{number - 1}')}-{number}")
        number += 1
    return folder


def check_folder(folder: Path, *, force: bool) -> None:
    """Refuses a folder that cannot take a record, before anything runs.

    Raises:
        UserError: it is a file, cannot be written, or is not empty and ``force`` is not given.
    """
    if folder.exists() and not folder.is_dir():
        raise UserError(f"{folder} is a file; give --out a folder that is empty or does not exist yet")
    if folder.is_dir() and any(folder.iterdir()) and not force:
        raise UserError(f"{folder} is not empty; give --out another folder, or --force to replace the record in it")
    parent = next(parent for parent in (folder, *folder.absolute().parents) if parent.exists())
    try:  # a folder may refuse writes despite its permissions
        tempfile.TemporaryDirectory(dir=parent).cleanup()
    except OSError as error:
        raise UserError(
            f"cannot write to {parent}: {error.strerror}; give --out a folder that you can write to"
        ) from error


class Recorder(EpisodeObserver):
    """Writes the record of an episode while it runs."""

    def __init__(self, folder: Path, setup: EpisodeSetup, arguments: Json) -> None:
        """Nothing is written before the hand-over.

        Args:
            folder: checked with ``check_folder``.
            setup: what is run.
            arguments: the command's arguments, for the manifest.
        """
        self.folder = folder
        self._setup = setup
        self._arguments = arguments
        self._lines: IO[str] | None = None
        self._started = datetime.now().astimezone()

    @property
    def has_begun(self) -> bool:
        """Whether the folder has been created."""
        return self._lines is not None

    def begun(self, session: Episode, shot: Shot) -> None:
        """Creates the folder and writes step 0."""
        self._lines = fresh(self.folder, OURS, "steps.jsonl")
        self.stepped(shot)

    def stepped(self, shot: Shot) -> None:
        """Saves the picture and appends a line; the picture first, so that every line has one."""
        assert self._lines is not None
        Image.fromarray(shot.screenshot).save(screenshot(self.folder, shot.step.number))
        told = {"thought": shot.thought, "stages": [stage.as_json() for stage in shot.stages]}
        self._lines.write(json.dumps(shot.step.as_json() | told, ensure_ascii=False) + "\n")
        self._lines.flush()

    def finished(self, result: EpisodeResult) -> None:
        """Writes ``episode.json``, if there was a hand-over."""
        if self._lines is None:
            return
        self._lines.close()
        write_whole(
            self.folder / "episode.json", json.dumps(result.as_json() | {"manifest": self._manifest()}, indent=1)
        )

    def _manifest(self) -> Json:
        return {
            "versions": installed(STAMPED) | {"python": platform.python_version()},
            "platform": platform.platform(),
            "setup": asdict(self._setup),
            "arguments": self._arguments,
            "seeds": {"episode": self._setup.seed, "traffic": self._setup.seed},
            "started": self._started.isoformat(timespec="seconds"),
            "wall_seconds": round((datetime.now().astimezone() - self._started).total_seconds(), 1),
        }


def screenshot(folder: Path, step: int) -> Path:
    """Path of a step's screenshot in a record."""
    return folder / "screenshots" / f"step_{step:03d}.png"


def fresh(folder: Path, ours: Iterable[str], lines: str) -> IO[str]:
    """Begins a record, without what an earlier one left in its folder.

    Args:
        folder: the record's, which may not exist yet.
        ours: names of all that a record of this kind has.
        lines: the one of them that is written step by step.

    Returns:
        That one, open.

    Raises:
        UserError: another record begins there at this instant.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for path in (folder / name for name in ours):
        if path.is_dir():
            shutil.rmtree(path)
        else:
            path.unlink(missing_ok=True)
    try:
        (folder / "screenshots").mkdir()
    except FileExistsError:
        raise UserError(f"another run is writing to {folder}; give --out another folder") from None
    return (folder / lines).open("w", encoding="utf-8", newline="\n")
