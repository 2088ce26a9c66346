"""The trip computer: trip A, and trip B, which keeps counting when A is reset."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal

from automotive_cosim.cockpit.app import App, AppPage, Where
from automotive_cosim.cockpit.cards import SMALL, content, fact, heading, title
from automotive_cosim.cockpit.flow import card, fill, grid, line
from automotive_cosim.cockpit.functions import CallMade, offered
from automotive_cosim.cockpit.layout import REST
from automotive_cosim.cockpit.messages import Back, Show
from automotive_cosim.cockpit.room import Room
from automotive_cosim.cockpit.signals import ENERGY, HMI
from automotive_cosim.cockpit.state import AppData, Command, State
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.values import distance, minutes, speed, speed_unit
from automotive_cosim.cockpit.vehicle import BATTERY_KWH
from automotive_cosim.cockpit.widgets import Button, Glyph, Label, Widget
from automotive_cosim.contracts import Feedback, FeedbackCode, Surroundings
from automotive_cosim.contracts.text import Quantity, say

Reading = tuple[float, float, float]
"""Driven metres, simulation time in seconds and battery level in percent."""


def odometer(state: State) -> Reading:
    """The present reading."""
    driven_m = 0.0 if state.outside is None else state.outside.driving.distance_m
    return driven_m, state.time_s, state.signals[ENERGY.LEVEL]


@dataclass(frozen=True, slots=True)
class TripMeter:
    """What a trip meter has counted up to a reading of the odometer, from which it counts on."""

    driven_m: float = 0.0
    took_s: float = 0.0
    used_kwh: float = 0.0
    since: Reading = (0.0, 0.0, 0.0)
    """Driven metres, time and battery (``odometer``) from which it counts on: at departure or the reset."""
    resets: int = 0

    def at(self, reading: Reading, battery_kwh: float) -> tuple[float, float, float]:
        """Metres, seconds and kWh that it shows at a reading of the odometer."""
        (metres, seconds, level), (from_m, from_s, from_level) = reading, self.since
        used_kwh = max(0.0, from_level - level) / 100 * battery_kwh
        return self.driven_m + max(0.0, metres - from_m), self.took_s + seconds - from_s, self.used_kwh + used_kwh


FROM_HERE = TripMeter()
"""A trip meter that has counted nothing yet."""


@dataclass(frozen=True, slots=True)
class TripMeters(AppData):
    """Trip A counts from its reset, trip B keeps counting when A is reset."""

    resets: int = 0
    since: Reading = (0.0, 0.0, 0.0)
    """From which trip A counts."""
    b: TripMeter = FROM_HERE

    def commands(self) -> dict[str, Any]:
        return {"trip.resets": self.resets, "trip.resets_b": self.b.resets}

    def passed(self, state: State, before: Surroundings | None, dt_s: float) -> None:
        """At departure, both count on from here."""
        if before is None:
            here = odometer(state)
            state.keep(replace(self, since=here, b=replace(self.b, since=here)))


@dataclass(frozen=True, slots=True)
class _ResetTrip(Command):
    """Count distance and time from here."""

    meter: Literal["a", "b"] = "a"

    def aims(self, state: State) -> frozenset[str]:
        return frozenset({"trip.resets_b" if self.meter == "b" else "trip.resets"})

    def perform(self, state: State) -> Feedback:
        trip, here = state.of(TripMeters), odometer(state)
        if self.meter == "a":
            state.keep(replace(trip, resets=trip.resets + 1, since=here))
            return Feedback(FeedbackCode.OK, say("the trip computer is reset"))
        state.keep(replace(trip, b=TripMeter(since=here, resets=trip.b.resets + 1)))
        return Feedback(FeedbackCode.OK, say("trip B is reset"))


def trip(state: State) -> tuple[Widget, ...]:
    """Distance, time and consumption since the last reset."""
    signals = state.signals
    metres, seconds, level = odometer(state)
    from_m, from_s, from_level = state.of(TripMeters).since
    driven_m, took_s, used_pct = max(0.0, metres - from_m), seconds - from_s, max(0.0, from_level - level)
    mean_kmh = 3.6 * driven_m / took_s if took_s > 0 else 0.0
    used_kwh = used_pct / 100 * BATTERY_KWH
    unit_m, unit = (1609.344, "mi") if signals[HMI.DISTANCE_UNIT] == "MILES" else (1000.0, "km")
    per_100 = 100 * unit_m * used_kwh / driven_m if driven_m > 100 else 0.0
    tiles = (
        ("trip.distance", say("Distance"), distance(signals, driven_m), Icon.ROUTE),
        ("trip.time", say("Driving time"), minutes(took_s), Icon.CLOCK),
        ("trip.speed", say("Average speed"), f"{speed(signals, mean_kmh)} {speed_unit(signals)}", Icon.SPEED),
        ("trip.energy", say("Energy"), Quantity(f"{used_kwh:.2f} kWh"), Icon.BATTERY),
        ("trip.consumption", say("Consumption"), Quantity(f"{per_100:.1f} kWh/100 {unit}"), Icon.CHARGING),
        ("trip.range", say("Range"), distance(signals, signals[ENERGY.RANGE]), Icon.GOAL),
    )
    cells = (
        card(
            (32, line((32, Glyph(icon=icon, size=28, tone="accent")), 12, heading(name))),
            REST,
            (56, Label(key=key, text=value, description=name, style=Type.HEADLINE)),
            padding=SMALL,
            look="raised",
        )
        for key, name, value, icon in tiles
    )
    reset = Button(key="trip.reset", text=say("Reset"), icon=Icon.TRIP, on_tap=_ResetTrip())
    other = Button(key="trip.other", text=say("Trip B"), icon=Icon.TRIP, on_tap=Show("trip_b"))
    whole = card(
        title(Icon.TRIP, say("Trip A"), "trip.title"),
        20,
        (312, grid(3, 16, *cells)),
        REST,
        (72, line((320, reset), REST, (320, other))),
        padding=(32, 24),
    )
    return fill(content(state), whole)


def trip_b(state: State) -> tuple[Widget, ...]:
    """Distance, time and energy of trip B; the mean is left to the reader."""
    driven_m, took_s, used_kwh = state.of(TripMeters).b.at(odometer(state), BATTERY_KWH)
    facts = grid(
        1,
        8,
        fact("trip_b.distance", say("Distance"), distance(state.signals, driven_m)),
        fact("trip_b.time", say("Driving time"), minutes(took_s)),
        fact("trip_b.energy", say("Energy"), Quantity(f"{used_kwh:.1f} kWh")),
    )
    reset = Button(key="trip_b.reset", text=say("Reset"), icon=Icon.TRIP, on_tap=_ResetTrip("b"))
    back = Button(key="trip_b.back", text=say("Trip A"), icon=Icon.BACK, on_tap=Back())
    whole = card(
        title(Icon.TRIP, say("Trip B"), "trip_b.title"),
        20,
        (3 * 64, line((640, facts), REST)),
        REST,
        (72, line((320, reset), REST, (320, back))),
        padding=(32, 24),
    )
    return fill(content(state), whole)


@offered
def reset_trip(state: State, meter: Annotated[Literal["a", "b"], "Which trip meter."]) -> CallMade:
    """Reset a trip meter: count distance and time from here."""
    return _ResetTrip(meter)


APP = App(
    name="trip",
    title=say("Trip"),
    icon=Icon.TRIP,
    order=15,
    where=Where.STORE,
    about=say("Distance, time and consumption"),
    functions=(reset_trip,),
    pages={"trip": AppPage(trip, Room.ONE), "trip_b": AppPage(trip_b, Room.ONE)},
    starts=lambda state, rng: (TripMeters(),),
)
