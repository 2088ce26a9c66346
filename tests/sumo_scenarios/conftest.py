"""Runs of the `sumo` binary on the shipped scenarios, kept for the session.

The scenarios are data, which cannot go wrong while nobody touches them: what is asked of their networks and of
their traffic is a proof (``proven``).
"""

import math
import xml.etree.ElementTree as ET
from collections import defaultdict
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import sumolib

from automotive_cosim import scenarios
from automotive_cosim.scenarios import Scenario
from automotive_cosim.traffic import sumo_programs

WARM_S, END_S = 900, 4500
"""Stability is asked of the hour after a quarter of an hour."""
RIDE_WITHIN_S = 1500


@dataclass(frozen=True)
class Ride:
    """One trip of the ego, an entry a second from its departure on."""

    edges: tuple[str, ...]
    speed_mps: tuple[float, ...]
    arrived: bool

    def seconds_on(self, *edges: str) -> int:
        """How long it was on those edges."""
        return sum(edge in edges for edge in self.edges)


@dataclass(frozen=True)
class Hour:
    """The result of an hour of traffic."""

    running: tuple[int, ...]
    """Vehicles on the road, one entry a second from ``WARM_S`` on."""
    halted: tuple[int, ...]
    teleports: int
    collisions: int
    speed_mps: dict[str, float]
    """Mean speed by edge."""
    rides: dict[str, Ride]

    @property
    def worst_halted(self) -> float:
        return max(h / r for h, r in zip(self.halted, self.running, strict=True))


def run_sumo(scenario: Scenario, seed: int, *options: str) -> str:
    """Runs `sumo` on the scenario's own configuration; returns what it complained of."""
    done, printed = sumo_programs.run("sumo", ["-c", scenario.config, "--seed", str(seed), *options])
    assert done, printed
    return printed


@pytest.fixture(scope="session")
def complaints(sumo: None, proof: None) -> Callable[..., str]:
    return run_sumo


@pytest.fixture(scope="session")
def net(proof: None) -> Callable[[str], Any]:
    """A scenario's network, as sumolib reads it."""

    @cache
    def of(name: str) -> Any:
        scenario = scenarios.load(name)
        file = ET.parse(scenario.config).getroot().find("input/net-file").get("value")  # type: ignore[union-attr]
        return sumolib.net.readNet(str(scenario.folder / str(file)))

    return of


@pytest.fixture(scope="session")
def metres() -> Callable[[tuple[float, float], tuple[float, float]], float]:
    """Distance between two places given as longitude and latitude, degrees."""

    def between(a: tuple[float, float], b: tuple[float, float]) -> float:
        east = (b[0] - a[0]) * 111_320 * math.cos(math.radians(a[1]))
        return math.hypot(east, (b[1] - a[1]) * 111_200)

    return between


@pytest.fixture(scope="session")
def lonlat(net: Callable[[str], Any]) -> Callable[[str, str], tuple[float, float]]:
    """Where a scenario's junction lies: longitude and latitude, degrees."""

    def of(name: str, junction: str) -> tuple[float, float]:
        x, y = net(name).getNode(junction).getCoord()
        lon_deg, lat_deg = net(name).convertXY2LonLat(x, y)
        return float(lon_deg), float(lat_deg)

    return of


@pytest.fixture(scope="session")
def hour(sumo: None, proof: None, tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Hour]:
    """A scenario's traffic for an hour, and in it every trip of the ego, driven at the limit or 130 km/h."""

    @cache
    def of(name: str) -> Hour:
        scenario = scenarios.load(name)
        folder = tmp_path_factory.mktemp(name)
        summary, statistic, edges, extra, egos, fcd, ends = (
            folder / f"{file}.xml" for file in ("summary", "statistic", "edges", "extra", "egos.rou", "fcd", "ends")
        )
        extra.write_text(
            f'<additional><edgeData id="e" file="{edges}" begin="{WARM_S}" end="{END_S}"/></additional>'
        )
        trips = "".join(
            f'<trip id="ego.{trip.name}" type="ego" depart="{scenario.sumo.warm_up_s}" from="{trip.from_edge}" '
            f'to="{trip.to_edge}"' + (f' via="{" ".join(trip.via)}"' if trip.via else "")
            + '><param key="has.rerouting.device" value="false"/></trip>'
            for trip in scenario.ego.trips
        )  # fmt: skip
        egos.write_text(f'<routes><vType id="ego" speedFactor="1" speedDev="0" maxSpeed="36"/>{trips}</routes>')
        known = ",".join(f"ego.{trip.name}" for trip in scenario.ego.trips)
        routes = ET.parse(scenario.config).getroot().find("input/route-files").get("value")  # type: ignore[union-attr]
        run_sumo(
            scenario, 5, "--route-files", f"{scenario.folder / str(routes)},{egos}", "--step-length", "1",
            "--end", str(END_S), "--summary-output", str(summary), "--statistic-output", str(statistic),
            "--additional-files", str(extra), "--device.fcd.explicit", known, "--fcd-output", str(fcd),
            "--device.tripinfo.explicit", known, "--tripinfo-output", str(ends),
        )  # fmt: skip
        arrived = {
            row.get("id")
            for row in ET.parse(ends).getroot().iter("tripinfo")
            if float(row.get("duration", 0)) <= RIDE_WITHIN_S
        }
        rows = defaultdict[str, list[ET.Element]](list)
        for row in ET.parse(fcd).getroot().iter("vehicle"):
            rows[row.get("id", "")].append(row)
        rides = {
            trip.name: _ride(rows[ego], ego in arrived)
            for trip in scenario.ego.trips
            for ego in (f"ego.{trip.name}",)
        }
        return _read(summary, statistic, edges, rides)

    return of


@pytest.fixture(scope="session")
def rides(hour: Callable[[str], Hour]) -> Callable[[str], dict[str, Ride]]:
    """Every trip of a scenario by its name."""
    return lambda name: hour(name).rides


def _ride(rows: Sequence[ET.Element], arrived: bool) -> Ride:
    edges = tuple(row.get("lane", "").rpartition("_")[0] for row in rows)
    return Ride(edges, tuple(float(row.get("speed", 0)) for row in rows), arrived)


def _read(summary: Path, statistic: Path, edges: Path, rides: dict[str, Ride]) -> Hour:
    steps = [s for s in ET.parse(summary).getroot() if float(s.get("time", 0)) >= WARM_S]
    totals = ET.parse(statistic).getroot()
    speeds = {e.get("id", ""): e.get("speed") for e in ET.parse(edges).getroot().iter("edge")}
    return Hour(
        tuple(int(s.get("running", 0)) for s in steps),
        tuple(int(s.get("halting", 0)) for s in steps),
        int(totals.find("teleports").get("total")),  # type: ignore[union-attr,arg-type]
        int(totals.find("safety").get("collisions")),  # type: ignore[union-attr,arg-type]
        {edge: float(speed) for edge, speed in speeds.items() if speed},
        rides,
    )
