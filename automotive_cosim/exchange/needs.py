"""What formats need that may not be installed, so that it is told before any work."""

from __future__ import annotations

from contextlib import suppress
from importlib.util import find_spec

from automotive_cosim.errors import SetupError, UserError
from automotive_cosim.exchange.openscenario import VERSIONS
from automotive_cosim.exchange.osi import NEEDS as OSI
from automotive_cosim.exchange.trajectories import NEEDS as PARQUET
from automotive_cosim.traffic.sumo_programs import program


def check_formats(
    *, openscenario: str | None = None, opendrive: bool = False, osi: bool = False, parquet: bool = False
) -> None:
    """Checks that every format that is asked for can be written.

    Args:
        openscenario: the version of OpenSCENARIO XML, if it is asked for.
        opendrive: whether OpenDRIVE is.
        osi: whether OSI ground truth is.
        parquet: whether Parquet is.

    Raises:
        UserError: there is no such version.
        SetupError: something is not installed; a line for each.
    """
    if openscenario and openscenario not in VERSIONS:
        raise UserError(f"OpenSCENARIO {openscenario} cannot be written; give one of {', '.join(VERSIONS)}")
    lacking: list[str] = []
    if opendrive:
        try:
            program("netconvert")
        except SetupError as error:
            lacking.append(f"OpenDRIVE: {error}")
    if osi and not (_is_there("osi_utilities") and _is_there("osi3")):
        lacking.append(OSI)
    if parquet and not (_is_there("pandas") and _is_there("pyarrow")):
        lacking.append(PARQUET)
    if lacking:
        raise SetupError(*lacking)


def _is_there(package: str) -> bool:
    with suppress(ImportError, ValueError):
        return find_spec(package) is not None
    return False
