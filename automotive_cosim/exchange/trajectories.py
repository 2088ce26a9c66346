"""The traffic of a recorded trial as SUMO's FCD, CSV and Parquet: a line for each vehicle and second."""

from __future__ import annotations

import csv
import io
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import astuple, dataclass, fields
from pathlib import Path

from automotive_cosim.errors import SetupError
from automotive_cosim.exchange.recording import Recording
from automotive_cosim.run.record import write_whole


@dataclass(frozen=True, slots=True)
class TrajectoryPoint:
    """A vehicle at one instant. Times are those of the record: 0 is the hand-over, or a drive's departure."""

    at_s: float
    vehicle: str
    kind: str
    """SUMO's vehicle class."""
    length_m: float
    width_m: float
    x_m: float
    y_m: float
    """Middle of the front bumper, network coordinates."""
    heading_deg: float
    """Clockwise from north."""
    speed_mps: float
    signals: int
    """Bits of ``SumoSignal``."""


def points(recording: Recording) -> Iterator[TrajectoryPoint]:
    """Every vehicle at every recorded second, in order."""
    for second in recording.road.seconds:
        for each in second.vehicles:
            yield TrajectoryPoint(
                second.at_s, each.vehicle_id, each.kind, each.length_m, each.width_m,
                each.x_m, each.y_m, each.heading_deg, each.speed_mps, each.signals,
            )  # fmt: skip


def write_csv(recording: Recording, target: Path) -> None:
    """Writes them as CSV, with a line of names."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(entry.name for entry in fields(TrajectoryPoint))
    writer.writerows(astuple(each) for each in points(recording))
    write_whole(target, text.getvalue())


def write_parquet(recording: Recording, target: Path) -> None:
    """Writes them as Parquet.

    Raises:
        SetupError: the extra ``parquet`` is not installed.
    """
    names = [entry.name for entry in fields(TrajectoryPoint)]
    try:
        import pandas as pd

        frame = pd.DataFrame([astuple(each) for each in points(recording)], columns=names)
        frame.to_parquet(target, index=False)
    except ImportError as error:
        raise SetupError("Parquet needs pandas and pyarrow: pip install 'automotive-cosim[parquet]'") from error


def write_fcd(recording: Recording, target: Path) -> None:
    """Writes them as SUMO's floating car data; times count from the first recorded second."""
    root = ET.Element("fcd-export")
    for second in recording.road.seconds:
        step = ET.SubElement(root, "timestep", time=f"{second.at_s - recording.begin_s:.2f}")
        for each in second.vehicles:
            ET.SubElement(
                step, "vehicle", id=each.vehicle_id, x=f"{each.x_m:.2f}", y=f"{each.y_m:.2f}",
                angle=f"{each.heading_deg:.2f}", type=each.kind, speed=f"{each.speed_mps:.2f}",
                signals=str(each.signals),
            )  # fmt: skip
    ET.indent(root)
    ET.ElementTree(root).write(target, encoding="UTF-8", xml_declaration=True)
