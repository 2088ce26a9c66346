"""Reads counts in SUMO's own formats.

* Edge data (``<meandata>`` or ``<data>``), as edgeData writes it and routeSampler reads it: the vehicles that
  ``entered`` each edge in an interval, and those that ``departed`` there, whom SUMO does not count as entered.
* What induction loops write (``<detector>``): ``nVehContrib`` of each loop and interval.
* The table that dfrouter and flowrouter read: ``Detector;Time;qPKW;qLKW``, whose times are minutes.

The last two need a file with the lane of each detector. A site is an edge: the detectors of its lanes are added up,
one per lane, since two behind each other count the same vehicles.

Formats: https://sumo.dlr.de/docs/Simulation/Output/Lane-_or_Edge-based_Traffic_Measures.html,
https://sumo.dlr.de/docs/Simulation/Output/Induction_Loops_Detectors_%28E1%29.html, https://sumo.dlr.de/docs/dfrouter.html
"""

from __future__ import annotations

import math
import xml.etree.ElementTree as ET
from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from automotive_cosim.contracts.plain import counted
from automotive_cosim.errors import UserError
from automotive_cosim.formats import bounds
from automotive_cosim.formats.files import opened
from automotive_cosim.formats.xml import read_tree
from automotive_cosim.studies.calibration.sheets import Sheet

DETECTOR, MINUTES, CARS, LORRIES = "Detector", "Time", "qPKW", "qLKW"
"""Columns of dfrouter's table."""

PLACED = frozenset({"e1Detector", "inductionLoop", "detectorDefinition", "detector_definition"})
"""Elements with the ``id`` and the ``lane`` of a detector."""

PASSED = {"entered": 1, "departed": 1, "left": -1, "arrived": -1, "vaporized": -1, "teleported": -1}
"""Of an edge: who came, and who went."""

HOUR_S = 3600
DAY_H = 24
LEAST_SHARE = 0.5
"""An hour of which less was counted is left out."""

Flows = dict[tuple[str, int], list[float]]
"""Edge and local hour (0 to 23) -> vehicles per hour, of each day."""


@dataclass(frozen=True, slots=True)
class _Count:
    """Vehicles at a site from one time to another."""

    site: str
    begin_s: float
    end_s: float
    vehicles: float


def is_xml(path: Path) -> bool:
    """Whether a file begins as XML does. A file that cannot be read is none."""
    try:
        with opened(path) as file:
            return file.read(64).removeprefix(b"\xef\xbb\xbf").lstrip().startswith(b"<")
    except OSError:
        return False


def read_xml_counts(path: Path, detectors: Path | None) -> Flows:
    """The flows of a file of edge data, or of what induction loops wrote.

    Args:
        detectors: the file that says on which lane each loop lies; edge data needs none.

    Raises UserError: it is neither, cannot be read, has an impossible figure, or lacks the place of a loop."""
    loops = edges = False
    found: list[_Count] = []
    begin_s = end_s = 0.0
    for element in _elements(path):
        if element.tag == "interval" and "nVehContrib" in element.attrib:
            loops = True
            name, vehicles = element.get("id", ""), _number(path, element, "nVehContrib")
            found.append(_Count(name, *_span(path, element), vehicles))
        elif element.tag == "interval":
            begin_s, end_s = _span(path, element)
        elif element.tag == "edge" and "entered" in element.attrib:
            edges = True
            passed = sum(_number(path, element, name) for name in ("entered", "departed") if name in element.attrib)
            found.append(_Count(element.get("id", ""), begin_s, end_s, passed))
    if loops == edges:
        raise UserError(
            f"{path} has no counts: neither edge data (<edge entered=…>) nor what induction loops write"
            " (<interval nVehContrib=…>); give one of these, or a table"
        )
    return _by_hour(found) if edges else _by_edge(_by_hour(found), _lanes(path, detectors))


def doubts_of(path: Path) -> tuple[str, ...]:
    """What is doubtful about a file of edge data that ``read_xml_counts`` has read: SUMO 1.28 with ``--mesosim``
    counts a vehicle as entered twice where it arrives before the last stretch of its road (``arrivalPos``)."""
    with opened(path) as file:
        if b'<mesosim value="true"' not in file.read(bounds.CHUNK_BYTES):  # of SUMO's options, in a comment
            return ()
    more: defaultdict[str, float] = defaultdict(float)
    ends: set[str] = set()
    for element in _elements(path):
        if element.tag == "edge" and "entered" in element.attrib:
            site, of = element.get("id", ""), PASSED.keys() & element.attrib.keys()
            more[site] += sum(PASSED[name] * _number(path, element, name) for name in of)
            ends |= {site} if element.get("arrived", "0") != "0" else set()
    if not (twice := sorted(site for site in ends if more[site] > 0)):
        return ()
    where = f"{counted(len(twice), 'edge')}, such as {twice[0]}"
    return (
        f"{path.name} is of --mesosim, which counts some arrivals (arrivalPos) as entered twice: on {where}, more "
        "came than went; let SUMO write it without --mesosim",
    )


