"""Updates the car's signals, air, glass and battery from the surroundings, and reads what its sensors say."""

from __future__ import annotations

import math
from dataclasses import replace
from datetime import timedelta
from typing import Any

from automotive_cosim.cockpit.apps.settings.state import wifi
from automotive_cosim.cockpit.cabin import Air, Cabin
from automotive_cosim.cockpit.changes import CarChange, step
from automotive_cosim.cockpit.forecast import MINUTES, cabin_c
from automotive_cosim.cockpit.notices import TYRES
from automotive_cosim.cockpit.occupants import in_words
from automotive_cosim.cockpit.restrictions import Restriction
from automotive_cosim.cockpit.sensor_range import NEWS_EVERY_S, RADAR_M
from automotive_cosim.cockpit.signals import (
    ADAS,
    BODY,
    DRIVE,
    ENERGY,
    GLASS,
    HMI,
    HVAC,
    LIGHTS,
    LINK,
    MEDIA,
    MOTION,
    OUTSIDE,
    SEAT,
    LeafKind,
    Signal,
    named,
)
from automotive_cosim.cockpit.sky import feel
from automotive_cosim.cockpit.state import State
from automotive_cosim.cockpit.telltales import RoadSign, SignKind
from automotive_cosim.cockpit.theme import Icon
from automotive_cosim.cockpit.tyres import Tyres
from automotive_cosim.cockpit.vehicle import DARK_BELOW_DEG, SEAT_W
from automotive_cosim.contracts import KMH_PER_MPS, DrivingState, OtherVehicle, Surroundings, VehicleState, Weather

SEAT_LOSS_W_K = 3.0
"""Heat transfer to the cabin and the driver: 20 K at full power; an assumption."""
SEAT_CAPACITY_J_K = 540.0
"""Cover and heating mat of seat and back: warm within three minutes (a time constant); an assumption."""
VENTILATION_K = 4.0
"""Cooling by full ventilation of a seat at cabin temperature: an assumption."""
WHITE_CD_M2, BLACK_CD_M2 = 1000.0, 1.0
"""Luminance of a car's display at full brightness, and of its black."""
SUN_LUX = 100_000.0
"""Illuminance of direct sun and sky at full daylight."""
SHADED = 0.1
"""Share of the daylight that falls on the display under the roof: an assumption."""
REFLECTANCE = 0.01
"""Reflectance of an anti-glare cover glass, taken as diffuse."""


def seat_after(temperature_c: float, dt_s: float, cabin_c: float, level_pct: float) -> float:
    """Surface temperature of a seat after some seconds; a negative level ventilates."""
    if level_pct >= 0:
        settled_c = cabin_c + SEAT_W * level_pct / 100 / SEAT_LOSS_W_K
    else:
        settled_c = cabin_c + VENTILATION_K * level_pct / 100
    left = math.exp(-dt_s * SEAT_LOSS_W_K / SEAT_CAPACITY_J_K)
    return settled_c + (temperature_c - settled_c) * left


def display_contrast(brightness_pct: float, light_pct: float) -> float:
    """Visible contrast of the display at a share of full daylight outside."""
    glare = SUN_LUX * SHADED * light_pct / 100 * REFLECTANCE / math.pi
    white = max(BLACK_CD_M2, WHITE_CD_M2 * brightness_pct / 100)
    return (white + glare) / (BLACK_CD_M2 + glare)


MOVING_MPS = 0.1
RAIN_FULL_MM_H = 10.0
"""Heavy rain (WMO: 10 mm/h and more is heavy) covers the rain sensor."""


def sense(state: State, surroundings: Surroundings, dt_s: float) -> None:
    """Lets ``dt_s`` seconds pass in these surroundings, which become the present ones."""
    before, state.outside = state.outside, surroundings
    driving, weather = surroundings.driving, surroundings.weather
    _motion(state, surroundings)
    _park(state, surroundings)
    online = bool(state.injected.get(LINK.ONLINE.path, state.signals[LINK.ONLINE]))
    if online:
        state.heard = surroundings
    if state.lookout and online and (state.news is None or driving.time_s - state.news.time_s >= NEWS_EVERY_S):
        state.news = driving
    _road(state, surroundings)
    sun = surroundings.sun_elevation_deg
    state.vehicle.follow_light(driving.road.in_tunnel or (sun is not None and sun < DARK_BELOW_DEG))
    feel(state.signals, surroundings, state.lookout)
    _climate(state, driving, weather, dt_s)
    _bodies(state, weather.temperature_2m, dt_s)
    if before is None:
        state.departed_s = driving.time_s
    for data in state.apps:
        data.passed(state, before, dt_s)
    _change(state, dt_s)
    for data in state.apps:
        data.received(state)
    state.signals[DRIVE.HORN] = False
    if Restriction.NO_KEYBOARD in state.restrictions:
        state.focus = ""


