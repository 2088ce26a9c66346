"""The traffic of a recorded trial as a trajectory file of SSAM, FHWA's Surrogate Safety Assessment Model.

Version 1.04 of its binary format ("SSAM File Format Specification", September 2004, which comes with SSAM 3.0), in
little-endian order and metres. SSAM expects steps of a tenth of a second, and a trial is recorded once a second:
between two seconds a vehicle is on the cubic that has SUMO's places, speeds and headings at both, and one that was
seen at only one of them is missing. Records have no links, so that SSAM tells kinds of conflicts by their angles.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from itertools import pairwise
from math import ceil, cos, floor, pi, sin
from pathlib import Path

from automotive_cosim.contracts import SeenVehicle
from automotive_cosim.exchange.bodies import GAP_S, heading_rad
from automotive_cosim.exchange.recording import Recording
from automotive_cosim.formats.writing import write_whole

VERSION = 1.04
STEPS = 10
"""Of a second."""
METRIC, METRES_PER_UNIT = 1, 1.0
UNKNOWN_LINK = 0
FORMAT, DIMENSIONS, TIMESTEP, VEHICLE = "<BBf", "<BBf4i", "<Bf", "<B2iB8f"
"""The four kinds of records, numbered from 0: layouts of ``struct``, each with its number first."""

Placed = tuple[float, ...]
"""Front and rear bumper (x, y each), length, width, speed and acceleration."""


def write_trajectories(recording: Recording, target: Path) -> None:
    """Writes them; times count from the first recorded second, vehicles are numbered as they are first seen.

    Raises OSError: it cannot be written."""
    numbers: dict[str, int] = {}
    body, places = bytearray(), []
    for at_s, lines in _steps(recording):
        body += struct.pack(TIMESTEP, 2, at_s)
        for vehicle_id, line in lines.items():
            number = numbers.setdefault(vehicle_id, len(numbers) + 1)
            body += struct.pack(VEHICLE, 3, number, UNKNOWN_LINK, 0, *line)
            places += [line[0:2], line[2:4]]
    xs, ys = zip(*places, strict=True) if places else ((0.0,), (0.0,))
    around = floor(min(xs)) - 1, floor(min(ys)) - 1, ceil(max(xs)) + 1, ceil(max(ys)) + 1
    head = struct.pack(FORMAT, 0, ord("L"), VERSION) + struct.pack(DIMENSIONS, 1, METRIC, METRES_PER_UNIT, *around)
    write_whole(target, head + bytes(body))


def _steps(recording: Recording) -> Iterator[tuple[float, dict[str, Placed]]]:
    """Time and lines of each step; where the record has a gap, there are none."""
    seconds, begin_s = recording.road.seconds, recording.begin_s
    for now, then in pairwise(seconds):
        later = {each.vehicle_id: each for each in then.vehicles}
        span_s = then.at_s - now.at_s
        for step in range(STEPS if span_s <= GAP_S else 1):
            share = step / STEPS
            lines = {
                each.vehicle_id: _between(each, later.get(each.vehicle_id, each), share, span_s)
                for each in now.vehicles
                if step == 0 or each.vehicle_id in later
            }
            yield now.at_s - begin_s + share * span_s, lines
    last = seconds[-1]
    yield last.at_s - begin_s, {each.vehicle_id: _between(each, each, 0.0, 1.0) for each in last.vehicles}


def _between(now: SeenVehicle, then: SeenVehicle, share: float, span_s: float) -> Placed:
    """A vehicle at a share of the way from one second to the next."""
    begins, ends = heading_rad(now), heading_rad(then)
    away, leaves, arrives = (3 - 2 * share) * share**2, share * (1 - share) ** 2, share**2 * (share - 1)
    front = [
        at
        + away * (to - at)
        + span_s * (leaves * now.speed_mps * turn(begins) + arrives * then.speed_mps * turn(ends))
        for at, to, turn in ((now.x_m, then.x_m, cos), (now.y_m, then.y_m, sin))
    ]
    heading = begins + share * ((ends - begins + pi) % (2 * pi) - pi)
    rear = front[0] - now.length_m * cos(heading), front[1] - now.length_m * sin(heading)
    gain_mps = then.speed_mps - now.speed_mps
    return *front, *rear, now.length_m, now.width_m, now.speed_mps + share * gain_mps, gain_mps / span_s
