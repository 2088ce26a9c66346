"""The air and the glass of the cabin: heat, moisture, fog inside, dew and rain outside.

One node of air, one node per pane, first order:

    air     C dT/dt = m_supply cp (T_supply - T) + UA (T_outside - T) + heat of the people
    vapour  M dw/dt = people + wet clothes + m_supply (w_supply - w) + leaks (w_outside - w) - glass
    glass   c dT/dt = h_in (T_near - T) + h_out (T_outside - T) + heater
    dust    V dC/dt = (leaks + (1 - filter) fresh) C_outside - (leaks + fresh + filter round + purifier) C

Glass fogs when the dew point of the air at it is above its surface temperature, and clears otherwise; the flux
follows from the heat transfer coefficient (Lewis relation). Sources are given with the constants. Those
without one are marked as assumptions.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any

from automotive_cosim.errors import UnknownNameError, UserError

PRESSURE_HPA = 1013.25
AIR_CP = 1006.0
"""J/(kg K), dry air."""
AIR_DENSITY = 1.2
"""kg/m3, 20 °C at sea level."""
CABIN_VOLUME_M3 = 3.0
"""A mid-size car (Ott, Klepeis, Switzer 2008, J. Expo. Sci. Environ. Epidemiol. 18)."""
CABIN_CAPACITY = 60_000.0
"""J/K of the air and the skin of the lining, which follow within a minute or two: an assumption."""
CABIN_LOSS = 70.0
"""W/K through body and glass: an assumption in the range published for passenger cars (60 to 100)."""
OCCUPANT_HEAT_W = 75.0
OCCUPANT_VAPOUR = 60.0 / 3_600_000
"""kg/s: seated, light work, 70 W sensible and 45 W latent, about 60 g/h (ASHRAE Fundamentals, chapter 18)."""
WET_CLOTHES_VAPOUR = 100.0 / 3_600_000
"""kg/s a person, clothes soaked by rain: an assumption."""
BLOWER_FULL = 0.11
"""kg/s at full speed, about 330 m3/h: typical of car blowers."""
LEAK_PER_HOUR, LEAK_PER_HOUR_KMH = 0.5, 0.08
"""Air changes an hour with everything shut, at rest and per km/h (Fruin et al. 2011, Atmos. Environ. 45)."""
WINDOW_PER_HOUR, WINDOW_PER_HOUR_KMH = 10.0, 1.5
"""Air changes an hour that one window adds when it is wholly open, at rest and per km/h: an assumption of the size
measured in moving cars with windows open (Ott, Klepeis, Switzer 2008: tens of changes an hour at 30 km/h)."""
CABIN_FILTER = 0.5
"""Share of the fine dust that one pass through the cabin filter removes: an assumption."""
PURIFIER_M3_H = 60.0
"""Clean air that the purifier delivers: typical of built-in ones."""
EVAPORATOR_C = 4.0
"""Air leaves the evaporator saturated at this; the compressor stays off in frost."""
COMPRESSOR_MINIMUM_C = 0.0
COOLANT_C = 85.0
"""Of the heater's water: thermostats of cars open at 82 to 90 °C, electric heaters hold about as much."""
HEATER_NTU_FULL = 1.05
"""Size of the heater's heat exchanger in transfer units at full fan, where it warms the air by two thirds of the
way to its water. It grows with the root of the slowness: air that lingers gets hotter (Kays and London 1984,
Compact Heat Exchangers, one fluid of constant temperature)."""
HEATER_W = 7_000.0
"""What a car's heater gives at most: high-voltage heaters are sold for 5 to 7 kW."""
DEFROST_SUPPLY_C = 45.0
SUPPLY_GAIN = 10.0
"""Supply air deviates this many times as much as the cabin, in the other direction, from what would hold it."""
GLASS_CAPACITY_M2 = 10_000.0
"""J/(m2 K): 5 mm of glass, 2500 kg/m3, 800 J/(kg K)."""
GLASS_RESISTANCE = 0.005
"""m2 K/W: 5 mm at 1 W/(m K)."""
INSIDE_STILL = 8.0
"""W/(m2 K): surface resistance 0.13 m2 K/W (ISO 6946)."""
JET_FULL, JET_LEAST = 60.0, 10.0
"""W/(m2 K) that the windshield outlet adds at full fan, and the least with the fan on: an assumption."""
OUTSIDE_STILL, OUTSIDE_PER_MPS = 9.0, 4.0
"""W/(m2 K): 4 + 4 v for wind plus 5 by radiation (ISO 6946)."""
REAR_WIND = 0.3
"""Share of the wind that reaches the rear window, in the wake: an assumption."""
REAR_HEATER_W_M2 = 350.0
"""About 200 W on 0.6 m2: typical of rear windows."""
GLASS_AREA_M2 = 4.0
"""Area of all panes, which take moisture from the air equally."""
FOG_OPAQUE = 2e-3
"""kg/m2 of droplets that hide the road: a mean film of 2 µm, an assumption."""
RAIN_OPAQUE = 30e-3
"""kg/m2 of rain that hides the road: large drops hide less: an assumption."""
RAIN_RUNS_OFF_S = 60.0
WIPED_SHARE = 0.9
"""Share of the film removed by one sweep."""
WIPED_PER_SWEEP = -math.log(1 - WIPED_SHARE)
"""The same as a rate, if sweeps follow one another evenly."""
SWEEPS_PER_MINUTE = {"OFF": 0.0, "INTERVAL": 12.0, "SLOW": 40.0, "MEDIUM": 50.0, "FAST": 65.0}
"""FMVSS 104 asks for one speed of at least 45 and another of at least 20."""
STEP_S = 0.5
"""Longest step of the integration."""


