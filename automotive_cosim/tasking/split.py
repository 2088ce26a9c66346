"""Development and test: two public sets of episodes, told apart by seed and phrasing.

A seed is of the test set if the first byte of the SHA-256 of its decimal digits, divided by four, leaves two: a
quarter of all seeds. A phrasing is of the test set if it is held out, as each task's last is. An episode is of the
development set if both its seed and its phrasing are; all others are of the test set. What is made on the
development set, such as the words of the model ``rules`` and the examples in the pages, has therefore seen neither.
"""

from __future__ import annotations

from hashlib import sha256

from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasking.sets import Split
from automotive_cosim.tasking.task import Task

SHARES, TEST_SHARE = 4, 2
"""A seed is of the test set if the first byte of its hash modulo the one is the other."""


def split_of_seed(seed: int) -> Split:
    """The set of a seed."""
    first_byte = sha256(str(seed).encode()).digest()[0]
    return Split.TEST if first_byte % SHARES == TEST_SHARE else Split.DEV


def split_of(task: Task, seed: int, *, held_out: bool = False, redrawn: int = 0) -> Split:
    """The set of an episode.

    Args:
        seed: the episode's seed, which draws the phrasing.
        held_out: whether the held-out phrasing is used, whatever is drawn.
        redrawn: how many phrasings further than the seed's."""
    if held_out or draw(task, "first", seed, redrawn=redrawn).held_out:
        return Split.TEST
    return split_of_seed(seed)
