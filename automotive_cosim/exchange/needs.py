"""What formats need that may not be installed, so that it is told before any work."""

from __future__ import annotations

from contextlib import suppress
from importlib.util import find_spec

from automotive_cosim.errors import SetupError, UserError
from automotive_cosim.exchange.openscenario import VERSIONS
from automotive_cosim.exchange.osi import NEEDS as OSI
from automotive_cosim.exchange.settings import ExportFormats
from automotive_cosim.exchange.trajectories import NEEDS as PARQUET
from automotive_cosim.traffic.sumo_programs import program


def check_formats(formats: ExportFormats) -> None:
    """Checks that every format that is asked for can be written.

    Raises:
        UserError: there is no such version.
        SetupError: something is not installed; a line for each.
    """
    if formats.openscenario and formats.openscenario not in VERSIONS:
        raise UserError(f"OpenSCENARIO {formats.openscenario} cannot be written; give one of {', '.join(VERSIONS)}")
    lacking: list[str] = []
    if formats.opendrive:
        try:
            program("netconvert")
        except SetupError as error:
            lacking.append(f"OpenDRIVE: {error}")
    if formats.osi and not (_is_there("osi_utilities") and _is_there("osi3")):
        lacking.append(OSI)
    if formats.parquet and not (_is_there("pandas") and _is_there("pyarrow")):
        lacking.append(PARQUET)
    if lacking:
        raise SetupError(*lacking)


def _is_there(package: str) -> bool:
    with suppress(ImportError, ValueError):
        return find_spec(package) is not None
    return False
