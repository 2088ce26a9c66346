"""Resource ids of what is on the screen: the same on every screen and in every version, and saying nothing.

The project's own code calls a widget by its key, such as ``hvac.front_defroster``. An agent is shown the id made
from it, ``view_8a0bcd``; entries of a list have the list's id and their number, ``view_1d3f02_4``. So nothing but
the text and the description says what a widget does.
"""

from __future__ import annotations

from functools import lru_cache
from hashlib import blake2b

DIGITS = 6
"""Hexadecimal digits of an id: enough to tell some thousand keys apart."""
_KEYS: dict[str, str] = {}


@lru_cache(maxsize=4096)
def resource_id(key: str) -> str:
    """The id under which the widget of that key is shown; empty for one without a key."""
    if not key:
        return ""
    stem, _, number = key.rpartition(".")
    if not number.isdigit():
        stem, number = key, ""
    code = blake2b(stem.encode(), digest_size=8).hexdigest()[:DIGITS]
    shown = f"view_{code}_{number}" if number else f"view_{code}"
    _KEYS[shown] = key
    return shown


def key_of(shown: str) -> str:
    """The key behind an id that this process has made, for its own judges and proofs; empty for any other."""
    return _KEYS.get(shown, "")
