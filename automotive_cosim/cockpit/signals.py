"""The car's signals: typed constants under COVESA VSS paths, and the store that holds their values.

    signals[HVAC.FAN_SPEED] = 60.0        # checked: type, range, allowed values
    signals[LIGHTS.HIGH_BEAM]             # bool, to a type checker too

Paths, kinds, units and allowed values are those of the Vehicle Signal Specification, release 6.0 of January 2026
(https://github.com/COVESA/vehicle_signal_specification), but ``MassageLevel`` and ``IsOccupied``, names of its
release 5.1; ranges are narrowed to what this car's switches offer. These differ: child locks, the sunroof and the
language are sensors in VSS, here switches as well; the horn is an actuator there; ambient light may be 0, which is
off. What VSS lacks has paths in its manner.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from math import inf
from operator import is_, itemgetter
from typing import Any, Generic, TypeVar, cast

from automotive_cosim.errors import SignalError, UnknownNameError

T = TypeVar("T")


class LeafKind(StrEnum):
    """Kinds of leaves in VSS."""

    ACTUATOR = "actuator"
    """Can be commanded."""
    SENSOR = "sensor"
    """Is measured."""


@dataclass(frozen=True, slots=True)
class Signal(Generic[T]):
    """One leaf of the tree: its path and valid values."""

    path: str
    kind: LeafKind
    default: T
    unit: str = ""
    """Unit as in VSS."""
    minimum: float | None = None
    maximum: float | None = None
    step: float = 1.0
    """Change per press of a button; any value in the range is valid."""
    allowed: tuple[T, ...] = ()
    optional: bool = False
    """Whether it may be None because there is nothing to measure."""
    _floats: tuple[float, float] = field(init=False, repr=False, compare=False)
    """Between which floats are valid; none are between infinity and its negative."""

    def __post_init__(self) -> None:
        least, most = self.minimum, self.maximum
        takes_any = (self.optional or type(self.default) is float) and not self.allowed
        floats = (-inf if least is None else least, inf if most is None else most) if takes_any else (inf, -inf)
        object.__setattr__(self, "_floats", floats)

    def __str__(self) -> str:
        return self.path

    def __hash__(self) -> int:
        """Hash of the unique path: widgets and messages with signals are hashed on every step."""
        return hash(self.path)

    @property
    def low(self) -> float:
        """The smallest valid number."""
        return 0.0 if self.minimum is None else self.minimum

    @property
    def high(self) -> float:
        """The largest valid number."""
        return 0.0 if self.maximum is None else self.maximum

    def check(self, value: Any) -> T:
        """The value to store; an int becomes a float if floats are expected.

        Raises SignalError: wrong type, out of range or not among the allowed values."""
        valid: T = value
        if type(value) is float and self._floats[0] <= value <= self._floats[1]:  # as most are
            return valid
        if value is None and self.optional:
            return valid
        expected = float if self.optional else type(self.default)
        if expected is float and type(value) is int:
            value = float(value)
        if type(value) is not expected or value != value:
            raise SignalError(f"{self.path} is {value!r}; it must be {_article(expected.__name__)} ({self.range})")
        too_low = self.minimum is not None and isinstance(value, float) and value < self.minimum
        too_high = self.maximum is not None and isinstance(value, float) and value > self.maximum
        if too_low or too_high or (self.allowed and value not in self.allowed):
            raise SignalError(f"{self.path} is {value!r}; it must be {self.range}")
        return cast(T, value)

    @property
    def range(self) -> str:
        """The valid values, in words."""
        if self.allowed:
            return "one of " + ", ".join(str(value) for value in self.allowed)
        if isinstance(self.default, bool):
            return "true or false"
        if self.minimum is None and self.maximum is None:
            return "any" + (" or nothing" if self.optional else "")
        unit = f" {self.unit}" if self.unit else ""
        return f"{_number(self.minimum)} to {_number(self.maximum)}{unit}" + (
            " or nothing" if self.optional else ""
        )


def _number(value: float | None) -> str:
    return "any" if value is None else f"{value:g}"


def _article(noun: str) -> str:
    return f"an {noun}" if noun[0] in "aeiou" else f"a {noun}"


CATALOGUE: dict[str, Signal[Any]] = {}
"""Every signal by its path."""


def _enter(signal: Signal[T]) -> Signal[T]:
    if signal.path in CATALOGUE:
        raise ValueError(f"signal {signal.path!r} occurs twice in the catalogue")
    signal.check(signal.default)
    CATALOGUE[signal.path] = signal
    return signal


def _switch(path: str, default: bool = False) -> Signal[bool]:
    return _enter(Signal(f"Vehicle.{path}", LeafKind.ACTUATOR, default))


def _is(path: str, default: bool = False) -> Signal[bool]:
    return _enter(Signal(f"Vehicle.{path}", LeafKind.SENSOR, default))


def _choice(path: str, default: str, allowed: str) -> Signal[str]:
    return _enter(Signal(f"Vehicle.{path}", LeafKind.ACTUATOR, default, allowed=tuple(allowed.split())))


def _set(path: str, default: float, unit: str, low: float, high: float, step: float = 1.0) -> Signal[float]:
    return _enter(Signal(f"Vehicle.{path}", LeafKind.ACTUATOR, default, unit, low, high, step))


def _measure(path: str, default: float, unit: str, low: float | None, high: float | None) -> Signal[float]:
    return _enter(Signal(f"Vehicle.{path}", LeafKind.SENSOR, default, unit, low, high))


def _maybe(path: str, unit: str, low: float, high: float | None) -> Signal[float | None]:
    signal: Signal[float | None] = Signal(f"Vehicle.{path}", LeafKind.SENSOR, None, unit, low, high, optional=True)
    return _enter(signal)


def _text(path: str) -> Signal[str]:
    return _enter(Signal(f"Vehicle.{path}", LeafKind.SENSOR, ""))


class HVAC:
    """Heating, ventilation and air conditioning. One blower and one air flap serve both front seats."""

    DRIVER_TEMPERATURE = _set("Cabin.HVAC.Station.Row1.Driver.Temperature", 21.0, "Celsius", 16, 28, 0.5)
    PASSENGER_TEMPERATURE = _set("Cabin.HVAC.Station.Row1.Passenger.Temperature", 21.0, "Celsius", 16, 28, 0.5)
    FAN_SPEED = _set("Cabin.HVAC.Station.Row1.Driver.FanSpeed", 30.0, "percent", 0, 100, 10)
    AIR_DISTRIBUTION = _choice("Cabin.HVAC.Station.Row1.Driver.AirDistribution", "MIDDLE", "UP MIDDLE DOWN")
    AIR_CONDITIONING = _switch("Cabin.HVAC.IsAirConditioningActive")
    RECIRCULATION = _switch("Cabin.HVAC.IsRecirculationActive")
    FRONT_DEFROSTER = _switch("Cabin.HVAC.IsFrontDefrosterActive")
    REAR_DEFROSTER = _switch("Cabin.HVAC.IsRearDefrosterActive")
    AUTO = _switch("Cabin.HVAC.IsAutoActive")
    SYNC = _switch("Cabin.HVAC.IsSyncActive", True)
    MAX_COOLING = _switch("Cabin.HVAC.IsMaxAirConditioningActive")
    MAX_DEFROST = _switch("Cabin.HVAC.IsMaxDefrostActive")
    PURIFIER = _switch("Cabin.HVAC.IsAirPurifierActive")
    CABIN_TEMPERATURE = _measure("Cabin.HVAC.AmbientAirTemperature", 21.0, "Celsius", -60, 90)
    CABIN_HUMIDITY = _measure("Cabin.HVAC.AmbientAirHumidity", 45.0, "percent", 0, 100)
    CABIN_FINE_DUST = _measure("Cabin.HVAC.AmbientAirFineDust", 4.0, "ug/m^3", 0, 2000)
    KEPT = _switch("Cabin.HVAC.IsKeptAfterParking")
    """Whether the climate control goes on for those who stay in the parked car."""
    FORECAST = _measure("Cabin.HVAC.ForecastTemperature", 21.0, "Celsius", -60, 120)
    """The air 20 minutes after the driver has left the car, as everything is set now (``forecast``)."""


class SEAT:
    """Warmth (negative is ventilation), position and massage. Positions count from the front, low and upright."""

    DRIVER_HEATING = _set("Cabin.Seat.Row1.DriverSide.Seating.HeatingCooling", 0.0, "percent", -100, 100, 50)
    PASSENGER_HEATING = _set("Cabin.Seat.Row1.PassengerSide.Seating.HeatingCooling", 0.0, "percent", -100, 100, 50)
    REAR_LEFT_HEATING = _set("Cabin.Seat.Row2.DriverSide.Seating.HeatingCooling", 0.0, "percent", 0, 100, 50)
    REAR_RIGHT_HEATING = _set("Cabin.Seat.Row2.PassengerSide.Seating.HeatingCooling", 0.0, "percent", 0, 100, 50)
    STEERING_WHEEL_HEATING = _set("Chassis.SteeringWheel.HeatingCooling", 0.0, "percent", -100, 100, 100)
    DRIVER_POSITION = _set("Cabin.Seat.Row1.DriverSide.Position", 140.0, "mm", 0, 260, 10)
    DRIVER_HEIGHT = _set("Cabin.Seat.Row1.DriverSide.Height", 30.0, "mm", 0, 80, 5)
    DRIVER_RECLINE = _set("Cabin.Seat.Row1.DriverSide.Backrest.Recline", 22.0, "degrees", 0, 60, 2)
    DRIVER_LUMBAR = _set("Cabin.Seat.Row1.DriverSide.Backrest.LumbarSupport", 30.0, "percent", 0, 100, 10)
    DRIVER_MASSAGE = _set("Cabin.Seat.Row1.DriverSide.MassageLevel", 0.0, "percent", 0, 100, 50)
    PASSENGER_POSITION = _set("Cabin.Seat.Row1.PassengerSide.Position", 160.0, "mm", 0, 260, 10)
    PASSENGER_HEIGHT = _set("Cabin.Seat.Row1.PassengerSide.Height", 20.0, "mm", 0, 80, 5)
    PASSENGER_RECLINE = _set("Cabin.Seat.Row1.PassengerSide.Backrest.Recline", 24.0, "degrees", 0, 60, 2)
    PASSENGER_LUMBAR = _set("Cabin.Seat.Row1.PassengerSide.Backrest.LumbarSupport", 30.0, "percent", 0, 100, 10)
    PASSENGER_MASSAGE = _set("Cabin.Seat.Row1.PassengerSide.MassageLevel", 0.0, "percent", 0, 100, 50)
    DRIVER_TEMPERATURE = _measure("Cabin.Seat.Row1.DriverSide.SurfaceTemperature", 21.0, "Celsius", -60, 120)
    PASSENGER_TEMPERATURE = _measure("Cabin.Seat.Row1.PassengerSide.SurfaceTemperature", 21.0, "Celsius", -60, 120)
    DRIVER_BELT = _is("Cabin.Seat.Row1.DriverSide.IsBelted", True)
    PASSENGER_BELT = _is("Cabin.Seat.Row1.PassengerSide.IsBelted")
    REAR_LEFT_BELT = _is("Cabin.Seat.Row2.DriverSide.IsBelted")
    REAR_MIDDLE_BELT = _is("Cabin.Seat.Row2.Middle.IsBelted")
    REAR_RIGHT_BELT = _is("Cabin.Seat.Row2.PassengerSide.IsBelted")
    BELT_REMINDER = _switch("Cabin.Seat.IsBeltReminderSounding", True)
    PASSENGER_AIRBAG = _switch("Cabin.Seat.Row1.PassengerSide.Airbag.IsSwitchedOn", True)
    """VSS has a sensor, ``IsEnabled``; this is the switch behind it."""


@dataclass(frozen=True, slots=True)
class Seated:
    """The signals of one seat's occupant."""

    occupied: Signal[bool]
    belted: Signal[bool]
    kind: Signal[str]
    """``NONE`` or a kind of occupant (``aboard.Kind``), in capitals."""
    asleep: Signal[bool]
    weight: Signal[float]