def read_dfrouter_counts(path: Path, sheet: Sheet, detectors: Path | None) -> Flows:
    """The flows of dfrouter's table. A period lasts until the next one of the file; if there is only one, an hour.

    Args:
        detectors: the file that says on which lane each detector lies.

    Raises UserError: it has an impossible figure, or lacks the place of a detector."""
    rows = [
        (
            row.cells[DETECTOR],
            60 * _of_cell(path, row.line, row.cells, MINUTES),
            sum(_of_cell(path, row.line, row.cells, name) for name in (CARS, LORRIES)),
        )
        for row in sheet.rows
    ]
    times = sorted({begin_s for _, begin_s, _ in rows})
    period_s = min((later - earlier for earlier, later in pairwise(times)), default=HOUR_S)
    counts = [_Count(name, begin_s, begin_s + period_s, vehicles) for name, begin_s, vehicles in rows]
    return _by_edge(_by_hour(counts), _lanes(path, detectors))


def _by_hour(counts: Iterable[_Count]) -> Flows:
    """Vehicles per hour of each site and hour, day by day."""
    vehicles: defaultdict[tuple[str, int], float] = defaultdict(float)
    counted_s: defaultdict[tuple[str, int], float] = defaultdict(float)
    for count in counts:
        for hour in range(int(count.begin_s // HOUR_S), math.ceil(count.end_s / HOUR_S)):
            here_s = min(count.end_s, (hour + 1) * HOUR_S) - max(count.begin_s, hour * HOUR_S)
            vehicles[count.site, hour] += count.vehicles * here_s / (count.end_s - count.begin_s)
            counted_s[count.site, hour] += here_s
    flows: Flows = defaultdict(list)
    for (site, hour), seconds in sorted(counted_s.items()):
        if seconds >= LEAST_SHARE * HOUR_S:
            flows[site, hour % DAY_H].append(vehicles[site, hour] * HOUR_S / seconds)
    return flows


def _by_edge(flows: Flows, lanes: Mapping[str, str]) -> Flows:
    """Adds up the detectors of an edge, one per lane."""
    if lost := sorted({name for name, _ in flows} - lanes.keys()):
        raise UserError(f"detector {lost[0]!r} was counted, and --sites has no lane for it; give it one")
    chosen = {lane: name for name, lane in sorted(lanes.items(), reverse=True)}
    found: Flows = {}
    for lane, name in sorted(chosen.items()):
        edge = lane.rpartition("_")[0]
        for hour in range(DAY_H):
            if each := flows.get((name, hour)):
                before = found.setdefault((edge, hour), [0.0] * len(each))
                found[edge, hour] = [one + other for one, other in zip(before, each, strict=False)]
    return found


def _lanes(path: Path, detectors: Path | None) -> dict[str, str]:
    if detectors is None:
        raise UserError(
            f"{path} counts at detectors and does not say where they are; give the file with their lanes:"
            " --sites detectors.add.xml"
        )
    lanes = {
        name: lane
        for element in _elements(detectors)
        if element.tag in PLACED and (name := element.get("id")) and (lane := element.get("lane"))
    }
    if not lanes:
        raise UserError(f"{detectors} has no detector with a lane; give SUMO's file with e1Detector elements")
    return lanes


def _elements(path: Path) -> Iterable[ET.Element]:
    """All elements, each before what it contains."""
    return read_tree(path, error=UserError).iter()


def _span(path: Path, element: ET.Element) -> tuple[float, float]:
    begin_s, end_s = (_number(path, element, name) for name in ("begin", "end"))
    if begin_s >= end_s:
        raise UserError(f"{path}: an interval from {begin_s:g} to {end_s:g} s; its end must be later")
    return begin_s, end_s


def _number(path: Path, element: ET.Element, name: str) -> float:
    return _checked(f"{path}: {name} of <{element.tag} id={element.get('id', '')!r}>", element.get(name, ""))


def _of_cell(path: Path, line: int, cells: Mapping[str, str], name: str) -> float:
    """A figure; an empty one is 0."""
    return _checked(f"{path} line {line}: {name}", cells.get(name) or "0")


def _checked(what: str, text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not 0 <= value < 1e9:
        raise UserError(f"{what} is {text!r}; it must be a number from 0")
    return value
