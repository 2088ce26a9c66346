"""A car on a road, and a facts, each with whatever a test changes."""

from collections.abc import Callable
from dataclasses import fields, replace
from datetime import datetime
from zoneinfo import ZoneInfo

import pytest

from automotive_cosim.contracts import (
    NO_LIMIT,
    Around,
    DrivingState,
    GpsFix,
    OtherVehicle,
    RoadAhead,
    RoadHere,
    Weather,
)
from automotive_cosim.geo.context import GeoContext
from automotive_cosim.geo.locate import Geo
from automotive_cosim.geo.rulefacts import RuleFacts

ROAD = RoadHere("e", "e_0", 0, 1, 10.0, "Avenue Foch", "primary", NO_LIMIT, False, None, None, None, 1.0)
CAR = DrivingState(
    time_s=0.0,
    x_m=0.0,
    y_m=0.0,
    lon_deg=2.285,
    lat_deg=48.873,
    heading_deg=90.0,
    speed_mps=20.0,
    acceleration_mps2=0.0,
    standing_s=0.0,
    distance_m=0.0,
    road=ROAD,
    ahead=RoadAhead(1000.0, 100.0, 0.0, 1.0, None, 0.0, None, None, None, None, None),
    around=Around(None, None, None, None, 1.0),
    hazard_lights=False,
    vehicle_count=1,
)
CLEAR = Weather(12.0, 70.0, 0.0, 0, 0.0, 20_000.0, 10.0)
NOON = datetime(2026, 10, 5, 12, 0, tzinfo=ZoneInfo("Europe/Paris"))
DAY = RuleFacts(
    local_time=NOON,
    lon_deg=2.285,
    lat_deg=48.873,
    street="",
    road_class="primary",
    motorway=False,
    dual_carriageway=False,
    expressway=False,
    built_up=False,
    lit=False,
    centre_line=True,
    lanes=1,
    tunnel=False,
    speed_kmh=72.0,
    standing=False,
    oncoming_m=None,
    leader_m=None,
    phenomena=frozenset(),
    visibility_m=20_000.0,
    after_sunset=False,
    trailer=False,
)


def _drive(**changes: object) -> DrivingState:
    """Changes of the state, of its road, or ``oncoming_m`` and ``leader_m``."""
    gaps = {name: changes.pop(f"{name}_m") for name in ("oncoming", "leader") if f"{name}_m" in changes}
    others = {name: OtherVehicle(name, float(gap), 10.0, None) for name, gap in gaps.items()}  # type: ignore[arg-type]
    on_road = {name: changes.pop(name) for name in [field.name for field in fields(RoadHere)] if name in changes}
    return replace(
        CAR,
        road=replace(ROAD, **on_road),  # type: ignore[arg-type]
        around=replace(CAR.around, **others),
        **changes,  # type: ignore[arg-type]
    )


@pytest.fixture(scope="session")
def drive() -> Callable[..., DrivingState]:
    return _drive


@pytest.fixture(scope="session")
def facts() -> Callable[..., RuleFacts]:
    return lambda **changes: replace(DAY, **changes)


@pytest.fixture(scope="session")
def geo() -> Geo:
    return Geo()


@pytest.fixture(scope="session")
def weather() -> Callable[..., Weather]:
    return lambda **changes: replace(CLEAR, **changes)


@pytest.fixture(scope="session")
def locate(geo: Geo) -> Callable[..., GeoContext]:
    """The context at a position, without receiver noise; ``weather``, ``time`` and ``drive``'s changes by name."""

    def at(
        lat: float, lon: float, weather: Weather | None = CLEAR, time: datetime = NOON, **changes: object
    ) -> GeoContext:
        fix = GpsFix(True, lon, lat, 3.0, 0.0, 90.0)
        return geo.locate(_drive(**changes), fix, weather, time)

    return at
