"""Golden accessibility lists: what every view of the cockpit lists, in four languages, with traffic on the left and
on the right, in the three states of motion; and on the other sizes of screen in one of each.

    python -m tests.cockpit.goldens            # what differs from the stored lists, view by view
    python -m tests.cockpit.goldens --renew    # stores the present ones
"""

import json
import lzma
import sys
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, fields, replace
from itertools import product
from pathlib import Path
from zlib import crc32

import numpy as np

from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.restrictions import Motion
from automotive_cosim.cockpit.signals import HMI, MOTION
from automotive_cosim.cockpit.size import ScreenSize
from automotive_cosim.contracts import Element
from automotive_cosim.interface.trace import plain

from .conftest import View, outside, town, walk

FILE = Path(__file__).with_name("goldens.json.xz")
MOTIONS = {Motion.PARKED: ("P", 0.0), Motion.IDLING: ("D", 0.0), Motion.MOVING: ("D", 48.0)}

Listing = list[str]
"""The elements of a view, a line each."""


def views(*, left_hand: bool) -> tuple[View, ...]:
    """Every view of a parked car."""
    cockpit = Cockpit(replace(town(), left_hand=left_hand), rng=np.random.default_rng(1))
    moved(cockpit, Motion.PARKED)
    return walk(cockpit)


def moved(cockpit: Cockpit, motion: Motion) -> None:
    """Lets no time pass, but brings the car into a state of motion."""
    gear, speed_kmh = MOTIONS[motion]
    cockpit.inject(MOTION.GEAR.path, gear)
    cockpit.sense(outside(speed_kmh=speed_kmh), 0.0)


def listings(
    views_of: Mapping[str, tuple[View, ...]],
    languages: tuple[str, ...],
    motions: Iterable[Motion] = Motion,
    *,
    part: int = 1,
) -> Iterator[tuple[str, Listing]]:
    """Each view's name, side of the road, motion and language, and its elements; or one in so many of them."""
    for side, found in views_of.items():
        for view, motion, language in product(found, motions, languages):
            if is_of(name := f"{view.name}, {side} hand, {motion}, {language}", part):
                there = view.cockpit.copy()
                moved(there, motion)
                there.inject(HMI.LANGUAGE.path, language)
                yield name, list(map(line, there.elements()))


def is_of(name: str, part: int) -> bool:
    """Whether a list is one of a part of all, in which each view, language, side and motion is."""
    return crc32(name.encode()) % part == 0


def line(element: Element) -> str:
    """An element without what is empty or false."""
    given = {field.name: getattr(element, field.name) for field in fields(element)}
    box = list(asdict(given.pop("bbox_pixels")).values())
    del given["package_name"]
    told = {name: value for name, value in given.items() if value not in ("", False)}
    return json.dumps(plain(told | {"box": box}), ensure_ascii=False)


def made(part: int = 1) -> dict[str, Listing]:
    """The present lists."""
    languages = HMI.LANGUAGE.allowed
    found = {side: views(left_hand=side == "left") for side in ("right", "left")}
    lists = dict(listings(found, languages, part=part))
    for size, side, language in ((ScreenSize.WIDE, "right", "en"), (ScreenSize.PORTRAIT, "left", languages[-1])):
        resized = {f"{size}, {side}": tuple(fitted(view, size) for view in found[side])}
        lists |= dict(listings(resized, (language,), (Motion.PARKED,), part=part))
    return lists


def fitted(view: View, size: ScreenSize) -> View:
    """The view on a screen of that size."""
    there = view.cockpit.copy()
    there.resize(size)
    return replace(view, cockpit=there)


def stored(part: int = 1) -> dict[str, Listing]:
    """The stored lists."""
    known: dict[str, Listing] = json.loads(lzma.decompress(FILE.read_bytes()))
    return {name: listing for name, listing in known.items() if is_of(name, part)}


def differences(known: Mapping[str, Listing], now: Mapping[str, Listing]) -> Iterator[str]:
    """What is gone (-) and what has come (+), under the name of its view."""
    for name in sorted(known.keys() | now.keys()):
        before, after = known.get(name, []), now.get(name, [])
        if before == after and name in known and name in now:
            continue
        yield name
        yield from (f"  - {one}" for one in before if one not in after)
        yield from (f"  + {one}" for one in after if one not in before)
        if sorted(before) == sorted(after):
            yield "  in another order"


if __name__ == "__main__":
    lists = made()
    if "--renew" in sys.argv:
        text = json.dumps(lists, ensure_ascii=False, indent=0)
        FILE.write_bytes(lzma.compress(text.encode(), preset=9))
        sys.stdout.write(f"{len(lists)} lists in {FILE} ({FILE.stat().st_size / 1000:.0f} kB)\n")
    else:
        sys.stdout.writelines(f"{one}\n" for one in differences(stored(), lists))
