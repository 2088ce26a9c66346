"""Makes the geo-context: drive, last fix, weather and clock -> ``GeoContext``."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import datetime
from pathlib import Path

from automotive_cosim.contracts import DrivingState, GpsFix, Weather
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.place import Atlas, check_position, shipped


class Geo:
    """Makes contexts. It has no state of a drive, so branches share it.

    Args:
        folders: folders of the user's own rule files, which override the shipped ones."""

    def __init__(self, folders: Sequence[Path] = ()) -> None:
        self.atlas = Atlas(folders) if folders else shipped()

    def locate(
        self, driving: DrivingState, gps: GpsFix | None, weather: Weather | None, local_time: datetime
    ) -> GeoContext:
        """The geo-context here and now.

        Args:
            driving: source of road, traffic and motion; its position is not used.
            gps: source of the place, by its last fix; None leaves the place unknown.
            weather: None leaves it unknown.
            local_time: zone-aware.

        Raises UserError: not a position on earth."""
        if gps is not None:
            check_position(gps.lon_deg, gps.lat_deg)
        return GeoContext(driving, gps, weather, local_time, self.atlas)