def _seated(seat: str, belted: Signal[bool], kind: str = "NONE", weight_kg: float = 0.0) -> Seated:
    """VSS knows that a seat is occupied and belted; who it is, an interior camera and the seat's mat tell."""
    return Seated(
        _is(f"Cabin.Seat.{seat}.IsOccupied", kind != "NONE"),
        belted,
        _enter(
            Signal(
                f"Vehicle.Occupant.{seat}.Class",
                LeafKind.SENSOR,
                kind,
                allowed=("NONE", "ADULT", "ELDERLY", "CHILD", "BABY", "PET", "OBJECT"),
            )
        ),
        _is(f"Occupant.{seat}.IsAsleep"),
        _measure(f"Occupant.{seat}.Weight", weight_kg, "kg", 0, 200),
    )


class OCCUPANT:
    """Who sits where. The driver is there by default."""

    DRIVER = _seated("Row1.DriverSide", SEAT.DRIVER_BELT, "ADULT", 75.0)
    PASSENGER = _seated("Row1.PassengerSide", SEAT.PASSENGER_BELT)
    REAR_LEFT = _seated("Row2.DriverSide", SEAT.REAR_LEFT_BELT)
    REAR_MIDDLE = _seated("Row2.Middle", SEAT.REAR_MIDDLE_BELT)
    REAR_RIGHT = _seated("Row2.PassengerSide", SEAT.REAR_RIGHT_BELT)


