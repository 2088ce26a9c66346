"""``automotive-cosim show context``: the geo-context anywhere on earth."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any
from zoneinfo import ZoneInfo

import typer
from annotated_types import Ge, Le

from automotive_cosim.cli.derived import filled, takes
from automotive_cosim.cli.options import print_json, tells_json
from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.formats.annotations import Option

if TYPE_CHECKING:
    from automotive_cosim.contracts import DrivingState, Json, Weather
    from automotive_cosim.geo.applied import AppliedRule
    from automotive_cosim.geo.context import GeoContext

FASTEST_KMH = 1000.0
"""No car is faster."""

OTHER_ROADS = frozenset(("service", "pedestrian", "track", "road", "busway"))
"""OSM highway values that networks may have in addition to those that an import keeps."""


@dataclass(frozen=True, slots=True)
class _ContextSettings:
    """What can be told about a car that is somewhere."""

    time: str = ""
    """ISO date and time, in the local zone unless it has one; now by default."""
    speed_kmh: Annotated[float, Ge(0), Le(FASTEST_KMH), Option("speed", form="KMH")] = 0.0
    """Speed of the car in km/h."""
    weather: Annotated[int | None, Option(form="CODE")] = None
    """WMO weather code as Open-Meteo uses it."""
    visibility_m: Annotated[float | None, Ge(0), Le(1e6), Option("visibility", form="M")] = None
    """Visibility in metres, instead of the usual one for the weather code."""
    online: bool = False
    """Ask Open-Meteo for the weather; if that fails, use the climate."""
    road: str = ""
    """OSM highway value, e.g. motorway, primary, residential."""


@tells_json
@takes(_ContextSettings)
def context(
    lat: Annotated[float, typer.Argument(help="Degrees north; negative is south.")],
    lon: Annotated[float, typer.Argument(help="Degrees east; negative is west.")],
    rules: Annotated[
        list[Path] | None, typer.Option(help="Folder with your own rule files, which override the shipped ones.")
    ] = None,
    as_json: bool = False,
    **settings: Any,
) -> None:
    """Print the traffic law, sky and climate at a place."""
    from automotive_cosim.contracts import GpsFix
    from automotive_cosim.geo.locate import Geo

    told = filled(_ContextSettings, settings)
    _check(told.road, rules or ())
    geo = Geo(rules or ())
    place = geo.atlas.place(lon, lat)
    local_time = _time(told.time, place.time_zone)
    found = geo.locate(
        _driving(told),
        GpsFix(has_fix=True, lon_deg=lon, lat_deg=lat, accuracy_m=0.0, age_s=0.0, heading_deg=0.0),
        _weather(told, lat, lon, local_time),
        local_time,
    )
    if as_json:
        print_json(_json(found))
    else:
        typer.echo(found.text())


def _check(road: str, folders: Sequence[Path]) -> None:
    from automotive_cosim.osm.extract import ROAD_CLASSES

    if road and road not in ROAD_CLASSES | OTHER_ROADS:
        raise UnknownNameError("road class", road, ROAD_CLASSES | OTHER_ROADS)
    for folder in folders:
        if folder.is_dir() and not any(folder.glob("*.toml")):
            raise UserError(f"--rules {folder} has no rule files; give a folder with files such as FR.toml")


def _time(text: str, zone_name: str) -> datetime:
    zone = ZoneInfo(zone_name)
    if not text:
        return datetime.now(zone)
    try:
        time = datetime.fromisoformat(text)
        # Through UTC and back: a clock time that summer time skips becomes the one an hour later.
        return time.replace(tzinfo=time.tzinfo or zone).astimezone(UTC).astimezone(zone)
    except (ValueError, OverflowError) as error:
        raise UserError(f"{text!r} is not a date and time; give one such as 2026-03-20T18:30") from error


def _weather(told: _ContextSettings, lat: float, lon: float, local_time: datetime) -> Weather | None:
    from automotive_cosim.geo.climate import climate_norm
    from automotive_cosim.geo.weather import typical_weather

    if told.online:
        return _report(told, lat, lon, local_time)
    if told.weather is None:
        if told.visibility_m is not None:
            raise UserError("--visibility requires --weather, e.g. --weather 45 for fog")
        return None
    norm = climate_norm(lon, lat, local_time.month)
    usual = (norm.temperature_c, norm.humidity_pct) if norm else ()
    found = typical_weather(told.weather, *usual)
    return found if told.visibility_m is None else replace(found, visibility=told.visibility_m)


def _report(told: _ContextSettings, lat: float, lon: float, local_time: datetime) -> Weather:
    from automotive_cosim.geo.forecast import Climate, OpenMeteo

    if told.weather is not None:
        raise UserError("--weather sets the weather; omit --online")
    report = OpenMeteo(Climate(0)).report(lon, lat, local_time)
    if report.note:
        typer.echo(report.note, err=True)
    return report.weather


def _driving(told: _ContextSettings) -> DrivingState:
    """A car alone on a road with one lane and no sign."""
    from automotive_cosim import contracts

    road = contracts.RoadHere(
        edge_id="",
        lane_id="",
        lane_index=0,
        lane_count=1,
        lane_position_m=0.0,
        name="",
        road_class=told.road,
        limit=contracts.NO_LIMIT,
        in_tunnel=False,
        lit=None,
        built_up=None,
        centre_line=None,
        friction=1.0,
    )
    return contracts.DrivingState(
        time_s=0.0,
        x_m=0.0,
        y_m=0.0,
        lon_deg=None,
        lat_deg=None,
        heading_deg=0.0,
        speed_mps=told.speed_kmh / contracts.KMH_PER_MPS,
        acceleration_mps2=0.0,
        standing_s=0.0,
        distance_m=0.0,
        road=road,
        ahead=contracts.RoadAhead(0.0, 0.0, 0.0, 1.0, None, 0.0, None, None, None, None, None),
        around=contracts.Around(None, None, None, None, 1.0),
        hazard_lights=False,
        vehicle_count=1,
    )


def _json(found: GeoContext) -> Json:
    place, sun = found.place, found.sun
    return {
        "country": place.country or None,
        "country_name": place.country_name or None,
        "region": place.region or None,
        "city": place.city or None,
        "time_zone": place.time_zone,
        "near_border_to": list(place.near_border_to),
        "driving_side": place.law.driving_side if place.law else None,
        "speed_unit": found.speed_unit,
        "emergency": list(place.law.emergency) if place.law else [],
        "local_time": found.local_time.isoformat(),
        "built_up": found.built_up,
        "built_up_source": found.built_up_source,
        "default_limits": _rules(found.default_limits),
        "reduced_limits": _rules(found.reduced_limits),
        "rules": _rules(found.rules),
        "sun": sun
        and {"elevation_deg": sun.elevation_deg, "azimuth_deg": sun.azimuth_deg, "darkness": sun.darkness.value},
        "weather": found.weather and asdict(found.weather),
        "climate": found.climate and asdict(found.climate),
        "lines": [{"text": line.text, "source": line.source} for line in found.shown],
    }


def _rules(found: Iterable[AppliedRule]) -> list[Json]:
    return [
        {
            "id": applied.rule.id,
            "topic": applied.rule.topic,
            "text": applied.rule.text,
            "value_now": applied.value,
            "certain": applied.certain,
            "unit": applied.rule.unit or None,
            "law": applied.rule.law,
            "as_of": applied.rule.as_of.isoformat(),
            "status": applied.rule.status.value,
        }
        for applied in found
    ]
