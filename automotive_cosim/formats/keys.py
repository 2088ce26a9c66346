"""Keys of models and services in texts, however they are spelled: what hides them and what refuses them agree."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Iterator
from functools import cache
from urllib.parse import quote

SHORTEST_KEY = 12
"""A shorter key is no secret but a dummy for a local server, and may occur in any text."""
ENOUGH = 16
"""Letters and digits in a row that give a key away, as twenty characters with separators have, or all of a shorter
one."""
STRIDE = ENOUGH // 2
"""A run of ``ENOUGH`` holds a whole piece of this length that begins at a multiple of it."""
FEWEST = 8
"""A key with fewer letters and digits is told by none of them."""
_OTHERS = re.compile("[^0-9A-Za-z]+")


def letters(text: str) -> str:
    """The letters and digits of a text, in lower case: what case, spaces and separators do not change."""
    return _OTHERS.sub("", text).lower()


def spelled(told: str, key: str) -> Iterator[tuple[int, int]]:
    """Where a key, or enough of it, stands in the ``letters`` of a text: begin and end, in no order."""
    for form in _forms(key):
        for piece in range(0, max(1, len(form) - STRIDE + 1), STRIDE):
            wanted = form[piece : piece + STRIDE]
            at = told.find(wanted)
            while at >= 0:
                begin, end = at, at + len(wanted)
                while begin and piece - (at - begin) and told[begin - 1] == form[piece - (at - begin) - 1]:
                    begin -= 1
                while end < len(told) and piece + end - at < len(form) and told[end] == form[piece + end - at]:
                    end += 1
                if end - begin >= min(len(form), ENOUGH):
                    yield begin, end
                at = told.find(wanted, at + 1)


def hidden(text: str, key: str) -> str:
    """A text with three stars in place of a key, or of enough of it."""
    found = sorted(spelled(letters(text), key))
    if not found:
        return text
    places = [each.start() for each in re.finditer("[0-9A-Za-z]", text)]
    left, until = "", 0
    for begin, end in found:
        if places[begin] >= until:
            left += f"{text[until : places[begin]]}***"
        until = max(until, places[end - 1] + 1)
    return left + text[until:]


@cache
def _forms(key: str) -> tuple[str, ...]:
    """How a key may be written, as ``letters``: as it is, in base64 at any place of a longer text, in hexadecimal,
    in a URL, in JSON, backwards."""
    if len(key) < SHORTEST_KEY:
        return ()
    data = key.encode()
    found = [key, data.hex(), quote(key, safe=""), json.dumps(key)[1:-1], key[::-1]]
    for before in range(3):
        whole = base64.b64encode(b"\0" * before + data).decode()
        found.append(whole[-(-before * 8 // 6) : (before + len(data)) * 8 // 6])  # what only the key determines
    return tuple(form for form in dict.fromkeys(map(letters, found)) if len(form) >= FEWEST)
