"""Instructions of one's own for the agents with prompts, from a file.

Where they are given, the file is named by its path and its SHA-256 (``PromptLength``), so that no two prompts share
a row. Whoever starts the agent reads it again, and it must not have changed since.
"""

from __future__ import annotations

import hashlib
import os
from pathlib import Path

from automotive_cosim.contracts.given import PromptLength
from automotive_cosim.errors import UserError

SUFFIXES = (".md", ".txt")
"""Tell a file from the name of a prompt."""
MOST_CHARACTERS = 16_000
"""Some 4,000 tokens: three times the whole standard prompt, and half the context of a local model."""


def resolved(word: str) -> str:
    """What was given for the prompt: a file becomes ``FILE@SHA-256``; anything else stays as it is.

    Raises UserError: the file cannot be used."""
    if not word.endswith(SUFFIXES):
        return word
    path = Path(word).as_posix()
    return f"{path}@{hashlib.sha256(_read(path).encode()).hexdigest()}"


def instructions(prompt: PromptLength) -> str:
    """What stands in place of the standard prompt's instructions; empty for a prompt of the package.

    Raises UserError: the file cannot be used, or is no longer what it was."""
    if not prompt.file:
        return ""
    text = _read(prompt.file)
    if hashlib.sha256(text.encode()).hexdigest() != prompt.sha256:
        raise UserError(f"--prompt {prompt.file} has changed since the run began; restore it, or begin another run")
    return text.strip()


def _read(path: str) -> str:
    """Text of the file, without line ends that depend on the machine."""
    file = Path(path)
    if not os.path.isfile(path):  # noqa: PTH113, false if the name is too long
        raise UserError(f"--prompt {path:.200}: there is no such file; give standard, short or a .md or .txt file")
    try:
        with file.open(encoding="utf-8") as opened:
            text = opened.read(MOST_CHARACTERS + 1)
    except (OSError, UnicodeDecodeError) as error:
        raise UserError(f"--prompt {path} cannot be read ({error}); give a text file in UTF-8") from error
    if not text.strip():
        raise UserError(f"--prompt {path} is empty; write what the agent is to do, and how")
    if len(text) > MOST_CHARACTERS:
        raise UserError(f"--prompt {path} has more than {MOST_CHARACTERS:,} characters; shorten it")
    return text
