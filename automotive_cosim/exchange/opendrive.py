"""The road of a scenario as OpenDRIVE: SUMO's netconvert writes it, and what it gets wrong is put right here.

netconvert 1.28 states version 1.4, but writes an ``offset`` that came with 1.5. It gives curves inexact lengths. It
crosses some junctions, most of them by turning back, with a jump of the heading, so that lanes do not meet. In
left-hand networks it puts the lanes of junctions on the left, but numbers them as on the right. Its ids of signals,
``c0_3``, are no numbers, which some readers expect: signals are numbered here, and have SUMO's ids as names. It
leaves out who may use a lane: their ``access`` is written here. Coordinates are those of the network, as in every
record.
"""

from __future__ import annotations

import math
import tempfile
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from automotive_cosim.errors import ScenarioError
from automotive_cosim.formats import bounds
from automotive_cosim.formats.writing import copy
from automotive_cosim.formats.xml import read_tree, write_xml
from automotive_cosim.traffic.network import drives_on_left, open_to
from automotive_cosim.traffic.sumo_programs import first_error, run

VERSION = "1.7"
"""Of the standard: the first that has all rules which ASAM's checker knows of one-way roads and junctions."""
SAME_HEADING_RAD = 1e-3
"""Roads whose headings differ by less meet without a kink."""
TURNS_BACK_ABOVE_RAD = 2.5
"""So large a turn is one back, to the side on which it ends."""
SHORT_M = 1e-6
"""By so much a curve is stated shorter than it is: readers that look for a place beyond its end find none."""
NAMES = "--output.original-names"
"""Lets netconvert write the ids of SUMO's edges."""
ASSUMED = {"code": "limit", "value": "assumed"}
"""Data of a road whose limit no sign has."""
POINT_M, ROOM_M = 0.01, 1.0
"""A shorter way through a junction is a point; the road before it ends this much earlier."""

ACCESS = {
    "passenger": "passengerCar",
    "bus": "bus",
    "taxi": "taxi",
    "truck": "truck",
    "delivery": "delivery",
    "emergency": "emergency",
    "motorcycle": "motorcycle",
    "bicycle": "bicycle",
}
"""Restrictions of OpenDRIVE 1.7 (its ``e_accessRestrictionType``) by SUMO's class of vehicle."""

Pose = tuple[float, float, float]
"""x, y and heading in radians, counter-clockwise from east."""


def write_opendrive(net: Path, target: Path) -> None:
    """Writes a network as OpenDRIVE; the same network gives the same bytes.

    Args:
        net: a SUMO network, ``.net.xml`` or ``.net.xml.gz``.

    Raises:
        ScenarioError: netconvert refuses the network.
        SetupError: netconvert is not installed.
    """
    with tempfile.TemporaryDirectory(prefix="automotive-cosim-opendrive-") as name:
        scratch = Path(name)
        ours = "road.net.xml.gz" if net.name.endswith(".gz") else "road.net.xml"
        copy(net, scratch / ours, bounds.UNPACKED_BYTES)
        ok, printed = run("netconvert", ("-s", ours, "--opendrive-output=road.xodr", NAMES), scratch)
        if not ok:
            raise ScenarioError(f"netconvert cannot write {net} as OpenDRIVE: {first_error(printed)}")
        root = read_tree(scratch / "road.xodr", error=ScenarioError)
        tell_access(root, read_tree(scratch / ours, error=ScenarioError))
    mend(root, left_hand=drives_on_left(net))
    ET.indent(root)
    write_xml(target, root)


def tell_access(root: ET.Element, network: ET.Element) -> None:
    """Writes who may use a lane: who may not on one for cars, who may on any other; and which limits no sign has.

    Args:
        root: netconvert's file with ``NAMES``; changed in place.
        network: of SUMO, from which it was made.
    """
    edges = {edge.attrib["id"]: edge for edge in network.iter("edge")}
    for road in root.iter("road"):
        for named in road.findall("userData"):  # NAMES wrote them
            road.remove(named)
            edge = edges[named.attrib["value"]]
            if edge.find("param[@key='maxspeed']") is None:
                ET.SubElement(road, "userData", ASSUMED)
            for lane, of_sumo in zip(reversed(_lanes(road)), edge.findall("lane"), strict=True):
                for_cars = open_to(of_sumo.attrib)
                for vehicle_class, restriction in ACCESS.items():
                    if open_to(of_sumo.attrib, vehicle_class) is not for_cars:
                        rule = "deny" if for_cars else "allow"
                        ET.SubElement(lane, "access", sOffset="0", rule=rule, restriction=restriction)


