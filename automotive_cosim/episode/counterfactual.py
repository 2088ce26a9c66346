"""The counterfactual: the same drive in which only what belongs to the goal was commanded.

What the agent's cockpit shows beyond it is the agent's doing and was not asked for. What the car itself couples to
a command of the goal's (a slower fan ends an air mode, another source has another entry) shows in both.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from itertools import pairwise
from typing import Any

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.state import CommandRecord
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.episode.specification import ROUNDING_S


def replayed(
    cockpit: Cockpit, given: Sequence[CommandRecord], moments: Sequence[Moment], keys: Collection[str] | None = None
) -> Cockpit:
    """A cockpit that went through a drive again, with its commands in full or in part.

    Args:
        cockpit: as it was at the first moment; it stays so.
        given: what was commanded since, in order.
        moments: of the drive, whose roads and skies it senses.
        keys: the commands to give (``Moment.commands``); all if None.
    """
    twin, left = cockpit.copy(), list(given)
    for before, now in pairwise(moments):
        while left and left[0].time_s <= before.time_s + ROUNDING_S:
            record = left.pop(0)
            twin.repeat(record, record.aims if keys is None else keys)
        twin.sense(now.surroundings, now.time_s - before.time_s)
    return twin


def counterfactual(
    cockpit: Cockpit, given: Sequence[CommandRecord], moments: Sequence[Moment], keys: Collection[str]
) -> Mapping[str, Any]:
    """What would be commanded at the end, had only the commands on these keys been given; see ``replayed``."""
    return replayed(cockpit, given, moments, keys).commands()
