"""The text of a file that a user wrote."""

from __future__ import annotations

from pathlib import Path

from automotive_cosim.errors import UserError

MOST_BYTES = 2**20
"""Nobody writes more by hand, and a wrong path may be a device that never ends."""


def read_text(path: Path, error: type[UserError] = UserError) -> str:
    """The text, with line ends as they are on Unix and without a byte order mark.

    Raises:
        UserError: of that class: it cannot be opened, is too large, or is not UTF-8.
    """
    try:
        with path.open("rb") as file:
            data = file.read(MOST_BYTES + 1)
        text = data.decode("utf-8-sig")
    except OSError as broken:
        raise error(f"cannot read {path}: {broken.strerror or broken}; give a file that is there") from broken
    except UnicodeDecodeError as broken:
        raise error(f"cannot read {path}: it is not UTF-8 text; save it as UTF-8") from broken
    if len(data) > MOST_BYTES:
        raise error(f"cannot read {path}: it is larger than {MOST_BYTES // 2**20} MB; give a file written by hand")
    return text.replace("\r\n", "\n")
