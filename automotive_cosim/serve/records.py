"""Finds recorded episodes and evaluations; the only module that turns what a browser asks for into files.

A browser names a record by an id from a table, never by a path. A file is read only if it really lies, links
resolved, in one of the folders given.
"""

from __future__ import annotations

import hashlib
import os
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from automotive_cosim.errors import UserError
from automotive_cosim.formats.layout import LIVE, PAIR, PICTURES, PictureOf, screenshot
from automotive_cosim.run import trial_folder

DEPTH = 3
"""How deep records are searched for below a given folder."""
MOST = 2000
"""Maximum number of listed records."""


class NotHereError(UserError):
    """There is no such record, or it has no such file."""


@dataclass(frozen=True, slots=True)
class RecordEntry:
    """One recorded trial, or one evaluation."""

    id: str
    folder: Path
    is_evaluation: bool


class RecordFolders:
    """The records below some folders."""

    def __init__(self, folders: Sequence[Path]) -> None:
        """Keeps the folders, which may still be empty. Raises UserError: one of them is not a folder."""
        for folder in folders:
            if not folder.is_dir():
                raise UserError(
                    f"{folder} is not a folder; give folders of `run` or `eval`, or one that holds them"
                )
        self._folders = [folder.resolve() for folder in folders]
        self._known: dict[str, RecordEntry] = {}

    def entries(self) -> list[RecordEntry]:
        """All current records, the newest first."""
        found = {entry.id: entry for folder in self._folders for entry in _seek(folder, DEPTH)}
        self._known = found
        return sorted(found.values(), key=lambda entry: _changed_s(entry.folder), reverse=True)[:MOST]

    def entry(self, name: str) -> RecordEntry:
        """The record of that id. Raises NotHereError: there is none."""
        if name not in self._known:
            self.entries()
        found = self._known.get(name)
        if found is None or not found.folder.is_dir():
            raise NotHereError(f"there is no record {name!r} in the given folders")
        return found

    def of(self, folder: Path) -> RecordEntry:
        """The recorded trial in a folder. Raises NotHereError: it is not below the folders given."""
        return self.entry(_id(folder.resolve()))

    def beside(self, entry: RecordEntry) -> str | None:
        """Id of the other run of a pair, to the one that knows its place; None where there is none."""
        known, withheld = PAIR
        other = entry.folder.with_name(withheld)
        return _id(other) if entry.folder.name == known and trial_folder.is_trial(other) else None

    def file(self, entry: RecordEntry, *parts: str) -> Path:
        """A file of a record.

        Args:
            parts: names below its folder, of which none may lead elsewhere.

        Raises NotHereError: there is no such file, or it lies outside the folders given."""
        if not all(map(_is_name, parts)):
            raise NotHereError("there is no such file")
        path = entry.folder.joinpath(*parts)
        real = path.resolve()
        if not path.is_file() or not any(real.is_relative_to(folder) for folder in self._folders):
            raise NotHereError(f"this record has no {'/'.join(parts)}")
        return path

    def trial(self, entry: RecordEntry, trial: str | None) -> Path:
        """The folder of a trial, all of whose files but its screenshots may be read.

        Args:
            trial: id of the trial in an evaluation or a study; None for a recorded trial.

        Raises NotHereError: there is no such trial, or a file of it lies outside the folders given."""
        if trial is None:
            found = [entry.folder]
        elif _is_name(trial):
            found = [entry.folder / LIVE / trial, entry.folder / PICTURES / trial]
        else:
            found = []
        for folder in found:
            paths = [path for name in trial_folder.READ if os.path.lexists(path := folder / name)]
            paths += [trace for trace in [trial_folder.trace_of(folder)] if trace is not None]
            if paths or (folder.is_dir() and folder is not entry.folder):
                for path in paths:
                    self.file(entry, *path.relative_to(entry.folder).parts)
                return folder
        raise NotHereError(f"this record has no run {trial!r}" if trial else "this record is of no run")

    def picture(self, entry: RecordEntry, folder: Path, step: int, of: PictureOf = screenshot) -> Path:
        """The screenshot of a step that changed the screen, or its view through the windshield, a JPEG.

        Args:
            folder: the trial's, from ``trial``.
            of: ``screenshot`` or ``road_view`` of ``formats.layout``.

        Raises NotHereError: there is none."""
        return self.file(entry, *of(folder, step).relative_to(entry.folder).parts)


def _seek(folder: Path, depth: int) -> Iterator[RecordEntry]:
    if trial_folder.is_trial(folder):
        yield RecordEntry(_id(folder), folder, is_evaluation=False)
    elif all(_is_own(folder / name) for name in ("manifest.json", "episodes.jsonl")):
        yield RecordEntry(_id(folder), folder, is_evaluation=True)
    elif depth:
        try:
            inner = sorted(path for path in folder.iterdir() if path.is_dir() and not path.is_symlink())
        except OSError:
            return
        for path in inner:
            yield from _seek(path, depth - 1)


def _is_name(part: str) -> bool:
    """Whether it names something in a folder, and leads nowhere else."""
    return part not in ("", ".", "..") and not any(letter in part for letter in "/\\\0")


def _is_own(path: Path) -> bool:
    """Whether it is a file, and no link, which may lead out of the folders."""
    return path.is_file() and not path.is_symlink()


def _id(folder: Path) -> str:
    """The same for the same folder, so that links outlive the server."""
    return hashlib.sha256(str(folder).encode(sys.getfilesystemencoding(), "surrogateescape")).hexdigest()[:12]


def _changed_s(folder: Path) -> float:
    try:
        return folder.stat().st_mtime
    except OSError:
        return 0.0