class CABIN:
    """Doors, windows, roof, mirrors and the light inside."""

    DRIVER_LOCK = _switch("Cabin.Door.Row1.DriverSide.IsLocked", True)
    PASSENGER_LOCK = _switch("Cabin.Door.Row1.PassengerSide.IsLocked", True)
    REAR_LEFT_LOCK = _switch("Cabin.Door.Row2.DriverSide.IsLocked", True)
    REAR_RIGHT_LOCK = _switch("Cabin.Door.Row2.PassengerSide.IsLocked", True)
    LEFT_CHILD_LOCK = _switch("Cabin.Door.Row2.DriverSide.IsChildLockActive")
    RIGHT_CHILD_LOCK = _switch("Cabin.Door.Row2.PassengerSide.IsChildLockActive")
    WINDOW_LOCK = _switch("Cabin.IsWindowChildLockEngaged")
    DRIVER_WINDOW = _set("Cabin.Door.Row1.DriverSide.Window.Position", 0.0, "percent", 0, 100, 10)
    PASSENGER_WINDOW = _set("Cabin.Door.Row1.PassengerSide.Window.Position", 0.0, "percent", 0, 100, 10)
    REAR_LEFT_WINDOW = _set("Cabin.Door.Row2.DriverSide.Window.Position", 0.0, "percent", 0, 100, 10)
    REAR_RIGHT_WINDOW = _set("Cabin.Door.Row2.PassengerSide.Window.Position", 0.0, "percent", 0, 100, 10)
    SUNROOF = _set("Cabin.Sunroof.Position", 0.0, "percent", 0, 100, 10)
    SUNROOF_SHADE = _set("Cabin.Sunroof.Shade.Position", 100.0, "percent", 0, 100, 10)
    """VSS: 0 is retracted, 100 covers the roof."""
    TRUNK = _switch("Body.Trunk.Rear.IsOpen")
    DOME_LIGHT = _switch("Cabin.Light.IsDomeOn")
    DRIVER_READING_LIGHT = _switch("Cabin.Light.Spotlight.Row1.DriverSide.IsLightOn")
    PASSENGER_READING_LIGHT = _switch("Cabin.Light.Spotlight.Row1.PassengerSide.IsLightOn")
    AMBIENT_LIGHT = _set("Cabin.Light.AmbientLight.Row1.DriverSide.Intensity", 30.0, "percent", 0, 100, 10)
    AMBIENT_COLOUR = _choice(
        "Cabin.Light.AmbientLight.Row1.DriverSide.Color", "#4FA8FF", "#FFE3B0 #4FA8FF #45D18A #B57BFF #FF5C5C"
    )