def saturation_hpa(temperature_c: float) -> float:
    """Vapour pressure over water (Magnus formula, coefficients of Sonntag 1990, as WMO-No. 8 gives them)."""
    return 6.112 * math.exp(17.62 * temperature_c / (243.12 + temperature_c))


def humidity_ratio(temperature_c: float, humidity_pct: float) -> float:
    """Kilograms of vapour per kilogram of dry air."""
    vapour = humidity_pct / 100 * saturation_hpa(temperature_c)
    return 0.622 * vapour / (PRESSURE_HPA - vapour)


EVAPORATOR_RATIO = humidity_ratio(EVAPORATOR_C, 100)


def relative_humidity_pct(temperature_c: float, ratio: float) -> float:
    """Relative humidity of air with that humidity ratio; at most 100."""
    vapour = ratio * PRESSURE_HPA / (0.622 + ratio)
    return min(100.0, 100 * vapour / saturation_hpa(temperature_c))


def dew_point_c(temperature_c: float, humidity_pct: float) -> float:
    """Dew point of air of that temperature and humidity (the Magnus formula solved for temperature)."""
    logarithm = math.log(max(humidity_pct, 1e-6) / 100) + 17.62 * temperature_c / (243.12 + temperature_c)
    return 243.12 * logarithm / (17.62 - logarithm)


@dataclass(frozen=True, slots=True)
class Pane:
    """One window: heat and water on it."""

    temperature_c: float
    """Temperature in the middle of the glass."""
    inner_c: float
    """Temperature of the surface towards the cabin."""
    outer_c: float
    fog: float = 0.0
    """Droplets inside, kg/m2."""
    dew: float = 0.0
    """Droplets outside, kg/m2."""
    rain: float = 0.0
    """Rain outside, kg/m2."""

    @property
    def fog_inside(self) -> float:
        """0 clear to 1 opaque."""
        return min(1.0, self.fog / FOG_OPAQUE)

    @property
    def film_outside(self) -> float:
        """0 clear to 1 opaque, dew and rain together."""
        dew, rain = min(1.0, self.dew / FOG_OPAQUE), min(1.0, self.rain / RAIN_OPAQUE)
        return 1 - (1 - dew) * (1 - rain)


@dataclass(frozen=True, slots=True)
class Air:
    """The weather at the car's body."""

    temperature_c: float
    humidity_pct: float
    rain_mm_h: float
    speed_mps: float
    fine_dust: float = 0.0
    """Particles under 2.5 micrometres, ug/m3."""


@dataclass(frozen=True, slots=True)
class Controls:
    """What acts on the air from inside: the settings, and who breathes it."""

    set_c: float
    fan_pct: float
    air_up: bool
    air_conditioning: bool
    recirculation: bool
    front_defroster: bool
    rear_defroster: bool
    front_sweeps_per_minute: float
    rear_sweeps_per_minute: float
    purifier: bool = False
    windows_open: float = 0.0
    """Sum over windows and roof; 1 is one window fully open."""
    people: float = 1.0
    """Heat and vapour of all who are aboard, in adults (``aboard.breath``)."""


