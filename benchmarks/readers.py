"""Has exports read by other packages, each in an environment of its own, and compares lanes, places and times.

    python -m benchmarks.readers [--environments readers] [--only scenic,mcap] [--newest] TRIAL ...

An environment is made where there is none, two gigabytes and more for all. This script runs there again, without
this package, and prints what was read as JSON. A metre of a lane is read if a lane passes within half a metre; a
place is a vehicle's front bumper at a second.
"""

from __future__ import annotations

import argparse
import json
import math
import subprocess
import tempfile
import venv
import xml.etree.ElementTree as ET
from collections.abc import Callable
from importlib.metadata import version
from itertools import pairwise
from pathlib import Path
from typing import Any

NEAR_M, EACH_M = 0.5, 5.0
"""How close a lane must be, and how far apart the places are at which it is looked for."""
EARTH_M = 6378137.0
"""Radius of the sphere of web Mercator, in which commonroad has its networks."""
Lane = list[tuple[float, float]]


# --- there: each returns {"lanes": lines} or {"places": {second: {id: [x, y]}}} -----------------------------------


def scenic(folder: Path) -> Any:
    from scenic.domains.driving.roads import Network

    network = Network.fromFile(folder / "road.xodr", useCache=False)
    return {"lanes": [[point[:2] for point in lane.centerline.points] for lane in network.lanes]}


def commonroad(folder: Path) -> Any:
    """Also writes what it read for lanelet2."""
    from crdesigner.map_conversion.lanelet2.cr2lanelet import CR2LaneletConverter
    from crdesigner.map_conversion.map_conversion_interface import opendrive_to_commonroad
    from lxml import etree

    scenario = opendrive_to_commonroad(folder / "road.xodr")
    (folder / "road.osm").write_bytes(etree.tostring(CR2LaneletConverter()(scenario)))
    return {
        "earth": [
            [
                (math.degrees(x_m / EARTH_M), math.degrees(math.atan(math.sinh(y_m / EARTH_M))))
                for x_m, y_m in each.center_vertices.tolist()
            ]
            for each in scenario.lanelet_network.lanelets
        ]
    }


def lanelet2(folder: Path) -> Any:
    """Between its borders: the centre line that lanelet2 makes of a long winding lanelet may end half-way."""
    from lanelet2.core import BasicPoint3d
    from lanelet2.io import Origin, load
    from lanelet2.projection import UtmProjector

    first = (folder / "road.osm").read_text(encoding="utf-8").partition("<node ")[2].partition(">")[0]
    lat, lon = (float(first.partition(f' {name}="')[2].partition('"')[0]) for name in ("lat", "lon"))
    projector = UtmProjector(Origin(lat, lon))
    lanes = []
    for each in load(str(folder / "road.osm"), projector).laneletLayer:
        between = zip(each.leftBound, each.rightBound, strict=True)
        middle = (BasicPoint3d((left.x + right.x) / 2, (left.y + right.y) / 2, 0.0) for left, right in between)
        lanes.append([(point.lon, point.lat) for point in map(projector.reverse, middle)])
    return {"earth": lanes}


def osi_utilities(folder: Path) -> Any:
    from osi_utilities import MessageType, SingleTraceReader

    with SingleTraceReader() as trace:
        trace.open(next(folder.glob("*.osi")))
        read = list(trace)
    assert {each.message_type for each in read} == {MessageType.GROUND_TRUTH}, "found by the file's name"
    return _places(each.message for each in read)


