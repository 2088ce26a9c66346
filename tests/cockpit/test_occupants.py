"""Who is aboard, as the car tells it on every channel, and the cabin that they are left in."""

from collections.abc import Callable
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from automotive_cosim.cockpit.cabin import CABIN_LOSS, STEP_S, Air, Cabin, CabinStart, Controls, parked_c
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.forecast import cabin_c
from automotive_cosim.cockpit.occupants import (
    SIGNALS,
    USUAL_KG,
    Kind,
    Occupant,
    Seat,
    breath,
    company,
    seated,
    take_seats,
)
from automotive_cosim.cockpit.signals import HVAC, MOTION, OUTSIDE, SEAT, Signals
from automotive_cosim.cockpit.vehicle import WINDOWS, Vehicle
from automotive_cosim.contracts import FeedbackCode, Surroundings
from automotive_cosim.contracts.ids import key_of
from automotive_cosim.errors import SignalError, UserError
from tests.cockpit.fingers import find

Make = Callable[..., Cockpit]
BEHIND = (Seat.PASSENGER, Seat.REAR_LEFT, Seat.REAR_MIDDLE, Seat.REAR_RIGHT)


@st.composite
def parties(draw: st.DrawFn) -> tuple[Occupant, ...]:
    seats = draw(st.lists(st.sampled_from(BEHIND), unique=True))

    def one(seat: Seat) -> Occupant:
        kind = draw(st.sampled_from(Kind))
        asleep = kind is not Kind.OBJECT and draw(st.booleans())
        return Occupant(seat, kind, draw(st.integers(1, 150)), asleep, draw(st.booleans()))

    return tuple(sorted(map(one, seats), key=lambda one: list(Seat).index(one.seat)))


@given(parties())
def test_the_signals_hold_exactly_who_took_a_seat(party: tuple[Occupant, ...]) -> None:
    signals = Signals()
    take_seats(signals, party)
    driver, *others = seated(signals)
    assert driver == Occupant(Seat.DRIVER, Kind.ADULT, USUAL_KG[Kind.ADULT])
    assert tuple(others) == party
    for seat, at in SIGNALS.items():
        assert signals[at.occupied] is (seat is Seat.DRIVER or seat in {one.seat for one in party})


@pytest.mark.parametrize(
    ("party", "words"),
    [
        ((Occupant(Seat.PASSENGER, Kind.PET), Occupant(Seat.PASSENGER, Kind.BABY)), "two occupants .* passenger"),
        ((Occupant(Seat.DRIVER, Kind.PET),), "the driver is of the kind pet"),
        ((Occupant(Seat.DRIVER, Kind.ADULT, asleep=True),), "the driver is asleep"),
        ((Occupant(Seat.REAR_LEFT, Kind.OBJECT, asleep=True),), "only people and pets sleep"),
    ],
)
def test_impossible_company_is_refused(party: tuple[Occupant, ...], words: str) -> None:
    with pytest.raises(UserError, match=words):
        take_seats(Signals(), party)
    with pytest.raises(SignalError, match="0 to 200 kg"):
        take_seats(Signals(), [Occupant(Seat.PASSENGER, Kind.OBJECT, 300.0)])


def test_screen_reading_and_signals_tell_the_same(make: Make) -> None:
    party = (
        Occupant(Seat.REAR_LEFT, Kind.BABY, asleep=True),
        Occupant(Seat.REAR_MIDDLE, Kind.OBJECT, 3.0, belted=False),
        Occupant(Seat.REAR_RIGHT, Kind.PET, 24.0),
    )
    cockpit = make(aboard=party)
    assert cockpit.open_app("cabin").code is FeedbackCode.OK
    shown = {key_of(one.resource_id): one.text for one in cockpit.elements()}
    assert (shown["cabin.rear_left"], shown["cabin.rear_left.awake"]) == ("Baby", "Asleep")
    assert (shown["cabin.rear_middle"], shown["cabin.rear_middle.belt"]) == ("Object", "Unbuckled")
    assert (shown["cabin.rear_right"], shown["cabin.rear_right.weight"]) == ("Pet", "24 kg")
    assert (shown["cabin.passenger"], "cabin.passenger.weight" in shown) == ("Empty", False)
    assert cockpit.vehicle_state().aboard == (
        "driver: adult, 75 kg, awake, belted; rear left: baby, 8 kg, asleep, belted; "
        "rear middle: object, 3 kg, not belted; rear right: pet, 24 kg, awake, belted"
    )