def mend(root: ET.Element, *, left_hand: bool) -> None:
    """Puts right what netconvert got wrong.

    Args:
        root: its file; changed in place.
    """
    header = root.find("header")
    assert header is not None
    header.attrib.pop("date", None)
    header.set("revMajor", VERSION[0])
    header.set("revMinor", VERSION[2:])
    _take_offset_in(header)
    roads = {road.attrib["id"]: road for road in root.iter("road")}
    ways = [road for road in roads.values() if road.attrib["junction"] != "-1"]
    _make_room(ways, roads)
    for way in ways:
        _join(way, roads)
    for road in roads.values():
        _measure(road)
    numbers = {signal.attrib["id"]: str(number) for number, signal in enumerate(root.iter("signal"))}
    for signal in root.iter("signal"):
        signal.set("name", signal.attrib["id"])
        signal.set("id", numbers[signal.attrib["id"]])
    for control in root.iter("control"):
        control.set("signalId", numbers[control.attrib["signalId"]])
    if left_hand:
        _keep_left(root, roads)


def _take_offset_in(header: ET.Element) -> None:
    """Lets the projection begin where the network does: some readers add an ``offset``, others subtract it."""
    offset, reference = header.find("offset"), header.find("geoReference")
    if offset is None or reference is None:
        return
    parts = (term.lstrip("+").partition("=") for term in (reference.text or "").split())
    terms = {name: value for name, _, value in parts}
    if terms.get("proj") == "utm":  # which has no origin of its own
        north_m = "0" if terms.pop("south", None) is None else "10000000"
        origin = {"lat_0": "0", "lon_0": f"{6 * int(terms.pop('zone')) - 183}", "k": "0.9996"}
        terms |= {"proj": "tmerc", **origin, "x_0": "500000", "y_0": north_m}
    if "proj" not in terms or terms.get("units", "m") != "m" or "to_meter" in terms:
        return
    for axis in "xy":
        terms[f"{axis}_0"] = f"{float(terms.get(f'{axis}_0', '0')) - float(offset.attrib[axis]):.2f}"
    reference.text = " ".join(f"+{name}={value}" if value else f"+{name}" for name, value in terms.items())
    header.remove(offset)


# --- curves ------------------------------------------------------------------------------------------------------


def pose_at(road: ET.Element, at: float) -> Pose:
    """The reference line at its start (0) or its end (1)."""
    geometry = road.findall("planView/geometry")[0 if at == 0 else -1]
    x_m, y_m, heading, length_m = (float(geometry.attrib[name]) for name in ("x", "y", "hdg", "length"))
    curve = geometry.find("paramPoly3")
    if curve is None:
        u_m, v_m, turned = at * length_m, 0.0, 0.0
    else:
        most = at * (1.0 if curve.get("pRange") == "normalized" else length_m)
        (u_m, du), (v_m, dv) = (_polynomial(_coefficients(curve, axis), most) for axis in "UV")
        turned = math.atan2(dv, du)
    cos, sin = math.cos(heading), math.sin(heading)
    return x_m + u_m * cos - v_m * sin, y_m + u_m * sin + v_m * cos, heading + turned


def _coefficients(curve: ET.Element, axis: str) -> tuple[float, ...]:
    return tuple(float(curve.attrib[f"{power}{axis}"]) for power in "abcd")


def _polynomial(coefficients: Sequence[float], at: float) -> tuple[float, float]:
    a, b, c, d = coefficients
    return a + at * (b + at * (c + at * d)), b + at * (2 * c + at * 3 * d)