class MIRROR:
    """Outside mirrors. Pan counts to the left, tilt upwards (VSS)."""

    DRIVER_FOLDED = _switch("Body.Mirrors.DriverSide.IsFolded")
    PASSENGER_FOLDED = _switch("Body.Mirrors.PassengerSide.IsFolded")
    DRIVER_HEATING = _switch("Body.Mirrors.DriverSide.IsHeatingOn")
    PASSENGER_HEATING = _switch("Body.Mirrors.PassengerSide.IsHeatingOn")
    DRIVER_PAN = _set("Body.Mirrors.DriverSide.Pan", 0.0, "percent", -100, 100, 10)
    PASSENGER_PAN = _set("Body.Mirrors.PassengerSide.Pan", 0.0, "percent", -100, 100, 10)
    DRIVER_TILT = _set("Body.Mirrors.DriverSide.Tilt", 0.0, "percent", -100, 100, 10)
    PASSENGER_TILT = _set("Body.Mirrors.PassengerSide.Tilt", 0.0, "percent", -100, 100, 10)


class TYRE:
    """Tyre pressures, cold at 20 degrees 250 kPa."""

    FRONT_LEFT = _measure("Chassis.Axle.Row1.Wheel.Left.Tire.Pressure", 250.0, "kPa", 0, 2550)
    FRONT_RIGHT = _measure("Chassis.Axle.Row1.Wheel.Right.Tire.Pressure", 250.0, "kPa", 0, 2550)
    REAR_LEFT = _measure("Chassis.Axle.Row2.Wheel.Left.Tire.Pressure", 250.0, "kPa", 0, 2550)
    REAR_RIGHT = _measure("Chassis.Axle.Row2.Wheel.Right.Tire.Pressure", 250.0, "kPa", 0, 2550)


class LIGHTS:
    """Exterior lamps."""

    SWITCH = _choice("Body.Lights.LightSwitch", "AUTO", "OFF POSITION AUTO BEAM")
    POSITION = _switch("Body.Lights.Parking.IsOn")
    LOW_BEAM = _switch("Body.Lights.Beam.Low.IsOn")
    HIGH_BEAM = _switch("Body.Lights.Beam.High.IsOn")
    FRONT_FOG = _switch("Body.Lights.Fog.Front.IsOn")
    REAR_FOG = _switch("Body.Lights.Fog.Rear.IsOn")
    HAZARD = _switch("Body.Lights.Hazard.IsSignaling")


