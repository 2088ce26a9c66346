"""The screens say what is so, and what they advise can be done."""

from collections.abc import Callable
from dataclasses import replace
from datetime import datetime

import numpy as np
import pytest

from automotive_cosim.cockpit.apps.phone.arrivals import Arrival
from automotive_cosim.cockpit.apps.phone.state import EARLIER, Contact, Thread
from automotive_cosim.cockpit.apps.vehicle.state import REMEMBERED, car
from automotive_cosim.cockpit.belongings import Belongings
from automotive_cosim.cockpit.cockpit import Cockpit
from automotive_cosim.cockpit.drawing import fit
from automotive_cosim.cockpit.signals import CABIN, HMI, LINK, MIRROR, SEAT
from automotive_cosim.cockpit.telltales import PLATES, SignKind, sign_picture
from automotive_cosim.cockpit.theme import Icon, Type
from automotive_cosim.cockpit.widgets import Button
from automotive_cosim.contracts import Element, FeedbackCode, Surroundings
from automotive_cosim.contracts.ids import key_of

from .conftest import View, outside, town

Make = Callable[..., Cockpit]
BEN = "Ben Marsh"
WRITTEN = Belongings((Contact(BEN, "555 45 72"),), (Thread(BEN, EARLIER, ("Later",), unread=True),))


def found(cockpit: Cockpit, key: str) -> Element:
    return next(each for each in cockpit.elements() if key_of(each.resource_id) == key)