def _motion(state: State, surroundings: Surroundings) -> None:
    signals, driving, gps = state.signals, surroundings.driving, surroundings.gps
    moving = driving.speed_mps > MOVING_MPS
    signals[MOTION.SPEED] = max(0.0, driving.speed_mps * KMH_PER_MPS)
    signals[MOTION.IS_MOVING] = moving
    if moving:
        signals[MOTION.GEAR] = "D"
    signals[MOTION.HEADING] = driving.heading_deg % 360
    signals[MOTION.LATITUDE] = None if gps is None else gps.lat_deg
    signals[MOTION.LONGITUDE] = None if gps is None else gps.lon_deg
    linked = signals[LINK.MOBILE_DATA] or bool(wifi(state))
    signals[LINK.ONLINE] = surroundings.connectivity.online and linked


def _park(state: State, surroundings: Surroundings) -> None:
    """Puts the car in park, and in gear again, as the driver does on the way."""
    if surroundings.parked == (state.parked_s is not None):
        return
    state.parked_s = surroundings.driving.time_s if surroundings.parked else None
    state.signals[MOTION.GEAR] = "P" if surroundings.parked else "D"
    state.signals[DRIVE.PARKING_BRAKE] = surroundings.parked


def _road(state: State, surroundings: Surroundings) -> None:
    signals, driving = state.signals, surroundings.driving
    road = driving.road
    limit = road.limit.posted_mps
    seen_kmh = round(limit * KMH_PER_MPS, 1) if state.sign_camera and limit is not None else None
    signals[ADAS.LIMIT_SIGN] = state.injected.get(ADAS.LIMIT_SIGN.path, seen_kmh)
    if state.sign_camera:
        _read_sign(state, surroundings)
    leader = _in_sight(driving.around.leader)
    signals[ADAS.LEADER_DISTANCE] = None if leader is None else leader.gap_m
    signals[ADAS.LEADER_TIME_TO_COLLISION] = None if leader is None else leader.time_to_collision_s


def _read_sign(state: State, surroundings: Surroundings) -> None:
    """Notes the sign at which tunnel, school zone or limit changed."""
    road, limit_kmh = surroundings.driving.road, state.signals[ADAS.LIMIT_SIGN]
    was_in_tunnel, was_at_school, was_kmh = state.signs_here or (False, False, None)
    if road.in_tunnel and not was_in_tunnel:
        state.last_sign = RoadSign(SignKind.TUNNEL)
    elif road.school_zone and not was_at_school:
        state.last_sign = RoadSign(SignKind.SCHOOL)
    elif limit_kmh is not None and limit_kmh != was_kmh:
        state.last_sign = RoadSign(SignKind.LIMIT, limit_kmh, surroundings.sign_unit, surroundings.sign_country)
    elif limit_kmh is None and was_kmh is not None:
        state.last_sign = RoadSign(SignKind.END_OF_LIMIT)
    state.signs_here = road.in_tunnel, bool(road.school_zone), limit_kmh


def _in_sight(leader: OtherVehicle | None) -> OtherVehicle | None:
    return leader if leader is not None and leader.gap_m <= RADAR_M else None


def _bodies(state: State, air_c: float, dt_s: float) -> None:
    """Updates tyres, seats and the display for the present air and light."""
    signals = state.signals
    if state.tyres is None:
        cold = Tyres(tuple(signals[tyre] for tyre in TYRES), air_c)
        state.tyres, cabin_c = cold, signals[HVAC.CABIN_TEMPERATURE]
        signals[SEAT.DRIVER_TEMPERATURE] = signals[SEAT.PASSENGER_TEMPERATURE] = cabin_c
    state.tyres = state.tyres.after(dt_s, air_c, signals[MOTION.SPEED])
    for tyre, pressure_kpa in zip(TYRES, state.tyres.pressures_kpa, strict=True):
        signals[tyre] = min(tyre.high, pressure_kpa)
    for seat, level in (
        (SEAT.DRIVER_TEMPERATURE, SEAT.DRIVER_HEATING),
        (SEAT.PASSENGER_TEMPERATURE, SEAT.PASSENGER_HEATING),
    ):
        signals[seat] = seat_after(signals[seat], dt_s, signals[HVAC.CABIN_TEMPERATURE], signals[level])
    signals[HMI.CONTRAST] = display_contrast(signals[HMI.BRIGHTNESS], signals[OUTSIDE.LIGHT])