def test_breath_grows_with_the_bodies_and_things_have_none() -> None:
    signals = Signals()
    assert breath(signals) == 1.0
    assert breath(signals, without=Seat.DRIVER) == 0.0
    take_seats(signals, company(4))
    assert breath(signals) == 4.0
    take_seats(signals, [Occupant(Seat.REAR_LEFT, Kind.OBJECT, 80.0)])
    assert breath(signals) == 3.0
    take_seats(signals, [Occupant(Seat.REAR_LEFT, Kind.PET, 24.0)])
    assert breath(signals) == pytest.approx(3 + 0.32**0.75)


OFF = Controls(21.0, 0.0, False, False, False, False, False, 0.0, 0.0, people=0.0)


def test_the_forecast_agrees_with_the_cabin_s_own_steps() -> None:
    """Without sun, where both know everything; the glass that stores heat aside."""
    cold, people = Air(5.0, 40.0, 0.0, 0.0), replace(OFF, people=2.0)
    cabin = Cabin.at(CabinStart(temperature_c=24.0, humidity_pct=20.0), cold)
    stepped = cabin.after(600.0, people, cold)
    assert parked_c(24.0, 10.0, people, cold, 0.0) == pytest.approx(stepped.temperature_c, abs=2 * STEP_S)


@pytest.mark.parametrize(("minutes", "rise_c"), [(10.0, 10.6), (20.0, 16.1), (60.0, 23.9)])
def test_a_car_in_the_sun_heats_up_as_measured(minutes: float, rise_c: float) -> None:
    """McLaren, Null, Quinn 2005: 19, 29 and 43 degrees Fahrenheit, mean of 16 sunny days."""
    warm = Air(27.0, 40.0, 0.0, 0.0)
    assert parked_c(27.0, minutes, OFF, warm, 1600.0) - 27.0 == pytest.approx(rise_c, rel=0.12)


def test_windows_left_ajar_hardly_help_and_the_climate_does() -> None:
    sunny = {OUTSIDE.TEMPERATURE.path: 31.0, OUTSIDE.LIGHT.path: 100.0, HVAC.CABIN_TEMPERATURE.path: 22.0}
    shut, ajar = Vehicle(Signals(sunny)), Vehicle(Signals(sunny | {window.path: 20.0 for window in WINDOWS}))
    assert (
        40.0
        < cabin_c(ajar, 20, climate=False)
        < cabin_c(shut, 20, climate=False)
        < cabin_c(shut, 30, climate=False)
    )
    assert cabin_c(shut, 20, climate=True) < 26.0
    assert cabin_c(shut, 0, climate=False) == cabin_c(shut, 0, climate=True) == 22.0


@given(st.floats(-20, 45), st.floats(16, 28), st.floats(0, 1600), st.floats(0, 60))
def test_climate_control_keeps_between_what_it_can_and_what_is_set(
    outside_c: float, set_c: float, sun_w: float, minutes: float
) -> None:
    air, on = Air(outside_c, 40.0, 0.0, 0.0), replace(OFF, set_c=set_c, fan_pct=100.0, air_conditioning=True)
    start_c = set_c
    then_c = parked_c(start_c, minutes, on, air, sun_w)
    alone_c = parked_c(start_c, minutes, OFF, air, sun_w)
    low, high = sorted((set_c, outside_c + sun_w / CABIN_LOSS))
    assert low - 1e-6 <= then_c <= high + 1e-6 or abs(then_c - set_c) <= abs(alone_c - set_c) + 1e-6


def test_the_signal_of_the_forecast_follows_the_switch_and_home_shows_it_when_parked(
    make: Make, around: Surroundings
) -> None:
    hot = replace(around, weather=replace(around.weather, temperature_2m=31.0), sun_elevation_deg=60.0)
    still = replace(hot, driving=replace(hot.driving, speed_mps=0.0))
    cockpit = make(surroundings=still, signals={MOTION.GEAR.path: "P"})
    left = cockpit.signals[HVAC.FORECAST]
    note = find(cockpit, "home.cabin_note").text
    assert note == f"If you leave: {left:.0f} °C"
    assert left > 40.0
    cockpit.command(HVAC.KEPT, True)
    cockpit.sense(still, 1.0)
    assert cockpit.signals[HVAC.FORECAST] < 26.0


def test_the_airbag_is_switched_only_at_a_standstill(make: Make, around: Surroundings) -> None:
    assert make().command(SEAT.PASSENGER_AIRBAG, False).code is FeedbackCode.REFUSED
    still = replace(around, driving=replace(around.driving, speed_mps=0.0))
    assert make(surroundings=still).command(SEAT.PASSENGER_AIRBAG, False).code is FeedbackCode.OK