def tapped(cockpit: Cockpit, key: str) -> str:
    box = found(cockpit, key).bbox_pixels
    return cockpit.tap((box.x_min + box.x_max) // 2, (box.y_min + box.y_max) // 2).text


@pytest.fixture
def parked(make: Make, around: Surroundings) -> Cockpit:
    cockpit = make()
    cockpit.inject("Vehicle.Powertrain.Transmission.Gear", "P")
    cockpit.sense(replace(around, driving=replace(around.driving, speed_mps=0.0)), 0.0)
    return cockpit


def test_the_keypad_shows_the_whole_number(parked: Cockpit) -> None:
    parked.visit("phone")
    tapped(parked, "phone.tab.keypad")
    for digit in "011441134960163":
        tapped(parked, f"phone.key.{digit}")
    assert found(parked, "phone.number").text == "011441134960163"


def test_a_number_too_long_to_be_drawn_loses_its_beginning() -> None:
    _, (line,), is_cut = fit("0123456789" * 9, Type.TITLE, 400, 1, keeps_end=True)
    assert is_cut
    assert (line[0], line[-3:]) == ("…", "789")


def test_who_types_where_there_is_no_field_is_told_what_there_is(parked: Cockpit) -> None:
    parked.visit("phone")
    tapped(parked, "phone.tab.keypad")
    told = parked.type_text("0114")
    assert (told.code, told.text) == (
        FeedbackCode.NO_SUCH_ELEMENT,
        "there is no text field here; press the keys on the screen one by one",
    )
    parked.visit("climate")
    assert parked.type_text("21").text == parked.key_enter().text == "there is no text field here"
    parked.visit("map")
    assert parked.type_text("Home").text == "no text field has the focus; tap one first"


@pytest.mark.parametrize("time", ["2026-05-12T07:40", "2026-05-12T00:05"])
def test_nothing_is_dated_later_than_the_clock(time: str, around: Surroundings) -> None:
    now = datetime.fromisoformat(time).replace(tzinfo=around.local_time.tzinfo)
    cockpit = Cockpit(town(), rng=np.random.default_rng(1), belongings=WRITTEN)
    cockpit.sense(replace(around, local_time=now), 0.0)
    cockpit.expect((Arrival("message", 1.0, BEN, "Are we there yet?"), Arrival("call", 2.0, BEN)))
    for seconds in range(1, 60):
        cockpit.sense(outside(900.0 + seconds, local_time=now), 1.0)
    for page, tab in (("phone", "messages"), ("phone", "recents"), ("notifications", "")):
        cockpit.visit(page)
        if tab:
            tapped(cockpit, f"phone.tab.{tab}")
        clocks = [word for each in cockpit.elements() for word in each.text.split() if ":" in word]
        days = [each.text for each in cockpit.elements() if "ago" in each.text or "Yesterday" in each.text]
        today = [clock for clock in clocks if not any(clock in text for text in days)]
        assert today
        assert max(today) <= f"{now:%H:%M}", (page, tab, today)


def test_messages_are_read_out_with_their_times(around: Surroundings) -> None:
    cockpit = Cockpit(town(), rng=np.random.default_rng(1), belongings=WRITTEN)
    cockpit.sense(around, 0.0)
    cockpit.expect((Arrival("message", 1.0, BEN, "Are we there yet?"), Arrival("message", 2.0, BEN, "I'm bored")))
    for seconds in range(1, 4):
        cockpit.sense(outside(900.0 + seconds), 1.0)
    told = cockpit.call("read_messages", {"who": BEN})
    assert told.code is FeedbackCode.READ_OUT
    assert told.text == f"{BEN} wrote: 13:45: Later. 14:05: Are we there yet? I'm bored."


def test_a_mirror_turns_to_the_side_that_its_button_is_on_and_says(parked: Cockpit) -> None:
    parked.visit("mirrors")
    for who, signal in (("driver", MIRROR.DRIVER_PAN), ("passenger", MIRROR.PASSENGER_PAN)):
        left, right = (found(parked, f"mirror.{who}.pan.{act}") for act in ("increase", "decrease"))
        assert left.bbox_pixels.x_max < right.bbox_pixels.x_min
        assert left.content_description.endswith("to the left by 10")
        assert right.content_description.endswith("to the right by 10")
        tapped(parked, f"mirror.{who}.pan.increase")
        assert parked.signals[signal] == 10.0  # VSS: 100 is fully left


def test_a_step_is_as_whole_as_the_value_it_changes(parked: Cockpit) -> None:
    parked.inject(HMI.TEMPERATURE_UNIT.path, "F")
    parked.inject(HMI.DISTANCE_UNIT.path, "MILES")
    for page in ("climate", "assistance"):
        parked.visit(page)
        steps = [each.content_description for each in parked.elements() if "er by " in each.content_description]
        assert steps
        assert not [step for step in steps if "." in step.rsplit("by", 1)[1]]


def test_a_seat_at_its_end_says_which(parked: Cockpit) -> None:
    ends = {
        SEAT.DRIVER_POSITION: ("position", "as far forward as it goes", "as far back as it goes"),
        SEAT.DRIVER_RECLINE: ("recline", "as upright as it goes", "as far back as it goes"),
        SEAT.DRIVER_HEIGHT: ("height", "at its lowest", "at its highest"),
    }
    for signal, (name, least, most) in ends.items():
        for value, act, words in ((signal.low, "decrease", least), (signal.high, "increase", most)):
            parked.inject(signal.path, value)
            parked.visit("seats")
            assert words in found(parked, f"seat.driver.{name}.{act}").content_description


def test_seats_are_remembered_as_people_drive() -> None:
    memories = [values for seed in range(30) for values in car(np.random.default_rng(seed)).memory]
    angles = {values[REMEMBERED.index(SEAT.DRIVER_RECLINE)] for values in memories}
    assert len(angles) > 3
    assert all(20 <= angle <= 28 for angle in angles)


def test_a_limit_sign_has_the_form_of_its_country() -> None:
    pictures = {}
    for country in ("US", "CA", "GB", ""):
        cockpit = Cockpit(town(), rng=np.random.default_rng(1))
        cockpit.sense(outside(sign_unit="mph", sign_country=country), 0.0)
        pictures[country] = cockpit.screenshot().tobytes()
    assert pictures["GB"] == pictures[""]
    assert len(set(pictures.values())) == 3
    for country in PLATES:
        corner = sign_picture(SignKind.LIMIT, "30", 64, country).getchannel("A").getpixel((10, 3))
        assert corner == 255, "a plate has corners, a disc has none"


def test_the_doors_page_says_that_doors_stay_locked_while_the_car_moves(cockpit: Cockpit, parked: Cockpit) -> None:
    cockpit.visit("doors")
    assert found(cockpit, "door.driving").text == "Keep the doors locked while driving"
    tapped(cockpit, "door.all")
    assert not cockpit.signals[CABIN.DRIVER_LOCK], "it stays possible"
    parked.visit("doors")
    assert not any(key_of(each.resource_id) == "door.driving" for each in parked.elements())


@pytest.mark.slow
def test_minus_and_plus_go_further_when_held_and_nothing_else_does(
    parked: Cockpit, walker: Callable[[Cockpit], tuple[View, ...]]
) -> None:
    signed = {Icon.MINUS, Icon.PLUS, Icon.TO_THE_LEFT, Icon.TO_THE_RIGHT}
    held = set[str]()
    for view in walker(parked):
        for widget in view.cockpit.tree.walk():
            is_signed = isinstance(widget, Button) and not widget.text and widget.icon in signed
            assert is_signed == (isinstance(widget, Button) and widget.on_hold is not None), (view.name, widget.key)
            if is_signed:
                held.add(widget.key)
    assert {"timer.more", "map.zoom_in", "safety.speed.increase", "climate.schedule.later"} <= held


def test_a_held_minus_stops_at_the_end(parked: Cockpit) -> None:
    parked.visit("timer")
    box = found(parked, "timer.less").bbox_pixels
    parked.long_press((box.x_min + box.x_max) // 2, (box.y_min + box.y_max) // 2)
    assert found(parked, "timer.left").text == "5:00"
    assert not found(parked, "timer.less").is_enabled


def test_an_arrival_to_be_sent_begins_with_that_of_the_route(parked: Cockpit) -> None:
    parked.visit("figure")
    now = outside().local_time
    assert f"{now:%H:%M}" == "14:05"
    assert (
        found(parked, "figure.words").text == "I'll be there at 14:20"
    )  # 640 s from now, in steps of five minutes
    tapped(parked, "figure.say.paid")
    tapped(parked, "figure.say.arrive")
    assert found(parked, "figure.words").text == "I'll be there at 14:20"


def test_a_message_in_own_words_is_typed_when_parked(parked: Cockpit) -> None:
    parked.visit("thread")
    tapped(parked, "thread.figure")
    tapped(parked, "figure.say.own")
    assert not found(parked, "figure.send").is_enabled
    tapped(parked, "figure.own")
    parked.type_text("Bring the  blue folder")
    assert tapped(parked, "figure.send").endswith("Bring the blue folder")
    assert parked.commands()["messages.sent"][-1]["text"] == "Bring the blue folder"
    assert found(parked, "figure.own").text == ""


@pytest.mark.parametrize(("language", "typed"), [("en", "on my way!"), ("de", "Bin unterwegs")])
def test_what_differs_from_a_reply_by_its_signs_is_that_reply(parked: Cockpit, language: str, typed: str) -> None:
    parked.command(HMI.LANGUAGE, language)
    parked.visit("thread")
    tapped(parked, "thread.figure")
    tapped(parked, "figure.say.own")
    tapped(parked, "figure.own")
    parked.type_text(typed)
    assert parked.key_enter().code is FeedbackCode.OK
    assert parked.commands()["messages.sent"][-1]["text"] == "On my way"


def test_while_driving_a_message_is_dictated_and_not_shown(make: Make, around: Surroundings) -> None:
    driving = make()
    driving.sense(around, 0.0)
    driving.visit("thread")
    tapped(driving, "thread.figure")
    tapped(driving, "figure.say.own")
    assert tapped(driving, "figure.own") == "Typing is locked while driving"
    tapped(driving, "figure.dictate")
    assert driving.type_text("Bring the blue folder").code is FeedbackCode.OK
    assert driving.type_text("again").code is FeedbackCode.RESTRICTED
    tapped(driving, "figure.send")
    assert driving.commands()["messages.sent"][-1]["text"] == "Bring the blue folder"
    tapped(driving, "figure.back")
    assert not any("blue folder" in element.text for element in driving.elements())
    driving.command(LINK.VOICE_ASSISTANT, False)
    driving.visit("figure")
    assert not found(driving, "figure.dictate").is_enabled


def test_what_goes_by_steps_shows_its_ends(parked: Cockpit) -> None:
    parked.visit("seats")
    assert found(parked, "seat.driver.position.value").content_description == "Seats: Position. 0 mm … 260 mm"
    assert found(parked, "seat.driver.massage").content_description == "Off, Low, High"
    parked.visit("climate")
    assert found(parked, "hvac.driver_seat_heating").content_description == "Driver: Seat heat. Off, Low, High"


def test_a_row_says_where_it_leads() -> None:
    cockpit = Cockpit(town(), rng=np.random.default_rng(1), belongings=Belongings(memos=("Buy bread",)))
    cockpit.visit("memo")
    assert found(cockpit, "memo.0").content_description == "Details"
