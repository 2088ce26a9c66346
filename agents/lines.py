"""Texts from outside, on lines of their own."""

from __future__ import annotations

import re


def one_line(text: str) -> str:
    """The text without line breaks of any kind, and without a heading's mark at its start."""
    return re.sub(r"^(#+ )+", "", " ".join(text.split()))