class BODY:
    """Wipers, washer and the rain they meet."""

    FRONT_WIPER = _choice(
        "Body.Windshield.Front.Wiping.Mode", "RAIN_SENSOR", "OFF INTERVAL SLOW MEDIUM FAST RAIN_SENSOR"
    )
    REAR_WIPER = _choice("Body.Windshield.Rear.Wiping.Mode", "OFF", "OFF INTERVAL SLOW")
    RAIN_INTENSITY = _measure("Body.Raindetection.Intensity", 0.0, "percent", 0, 100)
    WASHER_FLUID = _measure("Body.Windshield.Front.WasherFluid.Level", 80.0, "percent", 0, 100)


class GLASS:
    """Opacity of the glass, 0 clear to 1 opaque, as measured by glass sensors."""

    WINDSHIELD_FOG = _measure("Body.Windshield.Front.FogInside", 0.0, "", 0, 1)
    WINDSHIELD_FILM = _measure("Body.Windshield.Front.FilmOutside", 0.0, "", 0, 1)
    REAR_FOG = _measure("Body.Windshield.Rear.FogInside", 0.0, "", 0, 1)
    REAR_FILM = _measure("Body.Windshield.Rear.FilmOutside", 0.0, "", 0, 1)


class ADAS:
    """Driver assistance."""

    CRUISE_ENABLED = _switch("ADAS.CruiseControl.IsEnabled", True)
    CRUISE_ACTIVE = _switch("ADAS.CruiseControl.IsActive")
    CRUISE_SPEED = _set("ADAS.CruiseControl.SpeedSet", 50.0, "km/h", 10, 180, 5)
    CRUISE_ADAPTIVE = _switch("ADAS.CruiseControl.IsAdaptive", True)
    CRUISE_GAP = _set("ADAS.CruiseControl.TimeGapSet", 2.0, "s", 1.0, 3.0, 0.5)
    LIMITER_ACTIVE = _switch("ADAS.SpeedLimiter.IsActive")
    LIMITER_SPEED = _set("ADAS.SpeedLimiter.SpeedSet", 50.0, "km/h", 10, 180, 5)
    FORWARD_COLLISION_WARNING = _switch("ADAS.ObstacleDetection.Front.Center.IsEnabled", True)
    EMERGENCY_BRAKING = _switch("ADAS.EBA.IsEnabled", True)
    STABILITY_CONTROL = _switch("ADAS.ESC.IsEnabled", True)
    LANE_DEPARTURE = _switch("ADAS.LaneDepartureDetection.IsEnabled", True)
    LANE_KEEPING = _switch("ADAS.LaneKeepingAssist.IsEnabled", True)
    SPEED_WARNING = _switch("ADAS.IntelligentSpeedAssistance.IsEnabled", True)
    BLIND_SPOT = _switch("ADAS.BlindSpotDetection.IsEnabled", True)
    PARKING_SENSORS = _switch("ADAS.ObstacleDetection.Rear.Center.IsEnabled", True)
    DRIVER_MONITORING = _switch("ADAS.DMS.IsEnabled", True)
    ROAD_FRICTION = _measure("ADAS.ESC.RoadFriction.MostProbable", 100.0, "percent", 0, 100)
    LIMIT_SIGN = _maybe("ADAS.RoadSign.SpeedLimit", "km/h", 0, 400)
    LEADER_DISTANCE = _maybe("ADAS.ObstacleDetection.Front.Center.Distance", "m", 0, None)
    LEADER_TIME_TO_COLLISION = _maybe("ADAS.ObstacleDetection.Front.Center.TimeToCollision", "s", 0, None)


class DRIVE:
    """Drive mode, brakes and horn."""

    MODE = _choice("Powertrain.Transmission.PerformanceMode", "NORMAL", "NORMAL ECONOMY SPORT SNOW RAIN")
    PARKING_BRAKE = _switch("Chassis.ParkingBrake.IsEngaged")
    PARKING_BRAKE_AUTO = _switch("Chassis.ParkingBrake.IsAutoApplyEnabled", True)
    HORN = _is("Body.Horn.IsActive")
    """VSS has an actuator; here the horn sounds briefly when pressed."""


class MOTION:
    """Motion and position."""

    SPEED = _measure("Speed", 0.0, "km/h", 0, 400)
    IS_MOVING = _is("IsMoving")
    GEAR = _enter(
        Signal("Vehicle.Powertrain.Transmission.Gear", LeafKind.SENSOR, "D", allowed=("P", "R", "N", "D"))
    )
    HEADING = _measure("CurrentLocation.Heading", 0.0, "degrees", 0, 360)
    LATITUDE = _maybe("CurrentLocation.Latitude", "degrees", -90, 90)
    LONGITUDE = _maybe("CurrentLocation.Longitude", "degrees", -180, 180)