def mcap(folder: Path) -> Any:
    """Without OSI's classes: the file says what its messages are."""
    from mcap.reader import make_reader
    from mcap_protobuf.decoder import DecoderFactory

    with next(folder.glob("*.mcap")).open("rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        return _places(message for *_, message in reader.iter_decoded_messages())


def betterosi(folder: Path) -> Any:
    import betterosi

    return _places(betterosi.read(next(folder.glob("*.mcap")), return_ground_truth=True))


def _places(messages: Any) -> Any:
    places: dict[str, dict[str, tuple[float, float]]] = {}
    for message in messages:
        at_s = message.timestamp.seconds + message.timestamp.nanos * 1e-9
        second = places.setdefault(f"{at_s:.3f}", {})
        for each in message.moving_object:
            base, ahead_m = each.base, each.base.dimension.length / 2
            yaw = base.orientation.yaw
            front = base.position.x + ahead_m * math.cos(yaw), base.position.y + ahead_m * math.sin(yaw)
            second[each.source_reference[0].identifier[0]] = front
    return {"places": places}


READERS: dict[str, tuple[tuple[str, ...], Callable[[Path], Any]]] = {
    "scenic": (("scenic==3.1.1",), scenic),
    "commonroad": (("commonroad-scenario-designer==0.8.5",), commonroad),
    "lanelet2": (("lanelet2==1.2.3",), lanelet2),
    "osi_utilities": (("asam-osi-utilities==0.4.0", "osi-python==3.8.0"), osi_utilities),
    "mcap": (("mcap-protobuf-support==0.6.0", "mcap==1.6.0"), mcap),
    "betterosi": (("betterosi==0.9.0",), betterosi),
}
"""Each reader's packages, itself first, and what it does there; lanelet2 reads what commonroad has made."""


# --- here ---------------------------------------------------------------------------------------------------------


def python_of(environment: Path, packages: tuple[str, ...]) -> Path:
    """The interpreter of an environment with these packages, made if there is none."""
    python = environment / "bin" / "python"
    if not python.is_file():
        venv.create(environment, with_pip=True)
        subprocess.run([python, "-m", "pip", "install", "-qq", *packages], check=True)
    return python


def true_lanes(net: Path) -> list[Lane]:
    """SUMO's lanes outside junctions."""
    from automotive_cosim.formats.files import opened

    with opened(net) as file:
        edges = [edge for edge in ET.parse(file).getroot().iter("edge") if edge.get("function") is None]
    shapes = [lane.attrib["shape"].split() for edge in edges for lane in edge.iter("lane")]
    return [[tuple(map(float, point.split(",")[:2])) for point in shape] for shape in shapes]  # type: ignore[misc]


def lanes_compared(net: Path, road: Path, read: Any) -> str:
    """How much of SUMO's lanes was read, and how far off it is."""
    import numpy as np
    import pyproj
    from shapely import LineString, STRtree

    if "earth" in read:
        where = pyproj.Proj(ET.parse(road).getroot().findtext("header/geoReference"))
        read["lanes"] = [[where(*point) for point in lane] for lane in read["earth"]]
    pieces = [piece for lane in read["lanes"] for piece in pairwise(lane) if piece[0] != piece[1]]
    tree, looked, away = STRtree([LineString(piece) for piece in pieces]), 0, 0
    off_m: list[float] = []
    for lane in true_lanes(net):
        line = LineString(lane)
        for at_m in np.arange(EACH_M / 2, line.length, EACH_M):
            here, ahead = line.interpolate(at_m), line.interpolate(at_m + 0.1)
            looked += 1
            near = [pieces[each] for each in tree.query(here, predicate="dwithin", distance=NEAR_M)]
            if not near:
                continue
            off_m.append(min(LineString(piece).distance(here) for piece in near))
            away += all(
                (end[0] - begin[0]) * (ahead.x - here.x) + (end[1] - begin[1]) * (ahead.y - here.y) <= 0
                for begin, end in near
            )
    lanes, most_m = len(read["lanes"]), np.quantile(off_m or [math.inf], 0.95)
    back = f", {away / len(off_m):.0%} of them leading back" if away else ""
    return f"{lanes} lanes; {len(off_m) / looked:.1%} of SUMO's metres, 95 % of them within {most_m:.3f} m{back}"


def places_compared(recording: Any, read: Any) -> str:
    """How many places were read, at which times, and how far off they are."""
    seconds = recording.road.seconds
    true = {f"{each.at_s - recording.begin_s:.3f}": each.vehicles for each in seconds}
    if true.keys() != read["places"].keys():
        return f"{len(read['places'])} seconds in place of {len(true)}"
    off_m, count = 0.0, 0
    for at_s, vehicles in true.items():
        found = read["places"][at_s]
        if found.keys() != {each.vehicle_id for each in vehicles}:
            return f"other vehicles at {at_s} s"
        for each in vehicles:
            off_m = max(off_m, math.dist(found[each.vehicle_id], (each.x_m, each.y_m)))
            count += 1
    return f"{len(true)} seconds, {count} places, at most {off_m:.3f} m off"


def compared(trial: Path, chosen: list[str], environments: Path, is_newest: bool) -> None:
    """Prints a line for each reader."""
    from automotive_cosim.exchange.opendrive import write_opendrive
    from automotive_cosim.exchange.osi import trace_name, write_osi
    from automotive_cosim.exchange.recording import read_recording
    from automotive_cosim.scenarios import open_scenario
    from automotive_cosim.traffic.options import read_configuration

    recording = read_recording(trial)
    net = read_configuration(open_scenario(recording.scenario).config).net
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_opendrive(net, folder / "road.xodr")
        for end in (".osi", ".mcap"):
            write_osi(recording, folder / (trace_name(recording) + end))
        for reader in chosen:
            packages = READERS[reader][0]
            wanted = tuple(each.partition("==")[0] for each in packages) if is_newest else packages
            python = python_of(environments / reader, wanted)
            ran = subprocess.run(
                [python, __file__, "--there", reader, folder], capture_output=True, text=True, check=False
            )
            if ran.returncode:
                told, what = "?", f"failed: {(ran.stderr.strip().splitlines() or ['no word'])[-1]}"
            else:
                told, read = json.loads(ran.stdout.splitlines()[-1])
                what = (
                    places_compared(recording, read)
                    if "places" in read
                    else lanes_compared(net, folder / "road.xodr", read)
                )
            print(f"| {trial.name} | {packages[0].partition('==')[0]} | {told} | {what} |", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("trials", nargs="*", type=Path, help="folders of recorded trials")
    parser.add_argument("--environments", type=Path, default=Path("readers"), help="where the environments are")
    parser.add_argument("--only", default=",".join(READERS), help="which readers")
    parser.add_argument("--newest", action="store_true", help="make environments with the newest versions")
    parser.add_argument("--there", choices=READERS, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.there:
        packages, read = READERS[given.there]
        print("\n" + json.dumps([version(packages[0].partition("==")[0]), read(given.trials[0])]))
        return
    print("| trial | reader | version | what it read |\n| --- | --- | --- | --- |")
    for trial in given.trials:
        compared(trial, given.only.split(","), given.environments, given.newest)


if __name__ == "__main__":
    main()
