"""The traffic of a recorded trial as SUMO's FCD, CSV and Parquet: a line for each vehicle and second."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Iterator
from dataclasses import astuple, fields
from pathlib import Path
from typing import Any

from automotive_cosim.contracts import SeenVehicle
from automotive_cosim.errors import SetupError, install_hint
from automotive_cosim.exchange.recording import Recording
from automotive_cosim.formats.csvs import csv_text
from automotive_cosim.formats.writing import drafted, write_whole
from automotive_cosim.formats.xml import write_xml

NEEDS = f"Parquet needs pandas and pyarrow: {install_hint('reports')}"
COLUMNS = ("at_s", *(entry.name for entry in fields(SeenVehicle)))
"""Those of the tables; times are those of the record: 0 is the hand-over, or a drive's departure."""


def points(recording: Recording) -> Iterator[tuple[float, SeenVehicle]]:
    """Every vehicle at every recorded second, in order."""
    for second in recording.road.seconds:
        for each in second.vehicles:
            yield second.at_s, each


def _lines(recording: Recording) -> Iterator[tuple[object, ...]]:
    return ((at_s, *astuple(vehicle)) for at_s, vehicle in points(recording))


def write_csv(recording: Recording, target: Path) -> None:
    """Writes them as CSV, with a line of names."""
    write_whole(target, csv_text(COLUMNS, _lines(recording)))


def write_parquet(recording: Recording, target: Path) -> None:
    """Writes them as Parquet. Raises SetupError: the extra ``reports`` is not installed."""
    try:
        import pandas as pd
    except ImportError as error:
        raise SetupError(NEEDS) from error
    write_frame(pd.DataFrame(_lines(recording), columns=list(COLUMNS)), target)


def write_frame(frame: Any, target: Path) -> None:
    """Writes a data frame as Parquet. Raises SetupError: the extra ``reports`` is not installed."""
    try:
        with drafted(target) as file:
            frame.to_parquet(file, index=False)
    except ImportError as error:
        raise SetupError(NEEDS) from error


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
    write_xml(target, root)
