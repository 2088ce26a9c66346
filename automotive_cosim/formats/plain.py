"""Plain text. Names of streets, answers of models and messages of SUMO come from others. A terminal obeys control
characters: it moves the cursor, sets its title, hides a line. It may also show a page or a table."""

from __future__ import annotations

import re

SHOWN_AS = "\N{REPLACEMENT CHARACTER}"
OBEYED = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u202a-\u202e\u2066-\u2069]")
"""Both sets of controls without line ends and tabs, and what reverses the direction of writing."""

_UNWRITABLE = (
    "[^\t\n\r\x20-\x7e\xa0-\ud7ff\ue000-\ufdcf\ufdf0-\ufffd\U00010000-\U0010ffff]"
    f"|[{''.join(chr(plane << 16 | last) for plane in range(1, 17) for last in (0xFFFE, 0xFFFF))}]"
)
"""Characters that XML 1.0 (production Char) or HTML may not hold: controls, half surrogates, noncharacters."""


def markup(text: str) -> str:
    """A page or an XML document with a replacement character for each that it may not hold."""
    return re.sub(_UNWRITABLE, SHOWN_AS, text)


def plain(text: str) -> str:
    """The text with a replacement character for each control character, except line ends and tabs."""
    return text if text.isprintable() else OBEYED.sub(SHOWN_AS, text)