def _climate(state: State, driving: DrivingState, weather: Weather, dt_s: float) -> None:
    signals = state.signals
    rain = 0.0 if driving.road.in_tunnel else weather.precipitation
    air = Air(
        weather.temperature_2m, weather.relative_humidity_2m, rain, driving.speed_mps, signals[OUTSIDE.FINE_DUST]
    )
    cabin = state.cabin or Cabin.at(state.cabin_start, air)
    state.cabin = cabin.after(dt_s, state.vehicle.controls(rain), air)
    state.vehicle.use_energy(dt_s, air, state.cabin.temperature_c)
    signals[OUTSIDE.TEMPERATURE] = weather.temperature_2m
    signals[OUTSIDE.HUMIDITY] = weather.relative_humidity_2m
    signals[BODY.RAIN_INTENSITY] = min(100.0, 100 * rain / RAIN_FULL_MM_H)
    signals[HVAC.CABIN_TEMPERATURE] = state.cabin.temperature_c
    signals[HVAC.CABIN_HUMIDITY] = state.cabin.humidity_pct
    signals[HVAC.CABIN_FINE_DUST] = state.cabin.fine_dust
    signals[HVAC.FORECAST] = cabin_c(state.vehicle, MINUTES, climate=signals[HVAC.KEPT])
    signals[GLASS.WINDSHIELD_FOG] = state.cabin.windshield.fog_inside
    signals[GLASS.WINDSHIELD_FILM] = state.cabin.windshield.film_outside
    signals[GLASS.REAR_FOG] = state.cabin.rear_window.fog_inside
    signals[GLASS.REAR_FILM] = state.cabin.rear_window.film_outside


def _change(state: State, dt_s: float) -> None:
    """Makes the changes that are due."""
    going_on = []
    for change in state.changes:
        begun_s = state.parked_s if change.once_parked else state.departed_s
        if begun_s is None:
            going_on.append(change)
            continue
        since_s = round(state.time_s - begun_s - change.at_s, 6)
        is_moving = state.outside is not None and state.outside.driving.speed_mps >= MOVING_MPS
        if change.once_standing and since_s >= 0 and is_moving:
            going_on.append(change)
            continue
        if since_s >= 0:
            _make(state, change, since_s, dt_s)
        if since_s < change.over_s:
            going_on.append(change)
    state.changes = tuple(going_on)


def _make(state: State, change: CarChange, since_s: float, dt_s: float) -> None:
    """Turns a switch as from inside the car, even one that is locked while driving; sets what is measured."""
    signal, signals = named(change.path), state.signals
    if signal in TYRES and state.tyres is not None:
        state.tyres = state.tyres.changed(TYRES.index(signal), lambda cold: step(change, cold, since_s, dt_s))
    else:
        value = step(change, signals[signal], since_s, dt_s)
        if signal.kind is not LeafKind.ACTUATOR or state.vehicle.command(signal, value):
            signals[signal] = signal.check(value)


def readings(state: State) -> VehicleState:
    """The present readings."""
    now = state.signals
    return VehicleState(
        speed_kmh=now[MOTION.SPEED],
        gear=now[MOTION.GEAR],
        restrictions=int(state.restrictions),
        ambient_temperature_c=now[OUTSIDE.TEMPERATURE],
        cabin_temperature_c=now[HVAC.CABIN_TEMPERATURE],
        cabin_humidity_pct=now[HVAC.CABIN_HUMIDITY],
        rain_intensity_pct=now[BODY.RAIN_INTENSITY],
        driver_temperature_set_c=now[HVAC.DRIVER_TEMPERATURE],
        fan_speed_pct=now[HVAC.FAN_SPEED],
        is_low_beam_on=now[LIGHTS.LOW_BEAM],
        is_high_beam_on=now[LIGHTS.HIGH_BEAM],
        is_front_fog_on=now[LIGHTS.FRONT_FOG],
        is_rear_fog_on=now[LIGHTS.REAR_FOG],
        is_hazard_on=now[LIGHTS.HAZARD],
        energy_level_pct=now[ENERGY.LEVEL],
        range_km=now[ENERGY.RANGE] / 1000,
        speed_limit_sign_kmh=now[ADAS.LIMIT_SIGN],
        leader_gap_m=now[ADAS.LEADER_DISTANCE],
        leader_time_to_collision_s=now[ADAS.LEADER_TIME_TO_COLLISION],
        aboard=in_words(now),
    )


USED: tuple[Signal[Any], ...] = (ENERGY.LEVEL, ENERGY.RANGE, MEDIA.PLAYED, MEDIA.TRACK, MEDIA.ARTIST)
BODIES: tuple[Signal[Any], ...] = (*TYRES, SEAT.DRIVER_TEMPERATURE, SEAT.PASSENGER_TEMPERATURE)


def put_back(state: State, departed: State, surroundings: Surroundings, way: timedelta, *, with_air: bool) -> None:
    """Puts a state back and senses the surroundings anew.

    Args:
        state: changed in place.
        departed: the same cockpit's at departure.
        surroundings: the present ones, at the departure's time of day.
        with_air: whether air, glass, seats and tyres are put back too."""
    for signal in (*USED, *(BODIES if with_air else ())):
        state.signals[signal] = departed.signals[signal]
    if with_air:
        state.cabin, state.tyres = departed.cabin, departed.tyres
    departed_s, state.outside = state.departed_s, None  # the trip computer starts anew
    if state.heard is not None:
        state.heard = replace(state.heard, local_time=state.heard.local_time - way)
    sense(state, surroundings, 0.0)
    state.departed_s = departed_s  # what is still to arrive arrives when it would have
    for data in state.apps:
        data.put_back(state, departed)
    state.notices = tuple(
        replace(notice, clock=state.clock) for notice in state.notices if notice.icon is not Icon.CALL_MISSED
    )
