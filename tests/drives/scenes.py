"""Moments without SUMO: a car in daylight on a dry road in France, with whatever a test changes."""

from collections.abc import Sequence
from dataclasses import fields, replace
from datetime import datetime, timedelta
from functools import cache
from typing import Any
from zoneinfo import ZoneInfo

from automotive_cosim.cockpit.signals import CATALOGUE, LIGHTS, LINK, MOTION
from automotive_cosim.contracts import (
    Around,
    Connectivity,
    DrivingState,
    GpsFix,
    Limit,
    LimitSource,
    OtherVehicle,
    RoadAhead,
    RoadHere,
    Sight,
    Weather,
)
from automotive_cosim.contracts.errand import Errand
from automotive_cosim.cosim.moment import Moment
from automotive_cosim.drives.events import KINDS, DriveEvent, Tracker
from automotive_cosim.geo.locate import Geo

ROAD = RoadHere(
    edge_id="a",
    lane_id="a_0",
    lane_index=0,
    lane_count=1,
    lane_position_m=10.0,
    name="Rue",
    road_class="secondary",
    limit=Limit(50 / 3.6, LimitSource.POSTED),
    in_tunnel=False,
    lit=False,
    built_up=False,
    centre_line=True,
    friction=1.0,
)
AHEAD = RoadAhead(
    route_left_m=8000.0,
    eta_s=400.0,
    delay_s=0.0,
    relative_speed=1.0,
    jam_distance_m=None,
    jam_length_m=0.0,
    next_light=None,
    next_limit=None,
    next_limit_distance_m=None,
    tunnel_distance_m=None,
    exit_distance_m=None,
)
AROUND = Around(None, None, None, None, 1.0)
CLEAR = Weather(15.0, 60.0, 0.0, 1, 20.0, 20_000.0, 10.0)
NOON = datetime(2026, 6, 9, 13, 0, tzinfo=ZoneInfo("Europe/Paris"))
UNDONE: dict[str, Any] = {"messages.sent": [], "calls.declined": [], "navigation.destination": ""}
SWITCHED = {"Vehicle.Powertrain.Range": 250_000.0, LIGHTS.LOW_BEAM.path: True, LIGHTS.SWITCH.path: "BEAM"}


@cache
def _geo() -> Geo:
    return Geo()


def limit(kmh: float) -> Limit:
    """A posted limit."""
    return Limit(kmh / 3.6, LimitSource.POSTED)


def vehicle(gap_m: float, kmh: float = 50.0, **changes: Any) -> OtherVehicle:
    """Another vehicle."""
    return OtherVehicle("v", gap_m, kmh / 3.6, **({"time_to_collision_s": None} | changes))


def moment(
    time_s: float = 0.0,
    kmh: float = 50.0,
    signals: dict[str, Any] | None = None,
    at: datetime = NOON,
    position: tuple[float, float] = (2.0, 48.3),
    sights: tuple[Sight, ...] = (),
    asked: tuple[Errand, ...] = (),
    done: dict[str, Any] | None = None,
    **changes: Any,
) -> Moment:
    """A moment, with what is commanded besides signals as ``done``.

    Other changes go to the field of road, ahead, around or weather that has that name.
    """
    parts = {}
    for name, whole in (("road", ROAD), ("ahead", AHEAD), ("around", AROUND), ("weather", CLEAR)):
        mine = {field.name for field in fields(whole)} & changes.keys()
        mine -= {"relative_speed"} if name == "ahead" else set()
        parts[name] = replace(whole, **{field: changes[field] for field in mine})
    known = {field.name for whole in (ROAD, AHEAD, AROUND, CLEAR) for field in fields(whole)}
    assert changes.keys() <= known, changes.keys() - known
    driving = DrivingState(
        time_s=time_s,
        x_m=0.0,
        y_m=0.0,
        lon_deg=position[0],
        lat_deg=position[1],
        heading_deg=90.0,
        speed_mps=kmh / 3.6,
        acceleration_mps2=0.0,
        standing_s=0.0,
        distance_m=0.0,
        road=parts["road"],
        ahead=parts["ahead"],
        around=parts["around"],
        hazard_lights=False,
        vehicle_count=1,
    )
    local_time = at + timedelta(seconds=time_s)
    gps = GpsFix(True, *position, 3.0, 0.0, 90.0)
    values = {path: signal.default for path, signal in CATALOGUE.items()}
    values |= SWITCHED | {LINK.ONLINE.path: True, MOTION.SPEED.path: kmh} | (signals or {})
    return Moment(
        time_s=time_s,
        local_time=local_time,
        driving=driving,
        passed=(driving,),
        events=(),
        weather=parts["weather"],
        gps=gps,
        connectivity=Connectivity(True, "5g", 4),
        context=_geo().locate(driving, gps, parts["weather"], local_time),
        signals=values,
        commands=values | UNDONE | (done or {}),
        sights=sights,
        asked=asked,
    )


def stream(seconds: float, before: Sequence[dict[str, Any]] = (), **scene: Any) -> list[Moment]:
    """The same scene, every second; before it others, for a second each."""
    earlier = [moment(float(second - len(before)), **other) for second, other in enumerate(before)]
    return earlier + [moment(float(second), **scene) for second in range(int(seconds) + 1)]


def found(drive: Sequence[Moment], kind: str | None = None) -> list[DriveEvent]:
    """The events on a drive, of one kind or of all."""
    tracker = Tracker(KINDS if kind is None else {kind: KINDS[kind]})
    for count in range(len(drive)):
        tracker.see(drive[: count + 1])
    return tracker.events
