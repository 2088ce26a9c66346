"""Checks exported roads and trials with ASAM's own quality checkers, which live in an environment of their own.

python -m venv qc && qc/bin/pip install asam-qc-opendrive asam-qc-openscenarioxml
PATH=$PATH:$PWD/qc/bin python -m benchmarks.exchange [--scenarios grid,london] [TRIAL ...]

OSI traces of the trials (extra ``osi``) are read back and compared with the record.
"""

from __future__ import annotations

import argparse
import math
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ET
from collections import Counter
from collections.abc import Sequence
from importlib.util import find_spec
from itertools import pairwise
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

from shapely import LineString, Point

from automotive_cosim import scenarios
from automotive_cosim.exchange.opendrive import write_opendrive
from automotive_cosim.exchange.openscenario import VERSIONS, write_openscenario
from automotive_cosim.exchange.osi import write_osi
from automotive_cosim.exchange.recording import Recording, read_recording
from automotive_cosim.scenarios import open_scenario
from automotive_cosim.traffic.options import read_configuration

CHECKERS = {".xodr": ("qc_opendrive", "xodrBundle"), ".xosc": ("qc_openscenario", "xoscBundle")}
LEVELS = {"1": "errors", "2": "warnings", "3": "notes"}


def checked(path: Path) -> str:
    """A line of the table."""
    program, application = CHECKERS[path.suffix]
    found, config = path.with_suffix(".xqar"), path.with_suffix(".config.xml")
    config.write_text(
        f'<Config><Param name="InputFile" value={quoteattr(str(path))}/><CheckerBundle application="{application}">'
        f'<Param name="resultFile" value={quoteattr(str(found))}/></CheckerBundle></Config>',
        encoding="utf-8",
    )
    subprocess.run([program, "-c", str(config)], cwd=path.parent, check=True, capture_output=True)
    root = ET.parse(found).getroot()
    states = Counter(checker.attrib["status"] for checker in root.iter("Checker"))
    issues = Counter(LEVELS[issue.attrib["level"]] for issue in root.iter("Issue"))
    counts = *(states[name] for name in ("completed", "skipped")), *(issues[name] for name in LEVELS.values())
    return f"| {path.name} | {path.stat().st_size / 1e6:.2f} MB | " + " | ".join(map(str, counts)) + " |"


def read_back(recording: Recording, trace: Path) -> str:
    """A line about an OSI trace: how far front bumpers are off, and whether the host's lanes and borders fit it."""
    from osi_utilities import SingleTraceReader

    write_osi(recording, trace)
    off_m, on, along, sides, vehicles = 0.0, 0, 0, 0, 0
    with SingleTraceReader() as reader:
        assert reader.open(trace)
        for second, read in zip(recording.road.seconds, reader, strict=True):
            recorded = {each.vehicle_id: each for each in second.vehicles}
            vehicles += len(recorded)
            for each in read.message.moving_object:
                seen, base = recorded.pop(each.source_reference[0].identifier[0]), each.base
                ahead_m, yaw = base.dimension.length / 2, base.orientation.yaw
                front = base.position.x + ahead_m * math.cos(yaw), base.position.y + ahead_m * math.sin(yaw)
                off_m = max(off_m, math.dist(front, (seen.x_m, seen.y_m)))
                if each.id == read.message.host_vehicle_id:
                    host = base
            assert not recorded
            borders = {each.id.value: each.boundary_line for each in read.message.lane_boundary}
            for lane in (each.classification for each in read.message.lane):
                if not lane.is_host_vehicle_lane:
                    continue
                begin, end = nearest_piece(lane.centerline, host.position)
                east, north = end.x - begin.x, end.y - begin.y
                on += 1
                along += east * math.cos(host.orientation.yaw) + north * math.sin(host.orientation.yaw) > 0
                left, right = (
                    borders[ids[0].value][list(lane.centerline).index(begin)].position
                    for ids in (lane.left_lane_boundary_id, lane.right_lane_boundary_id)
                )
                sides += east * (left.y - right.y) - north * (left.x - right.x) > 0
    seconds = len(recording.road.seconds)
    return (
        f"| {trace.name} | {trace.stat().st_size / 1e6:.2f} MB | {seconds} messages, {vehicles} vehicles, at most "
        f"{off_m:.3f} m off; the host is on a lane in {on}, goes along it in {along}, and has its left border "
        f"on the left in {sides} |"
    )


def nearest_piece(line: Sequence[Any], to: Any) -> tuple[Any, Any]:
    """The piece of a line of OSI points that is nearest to a point."""
    at = Point(to.x, to.y)
    return min(pairwise(line), key=lambda ends: LineString([(each.x, each.y) for each in ends]).distance(at))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("trials", nargs="*", type=Path, help="folders of recorded trials")
    parser.add_argument("--scenarios", default=",".join(scenarios.shipped()), help="whose roads are checked")
    given = parser.parse_args()
    missing = [program for program, _ in CHECKERS.values() if shutil.which(program) is None]
    if missing:
        sys.exit(f"{', '.join(missing)} not found: install ASAM's checkers as above")
    print("| file | size | checks completed | skipped | errors | warnings | notes |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for scenario in filter(None, given.scenarios.split(",")):
            road = folder / f"{scenario}.xodr"
            write_opendrive(read_configuration(open_scenario(scenario).config).net, road)
            print(checked(road), flush=True)
        for trial in given.trials:
            recording = read_recording(trial)
            road = folder / "road.xodr"
            write_opendrive(read_configuration(open_scenario(recording.scenario).config).net, road)
            for version in VERSIONS:
                path = folder / f"{trial.name}-{version.replace('.', '_')}.xosc"
                write_openscenario(recording, path, version, road)
                print(checked(path), flush=True)
            if find_spec("osi_utilities"):
                print(read_back(recording, folder / f"{trial.name}_gt.osi"), flush=True)


if __name__ == "__main__":
    main()
