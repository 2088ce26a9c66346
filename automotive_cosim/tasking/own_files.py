"""Where a user's own tasks are: every ``.py`` file of a folder."""

from __future__ import annotations

from pathlib import Path

from automotive_cosim.errors import UserError
from automotive_cosim.formats.files import open_file

VARIABLE = "AUTOMOTIVE_COSIM_TASKS"
"""Environment variable with the folder, so that worker processes load it too."""


def own_files(folder: Path) -> list[Path]:
    """The files, in the order of their names.

    Raises:
        UserError: no such folder, no file in it, or something that is no regular file.
    """
    if not folder.is_dir():
        raise UserError(f"--tasks-from {folder} is no folder; give one that holds .py files with TASKS")
    paths = sorted(path for path in folder.glob("*.py") if not path.name.startswith("_"))
    if not paths:
        raise UserError(f"--tasks-from {folder} holds no .py file; each needs TASKS, a tuple of tasks")
    for path in paths:
        try:
            open_file(path).close()
        except OSError as error:
            raise UserError(f"--tasks-from: cannot read {path}: {error.strerror or error}") from error
    return paths