@dataclass(frozen=True, slots=True)
class CabinStart:
    """The cabin at the beginning of an episode."""

    wet_clothes: bool = False
    temperature_c: float = 21.0
    humidity_pct: float = 40.0
    fine_dust: float = 4.0
    """ug/m3: clean city air after the cabin filter."""

    @classmethod
    def read(cls, given: Mapping[str, Any]) -> CabinStart:
        """Creates it from a mapping of field names.

        Raises:
            UnknownNameError: no such field.
            UserError: a value is of the wrong type or impossible for a cabin."""
        known = [field.name for field in fields(cls)]
        for name in given:
            if name not in known:
                raise UnknownNameError("initial condition of the cabin", name, known)
        try:
            start = replace(cls(), **given)
            legal = (
                -40 <= start.temperature_c <= 80 and 0 < start.humidity_pct <= 100 and 0 <= start.fine_dust <= 2000
            )
        except TypeError as error:
            raise UserError(f"initial conditions of the cabin: {error}") from error
        if not legal:
            raise UserError(
                f"initial conditions of the cabin are {dict(given)}; expected -40 to 80 °C, "
                "0 to 100 % humidity, 0 to 2000 ug/m3 of fine dust"
            )
        return start


@dataclass(frozen=True, slots=True)
class Cabin:
    """Air and glass at one instant; ``after`` gives the next."""

    start: CabinStart
    temperature_c: float
    moisture: float
    """Humidity ratio, kg/kg."""
    windshield: Pane
    rear_window: Pane
    fine_dust: float = 0.0
    """ug/m3."""

    @classmethod
    def at(cls, start: CabinStart, outside: Air) -> Cabin:
        """With the glass at its equilibrium temperature in this air."""
        return cls(
            start,
            start.temperature_c,
            humidity_ratio(start.temperature_c, start.humidity_pct),
            _settled(start.temperature_c, outside, 1.0),
            _settled(start.temperature_c, outside, REAR_WIND),
            start.fine_dust,
        )

    @property
    def humidity_pct(self) -> float:
        """Relative humidity of the air."""
        return relative_humidity_pct(self.temperature_c, self.moisture)

    @property
    def dew_point_c(self) -> float:
        """Dew point: colder glass fogs."""
        return dew_point_c(self.temperature_c, self.humidity_pct)

    def after(self, duration_s: float, controls: Controls, outside: Air) -> Cabin:
        """The cabin after a time with constant controls and weather."""
        cabin = self
        steps = math.ceil(duration_s / STEP_S - 1e-9)
        outside_ratio = humidity_ratio(outside.temperature_c, outside.humidity_pct)
        for _ in range(steps):
            cabin = cabin._step(duration_s / steps, controls, outside, outside_ratio)
        return cabin

    def _step(self, dt_s: float, controls: Controls, outside: Air, outside_ratio: float) -> Cabin:
        blown = BLOWER_FULL * controls.fan_pct / 100
        leak = AIR_DENSITY * CABIN_VOLUME_M3 * _leaks_per_hour(controls, outside) / 3600
        supply = self._supply(controls, outside, outside_ratio, blown, leak)
        people = controls.people * (OCCUPANT_VAPOUR + (WET_CLOTHES_VAPOUR if self.start.wet_clothes else 0.0))
        heat = (
            blown * AIR_CP * (supply.temperature_c - self.temperature_c)
            + (CABIN_LOSS + leak * AIR_CP) * (outside.temperature_c - self.temperature_c)
            + controls.people * OCCUPANT_HEAT_W
        )
        jet = supply if blown > 0 and (controls.air_up or controls.front_defroster) else None
        heater = REAR_HEATER_W_M2 if controls.rear_defroster else 0.0
        sweeps = controls.front_sweeps_per_minute, controls.rear_sweeps_per_minute
        windshield = self._pane(self.windshield, dt_s, outside, outside_ratio, 1.0, jet, 0.0, sweeps[0])
        rear = self._pane(self.rear_window, dt_s, outside, outside_ratio, REAR_WIND, None, heater, sweeps[1])
        on_glass = (rear.fog - self.rear_window.fog) / dt_s * GLASS_AREA_M2
        vapour = people + leak * (outside_ratio - self.moisture) + blown * (supply.ratio - self.moisture) - on_glass
        return Cabin(
            self.start,
            self.temperature_c + dt_s * heat / CABIN_CAPACITY,
            max(1e-5, self.moisture + dt_s * vapour / (AIR_DENSITY * CABIN_VOLUME_M3)),
            windshield,
            rear,
            self._dust_after(dt_s, blown / AIR_DENSITY, leak / AIR_DENSITY, controls, outside),
        )

    def _dust_after(self, dt_s: float, blown: float, leak: float, controls: Controls, outside: Air) -> float:
        """Fine dust, with air flows in m3/s held, by the exact solution, which cannot oscillate."""
        purified = PURIFIER_M3_H / 3600 if controls.purifier else 0.0
        fresh, circulated = (0.0, blown) if controls.recirculation else (blown, 0.0)
        out = leak + fresh + CABIN_FILTER * circulated + purified
        settled = (leak + (1 - CABIN_FILTER) * fresh) * outside.fine_dust / out
        return settled + (self.fine_dust - settled) * math.exp(-out * dt_s / CABIN_VOLUME_M3)

    def _supply(self, controls: Controls, outside: Air, outside_ratio: float, blown: float, leak: float) -> _Supply:
        """Air as it leaves the outlets: taken in, dried and cooled by the evaporator, then heated.

        The control adds to what holds the set temperature, by the cabin's balance of heat, a part for the present
        deviation: so the cabin settles at what is set, as far as compressor, heater and fan can."""
        if controls.recirculation:
            taken_c, ratio = self.temperature_c, self.moisture
        else:
            taken_c, ratio = outside.temperature_c, outside_ratio
        if controls.air_conditioning and outside.temperature_c > COMPRESSOR_MINIMUM_C and controls.fan_pct:
            taken_c = min(taken_c, EVAPORATOR_C)
            ratio = min(ratio, EVAPORATOR_RATIO)
        wanted = _holding_c(controls, outside, blown, leak) + SUPPLY_GAIN * (controls.set_c - self.temperature_c)
        if controls.front_defroster:
            wanted = max(wanted, DEFROST_SUPPLY_C)
        return _Supply(max(taken_c, min(wanted, hottest_c(taken_c, blown))), ratio, controls.fan_pct)

    def _pane(
        self,
        pane: Pane,
        dt_s: float,
        outside: Air,
        outside_ratio: float,
        wind: float,
        jet: _Supply | None,
        heater_w_m2: float,
        sweeps_per_minute: float,
    ) -> Pane:
        """The pane a step later. Rain falls, runs off and is wiped away; dew is only wiped away."""
        h_in, near_c, ratio = INSIDE_STILL, self.temperature_c, self.moisture
        if jet is not None:
            h_in += max(JET_LEAST, JET_FULL * jet.fan_pct / 100)
            near_c, ratio = jet.temperature_c, jet.ratio
        h_out = OUTSIDE_STILL + OUTSIDE_PER_MPS * wind * outside.speed_mps
        flow_in = h_in * (near_c - pane.inner_c)
        flow_out = h_out * (pane.outer_c - outside.temperature_c)
        middle_c = pane.temperature_c + dt_s * (flow_in + heater_w_m2 - flow_out) / GLASS_CAPACITY_M2
        inner_c = _surface(middle_c, near_c, h_in)
        outer_c = _surface(middle_c, outside.temperature_c, h_out)
        condensing = h_in / AIR_CP * (ratio - humidity_ratio(inner_c, 100))
        dewing = (h_out - 5.0) / AIR_CP * (outside_ratio - humidity_ratio(outer_c, 100))
        wiped_per_s = WIPED_PER_SWEEP * sweeps_per_minute / 60
        lost_per_s = wiped_per_s + 1 / RAIN_RUNS_OFF_S
        falling = outside.rain_mm_h / 3600 * (1 + outside.speed_mps / 10)
        steady = falling / lost_per_s
        return Pane(
            middle_c,
            inner_c,
            outer_c,
            fog=_film(pane.fog + dt_s * condensing),
            dew=_film(pane.dew + dt_s * dewing) * math.exp(-wiped_per_s * dt_s),
            rain=min(steady + (pane.rain - steady) * math.exp(-lost_per_s * dt_s), 3 * RAIN_OPAQUE),
        )


