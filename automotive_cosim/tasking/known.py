"""Names in a task that only the whole car and the scenarios know: screens, entries of the apps' data, scenarios.

They are looked up in files of users; the tests do so for the catalogue. The keys of widgets depend on what a screen
shows at the time: the gates of ``tasks validate`` find those that are nowhere.
"""

from __future__ import annotations

import os
from collections.abc import Collection, Iterator
from dataclasses import fields, is_dataclass
from functools import cache
from typing import Any

import numpy as np

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.registry import by_any_name
from automotive_cosim.contracts.roads import RoadNetwork
from automotive_cosim.errors import UnknownNameError
from automotive_cosim.scenarios.reader import shipped
from automotive_cosim.tasking.moves import Open
from automotive_cosim.tasking.task import Half


@cache
def data_keys() -> frozenset[str]:
    """The keys of ``Moment.commands``."""
    nowhere = RoadNetwork((), (0.0, 0.0, 1.0, 1.0), None, (0.0, 0.0), False)
    return frozenset(Cockpit(nowhere, rng=np.random.default_rng(0)).commands())


def check(half: Half) -> Iterator[tuple[str, UnknownNameError]]:
    """The names in a half that are unknown, each with the field that it is in."""
    start = half.start
    if start.scenario not in shipped() and not os.path.exists(start.scenario):  # noqa: PTH110, false if too long
        yield "start", UnknownNameError("scenario", start.scenario, shipped(), "automotive-cosim scenarios list")
    for field, ways in (("moves", (half.moves,)), ("ways", half.ways), ("slips", half.slips)):
        screens = {move.app for way in ways for move in way if isinstance(move, Open)}
        for name in screens - by_any_name().keys():
            yield field, UnknownNameError("screen", name, by_any_name())
    for field, keys in (("goal", {*_keys(half.goal)}), ("may_write", half.may_write)):
        yield from ((field, UnknownNameError("entry of the data", key, data_keys())) for key in _beyond(keys))


def _beyond(keys: Collection[str]) -> list[str]:
    """Those that the car does not have."""
    return sorted(key for key in keys if not key.startswith("Vehicle.") and key not in data_keys())


def _keys(part: Any) -> Iterator[str]:
    """The keys of the apps' data that a goal names."""
    if isinstance(part, tuple):
        for each in part:
            yield from _keys(each)
    elif is_dataclass(part):
        for each in fields(part):
            value = getattr(part, each.name)
            if each.name == "key" and isinstance(value, str):
                yield value
            else:
                yield from _keys(value)
