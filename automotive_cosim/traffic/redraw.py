"""Another day of the same demand: every trip of a fixed list is taken none, one or several times, by seed.

The trips of a demand file are one day. Each is drawn a Poisson number of times with mean 1 (a bootstrap of a
Poisson process), at another minute, so that seeds differ in who travels and not only in how they drive. Buses of a
line and vehicles with stops have a timetable and stay, persons too; flows draw by themselves.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from copy import deepcopy
from pathlib import Path

import numpy as np

from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats.xml import read_tree, write_xml

WINDOW_S = 300.0
"""A trip departs up to this long before or after its time in the file, but not before the file's first."""

DEPARTING = {"vehicle": "depart", "trip": "depart", "flow": "begin", "person": "depart", "personFlow": "begin"} | {
    "container": "depart",
    "containerFlow": "begin",
}


def redraw(path: Path, target: Path, seed: int) -> Path:
    """Writes another day of a demand file; returns where.

    Args:
        path: SUMO's route file.
        seed: seed of the day.

    Raises:
        ScenarioError: it cannot be read."""
    rng = np.random.default_rng([seed, 8])
    root = read_tree(path, error=ScenarioError)
    fixed = [each for each in root if each.tag not in DEPARTING]
    departing = [each for each in root if each.tag in DEPARTING]
    first_s = min((at_s for each in departing if (at_s := _departs_s(each)) is not None), default=0.0)
    drawn: list[tuple[float, ET.Element]] = []
    for each in departing:
        at_s = _departs_s(each)
        if at_s is None or not _is_free(each):
            drawn.append((first_s if at_s is None else at_s, each))
            continue
        for number in range(int(rng.poisson(1.0))):
            copy = deepcopy(each)
            departs_s = max(first_s, at_s + float(rng.uniform(-WINDOW_S, WINDOW_S)))
            copy.set("depart", f"{departs_s:.2f}")
            if number:
                copy.set("id", f"{each.get('id')}.day{number}")
            drawn.append((departs_s, copy))
    root[:] = [*fixed, *(each for _, each in sorted(drawn, key=lambda one: one[0]))]
    write_xml(target, root)
    return target


def _departs_s(element: ET.Element) -> float | None:
    """When it departs, or a flow begins; None if that is a word, such as ``triggered``, or a clock time."""
    try:
        return float(element.get(DEPARTING[element.tag], ""))
    except ValueError:
        return None


def _is_free(element: ET.Element) -> bool:
    """Whether it is a trip that somebody may or may not make on a day."""
    return element.tag in ("vehicle", "trip") and not element.get("line") and element.find(".//stop") is None
