"""What a car lacks: whatever is missing in the suite of limits can neither be touched, nor called, nor read."""

import numpy as np
import pytest

from automotive_cosim.cockpit.calls import functions
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.commands import Set
from automotive_cosim.cockpit.missing_parts import Lacking
from automotive_cosim.cockpit.registry import pages
from automotive_cosim.cockpit.signals import ACTUATORS, BODY, HVAC, MEDIA, SEAT, TYRE
from automotive_cosim.cockpit.widgets import Slider
from automotive_cosim.contracts import FeedbackCode
from automotive_cosim.tasking.instance import draw
from automotive_cosim.tasking.sets import Suite
from automotive_cosim.tasks import CATALOGUE
from tests.cockpit.conftest import town
from tests.laws import over

LACKS = [
    each
    for task in CATALOGUE.of(Suite.LIMITS)
    for each in draw(task, "second", 0, {"places": ("x",), "contacts": ("x",)}).half.start.lacks
]
TOWN = town()


def car(*lacks: Lacking) -> Cockpit:
    return Cockpit(TOWN, rng=np.random.default_rng(0), lacks=lacks)


def barred(lacking: Lacking):
    """Commands that the car has to refuse."""
    for signal in lacking.signals:
        if signal.path in ACTUATORS:
            values = signal.allowed or ((not signal.default,) if isinstance(signal.default, bool) else ())
            numbers = () if values else (signal.low, signal.high)
            yield from (Set(signal, value) for value in (*values, *numbers) if lacking.bars(signal, value))


@over(LACKS)
def test_what_is_missing_cannot_be_commanded_and_says_why(lacking):
    cockpit = car(lacking)
    before = cockpit.state.commands()
    for command in barred(lacking):
        told = cockpit.command(command.signal, command.value)
        assert (told.code, told.text) == (FeedbackCode.REFUSED, lacking.words)
    for name in lacking.functions:
        told = cockpit.call(name, {})
        assert (told.code, told.text) == (FeedbackCode.DISABLED, lacking.words)
    assert cockpit.state.commands() == before


def test_an_empty_row_says_what_is_missing():
    cockpit = car(Lacking("rear wiper", (BODY.REAR_WIPER,)))
    cockpit.visit("vehicle")
    assert "This car has no rear wiper" in {widget.text for widget in cockpit.tree.walk()}


def test_a_missing_part_says_so_in_its_place():
    cockpit = car(Lacking("digital radio", (MEDIA.SOURCE,), ("DAB",), keys=("media.source.dab",)))
    cockpit.visit("media")
    (line,) = (each for each in cockpit.tree.walk() if each.description == "This car has no digital radio")
    assert (line.text, line.listens) == ("Not fitted", False)


@over(LACKS)
def test_no_screen_offers_what_is_missing(lacking):
    cockpit = car(lacking)
    for name in pages():
        cockpit.visit(name)
        for widget in cockpit.tree.walk():
            tap = widget.on_tap
            if isinstance(tap, Set) and lacking.bars(tap.signal, tap.value):
                assert widget.disabled == lacking.words
                assert lacking.is_broken
            if isinstance(widget, Slider) and widget.signal in lacking.signals:
                assert lacking.words in (widget.description, widget.disabled)


def test_a_reading_without_a_sensor_is_none_and_a_dash():
    cockpit = car(Lacking("tyre pressure sensors", (TYRE.REAR_LEFT,), keys=("tyre.rear_left",), is_broken=True))
    told = cockpit.call("get_signals", {"path": TYRE.REAR_LEFT.path})
    assert told.text.endswith("null}")
    shown = cockpit.call("read_screen", {"screen": "driving", "item": ""})
    assert "–. Not working: tyre pressure sensors" in shown.text


def test_what_only_some_values_lack_still_takes_the_others():
    cockpit = car(Lacking("seat ventilation", (SEAT.DRIVER_HEATING,), (-100.0, -1.0)))
    assert cockpit.command(SEAT.DRIVER_HEATING, 50.0).code is FeedbackCode.OK
    assert cockpit.command(SEAT.DRIVER_HEATING, -50.0).code is FeedbackCode.REFUSED
    assert "set_seat_heating" in functions()


@pytest.mark.parametrize(("signal", "value"), [(HVAC.CABIN_HUMIDITY, 3.0), (BODY.WASHER_FLUID, 99.0)])
def test_a_sensor_that_is_wrong_always_reads_the_same(signal, value):
    cockpit = Cockpit(TOWN, rng=np.random.default_rng(0), sensors={signal.path: value})
    assert cockpit.signals[signal] == value
