"""How much of other people's scenarios is carried out: ``python -m tests.exchange.suites FOLDER [NETWORK]``.

Imports every OpenSCENARIO file with a storyboard in a folder, e.g. of a checkout of esmini, and prints what became
of each, the reasons of refusals with how many files have them, and for each file that is imported how far its
vehicles are from where the file has them, second by second: the distance of each front bumper from the middle of
its lanes, and from where the speed of the file takes it until its first action. The network replaces missing roads.
"""

from __future__ import annotations

import re
import sys
import tempfile
import tomllib
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import sumolib
from shapely import LineString, Point

from automotive_cosim.contracts import KMH_PER_MPS
from automotive_cosim.errors import UserError
from automotive_cosim.exchange.incoming import NET, import_openscenario
from automotive_cosim.exchange.tree import XmlElement, read_tree
from automotive_cosim.scenarios import open_scenario
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.fork import Simulations

EGOS = "Ego", "ego", "hero"
SECONDS = 30
"""How long each drive is followed."""


def main(folder: Path, network: Path | None = None) -> None:
    """Prints the table, the reasons and the distances."""
    reasons: Counter[str] = Counter()
    simulations = Simulations()
    count, imported = 0, []
    with tempfile.TemporaryDirectory() as scratch:
        for file in sorted(folder.rglob("*.xosc")):
            root = read_tree(file)
            if root.find("Storyboard") is None:
                continue
            count += 1
            made, told = _import(file, root, Path(scratch) / f"{count}", network)
            if made is None:
                reasons[_reason(told)] += 1
                print(f"| {file.relative_to(folder)} | refused | {told} |")
                continue
            imported.append(file.stem)
            told = f"{told}; {_followed(made, simulations)}"
            print(f"| {file.relative_to(folder)} | imported | {told} |", flush=True)
    simulations.close()
    print(f"\n{len(imported)} of {count} are imported\n\n| files | what becomes of them |\n|---|---|")
    print(f"| {len(imported)} | imported: {', '.join(imported)} |")
    for reason, number in reasons.most_common():
        if number > 1:
            print(f"| {number} | refused: {reason} |")
    alone = [reason for reason, number in reasons.items() if number == 1]
    print(f"| {len(alone)} | refused, one for each of: {'; '.join(alone)} |")


def _import(file: Path, root: XmlElement, out: Path, network: Path | None) -> tuple[Path | None, str]:
    """The scenario and its ego, or why not; where nothing may act on the usual ego, another vehicle is the ego."""
    names = [each.attributes.get("name", "") for part in root.all("Entities") for each in part.parts]
    names.sort(key=lambda name: name not in EGOS)
    why = "has no vehicle"
    for name in names or ["ego"]:
        try:
            return import_openscenario(file, out, network, name, country="DE"), f"ego is {name}"
        except UserError as error:
            told = re.sub(r"^.*/([^/ ]+ line \d+)", r"\1", str(error)).replace(str(file.parent), "")
            why = told if name == (names or [""])[0] else why
            if "SUMO's driver drives" not in told:
                break
    return None, why


def _reason(told: str) -> str:
    """A reason of refusal without its place and values: the element, and what of it unless it is outside."""
    found = re.search(r"<(\w+)>(?: in <\w+>:)? ([^:;,]*)", told)
    if found is None:
        return re.sub(r"\S*/(\S+)", r"\1", told).partition(";")[0]
    why = re.sub(r"^(outside|in <).*|^has |(= )?'[^']*'|\b(Ego|Car\d*)\b|[-\d.]+ m\b.*", "", found[2])
    return f"`{found[1]}` {' '.join(why.split())}".strip()


def _followed(made: Path, simulations: Simulations) -> str:
    """How far vehicles are from their lanes, and from where their speed takes them until they act."""
    told = tomllib.loads((made / "scenario.toml").read_text("utf-8"))
    net = sumolib.net.readNet(str(made / NET), withInternal=True)
    vehicles = [each for each in told.get("incidents", ()) if each["kind"] == "vehicle"]
    ways = {each["name"]: _way(net, each) for each in vehicles}
    scenario = open_scenario(made)
    traffic = simulations.warm(scenario).depart(EgoPlan(scenario.ego.trips[0], "average"))
    seen: dict[str, dict[int, Point]] = {}
    try:
        for at_s in range(1, SECONDS + 1):
            if not traffic.advance(1.0).states:
                break
            for each in traffic.look().vehicles:
                if ".scripted." in each.vehicle_id:
                    seen.setdefault(each.vehicle_id, {})[at_s] = Point(each.x_m, each.y_m)
    finally:
        traffic.close()
    if len(seen) != len(vehicles):
        return f"{len(vehicles)} others, of which {len(seen)} came"
    aside_m = along_m = 0.0
    for vehicle, places in zip(vehicles, (seen[each] for each in sorted(seen, key=_number)), strict=True):
        lines = ways[vehicle["name"]]
        acts_s = min((each["at_s"] for each in vehicle.get("actions", ())), default=SECONDS)
        for at_s, here in places.items():
            wanted_m = vehicle["position_m"] + vehicle["speed_kmh"] / KMH_PER_MPS * at_s
            aside_m = max(aside_m, min(line.distance(here) for line in lines))
            if at_s <= acts_s and wanted_m < lines[vehicle["lane"]].length:
                along_m = max(along_m, abs(lines[vehicle["lane"]].project(here) - wanted_m))
    return f"{len(vehicles)} others, at most {aside_m:.1f} m off their lanes, {along_m:.1f} m from their places"


def _number(vehicle: str) -> int:
    return int(vehicle.rpartition(".")[2])


def _way(net: Any, vehicle: dict[str, Any]) -> list[LineString]:
    """The lines of the lanes for cars of a vehicle's first edge, of the others, and within junctions."""
    edges = [*map(net.getEdge, vehicle["route"]), *(each for each in net.getEdges() if each.isSpecial())]
    lanes: Iterator[Any] = (lane for edge in edges for lane in edge.getLanes())
    return [LineString(lane.getShape()) for lane in lanes if lane.allows("passenger")]


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]) if len(sys.argv) > 2 else None)