@dataclass(frozen=True, slots=True)
class _Supply:
    temperature_c: float
    ratio: float
    fan_pct: float


SUN_W = 1600.0
"""Heat that full sun brings into a parked car. With it the air rises by 11 K in 10 minutes, 17 K in 20 and 22 K in
60, as measured on sunny days (McLaren, Null, Quinn 2005, Pediatrics 116: 19, 29 and 43 degrees Fahrenheit)."""


def parked_c(cabin_c: float, minutes: float, controls: Controls, outside: Air, sun_w: float) -> float:
    """Temperature of the air in a parked car after a time, in the same model with the sun on it, solved exactly.

    Args:
        minutes: how long from now.
        controls: how it is left. With ``fan_pct`` the climate control holds ``set_c``, at whatever fan speed up to
            full that takes, as far as the compressor and the heater can.
        outside: the weather, which stays as it is.
        sun_w: heat of the sun, up to ``SUN_W``."""
    lost = CABIN_LOSS + AIR_DENSITY * CABIN_VOLUME_M3 * _leaks_per_hour(controls, outside) / 3600 * AIR_CP
    gained_w = lost * outside.temperature_c + sun_w + controls.people * OCCUPANT_HEAT_W
    blown = BLOWER_FULL * AIR_CP if controls.fan_pct else 0.0
    settled_c = gained_w / lost
    if blown:
        chills = controls.air_conditioning and outside.temperature_c > COMPRESSOR_MINIMUM_C
        coldest_c = EVAPORATOR_C if chills else outside.temperature_c
        coolest, warmest = (
            (gained_w + blown * c) / (lost + blown)
            for c in (coldest_c, hottest_c(outside.temperature_c, BLOWER_FULL))
        )
        settled_c = min(max(controls.set_c, coolest), max(warmest, coolest))
    return settled_c + (cabin_c - settled_c) * math.exp(-minutes * 60 * (lost + blown) / CABIN_CAPACITY)


