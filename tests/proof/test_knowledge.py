"""What is told before it is used, on hand-made screens."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from automotive_cosim.cockpit.apps.phone.state import Thread
from automotive_cosim.cockpit.apps.trip import TripMeter
from automotive_cosim.cockpit.belongings import Belongings
from automotive_cosim.cockpit.occupants import Kind, Occupant, Seat, take_seats
from automotive_cosim.cockpit.signals import ADAS, BODY, Signals
from automotive_cosim.contracts import BoundingBox, Element
from automotive_cosim.proof.knowledge import DrawnValues, normal, unknown
from automotive_cosim.tasking.checks import nothing_done
from automotive_cosim.tasking.dialogue import Says, Topic
from automotive_cosim.tasking.moves import Consult, Open, Tap, TypeText
from automotive_cosim.tasking.parameters import param
from automotive_cosim.tasking.task import Basis, Deadline, Half, Start
from automotive_cosim.tasking.triggers import Trigger, driving

HALF = Half(
    Start("grid", "avenue"),
    Trigger(driving(), 3.0, 60.0),
    nothing_done(),
    (),
    Deadline(60.0, "for the test"),
    Basis.WISH,
)
ZONES = {"zone": ("A", "B", "C")}


def shown(
    *texts: str, said: tuple[str, ...] = (), selected: str = "", aboard: tuple[Occupant, ...] = ()
) -> SimpleNamespace:
    """A step with these texts on the screen; ids are what comes before a bar."""
    elements = []
    for text in texts:
        name, _, words = text.rpartition("|")
        elements.append(
            Element(words, "", "TextView", BoundingBox(0, 0, 9, 9), name, "", is_selected=name == selected != "")
        )
    signals = Signals()
    take_seats(signals, aboard)
    moment = SimpleNamespace(context=SimpleNamespace(text=lambda: "Country: FR"), signals=signals.snapshot())
    return SimpleNamespace(elements=elements, said=said, feedback=SimpleNamespace(text=""), moment=moment)


def guesses(half: Half, steps, choices=ZONES, template: str = "Pay here.", moves=None, **drawn) -> list[str]:
    known = DrawnValues({name: values[0] for name, values in choices.items()} | drawn, choices)
    return list(unknown(half, template, known, steps, moves or [*range(len(half.moves)), None]))


PAYS = replace(HALF, moves=(Open("parking"), Tap(text="Zone {zone}")))
MENU = shown("parking.zone.a|Zone A", "parking.zone.b|Zone B", "parking.zone.c|Zone C")


def test_a_menu_does_not_tell_which_of_it_is_meant():
    (wrong,) = guesses(PAYS, [shown("Home"), MENU], zone="B")
    assert "depends on zone ('B')" in wrong
    assert "'A' or 'C'" in wrong


def test_the_driver_a_message_and_a_remark_tell():
    assert guesses(PAYS, [shown("Home"), MENU], template="Pay for zone {zone}.", zone="B") == []
    wrote = replace(
        PAYS.start, belongings=Belongings(threads=(Thread("Isla", "", ("It's zone {zone}.",), unread=True),))
    )
    message = shown("Isla\nIt's zone B.")
    assert guesses(replace(PAYS, start=wrote), [message, MENU], zone="B") == []
    says = replace(PAYS, says=(Says("Zone {zone}!"),))
    assert guesses(says, [shown("Home", said=("Zone B!",)), MENU], zone="B") == []


def test_what_is_told_after_the_act_comes_too_late():
    wrote = replace(
        PAYS.start, belongings=Belongings(threads=(Thread("Isla", "", ("It's zone {zone}.",), unread=True),))
    )
    half = replace(PAYS, start=wrote)
    assert guesses(half, [shown("Home"), MENU, shown("It's zone B.")], zone="B")


def test_a_hint_that_fits_several_leaves_them_open():
    hint = {"A": "One of the first two", "B": "One of the first two", "C": "The last one"}
    wrote = replace(PAYS.start, belongings=Belongings(memos=(param("zone", hint),)))
    (wrong,) = guesses(replace(PAYS, start=wrote), [shown("One of the first two"), MENU], zone="A")
    assert wrong.endswith("it could be 'B' just as well")
    assert guesses(replace(PAYS, start=wrote), [shown("The last one"), MENU], zone="C") == []


def test_an_act_that_is_the_same_for_all_that_is_left_is_no_guess():
    anyway = replace(PAYS, moves=(Tap(param("zone", {"A": "left", "B": "left", "C": "right"})),))
    wrote = replace(anyway.start, belongings=Belongings(memos=(param("zone", {"A": "x1", "B": "x1", "C": "x2"}),)))
    assert guesses(replace(anyway, start=wrote), [shown("x1")], zone="A") == []


def test_a_number_is_told_in_another_unit():
    meter = param("km", {34: TripMeter(34_000.0, 3600.0, 5.0), 52: TripMeter(52_000.0, 3600.0, 5.0)})
    start = replace(HALF.start, belongings=Belongings(trip_b=meter))
    half = replace(HALF, start=start, moves=(Tap("figure.up", param("km")),))
    choices = {"km": (34, 52)}
    assert guesses(half, [shown("34.0 km")], choices) == []
    assert guesses(half, [shown("52.0 km")], choices)


def test_a_setting_is_told_where_it_is_shown_selected():
    paces = {each.path: param("which", {"front": front, "rear": rear}) for each, front, rear in (
        (BODY.FRONT_WIPER, "SLOW", "OFF"), (BODY.REAR_WIPER, "OFF", "SLOW"))}  # fmt: skip
    half = replace(HALF, start=replace(HALF.start, signals=paces), moves=(Tap("wiper.{which}.off"),))
    choices = {"which": ("front", "rear")}
    page = ("wiper.front.off|Off", "wiper.front.slow|Slow", "wiper.rear.off|Off", "wiper.rear.slow|Slow")
    assert guesses(half, [shown(*page, selected="wiper.front.slow")], choices) == []
    assert guesses(half, [shown("Home")], choices)


def test_a_level_is_told_by_its_number():
    half = replace(
        HALF,
        start=replace(HALF.start, signals={ADAS.LIMITER_SPEED.path: param("kmh")}),
        moves=(Tap("figure.up", param("kmh")),),
    )
    assert guesses(half, [shown("adas.limiter_speed.value|80 km/h")], {"kmh": (80.0, 90.0)}) == []
    assert guesses(half, [shown("adas.limiter_speed.value|90 km/h")], {"kmh": (80.0, 90.0)})


def test_what_a_place_has_is_told_on_its_own_page_only():
    hours = param("name", {name: {"Sun": "Shut", "Park": "Shut"} | {name: "Open"} for name in ("Sun", "Park")})
    half = replace(
        HALF, start=replace(HALF.start, belongings=Belongings(details=hours)), moves=(Tap(text="{name}"),)
    )
    choices = {"name": ("Sun", "Park")}
    assert guesses(half, [shown("Sun", "Park")], choices)
    assert guesses(half, [shown("Sun", "Open")], choices) == []


def test_a_question_names_only_what_has_been_seen():
    half = replace(
        HALF, moves=(Consult("Adler or Costa?"),), topics=(Topic("which", (("adler",), ("costa",)), "Adler.", ()),)
    )
    (wrong,) = guesses(half, [shown("A. Costa")], {})
    assert "names 'adler'" in wrong
    assert guesses(half, [shown("A. Costa", "A. Adler")], {}) == []


def test_what_is_typed_has_been_told():
    half = replace(HALF, moves=(TypeText("search", "Quai 7"),))
    assert guesses(half, [shown("Home")], {})
    assert guesses(half, [shown("quai no. 7")], {}) == []


@pytest.mark.parametrize(
    ("text", "means"),
    [("At 6:30 p.m.", "at 18:30"), ("12 am", "0:00"), ("Seven  eggs", "7 eggs"), ("1,5 km", "1.5 km")],
)
def test_hours_and_numbers_read_alike(text, means):
    assert normal(text) == means


def test_who_is_aboard_tells_where_and_their_kilograms_tell_no_number():
    left, right = (Occupant(seat, Kind.CHILD) for seat in (Seat.REAR_LEFT, Seat.REAR_RIGHT))
    start = replace(HALF.start, aboard=param("side", {"left": (left,), "right": (right,)}))
    half = replace(HALF, start=start, moves=(Tap("door.child_{side}"),))
    sides = {"side": ("left", "right")}
    assert guesses(half, [shown("Doors", aboard=(left,))], sides, side="left") == []
    assert guesses(half, [shown("Doors")], sides, side="left")
    slider = replace(HALF, moves=(Tap("window.{percent}"),))
    assert guesses(slider, [shown("Doors", aboard=(left,))], {"percent": (20, 30)}, percent=20)
