"""What formats need that may not be installed, so that it is told before any work."""

from __future__ import annotations

from collections.abc import Collection
from contextlib import suppress
from importlib.util import find_spec

from automotive_cosim.errors import SetupError, UnknownNameError
from automotive_cosim.exchange.openscenario import VERSIONS
from automotive_cosim.exchange.osi import NEEDS as OSI
from automotive_cosim.exchange.trajectories import NEEDS as PARQUET
from automotive_cosim.traffic.sumo_programs import program

OPENSCENARIO = {f"openscenario-{version}": version for version in VERSIONS}
FORMATS = (*OPENSCENARIO, "opendrive", "osi", "ssam", "fcd", "csv", "parquet")
"""The words for the formats in which a kept trial can be written."""


def check_formats(formats: Collection[str]) -> None:
    """Checks that every format that is asked for can be written.

    Raises:
        UnknownNameError: there is no such format.
        SetupError: something is not installed; a line for each.
    """
    for name in formats:
        if name not in FORMATS:
            raise UnknownNameError("format", name, FORMATS)
    lacking: list[str] = []
    if "opendrive" in formats:
        try:
            program("netconvert")
        except SetupError as error:
            lacking.append(f"OpenDRIVE: {error}")
    if "osi" in formats and not (_is_there("osi_utilities") and _is_there("osi3")):
        lacking.append(OSI)
    if "parquet" in formats and not (_is_there("pandas") and _is_there("pyarrow")):
        lacking.append(PARQUET)
    if lacking:
        raise SetupError(*lacking)


def _is_there(package: str) -> bool:
    with suppress(ImportError, ValueError):
        return find_spec(package) is not None
    return False
