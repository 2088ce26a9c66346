"""What the flat views share: the number of an action, and words as numbers."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import lru_cache
from hashlib import blake2b

import numpy as np

from automotive_cosim.errors import ActionError
from automotive_cosim.formats.words import shown


def number_of(given: object, count: int) -> int:
    """The number of an action of a ``Discrete`` space; an array of one number is one, as policies return them.

    Raises:
        ActionError: it is no whole number below ``count``.
    """
    array = np.asarray(given)
    whole = array.size == 1 and array.dtype.kind in "iu"
    if not whole or not 0 <= int(array.item()) < count:
        raise ActionError(f"the action is {shown(array.tolist())}; it must be a whole number from 0 to {count - 1}")
    return int(array.item())


def hashed(texts: Iterable[str], count: int) -> list[float]:
    """1 in each of ``count`` slots that a word of the texts hashes into, 0 in the others."""
    slots = [0.0] * count
    for text in texts:
        for slot in _slots(text, count):
            slots[slot] = 1.0
    return slots


@lru_cache(maxsize=4096)
def _slots(text: str, count: int) -> tuple[int, ...]:
    """The slots of one text's words; cached, because most lines are the same from second to second."""
    words = set(re.findall(r"\w+", text.casefold()))
    return tuple(int.from_bytes(blake2b(word.encode(), digest_size=4).digest()) % count for word in words)