class ENERGY:
    """The traction battery."""

    LEVEL = _measure("Powertrain.TractionBattery.StateOfCharge.Displayed", 72.0, "percent", 0, 100)
    RANGE = _measure("Powertrain.Range", 0.0, "m", 0, None)
    CHARGE_LIMIT = _set("Powertrain.TractionBattery.Charging.ChargeLimit", 80.0, "percent", 50, 100, 5)
    CHARGE_FLAP = _switch("Powertrain.TractionBattery.Charging.ChargingPort.AnyPosition.IsFlapOpen")
    CABLE = _is("Powertrain.TractionBattery.Charging.ChargingPort.AnyPosition.IsChargingCableConnected")


class OUTSIDE:
    """Measurements of sky, air and light."""

    TEMPERATURE = _measure("Exterior.AirTemperature", 15.0, "Celsius", -60, 70)
    HUMIDITY = _measure("Exterior.Humidity", 60.0, "percent", 0, 100)
    LIGHT = _measure("Exterior.LightIntensity", 100.0, "percent", 0, 100)
    VISIBILITY = _measure("Exterior.Visibility", 20_000.0, "m", 0, None)
    WIND = _measure("Exterior.WindSpeed", 0.0, "km/h", 0, 400)
    GLARE = _measure("Exterior.Glare", 0.0, "percent", 0, 100)
    FINE_DUST = _measure("Exterior.FineDust", 8.0, "ug/m^3", 0, 2000)
    """Particles under 2.5 micrometres."""


class MEDIA:
    """Sound."""

    ACTION = _choice("Cabin.Infotainment.Media.Action", "STOP", "STOP PLAY")
    VOLUME = _set("Cabin.Infotainment.Media.Volume", 30.0, "percent", 0, 100, 5)
    MUTED = _switch("Cabin.Infotainment.Media.IsMuted")
    SOURCE = _choice("Cabin.Infotainment.Media.Played.Source", "BLUETOOTH", "BLUETOOTH FM DAB USB INTERNET")
    SELECTED = _enter(Signal("Vehicle.Cabin.Infotainment.Media.SelectedURI", LeafKind.ACTUATOR, ""))
    """Chosen media; what plays now is ``PLAYED``."""
    SHUFFLE = _switch("Cabin.Infotainment.Media.IsShuffleActive")
    REPEAT = _switch("Cabin.Infotainment.Media.IsRepeatActive")
    BASS = _set("Cabin.Infotainment.Media.Equalizer.Bass", 0.0, "dB", -10, 10, 1)
    MIDDLE = _set("Cabin.Infotainment.Media.Equalizer.Middle", 0.0, "dB", -10, 10, 1)
    TREBLE = _set("Cabin.Infotainment.Media.Equalizer.Treble", 0.0, "dB", -10, 10, 1)
    BALANCE = _set("Cabin.Infotainment.Media.Balance", 0.0, "percent", -100, 100, 10)
    FADER = _set("Cabin.Infotainment.Media.Fader", 0.0, "percent", -100, 100, 10)
    PLAYED = _text("Cabin.Infotainment.Media.Played.URI")
    TRACK = _text("Cabin.Infotainment.Media.Played.Track")
    ARTIST = _text("Cabin.Infotainment.Media.Played.Artist")


class CALL:
    """Incoming calls and messages."""

    RINGING = _text("Cabin.Infotainment.Call.Ringing")
    """The caller; empty without one."""
    PARTNER = _text("Cabin.Infotainment.Call.Partner")
    """The other party of the present call."""
    PHONE = _enter(Signal("Vehicle.Driver.Phone", LeafKind.SENSOR, "AWAY", allowed=("AWAY", "CRADLE", "HAND")))
    """Where the phone that the driver uses is, as the interior camera sees it."""
    UNREAD = _measure("Cabin.Infotainment.Message.Unread", 0.0, "", 0, None)
    """Number of senders with unread messages."""


class DRIVER:
    """What an interior camera makes of the driver: it sees eyes and hours, not the mind. None where the driver's
    attention is not limited; then records leave them out, as those from before did."""

    DISTRACTION = _maybe("Driver.DistractionLevel", "percent", 0, 100)
    """How much of two seconds the eyes have been away from the road."""
    FATIGUE = _maybe("Driver.FatigueLevel", "percent", 0, 100)
    """From two hours without a break to nine."""