def hottest_c(taken_c: float, blown: float) -> float:
    """Temperature of air that the heater warms as far as it can.

    Args:
        taken_c: temperature of the air before it.
        blown: air flow, kg/s; 0 for none."""
    if not blown:
        return taken_c
    share = 1 - math.exp(-HEATER_NTU_FULL * math.sqrt(BLOWER_FULL / blown))
    return taken_c + min(share * max(0.0, COOLANT_C - taken_c), HEATER_W / (blown * AIR_CP))


def _holding_c(controls: Controls, outside: Air, blown: float, leak: float) -> float:
    """Temperature of the supply air at which the cabin stays at what is set."""
    if not blown:
        return controls.set_c
    lost_w = (CABIN_LOSS + leak * AIR_CP) * (controls.set_c - outside.temperature_c)
    return controls.set_c + (lost_w - controls.people * OCCUPANT_HEAT_W) / (blown * AIR_CP)


def _leaks_per_hour(controls: Controls, outside: Air) -> float:
    """Air changes through gaps and open windows."""
    speed_kmh = outside.speed_mps * 3.6
    return (
        LEAK_PER_HOUR
        + LEAK_PER_HOUR_KMH * speed_kmh
        + controls.windows_open * (WINDOW_PER_HOUR + WINDOW_PER_HOUR_KMH * speed_kmh)
    )


def _film(mass: float) -> float:
    """Limit of the drops: beyond twice what hides the road, they run down."""
    return min(max(0.0, mass), 2 * FOG_OPAQUE)


def _surface(middle_c: float, air_c: float, h: float) -> float:
    """Surface of a pane: half its resistance lies between the surface and its middle."""
    conductance = 2 / GLASS_RESISTANCE
    return (conductance * middle_c + h * air_c) / (conductance + h)


def _settled(cabin_c: float, outside: Air, wind: float) -> Pane:
    resistance_in = 1 / INSIDE_STILL + GLASS_RESISTANCE / 2
    resistance_out = 1 / (OUTSIDE_STILL + OUTSIDE_PER_MPS * wind * outside.speed_mps) + GLASS_RESISTANCE / 2
    middle_c = (cabin_c / resistance_in + outside.temperature_c / resistance_out) / (
        1 / resistance_in + 1 / resistance_out
    )
    inner_c = _surface(middle_c, cabin_c, INSIDE_STILL)
    outer_c = _surface(middle_c, outside.temperature_c, OUTSIDE_STILL + OUTSIDE_PER_MPS * wind * outside.speed_mps)
    return Pane(middle_c, inner_c, outer_c)


def sweeps_per_minute(mode: str, rain_mm_h: float) -> float:
    """Sweeps of a wiper in a VSS mode; the rain sensor starts at drizzle, and is faster in heavier rain."""
    if mode != "RAIN_SENSOR":
        return SWEEPS_PER_MINUTE[mode]
    if rain_mm_h < 0.1:
        return 0.0
    return min(SWEEPS_PER_MINUTE["FAST"], 15.0 + 10.0 * rain_mm_h)
