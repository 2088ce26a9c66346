"""Plain text. Names of streets, answers of models and messages of SUMO come from others. A terminal obeys control
characters: it moves the cursor, sets its title, hides a line. It may also show a page or a table."""

from __future__ import annotations

import re

SHOWN_AS = "\N{REPLACEMENT CHARACTER}"
OBEYED = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")
"""Both sets of controls without line ends and tabs, and what reverses the direction of writing."""


def plain(text: str) -> str:
    """The text with a replacement character for each control character, except line ends and tabs."""
    return text if text.isprintable() else OBEYED.sub(SHOWN_AS, text)