class VOICE:
    """The other sounds: guidance, calls, the screen's clicks."""

    GUIDANCE = _choice("Cabin.Infotainment.Navigation.Mute", "UNMUTED", "UNMUTED ALERT_ONLY MUTED")
    GUIDANCE_VOLUME = _set("Cabin.Infotainment.Navigation.Volume", 50.0, "percent", 0, 100, 5)
    CALL_VOLUME = _set("Cabin.Infotainment.Call.Volume", 50.0, "percent", 0, 100, 5)
    TOUCH_SOUNDS = _switch("Cabin.Infotainment.HMI.IsTouchSoundActive", True)


class HMI:
    """The display itself."""

    BRIGHTNESS = _set("Cabin.Infotainment.HMI.Brightness", 70.0, "percent", 0, 100, 10)
    REAR_SCREEN = _set("Cabin.Infotainment.HMI.RearBrightness", 0.0, "percent", 0, 100, 10)
    """The screen for those behind; at 0 it is off."""
    DAY_NIGHT = _choice("Cabin.Infotainment.HMI.DayNightMode", "DAY", "DAY NIGHT")
    DAY_NIGHT_AUTO = _switch("Cabin.Infotainment.HMI.IsDayNightAuto", True)
    DISTANCE_UNIT = _choice("Cabin.Infotainment.HMI.DistanceUnit", "KILOMETERS", "KILOMETERS MILES")
    TEMPERATURE_UNIT = _choice("Cabin.Infotainment.HMI.TemperatureUnit", "C", "C F")
    PRESSURE_UNIT = _choice("Cabin.Infotainment.HMI.TirePressureUnit", "BAR", "BAR KPA PSI")
    TIME_FORMAT = _choice("Cabin.Infotainment.HMI.TimeFormat", "HR_24", "HR_24 HR_12")
    CONTRAST = _measure("Cabin.Infotainment.HMI.ContrastRatio", 50.0, "ratio", 1, 2000)
    """Contrast of white to black under the light that falls on the display."""
    LANGUAGE = _choice("Cabin.Infotainment.HMI.CurrentLanguage", "en", "en fr de ja")


class LINK:
    """Connectivity and privacy."""

    ONLINE = _is("Connectivity.IsConnectivityAvailable", True)
    MOBILE_DATA = _switch("Connectivity.Cellular.IsEnabled", True)
    WIFI = _switch("Connectivity.WiFi.IsEnabled")
    HOTSPOT = _switch("Connectivity.WiFi.IsHotspotActive")
    BLUETOOTH = _switch("Connectivity.Bluetooth.IsEnabled", True)
    SHARE_POSITION = _switch("Connectivity.Privacy.IsPositionShared")
    SHARE_DRIVING = _switch("Connectivity.Privacy.IsDrivingDataShared")
    VOICE_ASSISTANT = _switch("Connectivity.Privacy.IsMicrophoneEnabled", True)


def named(path: str) -> Signal[Any]:
    """The signal of that path. Raises UnknownNameError: there is no such signal."""
    try:
        return CATALOGUE[path]
    except KeyError:
        raise UnknownNameError("signal", path, CATALOGUE) from None


class Snapshot(Mapping[str, Any]):
    """Path and value of every signal at one instant. A drive has one a second, so each shares with the one before
    what has not changed."""

    __slots__ = ("_parts",)

    def __init__(self, parts: tuple[tuple[Any, ...], ...]) -> None:
        """Of the values of each of ``PARTS``."""
        self._parts = parts

    def __getitem__(self, path: str) -> Any:
        part, place = _PLACES[path]
        value = self._parts[part][place]
        if value is None and path in OF_ATTENTION:
            raise KeyError(path)
        return value

    def __iter__(self) -> Iterator[str]:
        return iter(self.as_dict())

    def __len__(self) -> int:
        return len(self.as_dict())

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Snapshot):
            return self._parts == other._parts
        return self.as_dict() == other

    def __repr__(self) -> str:
        return repr(self.as_dict())

    def as_dict(self) -> dict[str, Any]:
        """The same in the order of the catalogue."""
        values = dict(zip(CATALOGUE, _in_order(sum(self._parts, ())), strict=True))
        if values[DRIVER.DISTRACTION.path] is None:
            del values[DRIVER.DISTRACTION.path], values[DRIVER.FATIGUE.path]
        return values


def _unless_same(before: tuple[Any, ...], now: tuple[Any, ...]) -> tuple[Any, ...]:
    """A part of a snapshot; that of the one before if nothing in it has changed."""
    return before if len(before) == len(now) and all(map(is_, before, now)) else now