def _make_room(ways: Sequence[ET.Element], roads: dict[str, ET.Element]) -> None:
    """Ends a road before a kink, where netconvert has no room for a way to the next road: it would be a point."""
    short = {way.attrib["id"] for way in ways if math.dist(pose_at(way, 0)[:2], pose_at(way, 1)[:2]) < POINT_M}
    kinks = {before.attrib["elementId"] for way in ways if way.attrib["id"] in short for before in _linked(way)[:1]}
    for name in kinks:
        geometry = roads[name].findall("planView/geometry")[-1]
        left_m = float(geometry.attrib["length"]) - ROOM_M
        if geometry.find("line") is None or left_m < ROOM_M:
            continue
        geometry.set("length", f"{left_m:.8f}")
        most_m = float(roads[name].attrib["length"]) - ROOM_M
        roads[name].set("length", f"{most_m:.8f}")
        for signal in roads[name].iterfind("signals/*"):
            signal.set("s", f"{min(most_m, float(signal.attrib['s'])):.8f}")
        heading = float(geometry.attrib["hdg"])
        for way in ways:
            if _linked(way) and _linked(way)[0].attrib["elementId"] == name:
                x_m, y_m, _ = pose_at(way, 0)
                begin = x_m - ROOM_M * math.cos(heading), y_m - ROOM_M * math.sin(heading), heading
                leaves = pose_at(roads[_linked(way)[1].attrib["elementId"]], 0)[2]
                _bend(way, begin, (*pose_at(way, 1)[:2], leaves))


def _linked(way: ET.Element) -> tuple[ET.Element, ...]:
    """The links of a way to the road before and the road after it; nothing without one of the two."""
    links = [link for end in ("predecessor", "successor") if (link := way.find(f"link/{end}")) is not None]
    return tuple(links) if len(links) == 2 else ()


def _join(road: ET.Element, roads: dict[str, ET.Element]) -> None:
    """Gives a way through a junction the headings of the roads that it connects, so that its lanes meet theirs."""
    if not _linked(road):
        return
    before, after = (roads[link.attrib["elementId"]] for link in _linked(road))
    begin, end = pose_at(road, 0), pose_at(road, 1)
    enters, leaves = pose_at(before, 1)[2], pose_at(after, 0)[2]
    if max(abs(_turn(enters, begin[2])), abs(_turn(leaves, end[2]))) >= SAME_HEADING_RAD:
        _bend(road, (begin[0], begin[1], enters), (end[0], end[1], leaves))


def _bend(road: ET.Element, begin: Pose, end: Pose) -> None:
    """Replaces a reference line by a cubic that approximates an arc, as Bézier curves do for circles."""
    (x_m, y_m, heading), leaves = begin, end[2]
    cos, sin = math.cos(heading), math.sin(heading)
    chord_u, chord_v = (end[0] - x_m) * cos + (end[1] - y_m) * sin, (end[1] - y_m) * cos - (end[0] - x_m) * sin
    chord_m = math.hypot(chord_u, chord_v)
    turned = abs(_turn(leaves, heading))
    if turned > TURNS_BACK_ABOVE_RAD and _turn(leaves, heading) * chord_v < 0:
        turned = 2 * math.pi - turned  # over more than half a circle
    handle_m = chord_m / 3 if turned < 0.01 else chord_m * (2 / 3) * math.tan(turned / 4) / math.sin(turned / 2)
    way = leaves - heading
    points_u = 0.0, handle_m, chord_u - handle_m * math.cos(way), chord_u
    points_v = 0.0, 0.0, chord_v - handle_m * math.sin(way), chord_v
    plan = road.find("planView")
    assert plan is not None
    for geometry in plan.findall("geometry"):
        plan.remove(geometry)
    made = ET.SubElement(
        plan, "geometry", s="0", x=f"{x_m:.8f}", y=f"{y_m:.8f}", hdg=f"{heading:.8f}", length=f"{chord_m:.8f}"
    )
    values: dict[str, str] = {}
    for axis, (p0, p1, p2, p3) in (("U", points_u), ("V", points_v)):
        powers = p0, 3 * (p1 - p0), 3 * (p2 - 2 * p1 + p0), p3 - 3 * p2 + 3 * p1 - p0
        values |= {f"{name}{axis}": f"{power:.8f}" for name, power in zip("abcd", powers, strict=True)}
    ET.SubElement(made, "paramPoly3", values | {"pRange": "normalized"})