class Signals:
    """The values of all signals, always valid."""

    __slots__ = ("_commanded", "_sensed", "_values")

    def __init__(self, values: Mapping[str, Any] | None = None) -> None:
        """All at their defaults except ``values``, by path.

        Raises:
            UnknownNameError: no such path.
            SignalError: a value is invalid."""
        self._values: dict[str, Any] = {path: signal.default for path, signal in CATALOGUE.items()}
        self._commanded: tuple[Any, ...] | None = None
        """The actuators' values, once somebody has asked for them since one was set."""
        self._sensed: tuple[tuple[Any, ...], ...] = tuple(() for _ in _READERS)
        """The other parts of the last snapshot."""
        for path, value in (values or {}).items():
            self._values[path] = named(path).check(value)

    def __getitem__(self, signal: Signal[T]) -> T:
        value: T = self._values[signal.path]
        return value

    def __setitem__(self, signal: Signal[T], value: T) -> None:
        before = self._values[signal.path]
        if before is value:
            return
        now: object = signal.check(value)
        if before == now and type(before) is type(now) and (now or str(before) == str(now)):
            return  # they are written alike, so one need not be kept: -0.0 is no 0.0
        self._values[signal.path] = now
        if signal.kind is LeafKind.ACTUATOR:
            self._commanded = None

    def __iter__(self) -> Iterator[Signal[Any]]:
        return iter(CATALOGUE.values())

    def snapshot(self) -> Snapshot:
        """Path and value of every signal, as they are now."""
        now = (read(self._values) for read in _READERS)
        self._sensed = tuple(map(_unless_same, self._sensed, now))
        return Snapshot((self.actuators, *self._sensed))

    @property
    def actuators(self) -> tuple[Any, ...]:
        """The value of every actuator, in the order of ``ACTUATORS``: the same object until one is set."""
        known = self._commanded
        if known is None:
            known = self._commanded = _actuators(self._values)
        return known

    def picked(self, read: Callable[[Mapping[str, Any]], tuple[Any, ...]]) -> tuple[Any, ...]:
        """What a getter takes of all paths and values, without a copy of them."""
        return read(self._values)

    def commanded(self) -> dict[str, Any]:
        """Path and value of every actuator; a copy."""
        return dict(zip(ACTUATORS, self.actuators, strict=True))

    def reset(self) -> None:
        self._values = {path: signal.default for path, signal in CATALOGUE.items()}
        self._commanded = None

    def copy(self) -> Signals:
        twin = Signals.__new__(Signals)
        twin._values, twin._sensed = self._values.copy(), self._sensed
        twin._commanded = self._commanded
        return twin


ACTUATORS = tuple(path for path, signal in CATALOGUE.items() if signal.kind is LeafKind.ACTUATOR)
"""Paths of all actuators."""
_MOVING = (
    *("Vehicle.Chassis.Axle.", "Vehicle.CurrentLocation.", "Vehicle.Powertrain.", "Vehicle.Speed"),
    *("Vehicle.Cabin.HVAC.Ambient", "Vehicle.ADAS.ObstacleDetection."),
)
"""How the paths begin of what changes nearly every second."""
_SENSED = tuple(path for path in CATALOGUE if path not in ACTUATORS)
PARTS = (
    ACTUATORS,
    tuple(path for path in _SENSED if path.startswith(_MOVING)),
    tuple(path for path in _SENSED if not path.startswith(_MOVING)),
)
"""All paths, by how often they change."""
_actuators, *_READERS = (itemgetter(*part) for part in PARTS)
_in_order = itemgetter(*map(sum(PARTS, ()).index, CATALOGUE))
_PLACES = {path: (number, place) for number, part in enumerate(PARTS) for place, path in enumerate(part)}


def picker(paths: Sequence[str]) -> Callable[[Mapping[str, Any]], tuple[Any, ...]]:
    """A function that takes the values of several paths at once from a snapshot, or from any paths and values."""
    named: Callable[[Mapping[str, Any]], tuple[Any, ...]] = itemgetter(*paths)
    number, *others = {_PLACES[path][0] for path in paths}
    within = PARTS[number] if not others else sum(PARTS, ())
    placed: Callable[[tuple[Any, ...]], tuple[Any, ...]] = itemgetter(*map(within.index, paths))

    def pick(values: Mapping[str, Any]) -> tuple[Any, ...]:
        if not isinstance(values, Snapshot):
            return named(values)
        return placed(sum(values._parts, ()) if others else values._parts[number])

    return pick


OF_ATTENTION = (DRIVER.DISTRACTION.path, DRIVER.FATIGUE.path)
"""Not in a snapshot where they are None."""


def difference(before: Mapping[str, Any], after: Mapping[str, Any]) -> dict[str, tuple[Any, Any]]:
    """Differences between two snapshots: path to (before, after)."""
    return {
        path: (before.get(path), after.get(path))
        for path in sorted(before.keys() | after.keys())
        if before.get(path) != after.get(path)
    }