def _turn(to: float, of: float) -> float:
    return (to - of + math.pi) % (2 * math.pi) - math.pi


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(64)
PIECES = 32
"""In which a curve is measured: one that turns back sharply needs them."""


def _measure(road: ET.Element) -> None:
    """Gives curves their lengths, and with them the road and the pieces that follow."""
    at_m = 0.0
    if road.find("planView/geometry/paramPoly3") is None:
        return
    for geometry in road.iterfind("planView/geometry"):
        curve = geometry.find("paramPoly3")
        geometry.set("s", f"{at_m:.8f}")
        if curve is not None and curve.get("pRange") == "normalized":
            at = (np.arange(PIECES)[:, None] + (_NODES + 1) / 2) / PIECES
            (_, b, c, d), (_, e, f, g) = _coefficients(curve, "U"), _coefficients(curve, "V")
            speeds = np.hypot(b + at * (2 * c + at * 3 * d), e + at * (2 * f + at * 3 * g))
            geometry.set("length", f"{float((speeds @ _WEIGHTS).sum()) / 2 / PIECES - SHORT_M:.8f}")
        at_m += float(geometry.attrib["length"])
    road.set("length", f"{at_m:.8f}")


# --- the left side -----------------------------------------------------------------------------------------------


def _keep_left(root: ET.Element, roads: dict[str, ET.Element]) -> None:
    """Lanes left of a centre line that runs along their right border, numbered from there, under the rule LHT."""
    counts = {name: len(_lanes(road)) for name, road in roads.items()}
    for name, road in roads.items():
        for end in ("predecessor", "successor"):
            link = road.find(f"link/{end}")
            other = counts.get("" if link is None else link.attrib["elementId"], 0)
            if link is not None and link.get("elementType") == "road":
                _renumber((each for lane in _lanes(road) for each in lane.iterfind(f"link/{end}")), "id", other)
        for validity in road.iter("validity"):
            _renumber((validity,), "fromLane", counts[name])
            _renumber((validity,), "toLane", counts[name])
        _mirror(road)
    for connection in root.iter("connection"):
        links = tuple(connection.iter("laneLink"))
        _renumber(links, "from", counts[connection.attrib["incomingRoad"]])
        _renumber(links, "to", counts[connection.attrib["connectingRoad"]])


def _lanes(road: ET.Element) -> list[ET.Element]:
    """Its lanes from left to right."""
    return [lane for side in ("left", "right") for lane in road.iterfind(f"lanes/laneSection/{side}/lane")]


def _renumber(elements: Iterable[ET.Element], attribute: str, count: int) -> None:
    """From -1, the leftmost, to ``count``, the leftmost."""
    for each in elements:
        each.set(attribute, str(count + 1 + int(each.attrib[attribute])))


def _mirror(road: ET.Element) -> None:
    road.set("rule", "LHT")
    lanes, section = road.find("lanes"), road.find("lanes/laneSection")
    assert lanes is not None
    assert section is not None
    mine = _lanes(road)
    widths = [width for lane in mine if (width := lane.find("width")) is not None]
    before = lanes.find("laneOffset")
    offset = {name: float(before.attrib[name]) if before is not None else 0.0 for name in "abcd"}
    if before is not None:
        lanes.remove(before)
    shifted = {name: offset[name] - sum(float(width.attrib[name]) for width in widths) for name in "abcd"}
    lanes.insert(
        0, ET.Element("laneOffset", {"s": "0"} | {name: f"{value:.8f}" for name, value in shifted.items()})
    )
    centre = section.find("center/lane")
    assert centre is not None
    marks = [lane.find("roadMark") for lane in (centre, *mine)]
    for lane, mark in zip((*mine, centre), marks, strict=True):
        own = lane.find("roadMark")
        if own is not None and mark is not None:
            lane[list(lane).index(own)] = mark
    for side in ("left", "right"):
        if (old := section.find(side)) is not None:
            section.remove(old)
    left = ET.Element("left")
    for number, lane in enumerate(mine):
        lane.set("id", str(len(mine) - number))
        left.append(lane)
    section.insert(0, left)
